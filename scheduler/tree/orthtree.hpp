// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The quadtree (D = 2) or octree (D = 3) whose leaves are refined concurrently, and the buffer zones of its leaves
// (Chernikov, definitions 3.3-3.5, 3.7, 3.8). Leaves are half-open boxes; coordinates beyond the root are clamped, so
// that every point has exactly one leaf. Borders are positions of one integer grid, rounded once: two leaves that meet
// agree on the double between them, and the tree may have any grading.
// Threads: const members from any thread while nobody splits.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "pgdr/types.hpp"

namespace pgdr {

/// A quadtree or octree. Any number of threads may read it while none splits.
template <int D>
class Orthtree {
 public:
  using Node = std::uint32_t;                ///< a leaf, or an inner node
  static constexpr Node root = 0;            ///< the first
  static constexpr Node none = 0xffffffffu;  ///< no node
  static constexpr int children = 1 << D;    ///< of an inner node
  /// The finest level: its integer coordinates fill a Morton key of 64 bits.
  static constexpr int max_level = D == 2 ? 31 : 21;
  /// A node's place among the nodes of its own level, counted from the root's low corner.
  using Place = std::array<std::uint32_t, D>;

  /// A half-open box: low <= x < high on every axis.
  struct Box {
    Point<D> low;   ///< in it
    Point<D> high;  ///< not in it
    /// Does the point lie in it?
    bool contains(const Point<D>& p) const {
      for (int i = 0; i < D; ++i)
        if (!(p[i] >= low[i] && p[i] < high[i])) return false;
      return true;
    }
    friend bool operator==(const Box&, const Box&) = default;  ///< equal corners
  };

  /// A tree of one leaf over the bounding box [low, high] of the points: a cube whose side has few bits, 1/16 to 1/8 larger than
  /// the box and beyond it on all sides, placed so that neither the box's faces nor the dyadic fractions of it are borders of
  /// leaves. Scaling the box by a power of two scales the tree exactly. @throws InputError not_finite (also: too large)
  Orthtree(const Point<D>& low, const Point<D>& high);

  /// The leaf that holds the point; of a point outside the root, the leaf nearest to it; of a NaN, some leaf.
  Node leaf_at(const Point<D>& p) const {
    Node node = root;
    while (!is_leaf(node)) node = child_at(node, p);
    return node;
  }
  /// The child of a node that is no leaf in whose half of it p lies on every axis; p may lie outside the node.
  Node child_at(Node node, const Point<D>& p) const {
    unsigned child = 0;
    for (int i = 0; i < D; ++i) child |= static_cast<unsigned>(p[i] >= nodes_[node].centre[i]) << i;
    return nodes_[node].first_child + child;
  }

  bool is_leaf(Node node) const { return nodes_[node].first_child == 0; }                ///< has it no children?
  Node first_child(Node node) const { return nodes_[node].first_child; }                 ///< the others follow
  Node parent(Node node) const { return nodes_[node].parent; }                           ///< `none` for the root
  int level(Node node) const { return places_[node].level; }                             ///< 0 for the root
  const Place& place(Node node) const { return places_[node].at; }                       ///< on its level
  const Point<D>& centre(Node node) const { return nodes_[node].centre; }                ///< where its children meet
  double side(Node node) const { return side_[static_cast<std::size_t>(level(node))]; }  ///< length, exact
  Box box(Node node) const;                                                              ///< half-open

  /// The number of nodes made so far, which are numbered from 0.
  Node node_count() const { return static_cast<Node>(nodes_.size()); }
  std::size_t leaf_count() const { return leaf_count_; }  ///< of the tree
  /// Calls f for all nodes, each before its children, and these in their order: an order by the boxes alone, in which leaves go
  /// by morton(), and in which the order of splits has no part.
  template <class F>
  void for_each_node(F f) const {
    Node node = root;
    while (true) {
      f(node);
      if (!is_leaf(node)) {
        node = first_child(node);
        continue;
      }
      while (node != root && node == first_child(parent(node)) + children - 1) node = parent(node);
      if (node == root) return;
      ++node;
    }
  }
  std::vector<Node> leaves() const;  ///< in Morton order

  /// Can the leaf be split? Not at max_level, nor where the doubles are too coarse to halve the box.
  bool can_split(Node leaf) const;
  /// Makes 2^D children, numbered one after the other; bit i of a child's rank says that it is the upper half on axis i.
  /// @returns the first; `none`, and nothing is done, if the leaf cannot be split.
  Node split(Node leaf);

  /// Position of the low corner on the finest level, bits interleaved: different for all leaves of a tree, and a function
  /// of the box alone, not of the order of splits.
  std::uint64_t morton(Node node) const;
  /// The place modulo `period` on every axis, as one number. Among leaves of one size equal colours are equal, or at
  /// least `period` leaves apart on some axis: in a uniform tree the sets {L} + BUF^i(L) of leaves of equal
  /// colour are disjoint for period 2i + 1.
  std::uint64_t colour(Node node, std::uint32_t period = 3) const;

  /// Appends the leaves that share a face (a piece of positive area) with `leaf`; side 0 = below on that axis, 1 = above.
  /// None at the root's border.
  void append_face_neighbours(Node leaf, int axis, int side, std::vector<Node>& out) const;

  /// BUF(leaf), sorted: its face neighbours, their face neighbours along the axes not used yet, and so on, for every
  /// order of the axes. Holds every leaf that touches `leaf`. The leaf itself is not in it. (No chain that uses each
  /// axis at most once comes back to it, in any grading.) Symmetric: a in BUF(b) if and only if b in BUF(a). A split
  /// changes BUF(L) only if the leaf that split was in it.
  std::vector<Node> buffer(Node leaf) const;

  /// The double at a position of the finest grid, 0 .. 2^max_level from the root's low border to its high one.
  double border(int axis, std::uint64_t position) const { return low_[axis] + static_cast<double>(position) * unit_; }
  /// The position of a node's low border on the finest grid.
  std::uint64_t position(Node node, int axis) const {
    return std::uint64_t{place(node)[static_cast<std::size_t>(axis)]} << (max_level - level(node));
  }
  /// The number of positions of the finest grid that a node extends over.
  std::uint64_t extent(Node node) const { return std::uint64_t{1} << (max_level - level(node)); }

 private:
  struct Descent {  // all that leaf_at reads
    Point<D> centre;
    Node first_child = 0;  // 0 = leaf: the root is nobody's child
    Node parent = none;
  };
  struct Position {
    Place at{};
    std::uint8_t level = 0;
  };

  Node append(Node parent, const Place& at, int level);
  Node node_at(const Place& at, int level) const;
  void append_face(Node node, int axis, unsigned bit, std::vector<Node>& out) const;

  std::vector<Descent> nodes_;
  std::vector<Position> places_;
  std::array<double, max_level + 1> side_{};
  Point<D> low_;
  double unit_ = 0;
  std::size_t leaf_count_ = 0;
};

extern template class Orthtree<2>;
extern template class Orthtree<3>;

}  // namespace pgdr
