// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Which points lie inside of straight lines that edges make. As with facets of one plane: two edges go on in each other if the
// point between them is within the tolerance of the line past it; runs are the connected components of this, so that no order of
// edges decides. A run that as a whole is not within the tolerance of the line between its ends, as a fine arc, is ambiguous:
// what is exactly straight there loses its points, and nothing else.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "pgdr/types.hpp"

namespace pgdr::detail {

/// Edges of one kind go on in each other.
struct ChainEdge {
  std::array<std::uint32_t, 2> ends;  ///< numbers of points
  std::uint32_t kind = 0;
};

/// Of each point: is it inside of such a line, so that the edges are the same without it?
/// @param edges  none twice
/// @param kept  of each point: it stays, whatever it is inside of
template <int D>
std::vector<std::uint8_t> points_inside_lines(std::span<const Point<D>> points, std::span<const ChainEdge> edges,
                                              const std::vector<std::uint8_t>& kept, double tolerance);

/// The edges without these points, each in the place of the first of its parts.
/// @param inside  as points_inside_lines() gives them
std::vector<ChainEdge> without_points(std::span<const ChainEdge> edges, const std::vector<std::uint8_t>& inside);

}  // namespace pgdr::detail
