// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The reproducible schedule. Work proceeds in generations; within one the tree, the claims and the order of the visits are
// frozen, and a visit waits for the earlier visits whose claims meet its own and for nothing else. A visit reads and
// writes its own claim alone, so that any execution that respects these edges gives the same mesh. What visits hand to
// other leaves, what they set aside, and splits take effect at the end of the generation, in the order of the visits.
#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

#include "detail/claim_registry.hpp"
#include "detail/leaf_work.hpp"
#include "pgdr/conflict_manager.hpp"
#include "pgdr/refine.hpp"
#include "pgdr/refiner.hpp"

namespace pgdr::detail {

template <int D>
class Generations {
 public:
  using Node = typename Orthtree<D>::Node;

  /// `pools`: those that made the mesh so far; they go to the first worker.
  Generations(RefineContext<D>& context, typename Mesh<D>::Pools pools, std::uint64_t vertices_so_far);

  /// Lists the whole mesh and refines it. @throws what a callback throws
  StopCause run();

  const RefineCounts& counts() const { return counts_; }
  const SchedulerStatistics& statistics() const { return statistics_; }
  std::vector<VisitTrace> take_trace() { return std::move(trace_); }
  /// Were there ever faces that are not locally Delaunay?
  bool violations_seen() const { return violations_seen_; }
  /// Calls f with the span of refusals of each leaf.
  void for_each_refused(const std::function<void(std::span<const Refusal<D>>)>& f);

 private:
  using Clock = std::chrono::steady_clock;
  struct Planned {
    RegionVisit<D> work;
    double seconds = 0;
  };
  struct Worker {
    std::unique_ptr<Refiner<D>> refiner;
  };

  StopCause drain();
  bool one_generation();
  std::vector<VisitRequest> requests();
  void visit(const Visit<D>& v, Planned& planned);
  void prepare(const Visit<D>& v, Planned& planned);
  void execute(const VisitGraph& graph, const VisitBody& body);
  void finish(Generation<D>& generation, std::vector<Planned>& planned);
  bool looks_whole() const;
  void deliver(const VisitRequest& request, Planned& planned);
  void set_aside(const VisitRequest& request, std::vector<Entry<D>>& entries);
  bool wants_split(Node leaf);
  void split_leaves(std::vector<Node> candidates);
  void list_everything();
  void list_violations_everywhere();
  bool relist_refused();
  Worker check_out();
  void check_in(Worker worker);
  void record(const Visit<D>& v, const Planned& planned, Clock::time_point start, Clock::time_point end);

  RefineContext<D>& context_;
  const ScheduleOptions& options_;
  Orthtree<D> tree_;
  LeafWorks<D> works_;
  ConflictManager<D> conflicts_;
  ClaimRegistry<D> registry_;
  WorkList<D> whole_list_;               ///< entities that visits of the whole tree come upon
  std::vector<Entry<D>> whole_set_aside_;
  std::uint64_t generation_ = 0, vertices_;
  bool violations_seen_ = false, min_edge_hit_ = false;
  RefineCounts counts_;
  SchedulerStatistics statistics_;
  std::mutex workers_mutex_;             ///< of the members below
  std::vector<Worker> workers_;
  std::vector<std::pair<std::thread::id, double>> busy_;  ///< seconds, by thread
  std::vector<VisitTrace> trace_;
};

extern template class Generations<2>;
extern template class Generations<3>;

}  // namespace pgdr::detail
