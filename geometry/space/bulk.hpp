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
#include <iterator>
#include <stop_token>
#include <utility>
#include <vector>

#include "space/huge_pages.hpp"
#include "space/pieces.hpp"

namespace pgdr::detail {

/// While one lives, the bulk loops that this thread begins run as these pieces instead of in its task arena: so whatever a run
/// calls shares the run's threads. They nest. Pieces themselves run without.
class PiecesHere {
 public:
  explicit PiecesHere(const Pieces& pieces) : PiecesHere(&pieces) {}
  PiecesHere(const PiecesHere&) = delete;
  PiecesHere& operator=(const PiecesHere&) = delete;
  ~PiecesHere();

 private:
  friend class Bulk;
  explicit PiecesHere(const Pieces* pieces);  ///< null: none
  static const Pieces* current();

  const Pieces* before_;
};

class Bulk {
 public:
  /// Once `stop` is requested blocks are left out, so that what was to be made is nothing to use.
  explicit Bulk(bool parallel, std::stop_token stop = {})
      : parallel_(parallel && can_be_checked && tbb::this_task_arena::max_concurrency() > 1),
        pieces_(parallel ? PiecesHere::current() : nullptr),
        stop_(std::move(stop)) {}

  /// Blocks run as pieces. Sorting, too: blocks are sorted side by side, and merged two and two. `pieces` must outlive this.
  explicit Bulk(const Pieces& pieces, std::stop_token stop = {}) : parallel_(true), pieces_(&pieces), stop_(std::move(stop)) {}

  /// May several blocks run at once?
  bool is_parallel() const { return parallel_ || pieces_; }
  bool stopped() const { return stop_.stop_requested(); }
  /// How many of so many items make a block.
  std::size_t grain_of(std::size_t count) const { return pieces_ ? std::clamp(count / usual_pieces, least_grain, grain) : grain; }

  /// Calls f(first, last) for blocks that cover [0, count). With `parallel`, several at once; isolated, so that the
  /// thread that waits does not pick up other tasks of the caller.
  template <class F>
  void blocks(std::size_t count, const F& f) const {
    run(count, grain_of(count), std::cref(f));
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
    const std::size_t block = grain_of(count);
    std::vector<std::vector<T>> found((count + block - 1) / block);
    parts(found.size(), [&](std::size_t part) {
      for (std::size_t i = part * block; i < std::min(count, (part + 1) * block); ++i) f(i, found[part]);
    });
    std::size_t total = 0;
    for (const auto& part : found) total += part.size();
    auto all = vector_of_capacity<T>(total);
    for (auto& part : found) {
      all.insert(all.end(), std::make_move_iterator(part.begin()), std::make_move_iterator(part.end()));
      part = {};  // the storage of both is never needed whole
    }
    return all;
  }
  /// make(i) for each i in [0, count) that is_wanted(i), in order: two passes, so that each element is stored once.
  template <class T, class IsWanted, class Make>
  std::vector<T> collect(std::size_t count, const IsWanted& is_wanted, const Make& make) const {
    const std::size_t block = grain_of(count), blocks = (count + block - 1) / block;
    std::vector<std::size_t> begin(blocks + 1, 0);
    parts(blocks, [&](std::size_t part) {
      for (std::size_t i = part * block; i < std::min(count, (part + 1) * block); ++i) begin[part + 1] += is_wanted(i);
    });
    for (std::size_t part = 0; part < blocks; ++part) begin[part + 1] += begin[part];
    auto all = vector_of_capacity<T>(begin.back());
    all.resize(begin.back());
    parts(blocks, [&](std::size_t part) {
      std::size_t at = begin[part];
      for (std::size_t i = part * block; i < std::min(count, (part + 1) * block); ++i)
        if (is_wanted(i)) all[at++] = make(i);
    });
    return all;
  }
  template <class T, class Less>
  void sort(std::vector<T>& items, const Less& less) const {
    if (stopped()) return;
    if (items.size() <= grain || !is_parallel()) return std::sort(items.begin(), items.end(), less);
    if (pieces_) return sort_in_pieces(items, less);
    tbb::this_task_arena::isolate([&] {
      tbb::task_group_context context(tbb::task_group_context::isolated);
      const std::stop_callback stop(stop_, [&] { context.cancel_group_execution(); });
      tbb::task_group(context).run_and_wait([&] { tbb::parallel_sort(items.begin(), items.end(), less); });
    });
  }

 private:
  static constexpr std::size_t grain = 8192;
  /// Of pieces there are some hundred, which is enough for many threads: a loop takes as long as its longest piece. Less than 512
  /// items are too little work for a piece.
  static constexpr std::size_t least_grain = 512, usual_pieces = 128;
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

  /// Blocks, then pairs of them, twice as long each time. The last merges are of few long pairs: each of these is cut in two at
  /// the middle of the longer one until there are enough to share.
  template <class T, class Less>
  void sort_in_pieces(std::vector<T>& items, const Less& less) const;

  bool parallel_;
  const Pieces* pieces_;
  std::stop_token stop_;
};

template <class T, class Less>
void Bulk::sort_in_pieces(std::vector<T>& items, const Less& less) const {
  const std::size_t count = items.size();
  const auto at = [&items](std::size_t i) { return items.begin() + static_cast<std::ptrdiff_t>(i); };
  parts((count + grain - 1) / grain,
        [&](std::size_t part) { std::sort(at(part * grain), at(std::min(count, (part + 1) * grain)), less); });
  std::vector<T> merged(items);
  struct Merge {
    std::size_t first, middle, second, end, to;  ///< [first, middle) and [second, end), to be merged from `to` on
  };
  for (std::size_t length = grain; length < count && !stopped(); length *= 2) {
    std::vector<Merge> merges;
    for (std::size_t first = 0; first < count; first += 2 * length) {
      const std::size_t middle = std::min(count, first + length);
      merges.push_back({first, middle, middle, std::min(count, first + 2 * length), first});
    }
    for (std::size_t i = 0; i < merges.size(); ++i) {
      while (merges[i].end - merges[i].second + merges[i].middle - merges[i].first > 4 * grain) {
        Merge& m = merges[i];
        // Where the middle item of the longer run belongs in the other one; equal items of the first run stay in front.
        std::size_t cut = m.first + (m.middle - m.first) / 2, other = 0;
        if (m.middle - m.first >= m.end - m.second) {
          other = static_cast<std::size_t>(std::lower_bound(at(m.second), at(m.end), items[cut], less) - items.begin());
        } else {
          other = m.second + (m.end - m.second) / 2;
          cut = static_cast<std::size_t>(std::upper_bound(at(m.first), at(m.middle), items[other], less) - items.begin());
        }
        const Merge rest{cut, m.middle, other, m.end, m.to + (cut - m.first) + (other - m.second)};
        m.middle = cut;
        m.end = other;
        merges.push_back(rest);
      }
    }
    parts(merges.size(), [&](std::size_t i) {
      const Merge& m = merges[i];
      std::merge(at(m.first), at(m.middle), at(m.second), at(m.end), merged.begin() + static_cast<std::ptrdiff_t>(m.to), less);
    });
    if (!stopped()) items.swap(merged);
  }
}

}  // namespace pgdr::detail
