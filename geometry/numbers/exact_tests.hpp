// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Exact tests: order along a line, whether rounding explains an in-sphere sign. The checker
// asks them, and the diagnosis, which wall comes first. Each is decided by a filter in extended precision, then by rationals.
// Pure functions, any thread.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "pgdr/types.hpp"

namespace pgdr::checking {

/// True iff |det| of in_sphere(s, p) is at most the change that moving each point i (the corners, then p) by at most
/// `delta[i]` in each coordinate can make: then the points may stand for a configuration that is Delaunay.
template <int D>
bool rounding_cancels(const Simplex<D>& s, const Point<D>& p, const std::array<double, D + 2>& delta);

/// Is an edge (2D: or a height) at most 8 ulps of `largest` long, the largest coordinate of all? Where input points are so near
/// to others, or to segments, few places are left for points between, and poor cells stay.
template <int D>
bool is_as_short_as_rounding(const Simplex<D>& s, double largest);

/// The order in which the open segment from q to p crosses the given simplices of dimension D - 1; empty if two of them
/// are crossed at the same point. @pre q lies strictly on one side of each, p on the other.
template <int D>
std::vector<std::uint32_t> order_along(const Point<D>& q, const Point<D>& p,
                                       const std::vector<std::array<Point<D>, D>>& simplices);

}  // namespace pgdr::checking
