// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// SIGINT and SIGTERM as a stop token. One object at a time, made before other threads are (they inherit its mask).
#pragma once

#include <atomic>
#include <csignal>
#include <stop_token>
#include <thread>

namespace pgdr::tool {

/// While it lives, the first SIGINT or SIGTERM requests a stop, and another one, a second later or
/// more, ends the process.
class StopOnSignal {
 public:
  StopOnSignal();
  ~StopOnSignal();
  StopOnSignal(const StopOnSignal&) = delete;
  StopOnSignal& operator=(const StopOnSignal&) = delete;

  std::stop_token token() const { return stop_.get_token(); }

 private:
  sigset_t signals_, before_;
  std::stop_source stop_;
  std::atomic<bool> over_{false};
  std::thread watcher_;  // sits in sigwait: a handler could not call request_stop, which takes locks
};

}  // namespace pgdr::tool
