// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// A set of 64-bit keys that is emptied at no cost and reused from insertion to insertion. Open addressing; one thread.
#pragma once

#include <array>
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
  /// Adds the key. False if it was there.
  bool insert(std::uint64_t key) { return std::exchange(slots_[find(key)], Slot{key, stamp_}).stamp != stamp_; }
  /// Was the key added since the set was emptied?
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

/// Small numbers for few ids, given out as they are asked for. One thread.
class SmallNumbers {
 public:
  static constexpr std::uint32_t bound = 64;  ///< of the numbers
  static constexpr std::size_t most = 62;     ///< ids that may be asked for; quick with some 40

  /// Forgets all.
  void reset() { ids_.fill(none); }
  /// The number of the id, which is not all ones; a new one if it has none.
  std::uint32_t of(std::uint32_t id) {
    std::uint32_t i = first_place(id);
    while (ids_[i] != id) {
      if (ids_[i] == none)
        ids_[i] = id;
      else
        i = (i + 1) % bound;
    }
    return i;
  }
  /// Has the id a number?
  bool has(std::uint32_t id) const {
    std::uint32_t i = first_place(id);
    while (ids_[i] != id && ids_[i] != none) i = (i + 1) % bound;
    return ids_[i] == id;
  }

 private:
  static constexpr std::uint32_t none = 0xffffffffu;
  static std::uint32_t first_place(std::uint32_t id) { return id * 0x9e3779b9u >> 26; }
  std::array<std::uint32_t, bound> ids_;  // by number
};

/// Pairs up what comes twice: values are added for keys, two for each. No branch depends on the data but where two keys share a
/// slot, which the caller must then tell apart. Whoever adds clears. One thread.
class PairTable {
 public:
  /// Makes room for `most` keys. @pre every slot that was added to has been cleared
  void reserve(std::size_t most) {
    std::size_t size = slots_.size();
    while (size < 32 * most) size = size == 0 ? 2048 : 2 * size;
    if (size != slots_.size()) slots_.assign(size, 0);
  }
  std::size_t slot_of(std::uint64_t hash) const { return (hash >> 24) & (slots_.size() - 1); }  ///< of a key with this hash
  /// Adds a value for the key of the slot. Is it the slot's first?
  bool add(std::size_t slot, std::uint32_t value) {
    const std::uint64_t before = slots_[slot];
    slots_[slot] = (before ^ value) + one;
    return before == 0;
  }
  /// Is the slot one pair's alone?
  bool is_pair(std::size_t slot) const { return slots_[slot] >> 32 == 2; }
  /// The other one of the pair. @pre is_pair
  std::uint32_t partner(std::size_t slot, std::uint32_t value) const { return static_cast<std::uint32_t>(slots_[slot]) ^ value; }
  /// Forgets what was added to the slot.
  void clear(std::size_t slot) { slots_[slot] = 0; }

 private:
  static constexpr std::uint64_t one = std::uint64_t{1} << 32;
  std::vector<std::uint64_t> slots_;  // how many were added, and the exclusive or of them, 32 bits each
};

}  // namespace pgdr
