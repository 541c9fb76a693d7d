// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Threads that run at one time, on any machine and beside any load: each waits a little for the others.
#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>

namespace pgdr::test {

class Meeting {
 public:
  explicit Meeting(int wanted) : wanted_(wanted) {}

  /// Returns once that many threads are in here, or after a while; at once when they have met, or all have waited long enough.
  void wait() {
    using Clock = std::chrono::steady_clock;
    std::unique_lock lock(mutex_);
    if (met_ || waited_ > std::chrono::seconds(60)) return;
    met_ = ++inside_ >= wanted_;
    const auto start = Clock::now();
    if (met_)
      changed_.notify_all();
    else
      changed_.wait_for(lock, std::chrono::milliseconds(20), [this] { return met_; });
    --inside_;
    waited_ += Clock::now() - start;
  }

 private:
  const int wanted_;
  std::mutex mutex_;
  std::condition_variable changed_;
  int inside_ = 0;
  bool met_ = false;
  std::chrono::steady_clock::duration waited_{0};
};

}  // namespace pgdr::test
