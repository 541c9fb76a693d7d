// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// What the schedules and the stages of a run share.
#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <limits>
#include <random>
#include <span>
#include <utility>
#include <vector>

#include "refine/element_stage.hpp"
#include "refine/numbers.hpp"
#include "visits/progress_meter.hpp"
#include "visits/refused_work.hpp"
#include "visits/run_pieces.hpp"
#include "visits/visit_recorder.hpp"
#include "visits/waiting_work.hpp"
#include "visits/worker_pool.hpp"

namespace pgdr::detail {

/// What all visits did together. Plain data; one thread at a time.
struct RunTotals {
  RefineCounts counts;
  std::uint64_t vertices = 0;     ///< of the mesh
  bool violations_seen = false;   ///< were there ever faces that are not locally Delaunay?
  bool entities_refused = false;  ///< was the split of an entity ever refused?
  bool min_edge_hit = false;      ///< was anything refused for `min_edge`?

  template <int D>
  void add(const NodeVisit<D>& visit) {
    counts += visit.counts;
    vertices += visit.counts.committed - visit.counts.removed;
    violations_seen = violations_seen || visit.violations_seen;
    entities_refused = entities_refused || visit.entities_refused;
    min_edge_hit = min_edge_hit || visit.min_edge_hit;
  }
};

/// See above. One thread at a time where a part does not say otherwise.
template <int D>
struct RunState {
  using Node = typename Orthtree<D>::Node;

  /// `pools`: those that made the mesh so far. `vertices`: it has so many. The context and the pieces must outlive this.
  RunState(RefineContext<D>& c, typename Mesh<D>::Pools pools, std::uint64_t vertices, const RunPieces& run_pieces)
      : context(c),
        options(c.options.schedule),
        pieces(run_pieces),
        totals{{}, vertices},
        waiting(c),
        refused(c, waiting, run_pieces),
        workers(c, std::move(pools)),
        recorder(options, c.start),
        meter(c, waiting) {}
  RunState(const RunState&) = delete;
  RunState& operator=(const RunState&) = delete;

  /// Fills in what the visit is asked to do. Any thread that may use the work of its leaf, while the totals stay.
  void prepare(const VisitRequest& request, NodeVisit<D>& visit) {
    visit.violations_seen = totals.violations_seen;
    visit.entities_refused = totals.entities_refused;
    visit.most_evaluated = most_evaluated - std::min(most_evaluated, totals.counts.evaluated);
    visit.most_evaluated_an_entry = most_evaluated_an_entry;
    visit.most_unpaid = must_pay ? numbers::evaluations_a_poor_cell : std::numeric_limits<std::uint64_t>::max();
    waiting.prepare(request, visit);
  }
  /// Takes in what a visit that has ended did, and what it set aside.
  void account(const VisitRequest& request, const NodeVisit<D>& visit) {
    totals.add(visit);
    recorder.count_set_aside(waiting.defer(request, visit.set_aside));
    if (context.stop != 0) waiting.keep_given(visit.given);
  }
  /// For tests, between visits: gives all cells and vertices other numbers, and tells those who asked for it, too.
  void renumber(std::mt19937_64& random) {
    Renumbering<D> to(context.mesh, random);
    to.apply();
    waiting.rename(to);
    workers.forget_cells();
    for (const auto& rename : renamers) rename(to);
  }
  /// f(renumbering) is called whenever renumber() has been.
  void on_renumbered(std::function<void(const Renumbering<D>&)> f) { renamers.push_back(std::move(f)); }
  /// Is the budget of evaluations spent? Between generations, so that it does not depend on timing.
  bool is_spent() const { return totals.counts.evaluated >= most_evaluated; }
  /// How the run stands: what has stopped it, or finished.
  StopCause stop() const { return static_cast<StopCause>(context.stop.load()); }
  /// Does the mesh have as many vertices as it may, so that nothing more is inserted?
  bool is_full() const { return !context.stage && totals.vertices >= context.options.max_vertices; }
  /// What ends the run between visits; finished: nothing. Tells how far it is, if it is time for that.
  StopCause stop_between_visits() {
    meter.update();
    if (context.ended()) return stop();
    return is_full() ? StopCause::max_vertices : StopCause::finished;
  }
  /// Has the run been cancelled? It is stopped with that. For loops over all cells, which end then.
  bool is_cancelled() {
    if (!context.options.stop.stop_requested()) return false;
    context.stop = static_cast<int>(StopCause::cancelled);
    return true;
  }

  RefineContext<D>& context;
  const ScheduleOptions& options;
  const RunPieces& pieces;  ///< for loops between visits
  RunTotals totals;
  std::uint64_t most_evaluated = std::numeric_limits<std::uint64_t>::max();           ///< in all, by the end of this stage
  std::uint64_t most_evaluated_an_entry = std::numeric_limits<std::uint32_t>::max();  ///< in it, by a visit, for each that waits
  bool must_pay = false;  ///< in it, do visits end that make too few changes (evaluations_a_change)?
  WaitingWork<D> waiting;
  RefusedWork<D> refused;
  WorkerPool<D> workers;
  VisitRecorder recorder;
  ProgressMeter<D> meter;
  std::vector<std::function<void(const Renumbering<D>&)>> renamers;
};

/// A schedule: decides which visits run at once, and runs them.
template <int D>
class VisitSchedule {
 public:
  virtual ~VisitSchedule() = default;
  /// Works off all that waits, and what that brings forth. @throws what a callback throws
  virtual StopCause drain() = 0;
};

}  // namespace pgdr::detail
