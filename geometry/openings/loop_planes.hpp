// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Which of the loops in which a surface ends lie in a plane each, and which lie in one plane together.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "build/fitted_plane.hpp"
#include "input/triangle_shapes.hpp"
#include "openings/open_loops.hpp"
#include "pgdr/domain.hpp"
#include "space/box.hpp"
#include "space/stop_check.hpp"

namespace pgdr::detail {

/// The plane of a loop.
struct LoopPlane {
  int axis;                              ///< along which most is seen of it
  double area;                           ///< of the loop, rounded
  FittedPlane fitted;                    ///< of the scaled points
  std::array<std::uint32_t, 3> largest;  ///< triangle between points of the loop
  Box<3> box;                            ///< of the loop
};

class LoopPlanes {
 public:
  LoopPlanes(const Domain<3>& domain, std::span<const OpenLoop> loops, const StopCheck& stop);

  /// None: the loop is not closed.
  const std::optional<LoopPlane>& of(std::uint32_t loop) const { return planes_[loop]; }
  /// Does the point lie in the plane, exactly or within the tolerance?
  bool is_in(const LoopPlane& plane, std::uint32_t point) const;
  /// Do all points of a loop?
  bool is_in(const LoopPlane& plane, const OpenLoop& loop) const;
  /// Planar loops in groups, by their least ones: two are in one group if the smaller is in the plane and the box of the larger,
  /// so that it may lie in that; and what hangs together by such pairs.
  std::vector<std::vector<std::uint32_t>> groups(const StopCheck& stop) const;

 private:
  std::optional<LoopPlane> plane_of(const OpenLoop& loop) const;
  bool has(const LoopPlane& leader, std::uint32_t loop) const;

  const Domain<3>& domain_;
  std::span<const OpenLoop> loops_;
  double scale_;
  TriangleShapes shapes_;
  std::vector<std::optional<LoopPlane>> planes_;
};

}  // namespace pgdr::detail
