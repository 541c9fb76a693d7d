// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Storage that grows without moving once it is large, and the pools of ids, one a thread, that hand out its slots. An `IdSource`
// is shared: it deals out blocks of ids and makes the storage behind them, with one atomic operation a block and one lock a
// growth. An `IdPool` belongs to one thread at a time. It hands out ids that came back last first, while they are in the cache.
// No element carries a lock: mesh.hpp says who may use a slot.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <cstring>
#include <functional>
#include <memory>
#include <new>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "mesh/reserved_memory.hpp"
#include "pgdr/error.hpp"

namespace pgdr {

/// An array whose elements move at most once, when addresses are reserved for an array that began small; fresh ones are zero
/// bytes.
/// Threads: operator[] from any thread for slots that exist; grow_to from any thread; the rest while nobody uses the array.
template <class T>
class ReservedArray {
 public:
  static_assert(std::is_trivially_copyable_v<T> && std::is_trivially_destructible_v<T>);

  /// Makes the first `count` slots exist, in memory of the heap. @throws std::bad_alloc @pre it is new
  void begin_small(std::uint32_t count) {
    small_bytes_ = std::size_t{count} * sizeof(T);
    small_.reset(::operator new(small_bytes_, heap_alignment));
    std::memset(small_.get(), 0, small_bytes_);
    items_ = static_cast<T*>(small_.get());
  }
  /// Reserves addresses for so many. What began small moves there, and exists. @throws std::bad_alloc
  void reserve(std::uint32_t capacity) {
    memory_.emplace(std::size_t{capacity} * sizeof(T));
    if (small_) {
      memory_->grow_to(small_bytes_);
      std::memcpy(memory_->base(), small_.get(), small_bytes_);
      small_.reset();
    }
    items_ = static_cast<T*>(memory_->base());
  }

  T& operator[](std::uint32_t i) { return items_[i]; }              ///< slot i
  const T& operator[](std::uint32_t i) const { return items_[i]; }  ///< slot i

  /// Makes the slots [0, count) exist. @throws std::bad_alloc @pre what is small has them already
  void grow_to(std::uint32_t count) {
    if (memory_) memory_->grow_to(std::size_t{count} * sizeof(T));
  }
  /// ReservedMemory::fresh_pages of the slots [first, count), which exist then. @pre it is not small, and nobody has used them
  std::vector<std::span<std::byte>> fresh_pages(std::uint32_t first, std::uint32_t count) {
    return memory_->fresh_pages(std::size_t{first} * sizeof(T), std::size_t{count} * sizeof(T));
  }
  /// Gives back most of the memory of the slots [first, last), but for the first `kept` bytes. @pre nobody uses them meanwhile
  void discard(std::uint32_t first, std::uint32_t last, std::size_t kept = 0) {
    if (memory_) memory_->discard(std::size_t{first} * sizeof(T) + kept, std::size_t{last} * sizeof(T));
  }

 private:
  static constexpr std::align_val_t heap_alignment{64};  // of a cache line
  static_assert(alignof(T) <= 64);
  struct Free {
    void operator()(void* p) const { ::operator delete(p, heap_alignment); }
  };

  std::unique_ptr<void, Free> small_;
  std::size_t small_bytes_ = 0;
  std::optional<ReservedMemory> memory_;
  T* items_ = nullptr;
};

/// Deals out ids 0, 1, 2, ... in blocks, below a capacity.
class IdSource {
 public:
  static constexpr std::uint32_t block = 512;  ///< ids dealt out at once

  static constexpr std::uint32_t most = (1u << 30) - 1024;  ///< the largest capacity

  /// `grow(n)` is called before any id below n is handed out; from any thread. The capacity is 0.
  IdSource(const char* what, std::function<void(std::uint32_t)> grow) : what_(what), grow_(std::move(grow)) {}
  /// Sets the capacity. While no other thread uses it.
  void set_capacity(std::uint32_t capacity) { capacity_ = capacity; }

  /// First id of a fresh block. @throws ResourceError ids_exhausted, std::bad_alloc
  std::uint32_t take_block() {
    const std::uint32_t first = reserve_block();
    open_block(first);
    return first;
  }
  /// First id of a fresh block without storage, which open_block() makes. @throws ResourceError ids_exhausted, std::bad_alloc
  std::uint32_t reserve_block() {
    const std::uint32_t first = next_.fetch_add(block, std::memory_order_relaxed);
    if (first + block > capacity_) {
      next_.fetch_sub(block, std::memory_order_relaxed);
      if (capacity_ < most) throw std::bad_alloc();
      throw ResourceError({Errc::ids_exhausted, std::string("more than 2^30 ") + what_ + " are needed", {}, 0, {}, {}});
    }
    return first;
  }
  /// Makes the storage of a block that was reserved. @throws std::bad_alloc
  void open_block(std::uint32_t first) const { grow_(first + block); }
  /// All ids ever handed out are below this.
  std::uint32_t bound() const { return next_.load(std::memory_order_relaxed); }

 private:
  const char* what_;
  std::uint32_t capacity_ = 0;
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
      if (!reserved_.empty()) {
        open_reserved();
      } else {
        next_ = source_->take_block();
        end_ = next_ + IdSource::block;
      }
    }
    return next_++;
  }
  void give(std::uint32_t id) { free_.push_back(id); }  ///< takes an id back, to hand it out again
  std::uint32_t next() const { return next_; }          ///< the id that comes next of its block, once none came back
  /// Takes over the ids that another pool of the same source could hand out; that one has none then.
  /// @pre the other has reserved no blocks
  void absorb(IdPool&& other) {
    other.free_rest();
    take_over(other);
  }

  // Pools that run side by side, and hand out ids that do not depend on which is ahead: blocks are reserved beforehand, for one
  // pool after the other.
  /// How many ids it can hand out before it asks the source.
  std::size_t available() const { return free_.size() + (end_ - next_) + reserved_.size() * IdSource::block; }
  /// Makes so many available. @throws as IdSource::take_block.
  void reserve(std::size_t count) {
    while (available() < count) reserved_.insert(reserved_.begin(), source_->reserve_block());
  }
  /// Makes the storage of what is available. @throws std::bad_alloc
  void open() {
    while (!reserved_.empty()) {
      free_rest();
      open_reserved();
    }
    free_rest();
  }
  /// Takes over all that the other pool, of the same source, has available. @pre it is open
  void take_over(IdPool& other) {
    free_.insert(free_.end(), other.free_.begin(), other.free_.end());
    other.free_.clear();
  }

 private:
  void open_reserved() {
    next_ = reserved_.back();
    reserved_.pop_back();
    end_ = next_ + IdSource::block;
    source_->open_block(next_);
  }
  void free_rest() {
    for (std::uint32_t id = end_; id > next_; --id) free_.push_back(id - 1);
    next_ = end_;
  }

  IdSource* source_;
  std::uint32_t next_ = 0, end_ = 0;
  std::vector<std::uint32_t> free_;
  std::vector<std::uint32_t> reserved_;  ///< first ids of blocks without storage, the last is next
};

}  // namespace pgdr
