// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// A set of 64-bit keys that is emptied at no cost and reused from insertion to insertion. Open addressing; one thread.
#pragma once

#include <cstdint>
#include <vector>

namespace pgdr {

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
  void insert(std::uint64_t key) { slots_[find(key)] = {key, stamp_}; }
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

/// A map from ridges of a cavity's rim to the first of the two faces that meet there. Emptied at no cost.
class RidgeMap {
 public:
  /// Empties the map and makes room for `most` ridges.
  void reset(std::size_t most) {
    std::size_t size = slots_.size();
    while (size < 4 * most) size = size == 0 ? 256 : 2 * size;
    if (size != slots_.size() || ++stamp_ == 0) {
      slots_.assign(size, {});
      stamp_ = 1;
    }
  }
  /// The value that the key had already; if it had none it has `value` now, and so has the result.
  std::uint32_t find_or_insert(std::uint64_t key, std::uint32_t value) {
    const std::size_t mask = slots_.size() - 1;
    std::size_t i = (key * 0x9e3779b97f4a7c15u >> 32) & mask;
    while (slots_[i].stamp == stamp_) {
      if (slots_[i].key == key) return slots_[i].value;
      i = (i + 1) & mask;
    }
    slots_[i] = {key, stamp_, value};
    return value;
  }

 private:
  struct Slot {
    std::uint64_t key = 0;
    std::uint32_t stamp = 0, value = 0;
  };
  std::vector<Slot> slots_;
  std::uint32_t stamp_ = 0;
};

}  // namespace pgdr
