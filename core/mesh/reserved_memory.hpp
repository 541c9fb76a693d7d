// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// A range of addresses whose pages come as it grows: what makes an array grow without moving and without a table of
// chunks between an id and its element. Fresh memory is zero. Huge pages are asked for where it is large.
#pragma once

#include <atomic>
#include <cstddef>
#include <mutex>
#include <span>
#include <vector>

namespace pgdr {

/// Has the kernel find memory for pages that nothing has been written to. It clears them, which takes longer than anything that
/// is done to them later.
void touch_pages(std::span<std::byte> fresh);

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
  /// Makes the first `bytes` usable and returns what of them is from `first` on, in pieces of a huge page, but for what earlier
  /// calls returned. Nothing must have been written there yet, so that the pages can be had before they are needed.
  std::vector<std::span<std::byte>> fresh_pages(std::size_t first, std::size_t bytes);
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
  std::size_t returned_ = 0;  ///< by fresh_pages: up to here
  std::mutex mutex_;
};

}  // namespace pgdr
