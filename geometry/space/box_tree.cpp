// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "space/box_tree.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>
#include <utility>

#include "numbers/rounding.hpp"
#include "space/bulk.hpp"

namespace pgdr::detail {
namespace {

constexpr std::size_t boxes_a_leaf = 4;

/// The place of the box's centre along the Morton curve through `all`. Halves: sums of large numbers would overflow.
template <int D>
std::uint64_t place(const Box<D>& box, const Box<D>& all) {
  constexpr int bits = 63 / D;
  std::uint64_t key = 0;
  std::array<std::uint64_t, D> cell{};
  for (int i = 0; i < D; ++i) {
    const double low = all.low[i] / 2, range = all.high[i] / 2 - low;
    const double at = range > 0 ? ((box.low[i] / 2 - low) + (box.high[i] / 2 - low)) / 2 / range : 0;
    const double top = static_cast<double>(std::uint64_t{1} << bits);
    cell[static_cast<std::size_t>(i)] = static_cast<std::uint64_t>(std::clamp(at * top, 0.0, top - 1));
  }
  for (int b = bits; b-- > 0;)
    for (const std::uint64_t c : cell) key = key << 1 | (c >> b & 1);
  return key;
}

template <int D>
std::vector<std::uint32_t> order_along_curve(std::span<const Box<D>> boxes, const Bulk& bulk) {
  Box<D> all = Box<D>::empty();
  for (const Box<D>& b : boxes) all.add(b);
  using Place = std::pair<std::uint64_t, std::uint32_t>;
  std::vector<Place> places(boxes.size());
  bulk.each(places.size(), [&](std::size_t i) { places[i] = {place(boxes[i], all), static_cast<std::uint32_t>(i)}; });
  bulk.sort(places, std::less<Place>());
  std::vector<std::uint32_t> order(boxes.size());
  bulk.each(order.size(), [&](std::size_t i) { order[i] = places[i].second; });
  return order;
}

std::vector<std::uint32_t> order_of_input(std::size_t count) {
  std::vector<std::uint32_t> order(count);
  std::iota(order.begin(), order.end(), 0u);
  return order;
}

}  // namespace

template <int D>
BoxTree<D>::BoxTree(std::span<const Box<D>> boxes, TreeCut cut) {
  build(boxes, cut, Bulk(false));
}

template <int D>
BoxTree<D>::BoxTree(std::span<const Box<D>> boxes, const Bulk& bulk) {
  build(boxes, TreeCut::along_curve, bulk);
}

template <int D>
BoxTree<D>::BoxTree(std::span<const Corners> corners, std::span<const Point<D>> points, double within)
    : BoxTree(corners, points, within, Bulk(false)) {}

template <int D>
BoxTree<D>::BoxTree(std::span<const Corners> corners, std::span<const Point<D>> points, double within, const Bulk& bulk)
    : within_(within) {
  std::vector<Box<D>> boxes(corners.size());
  bulk.each(boxes.size(), [&](std::size_t i) {
    Box<D> box = Box<D>::empty();
    for (const std::uint32_t v : corners[i])
      if (v != no_corner) box.add(points[v]);
    boxes[i] = box.widened(within);
  });
  build(boxes, TreeCut::along_curve, bulk);
  find_anchors(corners, points, bulk);
}

template <int D>
template <class F>
void BoxTree<D>::bottom_up(const Bulk& bulk, const F& f) const {
  for (std::uint32_t first = leaves_; first > 0; first /= 2)  // a level after the other; the nodes of one do not wait
    bulk.each(first, [&](std::size_t i) { f(first + static_cast<std::uint32_t>(i)); });
}

template <int D>
void BoxTree<D>::build(std::span<const Box<D>> boxes, TreeCut cut, const Bulk& bulk) {
  leaves_ = static_cast<std::uint32_t>(std::bit_ceil(std::max<std::size_t>(1, boxes.size() / boxes_a_leaf)));
  items_.resize(boxes.size());
  const auto order = cut == TreeCut::along_curve ? order_along_curve(boxes, bulk) : order_of_input(boxes.size());
  bulk.each(items_.size(), [&](std::size_t i) { items_[i] = {boxes[order[i]], order[i]}; });
  if (cut == TreeCut::at_medians) cut_at_medians(0, leaves_);
  nodes_.assign(2 * std::size_t{leaves_}, Box<D>::empty());
  bottom_up(bulk, [this](std::uint32_t node) {
    if (is_leaf(node)) {
      for (const Item& item : items_of(node)) nodes_[node].add(item.box);
    } else {
      nodes_[node].add(nodes_[2 * node]);
      nodes_[node].add(nodes_[2 * node + 1]);
    }
  });
}

template <int D>
void BoxTree<D>::cut_at_medians(std::uint64_t first_leaf, std::uint64_t last_leaf) {
  const auto item = [this](std::uint64_t leaf) { return items_.begin() + static_cast<std::ptrdiff_t>(first_item(leaf)); };
  const auto begin = item(first_leaf), end = item(last_leaf);
  if (last_leaf - first_leaf == 1) return std::sort(begin, end, [](const Item& a, const Item& b) { return a.index < b.index; });
  Box<D> all = Box<D>::empty();
  for (auto i = begin; i != end; ++i) all.add(i->box);
  int axis = 0;
  for (int i = 1; i < D; ++i)
    if (all.high[i] - all.low[i] > all.high[axis] - all.low[axis]) axis = i;
  const auto centre = [axis](const Item& i) { return i.box.low[axis] / 2 + i.box.high[axis] / 2; };
  const std::uint64_t middle = (first_leaf + last_leaf) / 2;
  std::nth_element(begin, item(middle), end, [&](const Item& a, const Item& b) {
    const double p = centre(a), q = centre(b);
    return p != q ? p < q : a.index < b.index;
  });
  cut_at_medians(first_leaf, middle);
  cut_at_medians(middle, last_leaf);
}

template <int D>
std::vector<double> BoxTree<D>::least_below(std::span<const double> values, const Bulk& bulk) const {
  std::vector<double> least(nodes_.size(), std::numeric_limits<double>::infinity());
  bottom_up(bulk, [&](std::uint32_t node) {
    if (is_leaf(node)) {
      for (const Item& item : items_of(node)) least[node] = std::min(least[node], values[item.index]);
    } else {
      least[node] = std::min(least[2 * node], least[2 * node + 1]);
    }
  });
  return least;
}

// From the leaves up: which corners all simplices of a node share; where that is one alone, the box opposite it. A fan
// of k simplices has k log k of them below its nodes.
template <int D>
void BoxTree<D>::find_anchors(std::span<const Corners> corners, std::span<const Point<D>> points, const Bulk& bulk) {
  constexpr Corners none{no_corner, no_corner, no_corner};
  std::vector<Corners> common(nodes_.size(), none);
  std::vector<char> any(nodes_.size(), 0);  // holds something
  const auto keep_common = [](Corners& mine, const Corners& other) {
    for (std::uint32_t& v : mine)
      if (std::find(other.begin(), other.end(), v) == other.end()) v = no_corner;
  };
  bottom_up(bulk, [&](std::uint32_t node) {
    const auto take = [&](const Corners& c) {
      if (any[node])
        keep_common(common[node], c);
      else
        common[node] = c;
      any[node] = 1;
    };
    if (is_leaf(node)) {
      for (const Item& item : items_of(node)) take(corners[item.index]);
    } else {
      for (const std::uint32_t child : {2 * node, 2 * node + 1})
        if (any[child]) take(common[child]);
    }
  });
  anchors_.resize(nodes_.size());
  const auto items_below = [&](std::uint32_t node) {
    std::uint32_t first = node, last = node;
    while (!is_leaf(first)) {
      first = 2 * first;
      last = 2 * last + 1;
    }
    const auto begin = items_of(first), end = items_of(last);
    return std::span(begin.data(), end.data() + end.size());
  };
  bulk.each(nodes_.size(), [&](std::size_t i) {
    const auto node = static_cast<std::uint32_t>(i);
    const Corners& c = common[node];
    if ((c[0] != no_corner) + (c[1] != no_corner) + (c[2] != no_corner) != 1) return;
    Anchor& anchor = anchors_[node];
    anchor.corner = std::min({c[0], c[1], c[2]});
    anchor.apex = points[anchor.corner];
    anchor.opposite = Box<D>::empty();
    for (const Item& item : items_below(node))
      for (const std::uint32_t v : corners[item.index])
        if (v != no_corner && v != anchor.corner) anchor.opposite.add(points[v]);
    anchor.opposite = anchor.opposite.widened(within_);
  });
}

template <int D>
void BoxTree<D>::append_children(const NodePair& pair, std::vector<NodePair>& out) const {
  const auto [a, b] = pair;
  if (a == b)
    out.insert(out.end(), {{2 * a, 2 * a}, {2 * a, 2 * a + 1}, {2 * a + 1, 2 * a + 1}});
  else if (!apart(a, b))
    out.insert(out.end(), {{2 * a, 2 * b}, {2 * a, 2 * b + 1}, {2 * a + 1, 2 * b}, {2 * a + 1, 2 * b + 1}});
}

/// As many parts as keep some dozen threads busy though one may take a hundred times as long as another.
template <int D>
auto BoxTree<D>::pairs_of_some_level() const -> std::vector<NodePair> {
  constexpr std::size_t enough = 1024;
  std::vector<NodePair> level{{1, 1}}, next;
  while (!level.empty() && level.size() < enough && !is_leaf(level.front()[0])) {
    next.clear();
    for (const NodePair& pair : level) append_children(pair, next);
    level.swap(next);
  }
  return level;
}

template <int D>
Point<D> BoxTree<D>::farthest(const Hull& h, const Point<D>& direction) {
  Point<D> p;
  double at_box = 0, at_apex = 0;
  for (int i = 0; i < D; ++i) {
    p[i] = direction[i] > 0 ? h.box.high[i] : h.box.low[i];
    at_box += direction[i] * p[i];
    if (h.apex != nullptr) at_apex += direction[i] * (*h.apex)[i];
  }
  return h.apex != nullptr && at_apex > at_box ? *h.apex : p;
}

// Goes from the difference of two points towards that of the two nearest ones (Gilbert 1966) until the direction tells
// the hulls apart beyond all rounding; overflow and not-a-number tell nothing.
template <int D>
bool BoxTree<D>::separable(const Hull& a, const Hull& b) const {
  if (a.apex == nullptr && b.apex == nullptr) return !a.box.meets(b.box);
  constexpr int most_steps = 16;
  Point<D> d;
  for (int i = 0; i < D; ++i) d[i] = (b.box.low[i] / 2 + b.box.high[i] / 2) - (a.box.low[i] / 2 + a.box.high[i] / 2);
  for (int step = 0; step < most_steps; ++step) {
    Point<D> back, w;
    for (int i = 0; i < D; ++i) back[i] = -d[i];
    const Point<D> p = farthest(a, d), q = farthest(b, back);
    double gap = 0, size = 0, change = 0, towards = 0, square = 0;
    for (int i = 0; i < D; ++i) {
      gap += d[i] * q[i] - d[i] * p[i];
      square += d[i] * d[i];
      size += std::fabs(d[i] * q[i]) + std::fabs(d[i] * p[i]);
      for (const Hull* h : {&a, &b}) {
        size += std::fabs(d[i] * h->box.low[i]) + std::fabs(d[i] * h->box.high[i]);
        if (h->apex != nullptr) size += std::fabs(d[i] * (*h->apex)[i]);
      }
      w[i] = (q[i] - p[i]) - d[i];
      change += w[i] * w[i];
      towards -= d[i] * w[i];
    }
    if (gap > rounding::of_separation * size + within_ * std::sqrt(square) + 0x1p-1000) return true;
    if (!(towards > 0 && change > 0)) return false;
    const double t = std::min(1.0, towards / change);
    for (int i = 0; i < D; ++i) d[i] += t * w[i];
  }
  return false;
}

template class BoxTree<2>;
template class BoxTree<3>;

}  // namespace pgdr::detail
