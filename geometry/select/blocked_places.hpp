// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Where Delaunay refinement puts a point for a cell over the bound of shape, and what keeps it from there. A point that a facet
// hides from the cell, or that lies in the smallest ball about a triangle of a facet or about a segment, does not go in: that
// is split in its place. Where it may not be split, the cell stays. The mesher finds such a facet or segment by this, and the
// checker verifies it by the same: pure functions of coordinates, any thread.
#pragma once

#include <array>

#include "pgdr/types.hpp"

namespace pgdr::detail {

/// See above.
struct PlacesForCell {
  Point3 from;                   ///< inside the cell: its centroid
  std::array<Point3, 2> places;  ///< its circumcentre, and the off-centre if that is nearer

  static constexpr unsigned all = 3;  ///< of what blocked() returns

  /// @pre the cell is positive
  PlacesForCell(const Simplex<3>& cell, double radius_edge_bound);

  /// The sum of 1 << i of the places i that the triangle hides, seen from inside the cell, or in whose equatorial ball it has.
  unsigned blocked_by_triangle(const std::array<Point3, 3>& corners) const;
  /// The same of the places in the diametral ball of a segment, which hides nothing.
  unsigned blocked_by_segment(const std::array<Point3, 2>& ends) const;
};

}  // namespace pgdr::detail
