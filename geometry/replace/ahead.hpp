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
#include "replace/numbers.hpp"

namespace pgdr::detail {

/// @tparam Candidate  with an operator<: the largest comes first, what is equal is the same; of two with unlike key()s that with
/// the less one
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
    if (next_ == front_.size()) look_ahead(try_it);
    is_of_front_ = next_ < front_.size() && (heap_.empty() || !(front_[next_].candidate < waiting_[heap_.front().slot]));
    return is_of_front_ ? front_[next_++].candidate : take();
  }
  /// What came of the one that was taken off last. @pre nothing has changed since
  template <class TryIt>
  Trial trial(const Candidate& candidate, const TryIt& try_it) {
    if (is_of_front_ && front_[next_ - 1].is_tried && !changer_.has_changed(front_[next_ - 1].trial))
      return std::move(front_[next_ - 1].trial);
    Trial trial;
    try_it(candidate, trial);
    return trial;
  }
  /// Something else that trials depend on has changed.
  void forget_trials() {
    for (Entry& e : front_) e.is_tried = false;
  }

 private:
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

  template <class TryIt>
  void look_ahead(const TryIt& try_it) {
    front_.clear();
    next_ = 0;
    changer_.begin_changes();
    if (!changer_.looks_ahead()) return;
    while (front_.size() < numbers::tried_ahead && !heap_.empty()) front_.push_back({take(), {}, false});
    changer_.bulk().parts(front_.size(), [&](std::size_t k) {
      front_[k].trial.is_ahead = true;
      front_[k].is_tried = try_it(front_[k].candidate, front_[k].trial);
    });
  }

  Changer& changer_;
  std::vector<Handle> heap_;
  std::vector<Candidate> waiting_;   // by slot
  std::vector<std::uint32_t> free_;  // slots
  std::vector<Entry> front_;         // the first of the queue as it was, in their order
  std::size_t next_ = 0;             // of these
  bool is_of_front_ = false;         // the one that was taken off last
};

}  // namespace pgdr::detail
