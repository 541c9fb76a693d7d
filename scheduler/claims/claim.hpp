// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The part of space that one visit holds, and the question whether a vertex lies in it. A claim does not change once it is made,
// and holds for as long as no leaf of its tree is split and the tree stays where it is. Threads: const members from any thread,
// several visits and claims at once.
//
// By the rule of boxes (ClaimRule) it is the box of a node, grown by the node's side; by that of leaves, whole leaves. What a
// visit may change rests on this alone, that the claims of those that run at once have no point in common (mesh/visit_area.hpp):
// a cell beside one that a visit owns has D of its D + 1 vertices in that visit's claim, so that no other claim can hold D of
// them.
#pragma once

#include <cstdint>
#include <vector>

#include "claims/grid_box.hpp"
#include "tree/orthtree.hpp"

namespace pgdr {

/// The order of a claim that is all of space.
inline constexpr std::uint32_t whole_tree = 0xffffffffu;

/// What a visit holds. Immutable.
template <int D>
class Claim {
 public:
  using Node = typename Orthtree<D>::Node;  ///< of the tree
  using Box = typename Orthtree<D>::Box;    ///< half-open

  /// All of space, for a visit of this node.
  static Claim whole(const Orthtree<D>& tree, Node node);
  /// The points in the box. What lies beyond the root counts for the point of the root nearest to it.
  static Claim of_box(const Orthtree<D>& tree, Node node, const GridBox<D>& box);
  /// {leaf} + BUF^order(leaf): `leaves` are these, sorted. order >= 1.
  static Claim of_leaves(const Orthtree<D>& tree, Node leaf, std::vector<Node> leaves, std::uint32_t order);

  bool whole() const { return kind_ == Kind::whole; }  ///< is it all of space?
  Node node() const { return node_; }                  ///< which is visited
  /// A box around the visit's node that holds claimed points only; what lies beyond the root counts for the point of the root
  /// nearest to it, so that a side at the root's border is at infinity. All of the claim, unless that is one of leaves.
  const Box& inner() const { return inner_; }

  /// Is all of the node claimed? By the rule of leaves, of a leaf.
  bool holds(Node node) const;
  /// Is the point claimed?
  bool contains(const Point<D>& p) const {
    return inner_.contains(p) || whole() || (kind_ == Kind::leaves && holds(tree_->leaf_at(p)));
  }

 private:
  enum class Kind { whole, box, leaves };
  Claim(const Orthtree<D>& tree, Node node, Kind kind);
  void set_inner(const GridBox<D>& box);
  GridBox<D> grown(std::uint32_t order) const;

  const Orthtree<D>* tree_;
  Node node_;
  Kind kind_;
  Box inner_;
  GridBox<D> box_;            // of kind box
  std::vector<Node> leaves_;  // of kind leaves
};

extern template class Claim<2>;
extern template class Claim<3>;

}  // namespace pgdr
