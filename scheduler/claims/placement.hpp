// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Which node of the tree an element belongs to. By the rule of boxes, that is the smallest node around its place whose claim is
// large enough for what treating it takes: small elements belong to leaves, larger ones to inner nodes, so that a leaf need not
// wait for the largest element in it to be split. By the rule of leaves it is always the leaf. A value; any thread while nobody
// splits the tree.
#pragma once

#include <limits>

#include "pgdr/refine_options.hpp"
#include "tree/orthtree.hpp"

namespace pgdr {

/// See above.
template <int D>
class Placement {
 public:
  using Node = typename Orthtree<D>::Node;

  /// `share`: an element belongs to a node whose side is its circumradius over this, at least (ScheduleOptions::split_ratio). The
  /// tree must outlive it.
  Placement(const Orthtree<D>& tree, ClaimRule rule, double share)
      : tree_(&tree), by_boxes_(rule == ClaimRule::boxes), share_(share) {}

  const Orthtree<D>& tree() const { return *tree_; }
  /// The node of an element with its place at p, and a circumradius of at most this.
  Node node_of(const Point<D>& p, double radius) const {
    Node node = Orthtree<D>::root;
    while (!tree_->is_leaf(node)) {
      const Node child = tree_->child_at(node, p);
      if (radius > most_radius(child)) break;
      node = child;
    }
    return node;
  }
  /// The largest circumradius of elements that belong to the node.
  double most_radius(Node node) const {
    return by_boxes_ && node != Orthtree<D>::root ? most_radius_of_side(tree_->side(node)) : infinity;
  }
  /// By boxes, that of a node of this side.
  double most_radius_of_side(double side) const { return share_ * side; }
  /// Elements that belong to the node have larger circumradii than this.
  double radius_below(Node node) const {
    if (tree_->is_leaf(node)) return -1;
    return by_boxes_ ? share_ * tree_->side(node) / 2 : infinity;
  }
  bool by_boxes() const { return by_boxes_; }

 private:
  static constexpr double infinity = std::numeric_limits<double>::infinity();

  const Orthtree<D>* tree_;
  bool by_boxes_;
  double share_;
};

}  // namespace pgdr
