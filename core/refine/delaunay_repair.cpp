// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "refine/delaunay_repair.hpp"

#include <algorithm>

#include "mesh/locally_delaunay.hpp"
#include "refine/numbers.hpp"

namespace pgdr {

template <int D>
DelaunayRepair<D>::DelaunayRepair(Workspace<D>& workspace, WorkLister<D>& lister)
    : w_(&workspace), lister_(&lister), flips_(workspace.mesh, workspace.domain) {
  flips_.set_ended([this] { return w_->context.ended(); });
}

template <int D>
void DelaunayRepair<D>::begin_visit() {
  flips_.set_area(w_->visit->area);
  flips_left_ = 0;
}

template <int D>
void DelaunayRepair<D>::look_at(std::span<const CellId> made) {
  const std::uint64_t found = lister_->list_violations(made);
  w_->visit->violations_seen = w_->visit->violations_seen || found > 0;
  allow_for(found);
}

/// While no entity has been refused, and inside the volume, a constrained Delaunay triangulation should exist, if in a large
/// region. What is left there cuts back the cavities of points to come, so that it grows; small regions do for most of it.
template <int D>
auto DelaunayRepair<D>::rewrap_effort(const Entry<D>& e) const -> std::optional<LocalRewrap::Effort> {
  if constexpr (D == 2) return std::nullopt;
  const auto& vertices = w_->mesh.cell(e.cell).vertices;
  const auto inside = std::count_if(vertices.begin(), vertices.end(), [this](VertexId v) { return w_->in_volume(v); });
  const bool refused = w_->visit->entities_refused;
  if ((!refused || inside == D + 1) &&
      flips_.rewrap_pays(refused ? numbers::wasted_wrap_work_refused : numbers::wasted_wrap_work))
    return LocalRewrap::Effort::wide;
  if (inside >= numbers::inner_corners_to_wrap) return LocalRewrap::Effort::quick;
  return std::nullopt;
}

template <int D>
void DelaunayRepair<D>::treat(const Entry<D>& e) {
  using FlipOutcome = typename LocalFlips<D>::Outcome;
  if (!violates(w_->mesh, e.cell, e.which())) return;
  auto outcome = FlipOutcome::stuck;
  if (flips_left_ > 0) outcome = flips_.repair(w_->pools, e.cell, e.which());
  if (flips_left_ > 0 && outcome == FlipOutcome::stuck)
    if (const auto effort = rewrap_effort(e)) outcome = flips_.rewrap(w_->pools, e.cell, e.which(), *effort);
  if (outcome == FlipOutcome::not_owned) return w_->visit->set_aside.push_back(e);
  if (outcome == FlipOutcome::stuck) return lister_->list_poor(e.cell, Entry<D>::not_delaunay, w_->mesh.sphere(e.cell), 0);
  --flips_left_;
  list_made();
}

template <int D>
Outcome DelaunayRepair<D>::remove_flat_cell(CellId c) {
  using FlipOutcome = typename LocalFlips<D>::Outcome;
  switch (flips_.remove_flat_cell(w_->pools, c)) {
    case FlipOutcome::stuck: return Outcome::refused;
    case FlipOutcome::not_owned: return Outcome::not_owned;
    case FlipOutcome::flipped: break;
  }
  list_made();
  return Outcome::committed;
}

/// What the last flip, or rewrapping, has made.
template <int D>
void DelaunayRepair<D>::list_made() {
  const std::vector<CellId> made = flips_.new_cells();
  for (const CellId c : made) lister_->list_cell(c);
  lister_->list_violations(made);
}

template class DelaunayRepair<2>;
template class DelaunayRepair<3>;

}  // namespace pgdr
