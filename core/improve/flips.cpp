// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The last visits of a run, in 3D: flips that leave less excess (improve/improve.cpp says what that is, why this ends, and
// what may be new), and after any change those that leave no more excess, and fewer faces that are not locally Delaunay.
#include <algorithm>

#include "improve/improvement.hpp"
#include "refine/refiner.hpp"

namespace pgdr {

template <int D>
Simplex<D> Refiner<D>::simplex_of(const std::array<VertexId, D + 1>& vertices) const {
  Simplex<D> s;
  for (int i = 0; i <= D; ++i) s[i] = mesh_->point(vertices[i]);
  return s;
}

/// By how much the flip lessens the excess, if that is more than `least` and no edge is too short.
template <int D>
std::optional<double> Refiner<D>::gain_of_flip(const Flip& flip, double least) const {
  const double shortest = options_->min_edge * options_->min_edge;
  double excess = excess_of(flip.old.cells);
  for (const auto& cell : flip.cells) {
    if (!(excess > least)) return {};
    const Simplex<D> s = simplex_of(cell.vertices);
    excess -= context_->bounds.excess(s, cell.region);
    if (shortest_edge_squared<D>(s) < shortest || !context_->bounds.within_size(s, cell.region)) return {};
  }
  return excess > least ? std::optional(excess) : std::nullopt;
}

/// As of a move.
template <int D>
bool Refiner<D>::flip_is_explained(const Flip& flip, const Violations& violations) const {
  const auto homes = [this](const std::array<VertexId, D + 1>& vertices) {
    std::vector<Home> all;
    for (const VertexId v : vertices) all.push_back(mesh_->vertex(v).home);
    return all;
  };
  for (const auto& cell : flip.cells) {
    const Simplex<D> s = simplex_of(cell.vertices);
    if (context_->bounds.excess(s, cell.region) > 0 && !is_explained(homes(cell.vertices), s)) return false;
  }
  for (const auto& violation : violations) {
    const auto& vertices = flip.cells[violation.cell].vertices;
    std::vector<Home> all = homes(vertices);
    all.push_back(mesh_->vertex(violation.beyond).home);
    if (!is_explained(all, simplex_of(vertices))) return false;
  }
  return true;
}

/// Makes the flip of a face or edge of the element that lessens the excess most, the first of those that do.
template <int D>
auto Refiner<D>::flip_for_less(const Item& e) -> Outcome {
  using Flips = LocalFlips<D>;
  std::vector<Flip> flips;
  if (flips_.find_flips(e.cell, flips, seen_) == Flips::Outcome::not_owned) return Outcome::not_owned;
  const Flip* best = nullptr;
  bool violates = false;
  double most = least_gain;
  for (const Flip& flip : flips) {
    seen_.insert(seen_.end(), flip.old.cells.begin(), flip.old.cells.end());
    const auto gain = gain_of_flip(flip, most);
    if (!gain) continue;
    const auto violations = flips_.violations_after(flip);
    if (!violations || !flip_is_explained(flip, *violations)) continue;
    most = *gain;
    best = &flip;
    violates = !violations->empty();
  }
  if (!best) return Outcome::refused;
  flips_.make(pools_, *best);
  return note_change(e, flips_.new_cells(), violates);
}

/// Makes a flip at the face that leaves fewer faces that are not locally Delaunay, and no more excess.
template <int D>
bool Refiner<D>::flip_to_delaunay(CellId c, int face) {
  const CellId beyond = mesh_->cell(c).links[face].cell();
  std::vector<Flip> flips;
  std::vector<CellId> seen;
  flips_.find_flips(c, flips, seen);
  for (const Flip& flip : flips) {
    const auto& old = flip.old.cells;
    if (std::find(old.begin(), old.end(), beyond) == old.end()) continue;
    if (!gain_of_flip(flip, least_gain_without)) continue;
    const auto violations = flips_.violations_after(flip);
    if (!violations) continue;
    const auto inner = std::count_if(violations->begin(), violations->end(), [](const auto& v) { return v.inner; });
    if (violations->size() - inner / 2 >= flips_.violations_before(flip) || !flip_is_explained(flip, *violations)) continue;
    flips_.make(pools_, flip);
    return true;
  }
  return false;
}

/// The same at all faces of the cells, and of those that this makes, which are added.
template <int D>
void Refiner<D>::flip_to_delaunay(std::vector<CellId>& cells) {
  std::vector<Item> items;
  const auto add = [&](const std::vector<CellId>& all) {
    for (const CellId c : all) items.push_back(make_entry(c, EntryKind::cell, 0));
  };
  add(cells);
  for (std::size_t i = 0; i < items.size(); ++i)
    for (int f = 0; f <= D && alive(items[i]); ++f)
      if (flips_.violates(items[i].cell, f) && flip_to_delaunay(items[i].cell, f)) add(flips_.new_cells());
  cells.clear();
  for (const Item& item : items)
    if (alive(item)) cells.push_back(item.cell);
}

template class Refiner<3>;  // nothing of this in 2D

}  // namespace pgdr
