// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The grid that points go to where rounds of nearest doubles do not end (after the heuristic of Valque and Lazard): they move by
// as much as half of it, so that sheets which shred each other become one, or part. Any thread.
#pragma once

#include <span>

#include "pgdr/plc.hpp"

namespace pgdr::detail {

class Grid {
 public:
  Grid() = default;
  /// As wide as 2^-23 of the power of two above the largest coordinate: coarser than what files of floats say.
  explicit Grid(const Plc<3>& plc);

  /// The nearest point of the grid.
  Point3 nearest(const Point3& p) const;
  /// Moves all points that have the nearest one in common with any of these. True if any moved.
  bool snap(Plc<3>& plc, std::span<const Point3> places);
  double farthest() const { return farthest_; }  ///< that a point has moved

 private:
  double width_ = 1;
  double farthest_ = 0;
};

}  // namespace pgdr::detail
