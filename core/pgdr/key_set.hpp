// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// A set of 64-bit keys that is emptied at no cost and reused from insertion to insertion. Open addressing; one thread.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

namespace pgdr {

/// A set of keys that is emptied at no cost. One thread.
class KeySet {
 public:
  /// Empties the set and makes room for `most` keys.
  void reset(std::size_t most) {
    std::size_t size = slots_.size();
    while (size < 2 * most + 2) size = size == 0 ? 256 : 2 * size;
    if (size != slots_.size() || ++stamp_ == 0) {
      slots_.assign(size, {});
      stamp_ = 1;
    }
  }
  /// Into the set. False if it was there.
  bool insert(std::uint64_t key) { return std::exchange(slots_[find(key)], Slot{key, stamp_}).stamp != stamp_; }
  /// Since the last time that it was emptied.
  bool contains(std::uint64_t key) const { return slots_[find(key)].stamp == stamp_; }

 private:
  struct Slot {
    std::uint64_t key = 0;
    std::uint32_t stamp = 0;
  };
  std::size_t find(std::uint64_t key) const {
    const std::size_t mask = slots_.size() - 1;
    std::size_t i = (key * 0x9e3779b97f4a7c15u >> 32) & mask;
    while (slots_[i].stamp == stamp_ && slots_[i].key != key) i = (i + 1) & mask;
    return i;
  }

  std::vector<Slot> slots_;
  std::uint32_t stamp_ = 0;
};

/// Pairs up what comes twice: of each key that two values are added for, either value finds the other. No branch depends on
/// the data but where two keys share a slot, which the caller must then tell apart. Emptied at no cost; one thread.
class PairTable {
 public:
  /// Empties the table and makes room for `most` keys.
  void reset(std::size_t most) {
    std::size_t size = slots_.size();
    while (size < 32 * most) size = size == 0 ? 2048 : 2 * size;
    if (size != slots_.size() || stamp_ >= last_stamp) {
      slots_.assign(size, {});
      stamp_ = 0;
    }
    stamp_ += most_count + 1;
  }
  std::size_t slot_of(std::uint64_t hash) const { return (hash >> 24) & (slots_.size() - 1); }  ///< of a key with this hash
  /// Adds a value for the key of the slot.
  void add(std::size_t slot, std::uint32_t value) {
    Slot& s = slots_[slot];
    const bool fresh = s.tag < stamp_;
    const std::uint32_t tag = fresh ? stamp_ : s.tag, others = fresh ? 0 : s.values;
    s = {tag + ((tag & most_count) < most_count ? 1 : 0), others ^ value};
  }
  /// Is the slot one pair's alone?
  bool is_pair(std::size_t slot) const { return slots_[slot].tag == stamp_ + 2; }
  /// @pre is_pair
  std::uint32_t partner(std::size_t slot, std::uint32_t value) const { return slots_[slot].values ^ value; }

 private:
  static constexpr std::uint32_t most_count = 63, last_stamp = 0xffffff00u;
  struct Slot {
    std::uint32_t tag = 0;     // the stamp, and how many were added, up to most_count
    std::uint32_t values = 0;  // exclusive or
  };
  std::vector<Slot> slots_;
  std::uint32_t stamp_ = 0;
};

}  // namespace pgdr
