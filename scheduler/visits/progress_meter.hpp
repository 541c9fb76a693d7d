// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// About how much of its time a run has behind it, for the progress report. Reads clocks, and decides nothing.
//   * Insertions: of the cells that there will be, so many are there, if most are made since others are too big: how many will
//     take the place of these is known (WorkList::to_come). How many a bound of shape asks for is not, and nothing is said.
//   * The optimiser: it evaluates some hundred cells for each poor one that a phase begins with, as fast as it has done so far.
//   * What comes after that is a part of what was before.
#pragma once

#include <cstdint>

#include "refine/context.hpp"
#include "visits/waiting_work.hpp"

namespace pgdr::detail {

/// See above. One thread at a time, while no visit runs.
template <int D>
class ProgressMeter {
 public:
  /// Both must outlive it.
  ProgressMeter(RefineContext<D>& context, const WaitingWork<D>& waiting);
  ProgressMeter(const ProgressMeter&) = delete;
  ProgressMeter& operator=(const ProgressMeter&) = delete;

  /// Is there an optimiser? If nobody says so, there is none.
  void expect_optimizer(bool optimizes) { optimizes_ = optimizes; }
  /// A stage of the plan begins.
  void begin(const char* stage);
  /// A phase of the optimiser begins, which is expected to evaluate so many cells; and those after it so many times as many.
  void begin_phase(double evaluations, double others);
  /// Looks at what waits, now and then.
  void update();

 private:
  double seconds() const { return context_->elapsed().count(); }
  double remaining() const;
  double of_insertions() const;
  double of_optimizer() const;

  RefineContext<D>* context_;
  const WaitingWork<D>* waiting_;
  bool optimizes_ = false;
  bool is_by_size_ = false;  ///< have most cells been to come for their sizes, at any look?
  double all_vertices_ = 0;  ///< that there will be, as it seemed at the last look; 0: not known
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
