// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// What ranks tell all others after each phase, in one message that goes around: what it has done, and what each could do next. So
// all know the same, and go on with the same phase.
#pragma once

#include <cstdint>
#include <vector>

#include "plans/uniform.hpp"
#include "visits/run_state.hpp"

namespace pgdr::detail {

/// Of one rank, or of all.
struct Outlook {
  StopCause stop = StopCause::finished;  ///< why it does not go on; of several reasons the last
  std::uint64_t first = no_phase;        ///< number of the phase that comes next
  std::uint64_t visits = 0;              ///< in that phase
  std::uint64_t visits_before = 0;       ///< of these, on ranks before this one
  bool is_any_left = false;              ///< has any window been left, to be split?
  RunTotals totals;                      ///< since the last phase began; of all: since the run did

  /// For a message. `visits_before` does not travel.
  std::vector<std::uint64_t> to_row() const;
  static Outlook of(const std::vector<std::uint64_t>& row);
  /// What the rows of all ranks come to, for `rank`, after a phase that began with these totals.
  static Outlook of_all(const std::vector<std::vector<std::uint64_t>>& rows, int rank, const RunTotals& before);
};

/// What has been done since.
RunTotals operator-(const RunTotals& now, const RunTotals& then);

}  // namespace pgdr::detail
