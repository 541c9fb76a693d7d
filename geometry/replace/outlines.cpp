// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "replace/outlines.hpp"

#include <algorithm>
#include <map>

#include "pgdr/predicates.hpp"
#include "replace/flat_polygon.hpp"
#include "space/make_set.hpp"

namespace pgdr::detail {
namespace {

using Edge = std::array<std::uint32_t, 2>;

/// How the face runs in the projection of its group.
Sign way_of(const SurfaceComplex& s, const FlatGroup& group, std::uint32_t f) {
  const auto& c = s.faces[f].corners;
  return orient_projected(s.at(c[0]), s.at(c[1]), s.at(c[2]), group.axis);
}

/// Points inside of the part, of which others have one, or which are there for themselves: the part has them, though they may be
/// off its plane by more than rounding.
std::vector<std::uint32_t> touched_inside(const SurfaceComplex& s, std::span<const std::uint32_t> faces, const FlatRim& rim) {
  std::vector<std::uint32_t> points, on_edges;
  for (const std::uint32_t f : faces)
    for (const std::uint32_t v : s.faces[f].corners)
      if (s.order[v] == VertexOrder::fixed) points.push_back(v);
  for (const auto* edges : {&rim.rim, &rim.inner})
    for (const PlanarEdge& e : *edges) on_edges.insert(on_edges.end(), e.begin(), e.end());
  make_set(points);
  make_set(on_edges);
  std::erase_if(points, [&](std::uint32_t v) { return std::ranges::binary_search(on_edges, v); });
  return points;
}

}  // namespace

std::optional<Plc<3>::Facet> polygon_of(const SurfaceComplex& s, std::span<const std::uint32_t> faces) {
  const FlatGroup& group = s.groups[s.faces[faces[0]].group];
  FlatRim rim{.axis = group.axis, .anchor = group.anchor, .normal = group.normal, .may_touch_itself = true};
  rim.way = way_of(s, group, *std::min_element(faces.begin(), faces.end(), [&](std::uint32_t a, std::uint32_t b) {
                     return triangle_less(s.triangle(a), s.triangle(b));
                   }));
  std::map<Edge, Edge> open;  // sorted: as its face runs
  for (const std::uint32_t f : faces) {
    auto c = s.faces[f].corners;
    if (way_of(s, group, f) != rim.way) std::swap(c[1], c[2]);
    for (std::size_t i = 0; i < 3; ++i) {
      const Edge e{c[i], c[(i + 1) % 3]}, key{std::min(e[0], e[1]), std::max(e[0], e[1])};
      const auto [at, is_new] = open.emplace(key, e);
      if (is_new) continue;
      open.erase(at);
      if (s.is_kept(e[0], e[1])) rim.inner.push_back(key);
    }
  }
  for (const auto& [key, e] : open) rim.rim.push_back(e);
  auto facet = polygon_of(s.points, rim);
  if (facet)
    for (const std::uint32_t v : touched_inside(s, faces, rim)) facet->polygons.push_back({v});
  return facet;
}

}  // namespace pgdr::detail
