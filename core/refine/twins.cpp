// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Subsegments that vertices are close beside (twins.hpp).
#include <algorithm>

#include "refine/refiner.hpp"

namespace pgdr {

/// Where to split the subsegment for a vertex at its cells that is close beside it. Nothing if there is none, or, with
/// `owned` false, if the claim is too small to tell.
template <int D>
std::optional<SplitPlace> Refiner<D>::place_beside(const Item& e, std::span<const VertexId> own, bool& owned) const {
  const EntityId s = mesh_->constraints(e.cell)->edge_entity[e.which()];
  const auto [t0, t1] = piece(s, own[0], own[1]);
  PlaceBeside places(*domain_, s, t0, t1, Beside::as_far);
  int others[2], n = 0;
  for (int i = 0; i <= D; ++i)
    if (i != edge_ends[e.which()][0] && i != edge_ends[e.which()][1]) others[n++] = i;
  for (const int way : {0, 1}) {
    RidgeWalk<D> walk{e.cell, others[1 - way], others[way]};
    while (true) {
      owned = cavity_.owns(walk.cell);
      if (!owned) return std::nullopt;
      for (const int i : {walk.entry, walk.exit})
        if (const VertexId v = mesh_->cell(walk.cell).vertices[i]; v != infinite_vertex) places.look_at(mesh_->vertex(v));
      if (!walk.link(*mesh_)) break;
      walk.step(*mesh_);
      if (walk.cell == e.cell) return places.best();
    }
  }
  return places.best();
}

/// Vertices of the cavity whose distances from the place do not count.
template <int D>
std::vector<VertexId> Refiner<D>::twins_of(EntityId s, const SplitPlace& place) const {
  std::vector<VertexId> twins;
  for (const CellId c : cavity_.cells())
    for (const VertexId v : mesh_->cell(c).vertices)
      if (v != infinite_vertex && is_twin(*domain_, s, place, mesh_->vertex(v)) &&
          std::find(twins.begin(), twins.end(), v) == twins.end())
        twins.push_back(v);
  return twins;
}

template class Refiner<3>;

}  // namespace pgdr
