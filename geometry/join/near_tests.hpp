// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// What is within a width of what, for coordinates of the size of 1: points and edges, points and triangles, edges and edges. In
// doubles, whose error is a few ulps of the longest edge; where that might decide, as at needles, in twice as many digits. Pure
// functions, any thread.
#pragma once

#include <array>
#include <optional>

#include "pgdr/types.hpp"

namespace pgdr::detail {

/// How far on the way from a to b the point of the line nearest to p is, from 0 to 1, both excluded; none if p is not within
/// `width` of the line there.
template <int D>
std::optional<double> part_of_edge_near(const Point<D>& p, const Point<D>& a, const Point<D>& b, double width);
/// Do two edges pass each other within `width` inside of both? Parallel ones do not.
bool pass_within(const std::array<Point3, 2>& e, const std::array<Point3, 2>& f, double width);
/// Is p within `width` of the triangle?
bool is_near_triangle(const Point3& p, const std::array<Point3, 3>& t, double width);

}  // namespace pgdr::detail
