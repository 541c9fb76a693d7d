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

/// Adds the flip, if it has cells, and none of them is flat but for rounding.
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

/// find_flips() of one edge.
template <int D>
bool LocalFlips<D>::find_edge_flips(CellId c, int edge, std::vector<Flip>& flips, std::vector<CellId>& seen) const {
  if constexpr (D == 3) {
    Ring ring;
    const RingStatus status = take_ring(c, edge, longest_ring, ring);
    seen.insert(seen.end(), ring.cells.begin(), ring.cells.end());
    if (status != RingStatus::whole) return status != RingStatus::not_owned;
    const std::array<VertexId, 2> ends = ends_of_edge(mesh_->cell(c).vertices, edge);
    if (!ring.tips.empty() && !crosses_in_facet<D>(*mesh_, *domain_, ring.entity, ends, {ring.tips[0], ring.tips[1]}))
      return true;
    for (const VertexId hub : hubs(ring, ends[0], ends[1])) add_flip({ring, ends, fans(ring, ends[0], ends[1], hub)}, flips);
  }
  return true;
}

template <int D>
bool LocalFlips<D>::find_flips(CellId c, std::vector<Flip>& flips, std::vector<CellId>& seen) const {
  if constexpr (D == 3) {
    for (int face = 0; face <= D; ++face) {
      const Link link = mesh_->cell(c).links[face];
      if (!link || mesh_->constrained(c, face)) continue;
      if (!owns(link.cell())) return false;
      add_flip({{{c, link.cell()}, {}, no_entity}, {no_vertex, no_vertex}, cells_across(c, face)}, flips);
    }
    for (int e = 0; e < 6; ++e)
      if (!mesh_->is_subsegment(c, e) && !find_edge_flips(c, e, flips, seen)) return false;
  }
  return true;
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
      if (pgdr::violates(*mesh_, c, f))
        ++(std::find(old.begin(), old.end(), mesh_->cell(c).links[f].cell()) == old.end() ? outer : inner);
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
