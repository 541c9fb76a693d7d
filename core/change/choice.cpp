// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// All flips that there are at a cell, for a caller who knows which of them is best.
#include <algorithm>
#include <array>
#include <limits>
#include <utility>

#include "change/facet_flip.hpp"
#include "change/flips.hpp"
#include "mesh/locally_delaunay.hpp"

namespace pgdr {

/// Adds it, if there is one and no new cell is flat but for rounding.
template <int D>
void LocalFlips<D>::add_flip(Flip flip, std::vector<Flip>& flips) const {
  if (flip.cells.empty()) return;
  if constexpr (D == 3) {
    const std::vector<EntityId> facets = facets_at(*mesh_, flip.old.cells);
    for (const NewCell& cell : flip.cells) {
      std::array<Home, 4> homes;
      for (int i = 0; i < 4; ++i) homes[i] = mesh_->vertex(cell.vertices[i]).home;
      if (lie_on_one(*domain_, homes, facets)) return;
    }
  }
  flips.push_back(std::move(flip));
}

template <int D>
auto LocalFlips<D>::find_edge_flips(CellId c, int a, int b, std::vector<Flip>& flips, std::vector<CellId>& seen) const -> Outcome {
  Ring ring;
  const Outcome outcome = take_ring(c, a, b, longest_ring, ring);
  seen.insert(seen.end(), ring.cells.begin(), ring.cells.end());
  if (outcome != Outcome::flipped) return outcome;
  const auto& v = mesh_->cell(c).vertices;
  const std::array edge{v[a], v[b]};
  if (!ring.tips.empty() && !crosses_in_facet<D>(*mesh_, *domain_, ring.entity, edge, {ring.tips[0], ring.tips[1]}))
    return Outcome::stuck;
  for (const VertexId hub : hubs(ring, v[a], v[b])) add_flip({ring, edge, fans(ring, v[a], v[b], hub)}, flips);
  return Outcome::flipped;
}

template <int D>
auto LocalFlips<D>::find_flips(CellId c, std::vector<Flip>& flips, std::vector<CellId>& seen) const -> Outcome {
  if constexpr (D == 3) {
    for (int face = 0; face <= D; ++face) {
      const Link link = mesh_->cell(c).links[face];
      if (!link || mesh_->constrained(c, face)) continue;
      if (!owns(link.cell())) return Outcome::not_owned;
      add_flip({{{c, link.cell()}, {}, no_entity}, {no_vertex, no_vertex}, cells_across(c, face)}, flips);
    }
    const auto* k = mesh_->constraints(c);
    for (int e = 0; e < 6; ++e) {
      if (k && (k->edges >> e & 1)) continue;
      if (find_edge_flips(c, edge_ends[e][0], edge_ends[e][1], flips, seen) == Outcome::not_owned) return Outcome::not_owned;
    }
  }
  return flips.empty() ? Outcome::stuck : Outcome::flipped;
}

template <int D>
auto LocalFlips<D>::violations_after(const Flip& flip) -> std::optional<std::vector<Violation>> {
  take_old(flip.old.cells);
  add_walls(flip.old, flip.edge[0], flip.edge[1]);
  if (!walls_are_free()) return std::nullopt;
  return violations_of(flip.cells, std::numeric_limits<std::size_t>::max());
}

template <int D>
std::size_t LocalFlips<D>::violations_before(const Flip& flip) const {
  std::size_t outer = 0, inner = 0;
  const auto& old = flip.old.cells;
  for (const CellId c : old)
    for (int f = 0; f <= D; ++f)
      if (pgdr::violates(*mesh_, c, f)) ++(std::find(old.begin(), old.end(), mesh_->cell(c).links[f].cell()) == old.end() ? outer : inner);
  return outer + inner / 2;
}

template <int D>
void LocalFlips<D>::make(Pools& pools, const Flip& flip) {
  take_old(flip.old.cells);
  add_walls(flip.old, flip.edge[0], flip.edge[1]);
  replace(pools, flip.cells);
}

template class LocalFlips<2>;
template class LocalFlips<3>;

}  // namespace pgdr
