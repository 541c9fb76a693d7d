// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Pieces on the threads of a run: by its executor, as visits that do not wait for each other, and on its clock.
#pragma once

#include <mutex>

#include "pgdr/predicates.hpp"
#include "pgdr/refine_options.hpp"
#include "space/pieces.hpp"
#include "visits/run_clock.hpp"

namespace pgdr::detail {

/// The number of threads that visits can run on.
int threads_of(const ScheduleOptions& options);

/// See above. One thread calls `run` at a time. Who cancels the caller's tasks does not cancel pieces.
class RunPieces final : public Pieces {
 public:
  /// Both must outlive it.
  RunPieces(const ScheduleOptions& options, RunClock& clock) : options_(&options), clock_(&clock) {}

  void run(std::size_t count, const std::function<void(std::size_t)>& piece) const override;
  bool is_parallel() const override { return threads_of(*options_) > 1; }
  RunClock& clock() const { return *clock_; }
  /// Of pieces that ran on other threads than that which called.
  const PredicateCounts& predicates_elsewhere() const { return predicates_elsewhere_; }

 private:
  const ScheduleOptions* options_;
  RunClock* clock_;
  mutable std::mutex mutex_;  ///< of what follows
  mutable PredicateCounts predicates_elsewhere_;
};

}  // namespace pgdr::detail
