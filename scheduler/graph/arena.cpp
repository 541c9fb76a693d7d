// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "graph/arena.hpp"

#include <tbb/global_control.h>
#include <tbb/task_arena.h>
#include <tbb/task_group.h>

#include <algorithm>

namespace pgdr::detail {

int arena_threads(int threads) {
  const int here = tbb::this_task_arena::max_concurrency();
  if (threads <= 0) return here;
  const auto allowed = tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
  return std::min(threads, static_cast<int>(allowed));
}

void in_arena(int threads, const std::function<void()>& f) {
  const int wanted = arena_threads(threads);
  if (wanted == tbb::this_task_arena::max_concurrency()) return f();
  tbb::task_arena arena(wanted);
  arena.execute(f);
}

void in_arena_to_the_end(int threads, const std::function<void()>& f) {
  in_arena(threads, [&] {
    tbb::task_group_context own(tbb::task_group_context::isolated);
    tbb::task_group group(own);
    group.run_and_wait(f);
  });
}

int arena_slot() { return tbb::this_task_arena::current_thread_index(); }

}  // namespace pgdr::detail
