// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// A range of addresses whose pages come as it grows. An array in it grows without moving, and without a table of chunks between
// an id and its element. Fresh memory is zero. Large ranges ask for huge pages.
#pragma once

#include <atomic>
#include <cstddef>
#include <mutex>
#include <span>
#include <vector>

namespace pgdr {

/// Makes the kernel find memory for pages that nothing has been written to, and clear it, which takes longer than all later use.
void touch_pages(std::span<std::byte> fresh);

/// A reserved range of addresses, of which a growing part is usable.
class ReservedMemory {
 public:
  /// Reserves addresses, no memory. @throws std::bad_alloc
  explicit ReservedMemory(std::size_t bytes);
  ~ReservedMemory();
  ReservedMemory(const ReservedMemory&) = delete;
  ReservedMemory& operator=(const ReservedMemory&) = delete;

  void* base() const { return base_; }  ///< where the range begins, for good
  /// Makes the first `bytes` usable; from any thread. @throws std::bad_alloc @pre bytes <= what is reserved
  void grow_to(std::size_t bytes) {
    if (bytes > usable_.load(std::memory_order_acquire)) grow(bytes);
  }
  /// Makes the first `bytes` usable. Returns the part from `first` on that no earlier call returned, in pieces of a huge page,
  /// for touch_pages(). @pre nothing has been written there
  std::vector<std::span<std::byte>> fresh_pages(std::size_t first, std::size_t bytes);
  /// Gives back the whole huge pages among the bytes [first, last). What is in these bytes is lost. @pre nobody uses them
  /// meanwhile
  void discard(std::size_t first, std::size_t last);
  /// How many of so many elements, with all that belongs to them, there are addresses for.
  static std::size_t affordable_elements(std::size_t elements);

 private:
  void grow(std::size_t bytes);

  void* mapped_;
  std::byte* base_;
  std::size_t reserved_;
  std::atomic<std::size_t> usable_{0};
  std::size_t returned_ = 0;  ///< by fresh_pages: up to here
  std::mutex mutex_;
};

}  // namespace pgdr
