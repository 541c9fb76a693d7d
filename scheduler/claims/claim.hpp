// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The leaves that one visit holds, and the question whether a vertex lies in them. A claim does not change once it is made, and
// holds for as long as no leaf of its tree is split and the tree stays where it is. Threads: const members from any thread,
// several visits and claims at once.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "tree/orthtree.hpp"

namespace pgdr {

/// The order of a claim that is the whole tree; otherwise a claim of order i is {L} + BUF^i(L).
inline constexpr std::uint32_t whole_tree = 0xffffffffu;

/// The leaves that a visit holds. Immutable.
template <int D>
class Claim {
 public:
  using Node = typename Orthtree<D>::Node;  ///< of the tree
  using Box = typename Orthtree<D>::Box;    ///< half-open

  /// {leaf} + `zone`, where `zone` is BUF^order(leaf) without the leaf, in any order; order >= 1.
  Claim(const Orthtree<D>& tree, Node leaf, std::span<const Node> zone, std::uint32_t order);
  /// `leaves`: these and the leaf, sorted; none for the whole tree.
  static Claim of_leaves(const Orthtree<D>& tree, Node leaf, std::vector<Node> leaves, std::uint32_t order);
  /// The whole tree, for a visit of `leaf`.
  static Claim whole(const Orthtree<D>& tree, Node leaf);

  bool whole() const { return leaves_.empty(); }  ///< is it the whole tree?
  Node leaf() const { return leaf_; }             ///< which is visited
  /// Sorted; empty if the claim is the whole tree.
  const std::vector<Node>& leaves() const { return leaves_; }
  /// A box around the visit's leaf that holds points of claimed leaves only; what lies beyond the root counts for the
  /// leaf nearest to it, so that a side at the root's border is at infinity. All of space for the whole tree.
  const Box& inner() const { return inner_; }

  /// Is the leaf claimed? A constant number of steps.
  bool contains_leaf(Node leaf) const {
    if (whole()) return true;
    for (std::size_t i = slot(leaf);; i = (i + 1) & mask_) {
      if (table_[i] == leaf) return true;
      if (table_[i] == Orthtree<D>::none) return false;
    }
  }
  /// Does the point lie in a claimed leaf?
  bool contains(const Point<D>& p) const { return inner_.contains(p) || whole() || contains_leaf(tree_->leaf_at(p)); }

 private:
  Claim(const Orthtree<D>& tree, Node leaf);
  std::size_t slot(Node leaf) const { return (leaf * 0x9e3779b97f4a7c15u >> 32) & mask_; }
  void hold(std::vector<Node> leaves, std::uint32_t order);
  void make_table();
  void grow_inner(std::uint32_t order);

  const Orthtree<D>* tree_;
  Node leaf_;
  Box inner_;
  std::vector<Node> leaves_;
  std::vector<Node> table_;  // open addressing, at most half full
  std::size_t mask_ = 0;
};

extern template class Claim<2>;
extern template class Claim<3>;

}  // namespace pgdr
