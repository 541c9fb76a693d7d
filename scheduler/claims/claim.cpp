// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "claims/claim.hpp"

#include <algorithm>
#include <limits>
#include <utility>

namespace pgdr {

template <int D>
Claim<D>::Claim(const Orthtree<D>& tree, Node node, Kind kind) : tree_(&tree), node_(node), kind_(kind) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  for (int i = 0; i < D; ++i) {
    inner_.low[i] = -infinity;
    inner_.high[i] = infinity;
  }
}

template <int D>
Claim<D> Claim<D>::whole(const Orthtree<D>& tree, Node node) {
  return Claim(tree, node, Kind::whole);
}

template <int D>
Claim<D> Claim<D>::of_box(const Orthtree<D>& tree, Node node, const GridBox<D>& box) {
  Claim claim(tree, node, Kind::box);
  claim.box_ = box;
  claim.set_inner(box);
  return claim;
}

template <int D>
Claim<D> Claim<D>::of_leaves(const Orthtree<D>& tree, Node leaf, std::vector<Node> leaves, std::uint32_t order) {
  Claim claim(tree, leaf, Kind::leaves);
  claim.leaves_ = std::move(leaves);
  claim.set_inner(claim.grown(order));
  return claim;
}

template <int D>
bool Claim<D>::holds(Node node) const {
  switch (kind_) {
    case Kind::box: return box_.holds(GridBox<D>::around(*tree_, node, 0));
    case Kind::leaves: return std::binary_search(leaves_.begin(), leaves_.end(), node);
    case Kind::whole: break;
  }
  return true;
}

template <int D>
void Claim<D>::set_inner(const GridBox<D>& box) {
  for (int i = 0; i < D; ++i) {
    const std::uint64_t low = box.low[static_cast<std::size_t>(i)], high = box.high[static_cast<std::size_t>(i)];
    if (low > 0) inner_.low[i] = tree_->border(i, low);
    if (high < tree_->extent(Orthtree<D>::root)) inner_.high[i] = tree_->border(i, high);
  }
}

// Let B be a box such that every leaf that touches it is claimed. Move each side out to the nearest far border among the
// leaves that touch B and reach beyond that side. The larger box is covered by these leaves: take a point q of it, the
// point q' of B nearest to q, and the leaf K that holds the points just after q' on the way to q. K touches B, and on
// every axis where q lies beyond B it reaches beyond B, so at least as far as the box was grown. A leaf that touches
// the larger box touches, at a common point, one of those that cover it, and so is that leaf or in its BUF. So BUF, which
// holds every leaf that touches L, allows one such step from L's own box, and BUF^i allows i.
template <int D>
GridBox<D> Claim<D>::grown(std::uint32_t order) const {
  auto box = GridBox<D>::around(*tree_, node_, 0);
  for (std::uint32_t step = 0; step < order; ++step) {
    GridBox<D> larger;
    larger.high.fill(tree_->extent(Orthtree<D>::root));  // where nothing lies beyond, the side is at the root's border
    for (const Node leaf : leaves_) {
      const auto k = GridBox<D>::around(*tree_, leaf, 0);
      if (!box.touches(k)) continue;
      for (std::size_t i = 0; i < D; ++i) {
        if (k.low[i] < box.low[i]) larger.low[i] = std::max(larger.low[i], k.low[i]);
        if (k.high[i] > box.high[i]) larger.high[i] = std::min(larger.high[i], k.high[i]);
      }
    }
    if (larger == box) break;
    box = larger;
  }
  return box;
}

template class Claim<2>;
template class Claim<3>;

}  // namespace pgdr
