// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The greedy schedule (dissertation, fig. 3.15): whatever is free runs next, the largest leaf first, first in first out
// among equals. Leaves are claimed, handed work and split under one lock, as soon as a visit ends, so that the mesh depends
// on timing. A running visit reads a copy of the boxes that it has claimed and never the tree. It exists to measure
// what reproducibility costs.
#pragma once

#include <condition_variable>
#include <map>
#include <memory>
#include <mutex>
#include <set>
#include <tuple>
#include <utility>
#include <vector>

#include "visits/run_state.hpp"

namespace pgdr::detail {

/// The schedule of a run, see above.
template <int D>
class Greedy final : public VisitSchedule<D> {
 public:
  using Node = typename Orthtree<D>::Node;

  /// `threads`: visits that may run at once. The state must outlive this.
  Greedy(RunState<D>& state, int threads);

  StopCause drain() override;

 private:
  struct Running;
  /// Level, arrival, order, leaf: the order of the pool.
  using Waiting = std::tuple<int, std::uint64_t, std::uint32_t, Node>;
  /// What was found out when the pool was last looked through.
  struct Wanted {
    Visit<D> visit{};              ///< none yet if `tree_nodes` is 0
    std::uint32_t tree_nodes = 0;  ///< of the tree when its claim was last found to hold
  };

  void run_in_arena();
  void run_on_threads();
  // Under the lock:
  void pool(Node leaf);
  void pool(const VisitRequest& request);
  std::unique_ptr<Running> pick();
  std::unique_ptr<Running> begin(const VisitRequest& request, std::uint64_t vertices_left);
  bool is_free(const VisitRequest& r, Wanted& wanted);
  void end(Running& visit);
  void run_visit(Running& visit);
  void hand_over(Running& visit);
  void split(Node leaf);
  bool done() const { return running_.empty() && (pool_.empty() || context_->stop != 0); }

  RunState<D>* state_;
  RefineContext<D>* context_;
  WaitingWork<D>* waiting_;
  const Orthtree<D>* tree_;
  ConflictManager<D> conflicts_;
  const int threads_;
  std::mutex mutex_;  ///< of all below, and of the tree, the inboxes and the totals
  std::condition_variable ended_;
  std::map<Waiting, Wanted> pool_;
  std::set<std::pair<Node, std::uint32_t>> pooled_;  ///< node and order of what is in the pool
  std::vector<const Running*> running_;
  std::uint64_t arrivals_ = 0, reserved_ = 0;
};

extern template class Greedy<2>;
extern template class Greedy<3>;

}  // namespace pgdr::detail
