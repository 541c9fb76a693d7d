// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Random trees of any grading, and the definitions of neighbours and buffer zones straight on boxes: slow, with other means
// than the library's (no place, no descent).
#pragma once

#include <algorithm>
#include <random>
#include <set>
#include <vector>

#include "tree/orthtree.hpp"

namespace pgdr::trees {

template <int D>
Orthtree<D> over_unit_cube() {
  Point<D> low, high;
  high.x.fill(1.0);
  return Orthtree<D>(low, high);
}

template <int D>
Orthtree<D> uniform(int level) {
  Orthtree<D> tree = over_unit_cube<D>();
  for (int l = 0; l < level; ++l)
    for (const auto leaf : tree.leaves()) tree.split(leaf);
  return tree;
}

/// Splits random leaves, half of the time the one around a fixed point: neighbours differ by many levels.
template <int D>
Orthtree<D> graded(std::mt19937_64& random, int splits) {
  Orthtree<D> tree = over_unit_cube<D>();
  std::uniform_real_distribution<double> uniform(0, 1);
  Point<D> focus;
  for (int i = 0; i < D; ++i) focus[i] = uniform(random);
  for (int s = 0; s < splits; ++s) {
    Point<D> p = focus;
    if (s % 2 == 0)
      for (int i = 0; i < D; ++i) p[i] = uniform(random) * 1.5 - 0.25;
    tree.split(tree.leaf_at(p));
  }
  return tree;
}

/// The same boxes, split in random order.
template <int D>
Orthtree<D> split_otherwise(const Orthtree<D>& tree, std::mt19937_64& random) {
  Orthtree<D> other = over_unit_cube<D>();
  for (;;) {
    std::vector<std::uint32_t> todo;
    for (const auto leaf : other.leaves())
      if (tree.level(tree.leaf_at(other.centre(leaf))) > other.level(leaf)) todo.push_back(leaf);
    if (todo.empty()) return other;
    other.split(todo[random() % todo.size()]);
  }
}

template <int D>
using Set = std::set<typename Orthtree<D>::Node>;

/// BUF^order(leaf), sorted: BUF^i = BUF^(i-1) and the BUF of all its leaves; without the leaf itself.
template <int D>
std::vector<std::uint32_t> buffer(const Orthtree<D>& tree, std::uint32_t leaf, std::uint32_t order) {
  Set<D> zone{leaf};
  for (std::uint32_t i = 0; i < order; ++i)
    for (const auto l : Set<D>(zone)) {
      const auto around = tree.buffer(l);
      zone.insert(around.begin(), around.end());
    }
  zone.erase(leaf);
  return {zone.begin(), zone.end()};
}

/// Boxes and leaves looked up once.
template <int D>
struct Boxes {
  using Node = typename Orthtree<D>::Node;
  using Box = typename Orthtree<D>::Box;

  explicit Boxes(const Orthtree<D>& tree) {
    for (Node n = 0; n < tree.node_count(); ++n) box.push_back(tree.box(n));
    leaves = tree.leaves();
  }

  /// Is b beyond a's face on that axis and side, with a piece of that face in common?
  bool beyond(Node a, Node b, int axis, int side) const {
    for (int i = 0; i < D; ++i) {
      if (i == axis) {
        if (side == 1 ? box[a].high[i] != box[b].low[i] : box[a].low[i] != box[b].high[i]) return false;
      } else if (!(box[a].low[i] < box[b].high[i] && box[b].low[i] < box[a].high[i])) {
        return false;
      }
    }
    return true;
  }
  bool touch(Node a, Node b) const {
    for (int i = 0; i < D; ++i)
      if (box[a].low[i] > box[b].high[i] || box[b].low[i] > box[a].high[i]) return false;
    return true;
  }
  Set<D> neighbours(Node a, int axis) const {
    Set<D> out;
    for (const Node b : leaves)
      if (beyond(a, b, axis, 0) || beyond(a, b, axis, 1)) out.insert(b);
    return out;
  }
  /// Definitions 3.5 and 3.8, one order of the axes after the other.
  Set<D> buffer(Node a) const {
    Set<D> zone;
    std::array<int, D> axes;
    for (int i = 0; i < D; ++i) axes[static_cast<std::size_t>(i)] = i;
    do {
      Set<D> ends{a};
      for (const int axis : axes) {
        Set<D> next;
        for (const Node e : ends) next.merge(neighbours(e, axis));
        zone.insert(next.begin(), next.end());
        ends = next;
      }
    } while (std::next_permutation(axes.begin(), axes.end()));
    return zone;
  }

  std::vector<Box> box;
  std::vector<Node> leaves;
};

}  // namespace pgdr::trees
