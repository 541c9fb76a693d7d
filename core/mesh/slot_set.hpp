// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// A set of slots of cells, a bit each, which threads can fill side by side.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace pgdr {

/// Const members from any thread; one thread at a time may change the slots of one word.
class SlotSet {
 public:
  static constexpr std::size_t slots_a_word = 64;  ///< side by side

  /// None of so many slots.
  explicit SlotSet(std::size_t slots) : words_(slots / slots_a_word + 1, 0) {}

  /// Is it in the set?
  bool operator[](std::size_t slot) const { return words_[slot / slots_a_word] >> slot % slots_a_word & 1; }
  /// Adds it.
  void add(std::size_t slot) { words_[slot / slots_a_word] |= std::uint64_t{1} << slot % slots_a_word; }

 private:
  std::vector<std::uint64_t> words_;
};

}  // namespace pgdr
