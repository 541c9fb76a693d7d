// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <stop_token>
#include <thread>

namespace pgdr::tool {

/// A stop token that is requested after some time, or when another one is.
class Deadline {
 public:
  Deadline(std::chrono::duration<double> limit, const std::stop_token& other)
      : forward_(other, Request{&stop_}), clock_([this, limit](const std::stop_token& over) { wait(limit, over); }) {}

  std::stop_token token() const { return stop_.get_token(); }

 private:
  struct Request {
    std::stop_source* stop;
    void operator()() const { stop->request_stop(); }
  };
  void wait(std::chrono::duration<double> limit, const std::stop_token& over) {
    std::mutex mutex;
    std::unique_lock lock(mutex);
    std::condition_variable_any never;
    never.wait_for(lock, over, limit, [] { return false; });
    if (!over.stop_requested()) stop_.request_stop();
  }

  std::stop_source stop_;
  std::stop_callback<Request> forward_;
  std::jthread clock_;  // last, so that it ends first
};

}  // namespace pgdr::tool
