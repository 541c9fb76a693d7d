// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// A tree of boxes: which of them meet, and which is nearest. It is binary, and stored without pointers (node 1 is the root, 2i
// and 2i + 1 are the children of i). Building takes n log n time, finding k pairs about n log n + k for boxes as surfaces have
// them. Which pairs are found, and in which order, depends on the boxes alone. Immutable once made; any number of threads may
// search it.
//
// Boxes of simplices that share a corner all meet there: k^2/2 pairs for a fan of k triangles. So the tree may be told
// of the corners. Two simplices with a common corner v have more than v in common only if the side of one opposite v
// meets the other (follow the ray from v through a common point until it leaves one of them). Where all of two nodes
// share v, one of these opposite sides needs to meet the other node, or the pair of nodes is passed over. And a node all
// of which shares v lies in the hull of v and the box of the opposite sides: long thin triangles of two fans, whose boxes
// all meet, are told apart by planes between such hulls.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include "pgdr/types.hpp"
#include "space/box.hpp"

namespace pgdr::detail {

class Bulk;

inline constexpr std::uint32_t no_corner = 0xffffffffu;

/// How boxes are put into the order in which the tree halves them. Medians take twice the time to find, and make nodes so much
/// smaller that the nearest box is found in a fourth of the time.
enum class TreeCut {
  along_curve,  ///< by their places along a space-filling curve
  at_medians,   ///< each half by the median along its longest side
};

template <int D>
class BoxTree {
 public:
  /// @pre boxes are not empty, coordinates finite; at most 2^31 boxes.
  explicit BoxTree(std::span<const Box<D>> boxes, TreeCut cut = TreeCut::along_curve);
  /// The same tree, made by bulk loops. Of no use if they were stopped.
  BoxTree(std::span<const Box<D>> boxes, const Bulk& bulk);
  /// The boxes of simplices, by their corners (as many of three as there are, then no_corner), each larger by `within` on all
  /// sides: pairs that come within that distance are found, too, unless it is beside a common corner.
  BoxTree(std::span<const std::array<std::uint32_t, 3>> corners, std::span<const Point<D>> points, double within = 0);
  BoxTree(std::span<const std::array<std::uint32_t, 3>> corners, std::span<const Point<D>> points, double within,
          const Bulk& bulk);

  /// Calls visit(i, j), i < j, once for every pair of boxes that meet (common borders count). Of simplices, pairs that
  /// meet nowhere but at a common corner may be left out.
  template <class Visit>
  void self_pairs(Visit&& visit) const {
    pairs_below({1, 1}, visit);
  }
  /// The same pairs in the same order, but in parts, several of which may be looked through at once: visit(i, j, out) for those
  /// of a part, with a Part of its own. @returns these in the order of the parts.
  template <class Part, class Loops, class Visit>
  std::vector<Part> self_pairs_in_parts(const Loops& bulk, const Visit& visit) const {
    const std::vector<NodePair> tops = pairs_of_some_level();
    std::vector<Part> parts(tops.size());
    bulk.parts(tops.size(), [&](std::size_t k) {
      Part part;  // of this thread's memory while it grows
      pairs_below(tops[k], [&](std::uint32_t i, std::uint32_t j) { visit(i, j, part); });
      parts[k] = std::move(part);
    });
    return parts;
  }
  /// Calls visit(i), or visit(i, its box), once for every box that meets this one (borders count).
  template <class Visit>
  void meeting(const Box<D>& box, Visit&& visit) const {
    wherever([&](const Box<D>& other) { return other.meets(box); }, visit);
  }
  /// Calls visit(i), or visit(i, its box), once for every box with meets(box). @pre meets() is true of a box around one of which
  /// it is.
  template <class Meets, class Visit>
  void wherever(const Meets& meets, Visit&& visit) const;
  /// Calls visit(i) once for every box that holds p (its border counts).
  template <class Visit>
  void at(const Point<D>& p, Visit&& visit) const {
    meeting(Box<D>::around(p), visit);
  }
  /// Branch and bound: looks for the smallest value among the boxes. `bound(box, node)`: none of the boxes in this one, which is
  /// the box of a node, has a smaller value. `visit(i)` looks at box i and returns the smallest value so far; nodes with bounds
  /// above that are left out. The minimum does not depend on how the tree is cut.
  template <class Bound, class Visit>
  void nearest(const Bound& bound, const Visit& visit) const {
    double least = std::numeric_limits<double>::infinity();
    if (!items_.empty()) descend(1, bound(nodes_[1], 1), bound, visit, least);
  }
  /// Of each node the smallest of the values, one a box, of the boxes below it: for bounds of nearest().
  std::vector<double> least_below(std::span<const double> values, const Bulk& bulk) const;

 private:
  struct Item {
    Box<D> box;
    std::uint32_t index;
  };
  using NodePair = std::array<std::uint32_t, 2>;
  using Corners = std::array<std::uint32_t, 3>;
  /// Of a node all of whose simplices share this corner and no other: the box of their sides opposite it.
  struct Anchor {
    std::uint32_t corner = no_corner;
    Point<D> apex;  // where the corner is
    Box<D> opposite;
  };

  void build(std::span<const Box<D>> boxes, TreeCut cut, const Bulk& bulk);
  /// Calls f(node) for each node, its children before it.
  template <class F>
  void bottom_up(const Bulk& bulk, const F& f) const;
  void cut_at_medians(std::uint64_t first_leaf, std::uint64_t last_leaf);
  void find_anchors(std::span<const Corners> corners, std::span<const Point<D>> points, const Bulk& bulk);
  bool apart(std::uint32_t a, std::uint32_t b) const {
    if (!nodes_[a].meets(nodes_[b])) return true;
    if (anchors_.empty() || (anchors_[a].corner == no_corner && anchors_[b].corner == no_corner)) return false;
    if (anchors_[a].corner != anchors_[b].corner) return separable(hull_of(a), hull_of(b));
    const Hull side_a{nullptr, anchors_[a].opposite}, side_b{nullptr, anchors_[b].opposite};
    return separable(side_a, hull_of(b)) && separable(hull_of(a), side_b);
  }
  /// The hull of a box and, if there is one, a point.
  struct Hull {
    const Point<D>* apex;
    const Box<D>& box;
  };
  Hull hull_of(std::uint32_t node) const {
    const Anchor& anchor = anchors_[node];
    if (anchor.corner == no_corner) return {nullptr, nodes_[node]};
    return {&anchor.apex, anchor.opposite};
  }
  /// True only if a plane was found that has them strictly on its two sides; not all that are apart are found to be.
  bool separable(const Hull& a, const Hull& b) const;
  static Point<D> farthest(const Hull& h, const Point<D>& direction);
  /// Where two nodes are not apart: the pairs of their children, or of the node's own, in the order in which they are looked at.
  void append_children(const NodePair& pair, std::vector<NodePair>& out) const;
  std::vector<NodePair> pairs_of_some_level() const;
  template <class Visit>
  void pairs_below(const NodePair& top, const Visit& visit) const;
  template <class Bound, class Visit>
  void descend(std::uint32_t node, double low, const Bound& bound, const Visit& visit, double& least) const;
  bool is_leaf(std::uint32_t node) const { return node >= leaves_; }
  std::span<const Item> items_of(std::uint32_t leaf) const {
    const std::uint64_t k = leaf - leaves_, begin = first_item(k);
    return std::span(items_).subspan(begin, first_item(k + 1) - begin);
  }
  std::uint64_t first_item(std::uint64_t leaf) const { return leaf * items_.size() / leaves_; }

  std::uint32_t leaves_ = 1;     // a power of two
  std::vector<Item> items_;      // leaf by leaf
  std::vector<Box<D>> nodes_;    // 2 * leaves_, the first unused
  std::vector<Anchor> anchors_;  // of nodes, for simplices
  double within_ = 0;            // by which the boxes of simplices are larger; an apex is not
};

template <int D>
template <class Visit>
void BoxTree<D>::pairs_below(const NodePair& top, const Visit& visit) const {
  const auto report = [&](const Item& a, const Item& b) {
    if (!a.box.meets(b.box)) return;
    if (a.index < b.index)
      visit(a.index, b.index);
    else
      visit(b.index, a.index);
  };
  std::vector<NodePair> stack{top};  // both of a pair are on one level
  while (!stack.empty()) {
    const auto [a, b] = stack.back();
    stack.pop_back();
    if (!is_leaf(a)) {
      const auto first = static_cast<std::ptrdiff_t>(stack.size());
      append_children({a, b}, stack);
      std::reverse(stack.begin() + first, stack.end());
      continue;
    }
    if (a != b && apart(a, b)) continue;
    const auto first = items_of(a), second = items_of(b);
    for (std::size_t i = 0; i < first.size(); ++i)
      for (std::size_t j = a == b ? i + 1 : 0; j < second.size(); ++j) report(first[i], second[j]);
  }
}

template <int D>
template <class Meets, class Visit>
void BoxTree<D>::wherever(const Meets& meets, Visit&& visit) const {
  std::array<std::uint32_t, 34> stack;  // a node a level, and one
  stack[0] = 1;
  for (std::size_t n = 1; n > 0;) {
    const std::uint32_t node = stack[--n];
    if (!meets(nodes_[node])) continue;
    if (is_leaf(node)) {
      for (const Item& item : items_of(node)) {
        if (!meets(item.box)) continue;
        if constexpr (std::is_invocable_v<Visit, std::uint32_t, const Box<D>&>)
          visit(item.index, item.box);
        else
          visit(item.index);
      }
    } else {
      stack[n++] = 2 * node;
      stack[n++] = 2 * node + 1;
    }
  }
}

template <int D>
template <class Bound, class Visit>
void BoxTree<D>::descend(std::uint32_t node, double low, const Bound& bound, const Visit& visit, double& least) const {
  if (!(low <= least)) return;
  if (is_leaf(node)) {
    for (const Item& item : items_of(node)) least = visit(item.index);
    return;
  }
  const double a = bound(nodes_[2 * node], 2 * node), b = bound(nodes_[2 * node + 1], 2 * node + 1);
  const std::uint32_t nearer = 2 * node + (b < a ? 1 : 0);
  descend(nearer, std::min(a, b), bound, visit, least);
  descend(nearer ^ 1, std::max(a, b), bound, visit, least);
}

}  // namespace pgdr::detail
