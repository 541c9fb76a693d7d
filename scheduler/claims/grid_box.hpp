// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Boxes in positions of a tree's finest grid, so that whether they meet is a question of integers. Values, any thread.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include "tree/orthtree.hpp"

namespace pgdr {

/// A half-open box in positions of the finest grid, within the root.
template <int D>
struct GridBox {
  std::array<std::uint64_t, D> low{};   ///< in it
  std::array<std::uint64_t, D> high{};  ///< not in it

  /// The box of a node, grown by so many positions on every face, and cut at the root.
  static GridBox grown(const Orthtree<D>& tree, std::uint32_t node, std::uint64_t margin) {
    GridBox b;
    const std::uint64_t root = tree.extent(Orthtree<D>::root), extent = tree.extent(node);
    for (int i = 0; i < D; ++i) {
      const std::uint64_t at = tree.position(node, i), above = root - at - extent;
      b.low[static_cast<std::size_t>(i)] = at - std::min(margin, at);
      b.high[static_cast<std::size_t>(i)] = at + extent + std::min(margin, above);
    }
    return b;
  }
  /// The box of a node, grown by `sides` times its own side on every face, and cut at the root.
  static GridBox around(const Orthtree<D>& tree, std::uint32_t node, std::uint64_t sides) {
    const std::uint64_t extent = tree.extent(node), across = tree.extent(Orthtree<D>::root) / extent;
    return grown(tree, node, std::min(sides, across) * extent);
  }
  /// Have the boxes a cell of the grid in common?
  bool meets(const GridBox& b) const {
    for (std::size_t i = 0; i < D; ++i)
      if (low[i] >= b.high[i] || b.low[i] >= high[i]) return false;
    return true;
  }
  /// Is b a part of this one?
  bool holds(const GridBox& b) const {
    for (std::size_t i = 0; i < D; ++i)
      if (b.low[i] < low[i] || b.high[i] > high[i]) return false;
    return true;
  }
  /// Have the closed boxes a point in common?
  bool touches(const GridBox& b) const {
    for (std::size_t i = 0; i < D; ++i)
      if (low[i] > b.high[i] || b.low[i] > high[i]) return false;
    return true;
  }
  friend bool operator==(const GridBox&, const GridBox&) = default;  ///< the same corners
};

}  // namespace pgdr
