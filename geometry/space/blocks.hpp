// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Biconnected components of a graph, its blocks: parts that hang together whichever vertex is taken away. An edge is in one
// block, and which ones there are depends on the graph alone, not on the order of the search.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace pgdr::detail {

class Blocks {
 public:
  using Pair = std::array<std::uint32_t, 2>;
  /// The edges in the order of the search, by their ends in the order in which it went along them; one end is known before. The
  /// first begins at the vertex through which the block was entered.
  using Block = std::vector<Pair>;

  /// @param edges  of different vertices, in any order, any number of times
  Blocks(std::uint32_t vertices, std::vector<Pair> edges);

  /// Finds the blocks of what hangs together with `start`, unless it was seen before. A block is complete before the one through
  /// which it is reached. Linear time.
  void search(std::uint32_t start);
  const std::vector<Block>& found() const { return blocks_; }
  bool is_seen(std::uint32_t vertex) const { return number_[vertex] != unseen; }
  /// Did the search go along this edge to a vertex that it had not seen?
  bool is_forward(const Pair& edge) const { return number_[edge[1]] > number_[edge[0]]; }

 private:
  struct Step {
    std::uint32_t at, from, next;
  };
  static constexpr std::uint32_t unseen = 0xffffffffu;

  void see(std::uint32_t vertex) { number_[vertex] = low_[vertex] = count_++; }
  void close(const Pair& edge, std::vector<Pair>& open);

  std::vector<std::uint32_t> begin_, ends_;  ///< neighbours of each vertex
  std::vector<std::uint32_t> number_, low_;  ///< order of the search; the least number that its subtree is joined to
  std::uint32_t count_ = 0;
  std::vector<Block> blocks_;
};

}  // namespace pgdr::detail
