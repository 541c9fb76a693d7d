// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

namespace pgdr::detail {

/// Disjoint sets of numbers; the smallest one names its set.
class DisjointSets {
 public:
  explicit DisjointSets(std::size_t n) : parent_(n) { std::iota(parent_.begin(), parent_.end(), 0u); }
  std::uint32_t find(std::uint32_t c) {
    while (parent_[c] != c) c = parent_[c] = parent_[parent_[c]];
    return c;
  }
  void unite(std::uint32_t a, std::uint32_t b) {
    a = find(a);
    b = find(b);
    parent_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<std::uint32_t> parent_;
};

/// The same, for several threads that unite at once, in any order, with the same outcome: a set hangs on its smallest number in
/// the end, since a larger root is hung on a smaller one, and never the other way round.
class SharedDisjointSets {
 public:
  explicit SharedDisjointSets(std::vector<std::uint32_t> numbers) : parent_(std::move(numbers)) {}  ///< 0, 1, 2, ...

  /// The smallest number of the set, once nobody unites any more; before that some number of it, smaller the later it is.
  std::uint32_t find(std::uint32_t c) {
    for (std::uint32_t up = load(c); up != c;) {
      const std::uint32_t next = load(up);
      if (next == up) return up;
      at(c).store(next, std::memory_order_relaxed);  // whoever else writes here writes a number of the set, smaller than c
      c = next;
      up = load(c);
    }
    return c;
  }
  void unite(std::uint32_t a, std::uint32_t b) {
    while (true) {
      a = find(a);
      b = find(b);
      if (a == b) return;
      if (a < b) std::swap(a, b);
      std::uint32_t root = a;
      if (at(a).compare_exchange_strong(root, b, std::memory_order_relaxed)) return;
    }
  }

 private:
  std::atomic_ref<std::uint32_t> at(std::uint32_t c) { return std::atomic_ref<std::uint32_t>(parent_[c]); }
  std::uint32_t load(std::uint32_t c) { return at(c).load(std::memory_order_relaxed); }

  std::vector<std::uint32_t> parent_;
};

}  // namespace pgdr::detail
