// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "reasons/given_names.hpp"

#include <algorithm>

#include "pgdr/predicates.hpp"

namespace pgdr {

template <int D>
PoorReason GivenNames<D>::named(const DomainReason& reason, std::uint32_t cell) {
  return {cell, reason.code, {name_of(reason.entities[0]), name_of(reason.entities[1])}, reason.angle};
}

template <int D>
GivenEntity GivenNames<D>::name_of(EntityRef entity) {
  GivenEntity name;
  name.kind = entity.kind;
  if (entity.kind == EntityKind::segment)
    for (std::size_t k = 0; k < 2; ++k) {
      const auto& x = domain_.points()[domain_.segments()[entity.id].points[k]].x;
      std::copy(x.begin(), x.end(), name.ends[k].begin());
    }
  if (entity.kind == EntityKind::facet) name.facet = given_facet(entity.id);
  return name;
}

template <int D>
std::uint32_t GivenNames<D>::given_facet(EntityId facet) {
  if (given_of_.empty()) {
    given_of_.assign(domain_.facets().size(), no_entity);
    find_subfacets();
  }
  if (given_of_[facet] == no_entity) given_of_[facet] = find_given_facet(facet);
  return given_of_[facet];
}

template <int D>
void GivenNames<D>::find_subfacets() {
  subfacet_of_.assign(domain_.facets().size(), no_entity);
  for (std::uint32_t s = 0; s < mesh_.subfacets.size(); ++s)
    if (const EntityId f = mesh_.subfacets[s].entity; subfacet_of_[f] == no_entity) subfacet_of_[f] = s;
}

/// That with the middle of the facet's first subfacet, as it is in the mesh there.
template <int D>
std::uint32_t GivenNames<D>::find_given_facet(EntityId facet) const {
  const auto triangles = domain_.triangles(facet);
  const auto origins = domain_.triangle_origins(facet);
  if constexpr (D == 3) {
    if (subfacet_of_[facet] == no_entity) return origins[0].facet;
    const auto& v = mesh_.subfacets[subfacet_of_[facet]].vertices;
    Point3 middle;
    for (int k = 0; k < 3; ++k) middle[k] = (mesh_.points[v[0]][k] + mesh_.points[v[1]][k] + mesh_.points[v[2]][k]) / 3;
    const int axis = domain_.facets()[facet].axis;
    for (std::size_t i = 0; i < triangles.size(); ++i) {
      const auto p = [&](int k) { return domain_.points()[triangles[i][static_cast<std::size_t>(k % 3)]]; };
      const auto is_outside = [&](int k) { return orient_projected(p(k), p(k + 1), middle, axis) == Sign::negative; };
      if (!is_outside(0) && !is_outside(1) && !is_outside(2)) return origins[i].facet;
    }
  }
  return origins[0].facet;
}

template class GivenNames<2>;
template class GivenNames<3>;

}  // namespace pgdr
