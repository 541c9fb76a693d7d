// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Flat cells at facets. Points of a slanted facet are off its plane by their rounding, so that four of them may be the
// corners of a cell of positive volume, between a pair of subfacets and the pair that a flip within the facet would make
// of them. Its circumsphere is huge, and no point makes it better. At the hull it is left out; inside, the ring of cells about
// the edge between the two subfacets becomes one without that edge, and so without the flat cell.
#include <bit>
#include <cassert>

#include "change/facet_flip.hpp"
#include "change/flips.hpp"
#include "rule/insertion_rule.hpp"

namespace pgdr {

/// The two faces of c that are subfacets of the one facet that all its vertices lie on, both at the hull or neither; if they
/// are such.
template <int D>
std::optional<std::array<int, 2>> LocalFlips<D>::faces_of_flat(CellId c) const {
  const auto* k = mesh_->constraints(c);
  if (D != 3 || !k || std::popcount(k->faces) != 2) return std::nullopt;
  const int i = std::countr_zero(k->faces), j = 7 - std::countl_zero(k->faces);
  const auto& cell = mesh_->cell(c);
  if (static_cast<bool>(cell.links[i]) != static_cast<bool>(cell.links[j]) || k->face_entity[i] != k->face_entity[j])
    return std::nullopt;
  for (const VertexId v : cell.vertices)
    if (!lies_on<D>(*domain_, mesh_->vertex(v).home, {EntityKind::facet, k->face_entity[i]})) return std::nullopt;
  return std::array{i, j};
}

template <int D>
auto LocalFlips<D>::remove_flat_cell(Pools& pools, CellId c) -> Outcome {
  if constexpr (D == 3) {
    assert(owns(c));
    const auto tips = faces_of_flat(c);
    if (!tips) return Outcome::stuck;
    const auto [i, j] = *tips;
    const auto cell = mesh_->cell(c);
    const auto old = *mesh_->constraints(c);
    const auto ends = corners_without(i, j);
    if (cell.links[i]) return remove_edge(pools, c, edge_without(i, j), Condition::no_worse);
    // The ridge between the two faces may be no segment, nor the one that takes its place.
    if (old.has_edge(edge_of_ends[i][j]) || old.has_edge(edge_without(i, j))) return Outcome::stuck;
    const std::array edge{cell.vertices[ends[0]], cell.vertices[ends[1]]}, across{cell.vertices[i], cell.vertices[j]};
    if (!crosses_in_facet<D>(*mesh_, *domain_, old.face_entity[i], edge, across)) return Outcome::stuck;
    for (const int end : ends) {
      if (!cell.links[end]) return Outcome::stuck;
      if (!owns(cell.links[end].cell())) return Outcome::not_owned;
    }
    tried_.clear();
    tried_.old = {c};
    for (const int end : ends) tried_.walls.push_back({face_without(cell.vertices, end), old.face_entity[i]});
    if (!replacer_.fits(tried_)) return Outcome::stuck;
    replacer_.commit(pools, tried_);
    new_cells_ = replacer_.new_cells();
    return Outcome::flipped;
  }
  return Outcome::stuck;
}

template class LocalFlips<2>;
template class LocalFlips<3>;

}  // namespace pgdr
