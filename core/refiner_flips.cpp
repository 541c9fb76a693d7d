// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The last visits of a run, in 3D: flips that leave less excess (refiner_improvement.cpp says what that is, why this ends, and
// what may be new).
#include "pgdr/improvement.hpp"
#include "pgdr/refiner.hpp"

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

/// As of a move. `any`: is a face not locally Delaunay?
template <int D>
bool Refiner<D>::flip_is_explained(const Flip& flip, bool& any) {
  const auto homes = [this](const std::array<VertexId, D + 1>& vertices) {
    std::vector<Home> all;
    for (const VertexId v : vertices) all.push_back(mesh_->vertex(v).home);
    return all;
  };
  for (const auto& cell : flip.cells) {
    const Simplex<D> s = simplex_of(cell.vertices);
    if (context_->bounds.excess(s, cell.region) > 0 && !is_explained(homes(cell.vertices), s)) return false;
  }
  const auto violations = flips_.violations_after(flip);
  if (!violations) return false;
  any = !violations->empty();
  for (const auto& [cell, beyond] : *violations) {
    std::vector<Home> all = homes(flip.cells[cell].vertices);
    all.push_back(mesh_->vertex(beyond).home);
    if (!is_explained(all, simplex_of(flip.cells[cell].vertices))) return false;
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
    if (keeps_any(flip.old.cells)) continue;
    const auto gain = gain_of_flip(flip, most);
    bool any = false;
    if (!gain || !flip_is_explained(flip, any)) continue;
    most = *gain;
    best = &flip;
    violates = any;
  }
  if (!best) return Outcome::refused;
  flips_.make(pools_, *best);
  return note_change(e, flips_.new_cells(), violates);
}

template class Refiner<3>;  // nothing of this in 2D

}  // namespace pgdr
