// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// A queue of candidates whose first ones are tried ahead, by all threads, while their order stays that of one thread. The first
// of the queue are taken off and tried at once: that only reads. Then candidates come out in their order, with new ones between.
// A trial made ahead is used if no change since has touched what it read: then a trial made now would read the same and come to
// the same, so that the bytes are those of one thread, whatever is tried ahead. Else it is made anew.
#pragma once

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include "replace/changer.hpp"

namespace pgdr::detail {

/// @tparam Candidate  with an operator<: the largest comes first, what is equal is the same; of two with unlike key()s that with
/// the less one. Of those with is_same() that wait, which follow each other, one counts
template <class Candidate>
class AheadQueue {
 public:
  explicit AheadQueue(Changer& changer) : changer_(changer) {}

  bool empty() const { return next_ == front_.size() && heap_.empty(); }
  void push(const Candidate& candidate) {
    std::uint32_t slot = 0;
    if (free_.empty()) {
      slot = static_cast<std::uint32_t>(waiting_.size());
      waiting_.push_back(candidate);
    } else {
      slot = free_.back();
      free_.pop_back();
      waiting_[slot] = candidate;
    }
    heap_.push_back({candidate.key(), slot});
    std::push_heap(heap_.begin(), heap_.end(), later());
  }
  /// Takes the first one off. try_it(candidate, trial) tries one, where it may be tried at all; several threads call it at once.
  template <class TryIt>
  Candidate pop(const TryIt& try_it) {
    if (is_heap_before_front() && changer_.looks_ahead()) look_ahead(try_it);
    is_of_front_ = !is_heap_before_front();
    return is_of_front_ ? front_[next_++].candidate : take();
  }
  /// What came of the one that was taken off last. @pre nothing has changed since
  template <class TryIt>
  Trial trial(const Candidate& candidate, const TryIt& try_it) {
    if (is_of_front_ && front_[next_ - 1].is_tried) {
      if (!changer_.has_changed(front_[next_ - 1].trial)) return std::move(front_[next_ - 1].trial);
      ++in_vain_;
    }
    Trial trial;
    try_it(candidate, trial);
    return trial;
  }
  /// Something else that trials depend on has changed.
  void forget_trials() {
    for (Entry& e : front_) e.is_tried = false;
  }

 private:
  /// So many are tried at once, on which the surface does not depend: a few for each of many threads. More are tried in vain, as
  /// changes before them touch what they have read.
  static constexpr std::size_t most_ahead = 64, least_ahead = 8;

  struct Entry {
    Candidate candidate;
    Trial trial;
    bool is_tried = false;
  };
  /// What is moved about in the heap: candidates themselves are several times as large.
  struct Handle {
    double key;
    std::uint32_t slot;
  };

  auto later() const {
    return
        [this](const Handle& a, const Handle& b) { return a.key != b.key ? a.key > b.key : waiting_[a.slot] < waiting_[b.slot]; };
  }
  Candidate take() {
    std::pop_heap(heap_.begin(), heap_.end(), later());
    const std::uint32_t slot = heap_.back().slot;
    heap_.pop_back();
    free_.push_back(slot);
    return waiting_[slot];
  }

  bool is_heap_before_front() const {
    return next_ == front_.size() || (!heap_.empty() && front_[next_].candidate < waiting_[heap_.front().slot]);
  }
  /// Puts the first of the heap in order among those of the front that are left, and tries them at once.
  template <class TryIt>
  void look_ahead(const TryIt& try_it) {
    front_.erase(front_.begin(), front_.begin() + static_cast<std::ptrdiff_t>(next_));
    next_ = 0;
    if (front_.empty()) changer_.begin_changes();
    adapt();
    const std::size_t left = front_.size();
    if (left > 2 * ahead_) return;  // what is tried too long before its turn is tried in vain
    const std::size_t most = std::max(ahead_, left + ahead_ / 4);
    while (front_.size() < most && !heap_.empty()) {
      const Candidate next = take();
      if (front_.size() == left || !next.is_same(front_.back().candidate)) front_.push_back({next, {}, false});
    }
    tried_ += front_.size() - left;
    changer_.bulk().parts(front_.size() - left, [&](std::size_t k) {
      Entry& e = front_[left + k];
      e.trial.ahead_of = changer_.changes();
      try {
        e.is_tried = try_it(e.candidate, e.trial);
      } catch (...) {  // of the caller's sizes: thrown again when it is tried in its turn, if that comes
        e.is_tried = false;
      }
    });
    std::inplace_merge(front_.begin(), front_.begin() + static_cast<std::ptrdiff_t>(left), front_.end(),
                       [](const Entry& a, const Entry& b) { return b.candidate < a.candidate; });
  }

  /// Where neighbours follow each other in the queue, as the edges of a regular surface do, fewer are tried at once.
  void adapt() {
    if (tried_ < most_ahead) return;
    if (4 * in_vain_ > tried_)
      ahead_ = std::max(ahead_ / 2, least_ahead);
    else if (16 * in_vain_ < tried_)
      ahead_ = std::min(ahead_ * 2, most_ahead);
    tried_ = in_vain_ = 0;
  }

  Changer& changer_;
  std::size_t ahead_ = most_ahead;       // as many are tried at once
  std::size_t tried_ = 0, in_vain_ = 0;  // ahead since that was set
  std::vector<Handle> heap_;
  std::vector<Candidate> waiting_;   // by slot
  std::vector<std::uint32_t> free_;  // slots
  std::vector<Entry> front_;         // those that were tried ahead, in their order
  std::size_t next_ = 0;             // of these
  bool is_of_front_ = false;         // the one that was taken off last
};

}  // namespace pgdr::detail
