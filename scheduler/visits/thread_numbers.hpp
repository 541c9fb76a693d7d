// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Numbers for the threads that run visits, in the order in which they first ran one, so that no more numbers are given than
// threads can run at one time: whoever comes later into a slot of the arena, or starts after others have ended, has the
// number of a predecessor. One thread at a time.
#pragma once

#include <algorithm>
#include <cstdint>
#include <thread>
#include <vector>

#include "graph/arena.hpp"
#include "pgdr/refine_options.hpp"

namespace pgdr::detail {

/// See above.
class ThreadNumbers {
 public:
  explicit ThreadNumbers(Executor executor) : executor_(executor) {}

  /// Does the thread that made this object call?
  bool at_home() const { return std::this_thread::get_id() == home_; }
  /// The number of the calling thread.
  std::uint32_t of_this_one() {
    Key key{std::this_thread::get_id(), nowhere};
    if (executor_ == Executor::flow_graph && !at_home()) key = {{}, arena_slot()};
    auto k = std::find(keys_.begin(), keys_.end(), key);
    if (k == keys_.end()) {
      k = std::find(keys_.begin(), keys_.end(), Key{});
      if (k == keys_.end()) k = keys_.insert(k, key);
      *k = key;
    }
    return static_cast<std::uint32_t>(k - keys_.begin());
  }
  /// Frees the numbers of all threads but the one that made this object.
  void others_have_ended() {
    for (Key& k : keys_)
      if (k.thread != home_) k = {};
  }

 private:
  static constexpr int nowhere = -1;
  /// A thread, or a slot of an arena; neither: a number that is free.
  struct Key {
    std::thread::id thread;
    int slot = nowhere;
    friend bool operator==(const Key&, const Key&) = default;
  };

  const Executor executor_;
  const std::thread::id home_ = std::this_thread::get_id();
  std::vector<Key> keys_;
};

}  // namespace pgdr::detail
