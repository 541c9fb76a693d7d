// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// A set of slots of cells, a bit each, which threads can fill side by side.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace pgdr {

/// Const members from any thread, while none adds; one thread at a time may add slots of one word, but for add_shared().
class SlotSet {
 public:
  static constexpr std::size_t slots_a_word = 64;  ///< side by side

  /// None of so many slots.
  explicit SlotSet(std::size_t slots) : words_(slots / slots_a_word + 1, 0) {}

  /// Is it in the set?
  bool operator[](std::size_t slot) const { return words_[slot / slots_a_word] >> slot % slots_a_word & 1; }
  /// Adds it.
  void add(std::size_t slot) { words_[slot / slots_a_word] |= std::uint64_t{1} << slot % slots_a_word; }
  /// Adds it while others may add slots of the same word, in this way. False if it was in the set already.
  bool add_shared(std::size_t slot) {
    const std::uint64_t bit = std::uint64_t{1} << slot % slots_a_word;
    const std::atomic_ref word(words_[slot / slots_a_word]);
    if ((word.load(std::memory_order_relaxed) & bit) != 0) return false;
    return (word.fetch_or(bit, std::memory_order_relaxed) & bit) == 0;  // the set is read after the loop
  }

 private:
  std::vector<std::uint64_t> words_;
};

}  // namespace pgdr
