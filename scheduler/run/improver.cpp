// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "run/improver.hpp"

#include <utility>
#include <vector>

#include "pgdr/point_selector.hpp"

namespace pgdr::detail {

Improver::Improver(RunState<3>& state, VisitSchedule<3>& schedule, PoorSearch<3>& poor)
    : state_(&state), schedule_(&schedule), poor_(&poor), stage_(state.context.mesh, poor.reasons()) {}

/// Of bounds below what theory proves many elements may be over, for no reason but that. Where they are too many, it would take
/// many times as long as all before, and mend few of them; collapses are the quickest, and mend most.
bool Improver::is_worth_it(std::size_t cells_for_each_poor) const {
  const RefineContext<3>& context = state_->context;
  if (context.options.radius_edge_bound >= smallest_proved_bound<3>()) return true;
  const Mesh<3>& mesh = context.mesh;
  std::size_t cells = 0, poor = 0;
  for (std::uint32_t i = 0; i < mesh.cell_bound(); ++i) {
    if (!mesh.alive(CellId{i})) continue;
    ++cells;
    poor += context.bounds.test(mesh, CellId{i}) ? 1 : 0;
  }
  return cells_for_each_poor * poor <= cells;
}

/// Takes all refusals off the lists, and lists the poor elements among them anew.
void Improver::list_poor() {
  const RefineContext<3>& context = state_->context;
  std::vector<bool> listed(context.mesh.cell_bound());
  for (Refusal<3>& r : state_->refused.take_all()) {
    if (r.entry.kind() != EntryKind::cell) continue;
    const CellId c = r.entry.cell;
    if (!listed[index(c)] && context.bounds.test(context.mesh, c)) state_->waiting.relist(r.entry);
    listed[index(c)] = true;
    r.seen = {};
    poor_->remember(std::move(r));
  }
}

/// Visits until nothing that was refused is worth another try.
StopCause Improver::work_off() {
  while (true) {
    const std::uint64_t before = state_->totals.counts.improved;
    const StopCause stop = schedule_->drain();
    if (stop != StopCause::finished || state_->totals.counts.improved == before) return stop;
    state_->refused.relist_changed();
    if (state_->waiting.is_empty()) return stop;
  }
}

StopCause Improver::run(bool collapses_only, std::size_t cells_for_each_poor) {
  if (!is_worth_it(cells_for_each_poor)) return StopCause::finished;
  stage_.collapses_only = collapses_only;
  state_->context.stage = &stage_;
  list_poor();
  const StopCause stop = work_off();
  state_->context.stage = nullptr;
  return stop;
}

}  // namespace pgdr::detail
