// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Bulk loops over arrays, in the caller's task arena or on the calling thread: the one place where geometry and
// core use TBB. What comes out does not depend on the threads. Cancelling the caller's task group does not end a loop: items that
// were not looked at would pass for items where nothing was found.
#pragma once

#include <tbb/parallel_sort.h>
#include <tbb/task_arena.h>
#include <tbb/task_group.h>

#include <algorithm>
#include <cstddef>
#include <functional>
#include <stop_token>
#include <utility>
#include <vector>

#include "space/huge_pages.hpp"

namespace pgdr::detail {

class Bulk {
 public:
  /// Once `stop` is requested blocks are left out, so that what was to be made is nothing to use.
  explicit Bulk(bool parallel, std::stop_token stop = {})
      : parallel_(parallel && can_be_checked && tbb::this_task_arena::max_concurrency() > 1), stop_(std::move(stop)) {}

  bool is_parallel() const { return parallel_; }
  bool stopped() const { return stop_.stop_requested(); }

  /// Calls f(first, last) for blocks that cover [0, count). With `parallel`, several at once; isolated, so that the
  /// thread that waits does not pick up other tasks of the caller.
  template <class F>
  void blocks(std::size_t count, const F& f) const {
    run(count, grain, std::cref(f));
  }
  /// Calls f(i) for i in [0, count).
  template <class F>
  void each(std::size_t count, const F& f) const {
    blocks(count, [&](std::size_t first, std::size_t last) {
      for (std::size_t i = first; i < last; ++i) f(i);
    });
  }
  /// Calls f(part) for parts in [0, parts), each of which is much work.
  template <class F>
  void parts(std::size_t parts, const F& f) const {
    run(parts, 1, [&](std::size_t first, std::size_t last) {
      for (std::size_t i = first; i < last && !stopped(); ++i) f(i);
    });
  }
  /// What f(i, out) appends to `out` for i in [0, count), in the order of the i.
  template <class T, class F>
  std::vector<T> gather(std::size_t count, const F& f) const {
    std::vector<std::vector<T>> found((count + grain - 1) / grain);
    parts(found.size(), [&](std::size_t part) {
      for (std::size_t i = part * grain; i < std::min(count, (part + 1) * grain); ++i) f(i, found[part]);
    });
    std::size_t total = 0;
    for (const auto& part : found) total += part.size();
    auto all = vector_of_capacity<T>(total);
    for (auto& part : found) {
      all.insert(all.end(), part.begin(), part.end());
      part = {};  // the storage of both is never needed whole
    }
    return all;
  }
  /// make(i) for each i in [0, count) that is_wanted(i), in order: two passes, so that each element is stored once.
  template <class T, class IsWanted, class Make>
  std::vector<T> collect(std::size_t count, const IsWanted& is_wanted, const Make& make) const {
    const std::size_t blocks = (count + grain - 1) / grain;
    std::vector<std::size_t> begin(blocks + 1, 0);
    parts(blocks, [&](std::size_t part) {
      for (std::size_t i = part * grain; i < std::min(count, (part + 1) * grain); ++i) begin[part + 1] += is_wanted(i);
    });
    for (std::size_t part = 0; part < blocks; ++part) begin[part + 1] += begin[part];
    auto all = vector_of_capacity<T>(begin.back());
    all.resize(begin.back());
    parts(blocks, [&](std::size_t part) {
      std::size_t at = begin[part];
      for (std::size_t i = part * grain; i < std::min(count, (part + 1) * grain); ++i)
        if (is_wanted(i)) all[at++] = make(i);
    });
    return all;
  }
  template <class T, class Less>
  void sort(std::vector<T>& items, const Less& less) const {
    if (stopped()) return;
    if (!parallel_ || items.size() <= grain) return std::sort(items.begin(), items.end(), less);
    tbb::this_task_arena::isolate([&] {
      tbb::task_group_context context(tbb::task_group_context::isolated);
      const std::stop_callback stop(stop_, [&] { context.cancel_group_execution(); });
      tbb::task_group(context).run_and_wait([&] { tbb::parallel_sort(items.begin(), items.end(), less); });
    });
  }

 private:
  static constexpr std::size_t grain = 8192;
  // The thread sanitizer does not see the synchronisation inside oneTBB, and reports it.
#if defined(__SANITIZE_THREAD__)
  static constexpr bool can_be_checked = false;
#elif defined(__has_feature)
#if __has_feature(thread_sanitizer)
  static constexpr bool can_be_checked = false;
#else
  static constexpr bool can_be_checked = true;
#endif
#else
  static constexpr bool can_be_checked = true;
#endif

  /// Not a template: each loop that TBB gets a type of its own costs seconds of code generation.
  void run(std::size_t count, std::size_t block, const std::function<void(std::size_t, std::size_t)>& f) const;

  bool parallel_;
  std::stop_token stop_;
};

}  // namespace pgdr::detail
