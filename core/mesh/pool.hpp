// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Storage that grows without moving, and the pools of ids, one a thread, that hand out its slots. An `IdSource` is shared: it
// deals out blocks of ids and makes the storage behind them, with one atomic operation a block and one lock a growth. An `IdPool`
// belongs to one thread at a time. It hands out ids that came back last first, while they are in the cache. No element carries a
// lock: mesh.hpp says who may use a slot.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <new>
#include <span>
#include <type_traits>
#include <vector>

#include "mesh/reserved_memory.hpp"
#include "pgdr/error.hpp"

namespace pgdr {

/// An array whose elements never move; fresh ones are zero bytes.
/// Threads: operator[] from any thread for slots that exist; grow_to from any thread.
template <class T>
class ReservedArray {
 public:
  static_assert(std::is_trivially_copyable_v<T> && std::is_trivially_destructible_v<T>);

  /// Reserves addresses for so many; none exists yet.
  explicit ReservedArray(std::uint32_t capacity)
      : memory_(std::size_t{capacity} * sizeof(T)), items_(static_cast<T*>(memory_.base())) {}

  T& operator[](std::uint32_t i) { return items_[i]; }              ///< slot i
  const T& operator[](std::uint32_t i) const { return items_[i]; }  ///< slot i

  /// Makes the slots [0, count) exist. @throws std::bad_alloc
  void grow_to(std::uint32_t count) { memory_.grow_to(std::size_t{count} * sizeof(T)); }
  /// ReservedMemory::fresh_pages of the slots [first, count), which exist then. @pre nobody has used them
  std::vector<std::span<std::byte>> fresh_pages(std::uint32_t first, std::uint32_t count) {
    return memory_.fresh_pages(std::size_t{first} * sizeof(T), std::size_t{count} * sizeof(T));
  }
  /// Gives back most of the memory of the slots [first, last), but for the first `kept` bytes. @pre nobody uses them meanwhile
  void discard(std::uint32_t first, std::uint32_t last, std::size_t kept = 0) {
    memory_.discard(std::size_t{first} * sizeof(T) + kept, std::size_t{last} * sizeof(T));
  }

 private:
  ReservedMemory memory_;
  T* items_;
};

/// Deals out ids 0, 1, 2, ... in blocks, below a capacity, which is `most` unless addresses are scarce.
class IdSource {
 public:
  static constexpr std::uint32_t block = 512;  ///< ids dealt out at once

  static constexpr std::uint32_t most = (1u << 30) - 1024;  ///< the largest capacity

  /// `grow(n)` is called before any id below n is handed out; from any thread.
  IdSource(const char* what, std::uint32_t capacity, std::function<void(std::uint32_t)> grow)
      : what_(what), capacity_(capacity), grow_(std::move(grow)) {}

  /// First id of a fresh block. @throws ResourceError ids_exhausted, std::bad_alloc
  std::uint32_t take_block() {
    const std::uint32_t first = next_.fetch_add(block, std::memory_order_relaxed);
    if (first + block > capacity_) {
      next_.fetch_sub(block, std::memory_order_relaxed);
      if (capacity_ < most) throw std::bad_alloc();
      throw ResourceError({Errc::ids_exhausted, std::string("more than 2^30 ") + what_ + " are needed", {}, 0, {}, {}});
    }
    grow_(first + block);
    return first;
  }
  /// All ids ever handed out are below this.
  std::uint32_t bound() const { return next_.load(std::memory_order_relaxed); }

 private:
  const char* what_;
  std::uint32_t capacity_;
  std::atomic<std::uint32_t> next_{0};
  std::function<void(std::uint32_t)> grow_;
};

/// One thread's ids. Not thread-safe.
class IdPool {
 public:
  explicit IdPool(IdSource& source) : source_(&source) {}  ///< which must outlive it

  /// Hands out an id that nobody has. @throws as IdSource::take_block.
  std::uint32_t take() {
    if (!free_.empty()) {
      const std::uint32_t id = free_.back();
      free_.pop_back();
      return id;
    }
    if (next_ == end_) {
      next_ = source_->take_block();
      end_ = next_ + IdSource::block;
    }
    return next_++;
  }
  void give(std::uint32_t id) { free_.push_back(id); }  ///< takes an id back, to hand it out again

 private:
  IdSource* source_;
  std::uint32_t next_ = 0, end_ = 0;
  std::vector<std::uint32_t> free_;
};

}  // namespace pgdr
