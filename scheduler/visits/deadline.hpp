// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The caller's wish to stop and the time limit as one stop token, for what asks a token alone: the making of a Domain, the
// diagnosis, the triangulation. One thread; the token is for any.
#pragma once

#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <optional>
#include <stop_token>
#include <thread>
#include <utility>

#include "pgdr/refine_options.hpp"

namespace pgdr::detail {

class Deadline {
 public:
  using Clock = std::chrono::steady_clock;

  template <int D>
  Deadline(const RefineOptions<D>& options, Clock::time_point start) : wish_(options.stop) {
    constexpr std::chrono::duration<double> never = std::chrono::hours(24 * 365);  // the clock counts no further than 292 years
    if (!options.time_limit || *options.time_limit > never) return;
    both_.emplace();
    forward_.emplace(wish_, [this] { both_->request_stop(); });
    const auto end = start + std::chrono::duration_cast<Clock::duration>(*options.time_limit);
    timer_ = std::jthread([this, end](const std::stop_token& over) { wait(over, end); });
  }
  Deadline(const Deadline&) = delete;
  Deadline& operator=(const Deadline&) = delete;

  /// Requested once the caller wishes to stop, or the time is up.
  std::stop_token token() const { return both_ ? both_->get_token() : wish_; }
  /// Why it was requested; finished: it was not.
  StopCause cause() const {
    if (wish_.stop_requested()) return StopCause::cancelled;
    return token().stop_requested() ? StopCause::time_limit : StopCause::finished;
  }

 private:
  void wait(const std::stop_token& over, Clock::time_point end) {
    std::mutex mutex;
    std::unique_lock lock(mutex);
    std::condition_variable_any().wait_until(lock, over, end, [] { return false; });
    if (!over.stop_requested()) both_->request_stop();
  }

  std::stop_token wish_;
  std::optional<std::stop_source> both_;
  std::optional<std::stop_callback<std::function<void()>>> forward_;
  std::jthread timer_;
};

}  // namespace pgdr::detail
