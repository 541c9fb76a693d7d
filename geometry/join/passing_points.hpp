// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Which points a segment of the plane passes so nearly that it goes through them. Pure functions; any thread.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "input/edges.hpp"
#include "pgdr/types.hpp"

namespace pgdr::detail {

/// Would x split the segment pq into two that are shorter than it is, and lie side by side along it?
bool splits_into_shorter(const Point2& p, const Point2& q, const Point2& x);
/// Is x, which is neither p nor q, within the tolerance (0: exactly) of the inside of the segment pq? False, too, where it would
/// not split it into shorter ones. @pre coordinates are at most of the size of 1
bool passes_within(const Point2& p, const Point2& q, const Point2& x, double tolerance);
/// From one end of the edge to the other, through the points inside it in their order along it.
std::vector<std::uint32_t> chain_along(std::span<const Point2> points, const PlanarEdge& edge, std::vector<std::uint32_t> inside);

}  // namespace pgdr::detail
