// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// A range of addresses whose pages come as it grows: what makes an array grow without moving and without a table of
// chunks between an id and its element. Fresh memory is zero. Huge pages are asked for where it is large.
#pragma once

#include <atomic>
#include <cstddef>
#include <mutex>

namespace pgdr {

/// Asks for huge pages where [memory, memory + bytes), which nothing has been written to, is large: a hint.
void ask_for_huge_pages(void* memory, std::size_t bytes);

/// See above.
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
  /// Gives the whole huge pages among the bytes [first, last) back; what is in these bytes is lost. While nobody uses them.
  void discard(std::size_t first, std::size_t last);
  /// Of `elements` with all that belongs to them, as many as there are addresses for.
  static std::size_t affordable_elements(std::size_t elements);

 private:
  void grow(std::size_t bytes);

  void* mapped_;
  std::byte* base_;
  std::size_t reserved_;
  std::atomic<std::size_t> usable_{0};
  std::mutex mutex_;
};

}  // namespace pgdr
