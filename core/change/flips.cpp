// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "change/flips.hpp"

#include <algorithm>

#include "change/numbers.hpp"
#include "mesh/locally_delaunay.hpp"

namespace pgdr {
namespace {

constexpr std::size_t longest_flipped_ring = 7;  // cells round an edge that goes

}  // namespace

template <int D>
auto LocalFlips<D>::repair(Pools& pools, CellId c, int face) -> Outcome {
  if (!violates(*mesh_, c, face)) return Outcome::stuck;
  if (!owns(c) || !owns(mesh_->cell(c).links[face].cell())) return Outcome::not_owned;
  if (flip_face(pools, c, face)) return Outcome::flipped;
  if constexpr (D == 3) {
    for (int a = 0; a <= D; ++a)
      for (int b = a + 1; b <= D; ++b)
        if (a != face && b != face)
          if (const Outcome outcome = remove_edge(pools, c, edge_of_ends[a][b], Condition::better); outcome != Outcome::stuck)
            return outcome;
  }
  return Outcome::stuck;
}

template <int D>
auto LocalFlips<D>::rewrap(Pools& pools, CellId c, int face, LocalRewrap::Effort effort) -> Outcome {
  if constexpr (D == 3) {
    if (!violates(*mesh_, c, face)) return Outcome::stuck;
    const bool repaired = rewrap_.repair(pools, c, face, effort);
    if (repaired) new_cells_ = rewrap_.new_cells();
    return repaired ? Outcome::flipped : rewrap_.reached_border() ? Outcome::not_owned : Outcome::stuck;
  }
  return Outcome::stuck;
}

template <int D>
bool LocalFlips<D>::rewrap_pays(std::uint64_t allowance) const {
  if constexpr (D == 3) return rewrap_.ineffective_work() <= allowance + numbers::wrap_effect_weight * rewrap_.effective_work();
  return false;
}

/// The two cells at the face become D round the edge between their apexes.
template <int D>
bool LocalFlips<D>::flip_face(Pools& pools, CellId c, int face) {
  const auto& cell = mesh_->cell(c);
  const Link link = cell.links[face];
  tried_.clear();
  tried_.old = {c, link.cell()};
  for (int i = 0; i <= D; ++i) {
    if (i == face) continue;
    auto v = cell.vertices;
    v[i] = mesh_->cell(link.cell()).vertices[link.face()];
    tried_.cells.push_back({v, mesh_->region(c)});
  }
  return commit_if(pools, violations_before());
}

/// Faces of the old cells that are not locally Delaunay; those between two of them count twice.
template <int D>
int LocalFlips<D>::violations_before() const {
  int count = 0;
  for (const CellId c : tried_.old)
    for (int f = 0; f <= D; ++f) count += violates(*mesh_, c, f);
  return count;
}

/// Makes what is tried if all cells are positive, it fits, and no more faces than these are violations then.
template <int D>
bool LocalFlips<D>::commit_if(Pools& pools, int most) {
  const auto positive = [this](const auto& cell) { return orient<D>(mesh_->points(cell.vertices)) == Sign::positive; };
  if (!std::all_of(tried_.cells.begin(), tried_.cells.end(), positive) || !replacer_.fits(tried_)) return false;
  if (replacer_.violations(tried_, most) > most) return false;
  replacer_.commit(pools, tried_);
  new_cells_ = replacer_.new_cells();
  return true;
}

/// The cells about a vertex of the ring that take its place.
template <int D>
void LocalFlips<D>::fill_about(VertexId hub) {
  tried_.cells.clear();
  if constexpr (D == 3)
    for (std::size_t i = 0; i < ring_.cells.size(); ++i) {
      const VertexId x = ring_.vertices[i], y = ring_.vertex(i + 1);
      if (x == hub || y == hub) continue;
      const std::uint16_t region = mesh_->region(ring_.cells[i]);
      tried_.cells.push_back({{ring_.ends[0], hub, x, y}, region});
      tried_.cells.push_back({{hub, ring_.ends[1], x, y}, region});
    }
}

/// The ring of cells round an edge becomes two fans about one vertex of the ring; the edge vanishes. Where the edge lies
/// inside a facet the fans are about a tip of its two subfacets there, which are flipped with it.
template <int D>
auto LocalFlips<D>::remove_edge(Pools& pools, CellId c, int edge, Condition condition) -> Outcome {
  if constexpr (D == 3) {
    if (mesh_->is_subsegment(c, edge)) return Outcome::stuck;
    const Reach reach = collect_ring(*mesh_, area_, c, edge, longest_flipped_ring, ring_);
    if (reach != Reach::ok) return reach == Reach::not_owned ? Outcome::not_owned : Outcome::stuck;
    if (sides_without_edge(*mesh_, *domain_, ring_).empty()) return Outcome::stuck;
    tried_.clear();
    tried_.old = ring_.cells;
    const std::vector<std::size_t> at = ring_.constrained();
    std::vector<VertexId> hubs;
    for (const std::size_t i : at) hubs.push_back(ring_.vertices[i]);
    if (at.empty())
      hubs = ring_.vertices;
    else
      for (const VertexId end : ring_.ends) tried_.walls.push_back({{hubs[0], hubs[1], end}, ring_.walls[at[0]]});
    const int most = violations_before() - (condition == Condition::better && ring_.cells.size() > 3);
    if (most < 0) return Outcome::stuck;
    for (const VertexId hub : hubs) {
      fill_about(hub);
      if (commit_if(pools, most)) return Outcome::flipped;
    }
  }
  return Outcome::stuck;
}

template class LocalFlips<2>;
template class LocalFlips<3>;

}  // namespace pgdr
