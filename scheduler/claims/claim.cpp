// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "claims/claim.hpp"

#include <algorithm>
#include <limits>
#include <utility>

namespace pgdr {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// A box in positions of the finest grid.
template <int D>
struct GridBox {
  std::array<std::uint64_t, D> low, high;
};

template <int D>
GridBox<D> grid_box(const Orthtree<D>& tree, std::uint32_t node) {
  GridBox<D> b;
  for (int i = 0; i < D; ++i) {
    b.low[static_cast<std::size_t>(i)] = tree.position(node, i);
    b.high[static_cast<std::size_t>(i)] = tree.position(node, i) + tree.extent(node);
  }
  return b;
}

/// Have the closed boxes a point in common?
template <int D>
bool touch(const GridBox<D>& a, const GridBox<D>& b) {
  for (std::size_t i = 0; i < D; ++i)
    if (a.low[i] > b.high[i] || b.low[i] > a.high[i]) return false;
  return true;
}

}  // namespace

template <int D>
Claim<D>::Claim(const Orthtree<D>& tree, Node leaf) : tree_(&tree), leaf_(leaf) {
  for (int i = 0; i < D; ++i) {
    inner_.low[i] = -infinity;
    inner_.high[i] = infinity;
  }
}

template <int D>
Claim<D> Claim<D>::whole(const Orthtree<D>& tree, Node leaf) {
  return Claim(tree, leaf);
}

template <int D>
Claim<D>::Claim(const Orthtree<D>& tree, Node leaf, std::span<const Node> zone, std::uint32_t order) : Claim(tree, leaf) {
  std::vector<Node> leaves(zone.begin(), zone.end());
  leaves.push_back(leaf);
  std::sort(leaves.begin(), leaves.end());
  hold(std::move(leaves), order);
}

template <int D>
Claim<D> Claim<D>::of_leaves(const Orthtree<D>& tree, Node leaf, std::vector<Node> leaves, std::uint32_t order) {
  Claim claim(tree, leaf);
  if (!leaves.empty()) claim.hold(std::move(leaves), order);
  return claim;
}

template <int D>
void Claim<D>::hold(std::vector<Node> leaves, std::uint32_t order) {
  leaves_ = std::move(leaves);
  make_table();
  grow_inner(order);
}

template <int D>
void Claim<D>::make_table() {
  std::size_t size = 4;
  while (size < 2 * leaves_.size()) size *= 2;
  mask_ = size - 1;
  table_.assign(size, Orthtree<D>::none);
  for (const Node leaf : leaves_) {
    std::size_t i = slot(leaf);
    while (table_[i] != Orthtree<D>::none) i = (i + 1) & mask_;
    table_[i] = leaf;
  }
}

// Let B be a box such that every leaf that touches it is claimed. Move each side out to the nearest far border among the
// leaves that touch B and reach beyond that side. The larger box is covered by these leaves: take a point q of it, the
// point q' of B nearest to q, and the leaf K that holds the points just after q' on the way to q. K touches B, and on
// every axis where q lies beyond B it reaches beyond B, so at least as far as the box was grown. A leaf that touches
// the larger box touches, at a common point, one of those that cover it, and so is that leaf or in its BUF. So BUF, which
// holds every leaf that touches L, allows one such step from L's own box, and BUF^i allows i.
template <int D>
void Claim<D>::grow_inner(std::uint32_t order) {
  GridBox<D> box = grid_box(*tree_, leaf_);
  for (std::uint32_t step = 0; step < order; ++step) {
    GridBox<D> grown;
    grown.low.fill(0);  // where nothing lies beyond, the side is at the root's border
    grown.high.fill(tree_->extent(Orthtree<D>::root));
    for (const Node leaf : leaves_) {
      const GridBox<D> k = grid_box(*tree_, leaf);
      if (!touch<D>(box, k)) continue;
      for (std::size_t i = 0; i < D; ++i) {
        if (k.low[i] < box.low[i]) grown.low[i] = std::max(grown.low[i], k.low[i]);
        if (k.high[i] > box.high[i]) grown.high[i] = std::min(grown.high[i], k.high[i]);
      }
    }
    if (grown.low == box.low && grown.high == box.high) break;
    box = grown;
  }
  for (int i = 0; i < D; ++i) {
    const std::uint64_t low = box.low[static_cast<std::size_t>(i)], high = box.high[static_cast<std::size_t>(i)];
    if (low > 0) inner_.low[i] = tree_->border(i, low);
    if (high < tree_->extent(Orthtree<D>::root)) inner_.high[i] = tree_->border(i, high);
  }
}

template class Claim<2>;
template class Claim<3>;

}  // namespace pgdr
