// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// About how much of its time a run has behind it, for the progress report. Reads clocks, and decides nothing.
//   * Insertions: of the cells that there will be, so many are there: those that will take the place of others that are too big
//     are known (WorkList::to_come), and how many gaps ask for is estimated before (pgdr/estimate.hpp).
//   * The optimiser: it evaluates some hundred cells for each poor one that a phase begins with, as fast as it has done so far.
//   * What comes after that is a part of what was before.
#pragma once

#include <cstdint>
#include <functional>

#include "refine/context.hpp"
#include "run/waiting_work.hpp"

namespace pgdr::detail {

/// See above. One thread at a time, while no visit runs.
template <int D>
class ProgressMeter {
 public:
  /// Both must outlive it.
  ProgressMeter(RefineContext<D>& context, const WaitingWork<D>& waiting);
  ProgressMeter(const ProgressMeter&) = delete;
  ProgressMeter& operator=(const ProgressMeter&) = delete;

  /// `estimate` finds about how many cells there will be. It is called once, by look(), when the run is no longer a short one, as
  /// it takes a good part of the time of that. `optimizes`: is there an optimiser?
  void expect(std::function<double()> estimate, bool optimizes);
  /// A stage of the plan begins.
  void begin(const char* stage);
  /// A phase of the optimiser begins, which is expected to evaluate so many cells; and those after it so many times as many.
  void begin_phase(double evaluations, double others);
  /// Looks at what waits, now and then.
  void look();

 private:
  double seconds() const { return context_->elapsed().count(); }
  double remaining() const;
  double of_insertions() const;
  double of_optimizer() const;

  RefineContext<D>* context_;
  const WaitingWork<D>* waiting_;
  bool optimizes_ = false;
  std::function<double()> estimate_;  ///< none: it has been called
  double expected_cells_ = 0;         ///< by the estimate
  double all_vertices_ = 0;           ///< that there will be, as it seemed at the last look; 0: not known
  double next_look_ = 0;
  double insertions_since_ = -1, first_vertices_ = 0;  ///< seconds, and how many vertices there were
  double optimizing_since_ = -1, phase_since_ = -1;
  std::uint64_t evaluated_before_ = 0, evaluated_at_phase_ = 0;  ///< when the optimiser and when its phase began
  double of_phase_ = 0, others_ = 0;                             ///< evaluations that are expected; times that of later phases
  double rest_ = -1;                                             ///< what remains after the optimiser, as a part of all before
};

extern template class ProgressMeter<2>;
extern template class ProgressMeter<3>;

}  // namespace pgdr::detail
