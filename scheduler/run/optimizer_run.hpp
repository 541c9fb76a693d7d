// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The optimiser's part of a run, in 3D (optimize/optimizer.hpp): visits of leaves, as those before them, with claims as large as
// it takes, in phases that try more and more. A phase ends by a measure of its own, or once its budget of evaluations is spent;
// no clock decides anything but a time limit. One thread, beside those that the schedule runs.
#pragma once

#include <cstdint>
#include <optional>
#include <unordered_map>
#include <utility>
#include <vector>

#include "optimize/optimizer.hpp"
#include "pgdr/refine.hpp"
#include "reasons/poor_reasons.hpp"
#include "visits/cell_parts.hpp"
#include "visits/run_state.hpp"

namespace pgdr::detail {

/// Part of a run: see above. Workers may hold on to it: it must outlive them.
class OptimizerRun {
 public:
  using Phase = OptimizerStage::Phase;

  /// `min_dihedral`: the target in degrees, above 0. The others must outlive the last visit. @pre nothing waits
  OptimizerRun(RunState<3>& state, VisitSchedule<3>& schedule, double min_dihedral);

  /// Visits until nothing that was refused is worth another try, or the phase's budget is spent. The first phase begins with all
  /// poor cells, each other with what the one before has refused, but for what the same phase has refused before, with nothing
  /// changed about it since. @throws what a callback throws
  StopCause run(Phase phase);
  /// Once more, with what is left of the budget, for the cells that nothing excuses, if there are any. @pre run() has run.
  /// @throws what a callback throws
  StopCause run_for_unexplained();
  /// The cells that are still over a bound, with their reasons. The last call. Part of them if the run is cancelled meanwhile,
  /// or its time is up.
  std::vector<PoorCell> explain_left();

  /// Was no cell over a bound of size when it began? Then none is, since it never puts one that is in the place of others.
  bool sizes_are_met() const { return sizes_are_met_; }
  /// What was done before the optimiser began.
  const RefineCounts& counts_before() const { return before_; }
  /// What it did. `left` and `unexplained` are there after explain_left().
  OptimizationStatistics statistics() const;

 private:
  std::uint64_t evaluated() const { return state_->totals.counts.evaluated - before_.evaluated; }
  std::vector<Entry<3>> find_poor();
  std::vector<Entry<3>> find_unexplained();
  void begin(Phase phase);
  StopCause work_off(std::size_t waiting, std::uint64_t most);
  std::size_t list_all_poor();
  std::size_t list_refused();

  RunState<3>* state_;
  VisitSchedule<3>* schedule_;
  const double min_dihedral_, claimed_cosine_;
  OptimizerStage stage_;
  const RefineCounts before_;
  bool sizes_are_met_ = true;
  std::uint64_t cells_ = 0;    ///< of the mesh, at the last look at all
  std::optional<Phase> last_;  ///< that ran
  std::uint64_t budget_ = 0;   ///< evaluations that are left
  bool is_limited_ = false;    ///< did a limit keep the last phase from anything?
  std::uint64_t left_ = 0, unexplained_ = 0;
};

}  // namespace pgdr::detail
