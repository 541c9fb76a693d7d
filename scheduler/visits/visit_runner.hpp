// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Runs the visits of a plan, each once those that it waits for have ended, and takes in what they did in their order. A visit
// reads and writes its own claim alone, what waits in the nodes of it included, so that any execution that respects the edges of
// the plan gives the same mesh.
#pragma once

#include <cstdint>
#include <functional>
#include <random>
#include <vector>

#include "claims/claim_registry.hpp"
#include "visits/run_state.hpp"

namespace pgdr::detail {

/// A visit that has ended.
template <int D>
struct EndedVisit {
  NodeVisit<D> work;
  double seconds = 0;
};

/// When the entries that a visit finds for nodes that it has claimed whole get there.
enum class Posting {
  at_once,    ///< for the visits of these nodes that come after it in the plan: their claims hold these nodes, too
  afterwards  ///< with all others, when the plan has run
};

/// Part of a schedule: see above. One thread; it runs visits on others.
template <int D>
class VisitRunner {
 public:
  explicit VisitRunner(RunState<D>& state);  ///< it must outlive this

  /// On the thread of a visit, within its claim: before it runs, and after that.
  using Hook = std::function<void(VisitGraph::Visit, NodeVisit<D>&)>;
  struct Hooks {
    Hook before, after;
  };
  /// The numbers of the visits among all that share the vertices which are still allowed.
  struct Numbers {
    std::uint64_t first, in_all;
  };
  /// Runs the visits. What they find for others stays in their outboxes, unless it is posted at once. @returns the visits, by
  /// number. @throws what a callback throws
  std::vector<EndedVisit<D>> run(const Generation<D>& generation, Posting posting, const Numbers& numbers,
                                 const Hooks& hooks = {});
  /// Takes in what the visits did and set aside, in their order, and posts what is in their outboxes.
  void account(const Generation<D>& generation, std::vector<EndedVisit<D>>& ended);

 private:
  void run_visit(const Visit<D>& visit, EndedVisit<D>& ended, Posting posting, VisitGraph::Visit number, const Hooks& hooks);
  void execute(const VisitGraph& graph, const VisitBody& body);
  void touch_memory(const Generation<D>& generation);
  bool is_whole_if_small() const;

  RunState<D>* state_;
  RefineContext<D>* context_;
  const ScheduleOptions* options_;
  WaitingWork<D>* waiting_;
  VisitRecorder* recorder_;
  ClaimRegistry<D> registry_;
  std::mt19937_64 random_;  ///< of the executor that shuffles
};

extern template class VisitRunner<2>;
extern template class VisitRunner<3>;

}  // namespace pgdr::detail
