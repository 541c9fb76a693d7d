// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// What the schedules share: the tree and the work of its leaves, the workers, the passes over the whole mesh, the counts.
#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <random>
#include <span>
#include <thread>
#include <vector>

#include "claims/conflict_manager.hpp"
#include "mesh/slot_set.hpp"
#include "pgdr/predicates.hpp"
#include "pgdr/refine.hpp"
#include "reasons/poor_reasons.hpp"
#include "improve/improvement.hpp"
#include "refine/refiner.hpp"
#include "run/cell_parts.hpp"
#include "run/leaf_work.hpp"
#include "run/thread_numbers.hpp"

namespace pgdr::detail {

template <int D>
class LeafRefinement {
 public:
  using Node = typename Orthtree<D>::Node;

  /// `pools`: those that made the mesh so far; they go to the first worker.
  LeafRefinement(RefineContext<D>& context, typename Mesh<D>::Pools pools, std::uint64_t vertices_so_far);
  virtual ~LeafRefinement() = default;

  /// Lists the whole mesh and refines it. @throws what a callback throws
  StopCause run();

  /// Of every cell over a bound, or beside a face that is not locally Delaunay, why; after changes that leave fewer such cells.
  /// @pre run() said finished. `stop` becomes what ends this early.
  std::vector<PoorCell> explain(StopCause& stop);

  const RefineCounts& counts() const { return counts_; }
  const SchedulerStatistics& statistics() const { return statistics_; }
  std::vector<VisitTrace> take_trace() { return std::move(trace_); }
  Orthtree<D> take_tree() { return std::move(tree_); }
  /// Of visits that ran on other threads than the one that made this object.
  const PredicateCounts& predicates_elsewhere() const { return predicates_elsewhere_; }
  /// Were there ever faces that are not locally Delaunay?
  bool violations_seen() const { return violations_seen_; }
  /// At the end of a run, or where it was stopped: the cells over a bound, by what waits and what was refused, without a look
  /// at the others and without a call of the size function. Nothing where some may be on no list.
  std::optional<PoorCount> take_poor();

 protected:
  using Clock = std::chrono::steady_clock;
  using Worker = std::unique_ptr<Refiner<D>>;
  static double seconds_since(Clock::time_point t) { return std::chrono::duration<double>(Clock::now() - t).count(); }

  /// Treats all that waits in the leaves.
  virtual StopCause drain() = 0;

  /// What waits, one request for each leaf and order; for the whole tree one, last.
  std::vector<VisitRequest> requests() const;
  void append_requests(Node leaf, std::vector<VisitRequest>& out) const;
  bool whole_tree_waits() const { return !whole_set_aside_.empty() || !whole_list_.empty(); }
  /// Any leaf: the whole tree is nobody's.
  Node whole_tree_leaf() const { return tree_.leaf_at(context_.domain.points()[0]); }
  /// Fills in what the visit is asked to do; moves what was set aside for it out of the lists.
  void prepare(const VisitRequest& request, RegionVisit<D>& visit);
  /// When a visit began, and what its thread had counted then.
  struct Watch {
    Clock::time_point start = Clock::now();
    PredicateCounts predicates = predicate_counts();
  };
  /// Runs it in `area`, on a worker of its own; false if the run is over.
  bool work_off(const VisitArea<D>& area, RegionVisit<D>& visit);
  /// That it has ended; returns its seconds.
  double record(const VisitRequest& request, const RegionVisit<D>& visit, const Watch& watch);
  /// That the visit has changed its leaves, if it has. While it holds them.
  void mark_changed(const RegionVisit<D>& visit, std::span<const Node> claim);
  /// Adds up what a visit did, and puts off what it set aside. `claim`: its leaves; none for the whole tree.
  void account(const VisitRequest& request, RegionVisit<D>& visit, std::span<const Node> claim);
  void post(Node leaf, std::vector<Entry<D>>&& entries);
  /// Other threads than before will run visits. While none runs.
  void threads_are_new() { numbers_.others_have_ended(); }
  bool wants_split(Node leaf);
  std::size_t floor() const { return options_.floor != 0 ? options_.floor : D == 3 ? 1000 : 2000; }
  double small_radius(Node leaf) const { return options_.split_ratio * tree_.side(leaf) / 2; }

  RefineContext<D>& context_;
  const ScheduleOptions& options_;
  Orthtree<D> tree_;
  LeafWorks<D> works_;
  std::uint64_t generation_ = 0, vertices_;
  bool violations_seen_ = false;
  const bool uneven_;  ///< there may be some that no insertion brings
  bool all_listed_ = false;  ///< every poor cell is on a list, between visits
  SchedulerStatistics statistics_;
  std::mt19937_64 random_;  ///< of the executor that shuffles

 private:
  /// For loops over all cells, which end then: has the run been cancelled? Asked for every 1024th. It is stopped with that.
  bool cancelled(std::uint32_t i) {
    if (i % 1024 != 0 || !context_.options.stop.stop_requested()) return false;
    context_.stop = static_cast<int>(StopCause::cancelled);
    return true;
  }
  void each_cell_part(const std::function<void(const CellPart&)>& f);
  SlotSet changed_surroundings();
  void list_everything();
  StopCause refine_to_the_end();
  bool begin_last_resort();
  /// Calls f with the refusals of each leaf.
  void for_each_refused(const std::function<void(std::span<const Refusal<D>>)>& f);
  std::vector<PoorCell> look_for_poor(PoorReasons<D>& reasons);
  bool lists_all_poor(std::span<const PoorCell> found) const;
  bool may_improve(bool collapses_only) const;
  void list_for_improvement();
  StopCause improve_listed();
  StopCause improve(PoorReasons<D>& reasons, std::vector<PoorCell>& found);
  void total_statistics();
  std::vector<Entry<D>> look_for_violations();
  std::vector<Entry<D>> new_violations();
  void sort_by_vertices(std::vector<Entry<D>>& entries) const;
  bool may_have_changed(const LeafWork<D>* work, const Refusal<D>& refusal) const;
  std::vector<Refusal<D>> take_refused();
  void set_aside(Node leaf, std::uint32_t order, const Entry<D>& e);
  bool relist_refused();
  void relist(const Entry<D>& e);
  void defer(const VisitRequest& request, const std::vector<Entry<D>>& entries);
  Worker check_out();
  void shuffle_workers();
  void check_in(Worker worker);

  WorkList<D> whole_list_;               ///< entities that visits of the whole tree come upon
  std::vector<Entry<D>> whole_set_aside_;
  std::vector<Refusal<D>> refused_before_;  ///< poor elements, until they were improved
  std::vector<Entry<D>> given_and_not_processed_;      ///< given to visits that the end of the run has overtaken
  std::uint64_t whole_changed_ = 0, last_change_ = 0;  ///< generation: of a visit of the whole tree; of others
  std::vector<std::uint16_t> births_looked_at_;  ///< by slot: of the cell when violations were last looked for everywhere
  std::vector<Entry<D>> violations_;             ///< that were there then
  bool min_edge_hit_ = false, entities_refused_ = false;
  RefineCounts counts_;
  Clock::time_point start_;              ///< of run()
  std::mutex workers_mutex_;             ///< of the members below
  std::unique_ptr<Improvement> improvement_;  ///< 3D: the last stage; workers may hold on to it
  std::vector<Worker> workers_;
  ThreadNumbers numbers_;
  std::vector<double> busy_;             ///< seconds, by number of thread
  std::vector<VisitTrace> trace_;
  PredicateCounts predicates_elsewhere_;
};

extern template class LeafRefinement<2>;
extern template class LeafRefinement<3>;

}  // namespace pgdr::detail
