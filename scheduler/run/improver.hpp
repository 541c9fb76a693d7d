// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The last visits of a run, in 3D, which change the mesh for elements that stay poor (improve/improvement.hpp): visits of leaves,
// as those before them, with claims as large as it takes. One thread, beside those that the schedule runs.
#pragma once

#include "improve/improvement.hpp"
#include "run/poor_search.hpp"
#include "run/run_state.hpp"

namespace pgdr::detail {

/// Part of a run: see above. Workers may hold on to it: it must outlive them.
class Improver {
 public:
  /// All must outlive the last visit.
  Improver(RunState<3>& state, VisitSchedule<3>& schedule, PoorSearch<3>& poor);

  /// Collapses edges where that leaves fewer poor elements, or better ones. Does nothing if the poor are too many.
  StopCause collapse() { return run(true, 6); }
  /// Does whatever else does so, too: relocates vertices, flips, inserts points.
  StopCause improve() { return run(false, 16); }

 private:
  StopCause run(bool collapses_only, std::size_t cells_for_each_poor);
  bool is_worth_it(std::size_t cells_for_each_poor) const;
  void list_poor();
  StopCause work_off();

  RunState<3>* state_;
  VisitSchedule<3>* schedule_;
  PoorSearch<3>* poor_;
  Improvement stage_;
};

}  // namespace pgdr::detail
