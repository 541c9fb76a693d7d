// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The triangulation of one facet of the input, of its own polygons alone.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <numeric>
#include <span>
#include <vector>

#include "pgdr/plc.hpp"

namespace pgdr::checking {

struct FacetTriangulation {
  std::vector<std::array<std::uint32_t, 3>> triangles;    ///< indices into Plc::points
  std::vector<std::array<std::uint32_t, 2>> inner_edges;  ///< of polygons, with the facet on both sides or on none
  double bend = 0;                                        ///< see GivenInput::bend
  bool failed = false;                                    ///< its edges cross by more than `reach`
};

/// Edges that an input has as segments, by the places of their ends: where one runs through a polygon from a corner to a corner,
/// the polygon consists of triangles on both of its sides. That tells which surface it is, if its corners are not in one plane.
class ExplicitEdges {
 public:
  /// @param place  of each point the first one there
  ExplicitEdges(const Plc<3>& plc, std::span<const std::uint32_t> place);
  /// From one of these points to another one, as they are numbered there.
  std::vector<std::array<std::uint32_t, 2>> among(std::span<const std::uint32_t> points) const;

 private:
  std::span<const std::uint32_t> place_;
  std::vector<std::array<std::uint32_t, 2>> ends_;  ///< both ways, sorted
};

/// Of each point the first one at its place.
template <int D>
std::vector<std::uint32_t> number_places(const Plc<D>& plc) {
  const auto& points = plc.points;
  std::vector<std::uint32_t> order(points.size());
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin(), order.end(), [&](std::uint32_t p, std::uint32_t q) { return lex_less(points[p], points[q]); });
  std::vector<std::uint32_t> place = order;
  for (std::size_t i = 0; i < order.size(); ++i)
    place[order[i]] = i > 0 && points[order[i]] == points[order[i - 1]] ? place[order[i - 1]] : order[i];
  return place;
}

/// Nothing, if all points of the facet are on one line. Points of it within `reach` of each other, or of its edges, are joined
/// where its polygons cannot be triangulated otherwise.
FacetTriangulation triangulate_given(const Plc<3>& plc, const ExplicitEdges& edges, std::uint32_t facet, double reach);

}  // namespace pgdr::checking
