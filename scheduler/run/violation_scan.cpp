// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "run/violation_scan.hpp"

#include <algorithm>
#include <utility>

#include "input/bent_facets.hpp"
#include "space/bulk.hpp"

namespace pgdr::detail {
namespace {

/// Sorts by the vertices, as the slots of cells depend on timing.
template <int D>
void sort_by_vertices(const Mesh<D>& mesh, const Pieces& pieces, std::vector<Entry<D>>& entries) {
  Bulk(pieces).sort(entries, [&mesh](const Entry<D>& a, const Entry<D>& b) {
    const int order = compare_vertices<D>(mesh, a.cell, b.cell);
    return order != 0 ? order < 0 : a.which() < b.which();
  });
}

}  // namespace

template <int D>
bool has_uneven_facets(const Domain<D>& domain) {
  if constexpr (D == 3)
    for (EntityId f = 0; f < domain.facets().size(); ++f)
      if (is_uneven(domain, f)) return true;
  return false;
}

template <int D>
ViolationScan<D>::ViolationScan(RunState<D>& state) : state_(&state), uneven_(has_uneven_facets(state.context.domain)) {
  state.on_renumbered([this](const Renumbering<D>& to) { rename(to); });
}

template <int D>
void ViolationScan<D>::rename(const Renumbering<D>& to) {
  for (Entry<D>& e : standing_) to.rename(e.cell, e.birth);
  if (births_looked_at_.empty()) return;
  const Mesh<D>& mesh = state_->context.mesh;
  std::vector<std::uint16_t> looked_at(mesh.cell_bound(), Mesh<D>::last_birth);
  for (std::uint32_t i = 0; i < births_looked_at_.size(); ++i) {
    CellId c{i};
    std::uint16_t birth = births_looked_at_[i];
    to.rename(c, birth);
    if (birth == mesh.birth(c)) looked_at[index(c)] = birth;  // else the cell that was there is gone
  }
  births_looked_at_ = std::move(looked_at);
}

/// The slots with another cell than at the last look, or with none now, or with a cell beside such: of a given cell, born
/// before or since, dead or alive, that says the same whatever slot it was given.
template <int D>
SlotSet ViolationScan<D>::changed_surroundings() {
  const Mesh<D>& mesh = state_->context.mesh;
  const bool is_first = births_looked_at_.empty();
  if (is_first) births_looked_at_ = vector_of_capacity<std::uint16_t>(mesh.cell_bound());
  births_looked_at_.resize(mesh.cell_bound(), Mesh<D>::last_birth);
  SlotSet changed(mesh.cell_bound());
  const auto look_at = [&](const CellPart& part) {
    for (std::uint32_t i = part.first; i < part.last; ++i) {
      const CellId c{i};
      const bool alive = mesh.alive(c);
      const std::uint16_t born = alive ? mesh.birth(c) : Mesh<D>::last_birth;
      if (std::exchange(births_looked_at_[i], born) == born && alive) continue;
      changed.add_shared(i);
      if (!alive || is_first) continue;
      for (const Link next : mesh.cell(c).links)
        if (next) changed.add_shared(index(next.cell()));
    }
  };
  each_part(mesh.cell_bound(), state_->pieces, look_at);
  return changed;
}

template <int D>
std::vector<Entry<D>> ViolationScan<D>::scan() {
  const Mesh<D>& mesh = state_->context.mesh;
  // Nothing but what is new since then, or beside such, can have a violation that was not found.
  const SlotSet changed = changed_surroundings();
  std::erase_if(standing_, [&](const Entry<D>& e) {
    if (!e.alive(mesh) || mesh.constrained(e.cell, e.which())) return true;  // constrained: a flat cell beside it was taken off
    return changed[index(e.cell)];
  });
  constexpr std::uint32_t between_looks = 1024;  // at the clock, and at the caller's wish to cancel
  std::vector<std::vector<Entry<D>>> parts(count_parts(mesh.cell_bound()));
  const auto look_at = [&](const CellPart& part) {
    for (std::uint32_t i = part.first; i < part.last; ++i) {
      if (i % between_looks == 0 && state_->context.ended()) break;
      if (changed[i] && mesh.alive(CellId{i})) add_violations(mesh, CellId{i}, changed, parts[part.number]);
    }
  };
  each_part(mesh.cell_bound(), state_->pieces, look_at);
  state_->is_cancelled();
  std::vector<Entry<D>> found;
  for (const auto& part : parts) found.insert(found.end(), part.begin(), part.end());
  sort_by_vertices(mesh, state_->pieces, found);
  standing_.insert(standing_.end(), found.begin(), found.end());
  return found;
}

/// Beside entities that were refused a constrained Delaunay triangulation need not exist, so that whole cavities may bring
/// violations, too.
template <int D>
std::vector<Entry<D>> ViolationScan<D>::scan_if_any() {
  RunTotals& totals = state_->totals;
  if (!totals.violations_seen && !totals.entities_refused && !uneven_) return {};
  std::vector<Entry<D>> found = scan();
  totals.violations_seen = totals.violations_seen || !found.empty();
  return found;
}

template bool has_uneven_facets(const Domain<2>&);
template bool has_uneven_facets(const Domain<3>&);
template class ViolationScan<2>;
template class ViolationScan<3>;

}  // namespace pgdr::detail
