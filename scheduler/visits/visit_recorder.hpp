// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The record of a run: which visits ran when and on which thread, how long they took, and how long all the rest did. Decides
// nothing.
#pragma once

#include <chrono>
#include <cstdint>
#include <mutex>
#include <utility>
#include <vector>

#include "claims/conflict_manager.hpp"
#include "pgdr/predicates.hpp"
#include "pgdr/refine.hpp"
#include "refine/node_visit.hpp"
#include "visits/thread_numbers.hpp"

namespace pgdr::detail {

/// Part of a run: see above. One thread at a time where nothing else is said.
class VisitRecorder {
 public:
  using Clock = std::chrono::steady_clock;

  /// `origin`: from which the times of the trace count.
  VisitRecorder(const ScheduleOptions& options, Clock::time_point origin)
      : numbers_(options.executor), keeps_trace_(options.trace), origin_(origin) {}

  static double seconds_since(Clock::time_point t) { return std::chrono::duration<double>(Clock::now() - t).count(); }

  /// When a visit began, and what its thread had counted then.
  struct Watch {
    Clock::time_point start = Clock::now();
    PredicateCounts predicates = predicate_counts();
  };
  /// Records that the visit has ended, on the thread that ran it; returns its seconds. Any thread.
  template <int D>
  double record(const VisitRequest& request, const NodeVisit<D>& visit, const Watch& watch);

  /// Other threads than before will run visits. While none runs.
  void threads_are_new() { numbers_.others_have_ended(); }
  void count_generation() { ++statistics_.generations; }
  void count_set_aside(std::uint64_t entries) { statistics_.set_aside += entries; }
  /// So many visits ran at one time.
  void count_concurrent(std::uint32_t visits);
  /// Adds the seconds of a generation on the wall.
  void add_generation(double seconds) { statistics_.seconds_in_generations += seconds; }
  /// The phases of the finest lattice so far came round so many times.
  void count_cycles(std::uint64_t cycles) { statistics_.cycles = cycles; }
  /// The tree has so many leaves in the end.
  void count_leaves(std::uint64_t leaves) { statistics_.leaves = leaves; }

  const SchedulerStatistics& statistics() const { return statistics_; }
  std::vector<VisitTrace> take_trace() { return std::move(trace_); }
  /// Of visits that ran on other threads than the one that made this object.
  const PredicateCounts& predicates_elsewhere() const { return predicates_elsewhere_; }

 private:
  std::mutex mutex_;  ///< of what record() changes: the numbers, the visits and busy seconds, the predicates, the trace
  ThreadNumbers numbers_;
  const bool keeps_trace_;
  const Clock::time_point origin_;
  SchedulerStatistics statistics_;
  PredicateCounts predicates_elsewhere_;
  std::vector<VisitTrace> trace_;
};

}  // namespace pgdr::detail
