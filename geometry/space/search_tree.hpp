// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// A binary tree of boxes over items, for branch and bound: the smallest value among items, where a box bounds the values of
// its items from below. What it finds is the minimum of the items' values, so it does not depend on how the tree is cut.
// Immutable once made; any thread.
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <numeric>
#include <vector>

#include "pgdr/types.hpp"

namespace pgdr::detail {

template <int D>
struct SearchBox {
  Point<D> low, high;
  double least = std::numeric_limits<double>::infinity();  ///< smallest weight of an item

  static SearchBox empty() {
    SearchBox b;
    b.low.x.fill(std::numeric_limits<double>::infinity());
    b.high.x.fill(-std::numeric_limits<double>::infinity());
    return b;
  }
  void add(const Point<D>& p) {
    for (int i = 0; i < D; ++i) {
      low[i] = std::min(low[i], p[i]);
      high[i] = std::max(high[i], p[i]);
    }
  }
  void add(const SearchBox& b) {
    add(b.low);
    add(b.high);
    least = std::min(least, b.least);
  }
  bool contains(const Point<D>& p) const {
    for (int i = 0; i < D; ++i)
      if (p[i] < low[i] || p[i] > high[i]) return false;
    return true;
  }
  /// At most squared_distance(p, q) for any q in the box, also as rounded: each step is monotonous.
  double squared_distance_to(const Point<D>& p) const {
    double s = 0;
    for (int i = 0; i < D; ++i) {
      const double d = p[i] < low[i] ? low[i] - p[i] : p[i] > high[i] ? p[i] - high[i] : 0;
      s += d * d;
    }
    return s;
  }
};

template <int D>
class SearchTree {
 public:
  using Box = SearchBox<D>;
  using Item = std::uint32_t;

  explicit SearchTree(std::vector<Box> boxes) : boxes_(std::move(boxes)), order_(boxes_.size()) {
    std::iota(order_.begin(), order_.end(), Item{0});
    nodes_.reserve(boxes_.size() / 2 + 1);
    nodes_.emplace_back();
    if (!boxes_.empty()) build(0, 0, static_cast<Item>(boxes_.size()));
  }

  /// `bound(box)`: no item in the box has a smaller value. `visit(item)` looks at an item and returns the smallest value
  /// so far; boxes with bounds above that are left out.
  template <class Bound, class Visit>
  void search(const Bound& bound, const Visit& visit) const {
    if (boxes_.empty()) return;
    double best = std::numeric_limits<double>::infinity();
    descend(0, bound(nodes_[0].box), bound, visit, best);
  }

  /// Calls visit(item) for the items whose boxes contain p.
  template <class Visit>
  void each_at(const Point<D>& p, const Visit& visit, std::size_t at = 0) const {
    const Node& node = nodes_[at];
    if (!node.box.contains(p)) return;
    for (Item i = 0; i < node.count; ++i)
      if (const Item item = order_[node.first + i]; boxes_[item].contains(p)) visit(item);
    if (node.count > 0) return;
    each_at(p, visit, node.first);
    each_at(p, visit, node.first + 1);
  }

 private:
  static constexpr Item leaf_size = 4;
  struct Node {
    Box box = Box::empty();
    Item first = 0, count = 0;  ///< of a leaf: into order_; else count is 0, and first the number of two children
  };

  void build(std::size_t node, Item first, Item last) {
    Box box = Box::empty();
    for (Item i = first; i < last; ++i) box.add(boxes_[order_[i]]);
    nodes_[node].box = box;
    if (last - first <= leaf_size) {
      nodes_[node].first = first;
      nodes_[node].count = last - first;
      return;
    }
    int axis = 0;
    for (int i = 1; i < D; ++i)
      if (box.high[i] - box.low[i] > box.high[axis] - box.low[axis]) axis = i;
    const Item middle = first + (last - first) / 2;
    auto centre = [&](Item i) { return boxes_[i].low[axis] / 2 + boxes_[i].high[axis] / 2; };
    std::nth_element(order_.begin() + first, order_.begin() + middle, order_.begin() + last, [&](Item a, Item b) {
      const double p = centre(a), q = centre(b);
      return p != q ? p < q : a < b;
    });
    const auto child = static_cast<Item>(nodes_.size());
    nodes_[node].first = child;
    nodes_.emplace_back();
    nodes_.emplace_back();
    build(child, first, middle);
    build(child + 1, middle, last);
  }

  template <class Bound, class Visit>
  void descend(std::size_t at, double low, const Bound& bound, const Visit& visit, double& best) const {
    if (!(low <= best)) return;
    const Node& node = nodes_[at];
    for (Item i = 0; i < node.count; ++i) best = visit(order_[node.first + i]);
    if (node.count > 0) return;
    const double a = bound(nodes_[node.first].box), b = bound(nodes_[node.first + 1].box);
    const std::size_t nearer = node.first + (b < a ? 1 : 0), other = node.first + (b < a ? 0 : 1);
    descend(nearer, std::min(a, b), bound, visit, best);
    descend(other, std::max(a, b), bound, visit, best);
  }

  std::vector<Box> boxes_;
  std::vector<Item> order_;
  std::vector<Node> nodes_;
};

}  // namespace pgdr::detail
