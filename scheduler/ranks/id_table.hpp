// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// A table of ids that are found by what they stand for: the caller gives a hash, which several may have, and says whether an id
// is the one. Open addressing, without tombstones. One thread.
#pragma once

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

namespace pgdr::detail {

/// See above. An id is any number but `none`.
class IdTable {
 public:
  static constexpr std::uint32_t none = 0xffffffffu;

  /// Takes all out, and gives the memory back.
  void clear() { *this = IdTable(); }
  /// The id of this hash of which is(id) holds; none.
  template <class Is>
  std::uint32_t find(std::uint32_t hash, Is is) const {
    if (size_ == 0) return none;
    for (std::size_t i = home(hash); slots_[i].id != none; i = next(i))
      if (slots_[i].hash == hash && is(slots_[i].id)) return slots_[i].id;
    return none;
  }
  /// Begins to load what find(), insert() and erase() of this hash will look at.
  void prefetch(std::uint32_t hash) const {
    if (!slots_.empty()) __builtin_prefetch(&slots_[home(hash)]);
  }
  /// Puts in an id that is not there.
  void insert(std::uint32_t hash, std::uint32_t id) {
    if (2 * (size_ + 1) > slots_.size()) grow();
    place({hash, id});
    ++size_;
  }
  /// Takes the id of this hash out; false if it is not there.
  bool erase(std::uint32_t hash, std::uint32_t id) {
    if (size_ == 0) return false;
    std::size_t i = home(hash);
    while (slots_[i].id != id || slots_[i].hash != hash) {
      if (slots_[i].id == none) return false;
      i = next(i);
    }
    close_gap(i);
    --size_;
    return true;
  }

 private:
  struct Slot {
    std::uint32_t hash;
    std::uint32_t id;
  };
  std::size_t mask() const { return slots_.size() - 1; }
  std::size_t home(std::uint32_t hash) const { return hash & mask(); }
  std::size_t next(std::size_t i) const { return (i + 1) & mask(); }
  void place(Slot slot) {
    std::size_t i = home(slot.hash);
    while (slots_[i].id != none) i = next(i);
    slots_[i] = slot;
  }
  void grow() {
    const std::size_t size = std::max<std::size_t>(64, 2 * slots_.size());
    const std::vector<Slot> old = std::exchange(slots_, std::vector<Slot>(size, {0, none}));
    for (const Slot& s : old)
      if (s.id != none) place(s);
  }
  /// Moves ids that were displaced by the one at i, directly or not, nearer to their homes.
  void close_gap(std::size_t i) {
    for (std::size_t j = next(i); slots_[j].id != none; j = next(j)) {
      const std::size_t from = home(slots_[j].hash);
      if (((i - from) & mask()) > ((j - from) & mask())) continue;  // it would come before its home
      slots_[i] = slots_[j];
      i = j;
    }
    slots_[i].id = none;
  }

  std::vector<Slot> slots_;
  std::size_t size_ = 0;
};

/// A hash of some numbers, in their order.
class WordHash {
 public:
  void add(std::uint64_t number) { value_ = (value_ ^ number * 0x9e3779b97f4a7c15u) * 0xbf58476d1ce4e5b9u ^ value_ >> 29; }
  std::uint64_t value() const { return value_ ^ value_ >> 31; }

 private:
  std::uint64_t value_ = 0x243f6a8885a308d3u;
};

}  // namespace pgdr::detail
