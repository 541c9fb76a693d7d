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

/// While it lives, and the token is heard, the first SIGINT or SIGTERM requests a stop, and another one, a second later or more,
/// ends the process. Where it is not heard, as at first, any ends it.
class StopOnSignal {
 public:
  StopOnSignal();
  ~StopOnSignal();
  StopOnSignal(const StopOnSignal&) = delete;
  StopOnSignal& operator=(const StopOnSignal&) = delete;

  /// Does somebody look at the token from now on?
  void hear(bool heard) { heard_ = heard; }
  std::stop_token token() const { return stop_.get_token(); }
#ifdef _WIN32
  bool interrupt();  ///< requests a stop, if somebody looks; of the handler
#endif

 private:
  std::stop_source stop_;
  std::atomic<bool> heard_{false};
#ifndef _WIN32
  void end_by(int signal) const;

  sigset_t signals_, before_;
  std::atomic<bool> over_{false};
  std::thread watcher_;  // sits in sigwait: a handler could not call request_stop, which takes locks
#endif
};

}  // namespace pgdr::tool
