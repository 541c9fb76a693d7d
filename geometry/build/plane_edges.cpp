// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "build/plane_edges.hpp"

#include <algorithm>
#include <iterator>
#include <vector>

#include "pgdr/predicates.hpp"
#include "space/triangle.hpp"

namespace pgdr::detail {

using Kind = EdgeUse::Kind;

std::uint32_t PlaneEdges::beyond(std::uint32_t t, std::size_t edge, std::span<const std::uint32_t> plane_of) const {
  const std::uint32_t f = faces_.facet_of[t];
  const auto uses = uses_.of(faces_.key_of_edge(t, edge));
  if (joints_.is_soft(uses, width_)) return uses[0].owner ^ uses[1].owner ^ f;
  if (!lies_in_plane(uses, plane_of[f], plane_of)) return no_entity;
  return faces_.is_constraint(t, edge) ? partner(t, uses) : f;
}

bool PlaneEdges::is_soft(std::uint64_t key, std::span<const std::uint32_t> plane_of) const {
  const auto uses = uses_.of(key);
  if (!uses[0].is_triangle()) return false;
  return std::ranges::all_of(uses, [&](const EdgeUse& use) {
    if (!use.is_triangle()) return true;
    const auto [a, b] = edge_of(key);
    const PlanarTriangle& t = faces_.triangles[use.triangle];
    const auto opposite = std::ranges::find(t, corner_beside(t, a, b));
    return beyond(use.triangle, static_cast<std::size_t>(opposite - t.begin()), plane_of) != no_entity;
  });
}

bool PlaneEdges::is_of_segments(std::uint64_t key) const {
  std::vector<EdgeUse> others;
  std::ranges::copy_if(uses_.of(key), std::back_inserter(others),
                       [](const EdgeUse& use) { return use.kind != Kind::explicit_segment; });
  return others.empty() || joints_.is_soft(others, width_);
}

bool PlaneEdges::is_on_outline(std::uint64_t key) const {
  return std::ranges::any_of(uses_.of(key), [](const EdgeUse& use) { return use.kind == Kind::rim; });
}

/// Do facets of this plane alone have the edge, and none of them as an edge of a polygon that bounds no triangle of it?
bool PlaneEdges::lies_in_plane(std::span<const EdgeUse> uses, std::uint32_t plane,
                               std::span<const std::uint32_t> plane_of) const {
  return std::ranges::all_of(uses, [&](const EdgeUse& use) {
    if (use.is_triangle()) return plane_of[use.owner] == plane;
    return use.kind == Kind::polygon &&
           std::ranges::any_of(uses, [&](const EdgeUse& other) { return other.kind == Kind::rim && other.owner == use.owner; });
  });
}

/// Of a triangle that has the edge as a rim: the facet of equal marker that goes on beyond it. The first on the one side goes
/// with the first on the other. None if the facet has both sides: the edge is drawn inside of it, and stays.
std::uint32_t PlaneEdges::partner(std::uint32_t t, std::span<const EdgeUse> uses) const {
  const auto& p = in_.points;
  const std::uint32_t f = faces_.facet_of[t];
  const auto [a, b] = edge_of(uses[0].key);
  const auto side = [&, a = a, b = b](std::uint32_t s) {
    return orient_projected(p[a], p[b], p[corner_beside(faces_.triangles[s], a, b)], faces_.facets[f].axis);
  };
  const auto marker = [&](std::uint32_t g) { return in_.plc.facets[faces_.facets[g].input].marker; };
  const Sign mine = side(t);
  std::vector<std::uint32_t> here, there;
  for (const EdgeUse& use : uses)
    if (use.kind == Kind::rim && marker(use.owner) == marker(f)) (side(use.triangle) == mine ? here : there).push_back(use.owner);
  std::vector<std::uint32_t> ends_here, ends_there;  // uses come by owner
  std::ranges::set_difference(here, there, std::back_inserter(ends_here));
  std::ranges::set_difference(there, here, std::back_inserter(ends_there));
  const auto at = std::ranges::find(ends_here, f);
  const auto rank = static_cast<std::size_t>(at - ends_here.begin());
  return at != ends_here.end() && rank < ends_there.size() ? ends_there[rank] : no_entity;
}

}  // namespace pgdr::detail
