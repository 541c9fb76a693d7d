// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "run/refinement.hpp"

#include <algorithm>

#include "pgdr/point_selector.hpp"
#include "plans/generations.hpp"
#include "plans/greedy.hpp"
#include "plans/uniform.hpp"
#include "space/bulk.hpp"

namespace pgdr::detail {
namespace {

template <int D>
std::unique_ptr<VisitSchedule<D>> make_schedule(RunState<D>& state, const RunHooks<D>* hooks, bool optimizes) {
  if (hooks) return hooks->make_schedule(state, optimizes);
  if (state.options.schedule == Schedule::greedy) return std::make_unique<Greedy<D>>(state, threads_of(state.options));
  std::unique_ptr<Planner<D>> planner;
  if (state.options.schedule == Schedule::uniform)
    planner = std::make_unique<Uniform<D>>(state);
  else
    planner = std::make_unique<Generations<D>>(state);
  return std::make_unique<PlannedSchedule<D>>(state, std::move(planner));
}

}  // namespace

template <int D>
Refinement<D>::Refinement(RefineContext<D>& context, typename Mesh<D>::Pools pools, std::uint64_t vertices, double min_dihedral,
                          const RunPieces& pieces, const RunHooks<D>* hooks)
    : min_dihedral_(min_dihedral),
      state_(context, std::move(pools), vertices, pieces),
      schedule_(make_schedule(state_, hooks, min_dihedral > 0)),
      violations_(state_) {
  const ScheduleOptions& options = context.options.schedule;
  if (options.schedule == Schedule::greedy || options.executor == Executor::shuffled) context.mesh.leave_heap();  // several pools
}

template <int D>
auto Refinement<D>::plan(bool optimizes) -> std::span<const Stage> {
  using R = Refinement;
  static constexpr Stage refining[] = {
      {"list", &R::list_everything},
      {"insert", &R::refine},
      {"last_resort", &R::refine_as_last_resort},
      {"violations", &R::look_for_violations},
      {"shortest_edge", &R::end_if_min_edge_hit},
      {"reasons", &R::explain},
      {"budget", &R::end_if_vertices_are_spent},
  };
  static constexpr Stage with_optimizer[] = {
      {"list", &R::list_everything},
      {"insert", &R::refine},
      {"shortest_edge", &R::end_if_min_edge_hit},
      {"budget", &R::end_if_vertices_are_spent},
      {"optimize_cheap", &R::optimize_cheaply, true},
      {"optimize_strong", &R::optimize_strongly, true},
      {"optimize_rest", &R::optimize_the_rest, true},
      {"reasons", &R::explain_what_is_left, true},
  };
  return optimizes ? std::span<const Stage>(with_optimizer) : std::span<const Stage>(refining);
}

template <int D>
StopCause Refinement<D>::run() {
  RunClock& clock = state_.pieces.clock();
  StopCause stop = StopCause::finished;
  for (const Stage& stage : plan(min_dihedral_ > 0)) {
    if (stage.optimizes && !optimizing_since_) optimizing_since_ = clock.now();
    {
      const RunClock::Stage timed(clock, stage.name);
      state_.meter.begin(stage.name);
      stop = (this->*stage.run)();
    }
    if (stop == StopCause::finished) stop = state_.stop();
    if (stop != StopCause::finished) break;
  }
  state_.context.stage = nullptr;
  state_.meter.begin("number");
  if (stop == StopCause::max_vertices || stop == StopCause::min_edge) {
    if (!optimizing_) leave_in_order();
    if (state_.stop() == StopCause::finished) state_.context.stop = static_cast<int>(stop);
    stop = state_.stop();
  }
  if (stop != StopCause::finished && optimizing_) explained_.clear();  // which may be a part; and nothing is Delaunay by intent
  state_.recorder.count_leaves(state_.waiting.tree().leaf_count());
  return stop;
}

/// Lists what is encroached or poor in the root, before the first split: what one worker would list, cell by cell.
template <int D>
StopCause Refinement<D>::list_everything() {
  RefineContext<D>& context = state_.context;
  const Bulk bulk(state_.pieces);
  const std::size_t cells = context.mesh.cell_bound(), block = bulk.grain_of(cells);
  std::vector<Listed> found((cells + block - 1) / block);
  bulk.parts(found.size(), [&](std::size_t part) {
    if (!context.ended()) found[part] = list_cells(part * block, std::min(cells, (part + 1) * block));
  });
  for (Listed& listed : found) {
    for (const Entry<D>& e : listed.entries) state_.waiting[Orthtree<D>::root].list.push(e);
    state_.totals.entities_refused = state_.totals.entities_refused || listed.entities_refused;
    listed = {};
  }
  state_.waiting.set_all_listed(context.stop == 0);
  if (!context.begins_delaunay) {
    state_.totals.violations_seen = true;
    for (const Entry<D>& e : violations_.scan_if_any()) state_.waiting.relist(e);
  }
  return StopCause::finished;
}

/// What is to be listed of the cells numbered [first, last), in their order. Any thread.
template <int D>
auto Refinement<D>::list_cells(std::size_t first, std::size_t last) -> Listed {
  WorkList<D> list;
  NodeVisit<D> listing;
  listing.list = &list;
  const auto worker = state_.workers.lease();
  worker->begin(listing);
  for (std::size_t i = first; i < last; ++i)
    if (const CellId c{static_cast<std::uint32_t>(i)}; state_.context.mesh.alive(c)) worker->list_cell(c);
  worker->end_listing();
  std::vector<Entry<D>> entries;
  entries.reserve(list.size());
  list.drain([&](const Entry<D>& e) { entries.push_back(e); });
  std::stable_sort(entries.begin(), entries.end(), [](const Entry<D>& a, const Entry<D>& b) { return a.cell < b.cell; });
  return {std::move(entries), listing.entities_refused};
}

/// Treats all that waits, and what was refused as often as its surroundings change.
template <int D>
StopCause Refinement<D>::refine() {
  while (true) {
    const std::uint64_t before = state_.totals.counts.committed;
    const StopCause stop = schedule_->drain();
    if (stop != StopCause::finished || state_.totals.counts.committed == before) return stop;
    for (const Entry<D>& e : violations_.scan_if_any()) state_.waiting.relist(e);
    state_.refused.relist_changed();
    if (state_.context.ended() || state_.waiting.is_empty()) return state_.stop();
  }
}

/// Retries refused cells with half the demand. Skipped below the proved bound, as nothing says that most is good by then. In that
/// order meshes are smaller than where all demand little; the optimiser makes such cells good without a point for each.
template <int D>
StopCause Refinement<D>::refine_as_last_resort() {
  if (D == 2 || state_.context.options.radius_edge_bound < smallest_proved_bound<D>()) return StopCause::finished;
  state_.context.last_resort = true;
  state_.refused.relist_elements();
  return state_.waiting.is_empty() ? state_.stop() : refine();
}

/// Looks for those that the last visits left, so that they are seen.
template <int D>
StopCause Refinement<D>::look_for_violations() {
  violations_.scan_if_any();
  return StopCause::finished;
}

template <int D>
StopCause Refinement<D>::end_if_min_edge_hit() {
  return state_.totals.min_edge_hit ? StopCause::min_edge : StopCause::finished;
}

template <int D>
StopCause Refinement<D>::explain() {
  poor_.emplace(state_, violations_);
  explained_ = poor_->find();
  state_.is_cancelled();
  return StopCause::finished;
}

template <int D>
StopCause Refinement<D>::end_if_vertices_are_spent() {
  const bool spent = state_.totals.vertices >= state_.context.options.max_vertices;
  return spent && !state_.waiting.is_empty() ? StopCause::max_vertices : StopCause::finished;
}

template <int D>
StopCause Refinement<D>::optimize(OptimizerStage::Phase phase) {
  if constexpr (D == 3) {
    if (!optimizing_) optimizing_ = std::make_unique<OptimizerRun>(state_, *schedule_, min_dihedral_);
    return optimizing_->run(phase);
  }
  return StopCause::finished;
}

template <int D>
StopCause Refinement<D>::optimize_cheaply() {
  return optimize(OptimizerStage::Phase::cheap);
}

template <int D>
StopCause Refinement<D>::optimize_strongly() {
  return optimize(OptimizerStage::Phase::strong);
}

/// Gives the cells that nothing excuses more effort.
template <int D>
StopCause Refinement<D>::optimize_the_rest() {
  return optimizing_ ? optimizing_->run_for_unexplained() : StopCause::finished;
}

template <int D>
StopCause Refinement<D>::explain_what_is_left() {
  if (optimizing_) explained_ = optimizing_->explain_left();
  return StopCause::finished;
}

/// A budget ends a run between an insertion and the repair of the faces that it left not locally Delaunay. This makes up for it,
/// and names the small angles beside which such faces stay. (Whom a clock or a signal has told to end does not wait for that.)
template <int D>
void Refinement<D>::leave_in_order() {
  RefineContext<D>& context = state_.context;
  context.stop = static_cast<int>(StopCause::finished);
  violations_.scan();
  for (std::size_t before = violations_.standing().size() + 1; violations_.standing().size() < before && !context.ended();) {
    before = violations_.standing().size();
    repair_standing_violations();
    violations_.scan();
  }
  if (!poor_) poor_.emplace(state_, violations_);
  explained_ = poor_->find_at_violations();
}

/// One visit by one worker, which inserts nothing.
template <int D>
void Refinement<D>::repair_standing_violations() {
  WorkList<D> list;
  for (const Entry<D>& e : violations_.standing()) list.flips.push(e);
  NodeVisit<D> visit;
  visit.list = &list;
  visit.entities_refused = state_.totals.entities_refused;
  {
    const auto worker = state_.workers.lease();
    worker->repair(visit);
  }
  state_.totals.entities_refused = state_.totals.entities_refused || visit.entities_refused;
  list.drain([this](const Entry<D>& e) {
    if (e.alive(state_.context.mesh)) state_.waiting.relist(e);
  });
}

template class Refinement<2>;
template class Refinement<3>;

}  // namespace pgdr::detail
