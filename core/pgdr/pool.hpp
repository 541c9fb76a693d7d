// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Storage that grows without moving, and the per-thread pools of ids that hand its slots out. An `IdSource` is shared:
// it deals out blocks of ids and makes the storage behind them (one atomic per block, a lock per chunk). An `IdPool`
// belongs to one thread at a time: ids it is given back are handed out again by the same pool, last in first out, while
// they are still in the cache. No element carries a lock; who may touch a slot is decided above (see mesh.hpp).
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <vector>

#include "pgdr/error.hpp"

namespace pgdr {

/// An array in chunks of 2^log_chunk elements; references stay valid while it grows.
/// Threads: operator[] from any thread for slots that exist; grow_to from any thread.
template <class T, int log_chunk>
class ChunkedArray {
 public:
  static constexpr std::uint32_t chunk_size = 1u << log_chunk;

  explicit ChunkedArray(std::uint32_t capacity)
      : chunks_((capacity >> log_chunk) + 1), table_(new std::atomic<T*>[chunks_]()) {}
  ~ChunkedArray() {
    for (std::uint32_t c = 0; c < chunks_; ++c) delete[] table_[c].load(std::memory_order_relaxed);
  }
  ChunkedArray(const ChunkedArray&) = delete;
  ChunkedArray& operator=(const ChunkedArray&) = delete;

  T& operator[](std::uint32_t i) {
    // Relaxed: an id reaches another thread only through a synchronising operation that came after its chunk was made.
    return table_[i >> log_chunk].load(std::memory_order_relaxed)[i & (chunk_size - 1)];
  }
  const T& operator[](std::uint32_t i) const {
    return table_[i >> log_chunk].load(std::memory_order_relaxed)[i & (chunk_size - 1)];
  }

  /// Gives the storage of a chunk back. None of its slots may be touched after that, or while it goes on.
  void release_chunk(std::uint32_t chunk) { delete[] table_[chunk].exchange(nullptr, std::memory_order_relaxed); }
  void release() {
    for (std::uint32_t c = 0; c < chunks_; ++c) release_chunk(c);
  }

  /// Makes the slots [0, count) exist. @throws std::bad_alloc
  void grow_to(std::uint32_t count) {
    if (count == 0) return;
    const std::uint32_t last = (count - 1) >> log_chunk;
    if (table_[last].load(std::memory_order_acquire)) return;
    std::lock_guard lock(mutex_);
    for (std::uint32_t c = 0; c <= last; ++c)
      if (!table_[c].load(std::memory_order_relaxed)) table_[c].store(new T[chunk_size], std::memory_order_release);
  }

 private:
  std::uint32_t chunks_;
  std::unique_ptr<std::atomic<T*>[]> table_;
  std::mutex mutex_;
};

/// Deals out ids 0, 1, 2, ... in blocks, below a capacity.
class IdSource {
 public:
  static constexpr std::uint32_t block = 512;

  /// `grow(n)` is called before any id below n is handed out; from any thread.
  IdSource(const char* what, std::uint32_t capacity, std::function<void(std::uint32_t)> grow)
      : what_(what), capacity_(capacity), grow_(std::move(grow)) {}

  /// First id of a fresh block. @throws ResourceError ids_exhausted, std::bad_alloc
  std::uint32_t take_block() {
    const std::uint32_t first = next_.fetch_add(block, std::memory_order_relaxed);
    if (first > capacity_ - block) {
      next_.fetch_sub(block, std::memory_order_relaxed);
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
  explicit IdPool(IdSource& source) : source_(&source) {}

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
  void give(std::uint32_t id) { free_.push_back(id); }

 private:
  IdSource* source_;
  std::uint32_t next_ = 0, end_ = 0;
  std::vector<std::uint32_t> free_;
};

}  // namespace pgdr
