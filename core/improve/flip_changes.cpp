// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "improve/flip_changes.hpp"

#include <algorithm>

#include "mesh/locally_delaunay.hpp"

namespace pgdr {

Simplex<3> FlipChanges::simplex_of(const std::array<VertexId, 4>& vertices) const {
  Simplex<3> s;
  for (int i = 0; i < 4; ++i) s[i] = w_->mesh.point(vertices[i]);
  return s;
}

/// The amount by which the flip lowers the excess, if that is more than `least` and no edge is too short.
std::optional<double> FlipChanges::gain_of_flip(const Flip& flip, double least) {
  const double shortest = w_->options.min_edge * w_->options.min_edge;
  double excess = judge_->excess_of(flip.old.cells);
  for (const auto& cell : flip.cells) {
    if (!(excess > least)) return {};
    const Simplex<3> s = simplex_of(cell.vertices);
    excess -= judge_->excess_of(s, cell.region);
    if (shortest_edge_squared<3>(s) < shortest || !w_->context.bounds.within_size(s, cell.region)) return {};
  }
  return excess > least ? std::optional(excess) : std::nullopt;
}

/// As of a move.
bool FlipChanges::flip_is_explained(const Flip& flip, const Violations& violations) {
  const auto homes = [this](const std::array<VertexId, 4>& vertices) {
    std::vector<Home> all;
    for (const VertexId v : vertices) all.push_back(w_->mesh.vertex(v).home);
    return all;
  };
  for (const auto& cell : flip.cells) {
    const Simplex<3> s = simplex_of(cell.vertices);
    if (judge_->excess_of(s, cell.region) > 0 && !judge_->is_explained(homes(cell.vertices), s)) return false;
  }
  for (const auto& violation : violations) {
    const auto& vertices = flip.cells[violation.cell].vertices;
    std::vector<Home> all = homes(vertices);
    all.push_back(w_->mesh.vertex(violation.beyond).home);
    if (!judge_->is_explained(all, simplex_of(vertices))) return false;
  }
  return true;
}

Outcome FlipChanges::flip_to_improve(const Entry<3>& e) {
  std::vector<Flip> flips;
  if (!flips_->find_flips(e.cell, flips, w_->trace)) return Outcome::not_owned;
  const Flip* best = nullptr;
  bool violates = false;
  double most = least_gain;
  for (const Flip& flip : flips) {
    w_->trace.insert(w_->trace.end(), flip.old.cells.begin(), flip.old.cells.end());
    const auto gain = gain_of_flip(flip, most);
    if (!gain) continue;
    const auto violations = flips_->violations_after(flip);
    if (!violations || !flip_is_explained(flip, *violations)) continue;
    most = *gain;
    best = &flip;
    violates = !violations->empty();
  }
  if (!best) return Outcome::refused;
  flips_->make(w_->pools, *best);
  return finish(e, flips_->new_cells(), violates);
}

/// Makes a flip at the face that leaves fewer faces that are not locally Delaunay, and no more excess.
bool FlipChanges::flip_to_delaunay(CellId c, int face) {
  const CellId beyond = w_->mesh.cell(c).links[face].cell();
  std::vector<Flip> flips;
  std::vector<CellId> seen;
  flips_->find_flips(c, flips, seen);
  for (const Flip& flip : flips) {
    const auto& old = flip.old.cells;
    if (std::find(old.begin(), old.end(), beyond) == old.end()) continue;
    if (!gain_of_flip(flip, least_gain_of_collapse)) continue;
    const auto violations = flips_->violations_after(flip);
    if (!violations) continue;
    const auto inner = std::count_if(violations->begin(), violations->end(), [](const auto& v) { return v.inner; });
    if (violations->size() - inner / 2 >= flips_->violations_before(flip) || !flip_is_explained(flip, *violations)) continue;
    flips_->make(w_->pools, flip);
    return true;
  }
  return false;
}

/// The same at all faces of the cells, and of those that this makes, which are added.
void FlipChanges::flip_to_delaunay(std::vector<CellId>& cells) {
  std::vector<Entry<3>> items;
  const auto add = [&](const std::vector<CellId>& all) {
    for (const CellId c : all) items.push_back(w_->entry(c, EntryKind::cell, 0));
  };
  add(cells);
  for (std::size_t i = 0; i < items.size(); ++i)
    for (int f = 0; f < 4 && w_->alive(items[i]); ++f)
      if (pgdr::violates(w_->mesh, items[i].cell, f) && flip_to_delaunay(items[i].cell, f)) add(flips_->new_cells());
  cells.clear();
  for (const Entry<3>& item : items)
    if (w_->alive(item)) cells.push_back(item.cell);
}

Outcome FlipChanges::finish(const Entry<3>& e, std::vector<CellId> new_cells, bool violates) {
  if (violates) flip_to_delaunay(new_cells);
  ++w_->visit->counts.improved;
  w_->visit->changed_mesh = true;
  w_->visit->violations_seen = w_->visit->violations_seen || violates;
  for (const CellId c : new_cells) {
    for (const VertexId v : w_->mesh.cell(c).vertices) ++w_->mesh.note(v).version;
    lister_->list_if_poor(c);
  }
  if (w_->alive(e)) lister_->relist_cell(e);  // the change was beside it
  return Outcome::committed;
}

}  // namespace pgdr
