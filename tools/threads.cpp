// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "threads.hpp"

#include <tbb/global_control.h>
#include <tbb/info.h>

#include <latch>
#include <string>
#include <system_error>
#include <thread>
#include <vector>

#include "pgdr/error.hpp"

namespace pgdr::tool {
namespace {

/// Starts so many threads at once, and ends them.
void try_threads(int n) {
  std::latch all_there(1);
  std::vector<std::jthread> threads;  // joined after the latch opens, whatever happens
  try {
    for (int i = 0; i < n; ++i) threads.emplace_back([&all_there] { all_there.wait(); });
  } catch (const std::system_error&) {
    all_there.count_down();
    throw ResourceError(
        {.code = Errc::out_of_memory, .message = "out of memory or threads: " + std::to_string(n + 1) + " cannot be started"});
  } catch (...) {
    all_there.count_down();
    throw;
  }
  all_there.count_down();
}

}  // namespace

struct Threads::Control {
  tbb::global_control allowed;
};

Threads::Threads(std::optional<int> asked) : requested_(asked.value_or(tbb::info::default_concurrency())) {
  try_threads(requested_ - 1);
  if (requested_ != tbb::info::default_concurrency())
    control_.reset(
        new Control{tbb::global_control(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(requested_))});
}

Threads::~Threads() = default;

}  // namespace pgdr::tool
