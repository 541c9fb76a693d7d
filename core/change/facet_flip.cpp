// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "change/facet_flip.hpp"

#include <algorithm>
#include <utility>

#include "pgdr/predicates.hpp"
#include "rule/insertion_rule.hpp"

namespace pgdr {

template <int D>
bool lie_in_line(const Mesh<D>& mesh, const Domain<D>& domain, const std::array<VertexId, 3>& vertices) {
  return std::any_of(vertices.begin(), vertices.end(), [&](VertexId v) {
    const EntityRef home = mesh.vertex(v).home.entity();
    const auto on = [&](VertexId w) { return lies_on<D>(domain, mesh.vertex(w).home, home); };
    return home.kind == EntityKind::segment && std::all_of(vertices.begin(), vertices.end(), on);
  });
}

template <int D>
bool crosses_in_facet(const Mesh<D>& mesh, const Domain<D>& domain, EntityId facet, std::array<VertexId, 2> edge,
                      std::array<VertexId, 2> tips) {
  if constexpr (D == 3) {
    for (const VertexId v : edge)
      if (lie_in_line<D>(mesh, domain, {tips[0], tips[1], v})) return false;
    const int axis = domain.facets()[facet].axis;
    const auto side = [&](VertexId v) { return orient_projected(mesh.point(tips[0]), mesh.point(tips[1]), mesh.point(v), axis); };
    const Sign first = side(edge[0]);
    return first != Sign::zero && first == -side(edge[1]);
  }
  return false;
}

std::vector<EntityId> facets_at(const Mesh<3>& mesh, std::span<const CellId> cells) {
  std::vector<EntityId> facets;
  for (const CellId c : cells)
    if (const auto* k = mesh.constraints(c))
      for (int f = 0; f < 4; ++f)
        if (k->has_face(f) && std::find(facets.begin(), facets.end(), k->face_entity[f]) == facets.end())
          facets.push_back(k->face_entity[f]);
  return facets;
}

bool lie_on_one(const Domain<3>& domain, const std::array<Home, 4>& homes, std::span<const EntityId> facets) {
  return std::any_of(facets.begin(), facets.end(), [&](EntityId facet) {
    const auto on = [&](Home home) { return lies_on<3>(domain, home, {EntityKind::facet, facet}); };
    return std::all_of(homes.begin(), homes.end(), on);
  });
}

template bool lie_in_line(const Mesh<3>&, const Domain<3>&, const std::array<VertexId, 3>&);
template bool crosses_in_facet<2>(const Mesh<2>&, const Domain<2>&, EntityId, std::array<VertexId, 2>, std::array<VertexId, 2>);
template bool crosses_in_facet<3>(const Mesh<3>&, const Domain<3>&, EntityId, std::array<VertexId, 2>, std::array<VertexId, 2>);

}  // namespace pgdr
