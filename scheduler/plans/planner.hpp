// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Who decides which visits run next, and what becomes of what they did: in generations (generations.hpp), in the phases of a
// lattice (uniform.hpp), or in those of one on several ranks (ranks/uniform_on_ranks.hpp). One loop runs the visits of them all.
#pragma once

#include <exception>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "visits/run_state.hpp"
#include "visits/visit_runner.hpp"

namespace pgdr::detail {

/// The visits that run next.
template <int D>
struct PlannedVisits {
  Generation<D> generation;
  Posting posting = Posting::afterwards;
  typename VisitRunner<D>::Numbers numbers{0, generation.visits.size()};
  typename VisitRunner<D>::Hooks hooks{};
};

/// See above. One thread.
template <int D>
class Planner {
 public:
  virtual ~Planner() = default;
  /// Work has come from elsewhere, and is to be worked off.
  virtual void begin() {}
  /// What ends the run before the next plan; finished: nothing. @throws what the caller's progress function throws
  virtual StopCause stop() = 0;
  /// What runs next; nothing if nothing waits, or stop() has a cause now.
  virtual std::optional<PlannedVisits<D>> next() = 0;
  /// Takes in what the visits of the plan did. `error`: what one threw, so that they are not all there; mostly it is thrown.
  virtual void done(VisitRunner<D>& runner, const PlannedVisits<D>& plan, std::vector<EndedVisit<D>> ended,
                    const std::exception_ptr& error) {
    if (error) std::rethrow_exception(error);
    runner.account(plan.generation, ended);
  }
};

/// The schedule of a planner.
template <int D>
class PlannedSchedule final : public VisitSchedule<D> {
 public:
  /// The state must outlive this.
  PlannedSchedule(RunState<D>& state, std::unique_ptr<Planner<D>> planner)
      : state_(&state), runner_(state), planner_(std::move(planner)) {}

  StopCause drain() override {
    planner_->begin();
    while (true) {
      if (const StopCause stop = planner_->stop(); stop != StopCause::finished) return stop;
      if (state_->is_spent()) return StopCause::finished;
      std::optional<PlannedVisits<D>> plan = planner_->next();
      if (!plan) return planner_->stop();
      state_->waiting.begin_generation();
      std::vector<EndedVisit<D>> ended;
      std::exception_ptr error;
      try {
        ended = runner_.run(plan->generation, plan->posting, plan->numbers, plan->hooks);
      } catch (...) {
        error = std::current_exception();
      }
      planner_->done(runner_, *plan, std::move(ended), error);
    }
  }

 private:
  RunState<D>* state_;
  VisitRunner<D> runner_;
  std::unique_ptr<Planner<D>> planner_;
};

}  // namespace pgdr::detail
