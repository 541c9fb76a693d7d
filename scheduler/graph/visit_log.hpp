// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The log of the concurrent executors of a visit graph: it counts the bodies that run, and keeps the exception that comes out in
// the end. Any thread, except finish().
#pragma once

#include <atomic>
#include <exception>
#include <mutex>

#include "graph/visit_graph.hpp"
#include "pgdr/error.hpp"

namespace pgdr {

/// See above.
class VisitLog {
 public:
  explicit VisitLog(std::uint32_t planned) : planned_(planned) {}

  /// Runs the body, unless an earlier one threw.
  void run(const VisitBody& body, VisitGraph::Visit v) noexcept {
    if (stopped()) return;
    // Relaxed: counters for the report. Visits are ordered by the executor's own synchronisation.
    const std::uint32_t now = running_.fetch_add(1, std::memory_order_relaxed) + 1;
    std::uint32_t most = most_.load(std::memory_order_relaxed);
    while (now > most && !most_.compare_exchange_weak(most, now, std::memory_order_relaxed)) {
    }
    try {
      body(v);
      run_.fetch_add(1, std::memory_order_relaxed);
    } catch (...) {
      fail(v);
    }
    running_.fetch_sub(1, std::memory_order_relaxed);
  }
  /// Keeps the exception that is handled as that of visit v, and stops.
  void fail(VisitGraph::Visit v) noexcept {
    std::lock_guard lock(mutex_);
    if (!exception_ || v < thrower_) {
      exception_ = std::current_exception();
      thrower_ = v;
    }
    stopped_.store(true, std::memory_order_relaxed);
  }
  bool stopped() const noexcept { return stopped_.load(std::memory_order_relaxed); }

  /// Returns the counts, or throws the exception. @pre all threads are done
  VisitRun finish() {
    if (exception_) std::rethrow_exception(exception_);
    return {planned_, run_.load(std::memory_order_relaxed), most_.load(std::memory_order_relaxed)};
  }

 private:
  std::uint32_t planned_;
  std::atomic<std::uint32_t> running_{0}, most_{0}, run_{0};
  std::atomic<bool> stopped_{false};
  std::mutex mutex_;
  std::exception_ptr exception_;
  VisitGraph::Visit thrower_ = 0;
};

}  // namespace pgdr
