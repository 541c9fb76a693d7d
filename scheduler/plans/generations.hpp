// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The reproducible schedule. Work proceeds in generations; within one the tree, the claims and the order of the visits are
// frozen, and a visit waits for the earlier visits whose claims meet its own and for nothing else. A visit reads and
// writes its own claim alone, what waits in these leaves included, so that any execution that respects these edges gives the
// same mesh. What they find for other leaves or set aside, and splits, take effect at the end of the generation, in their order.
#pragma once

#include <span>
#include <vector>

#include "plans/planner.hpp"

namespace pgdr::detail {

/// See above.
template <int D>
class Generations final : public Planner<D> {
 public:
  using Node = typename Orthtree<D>::Node;

  explicit Generations(RunState<D>& state);  ///< it must outlive this

  void begin() override { split_leaves(waiting_->tree().leaves()); }
  StopCause stop() override { return state_->stop_between_visits(); }
  std::optional<PlannedVisits<D>> next() override;
  void done(VisitRunner<D>& runner, const PlannedVisits<D>& plan, std::vector<EndedVisit<D>> ended,
            const std::exception_ptr& error) override;

 private:
  void renew_buffers(std::span<const VisitRequest> requests);
  void split_leaves(std::vector<Node> candidates);

  RunState<D>* state_;
  RefineContext<D>* context_;
  const ScheduleOptions* options_;
  WaitingWork<D>* waiting_;
  ConflictManager<D> conflicts_;
};

extern template class Generations<2>;
extern template class Generations<3>;

}  // namespace pgdr::detail
