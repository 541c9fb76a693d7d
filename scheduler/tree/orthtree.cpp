// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "tree/orthtree.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "pgdr/error.hpp"

namespace pgdr {

namespace {

// Shares of the free room that lie below the box: off the middle, so that the centres differ, and with long binary
// expansions, different on every axis, so that planes of a symmetric model are not borders of large leaves.
constexpr double share_below[3] = {0.4103179, 0.3819660, 0.4371523};
// The root's corner is a multiple of 2^-corner_bits of its side or less: borders are then exact doubles to great depth.
constexpr int corner_bits = 24;
constexpr double smallest_margin = 1.0 / 16;
// Beyond this the numbers above, or those of the finest level, leave the range of double.
constexpr int max_exponent = 1000;

}  // namespace

template <int D>
Orthtree<D>::Orthtree(const Point<D>& low, const Point<D>& high) {
  double longest = 0, largest = 0;
  for (int i = 0; i < D; ++i) {
    longest = std::max(longest, high[i] - low[i]);
    largest = std::max({largest, std::fabs(low[i]), std::fabs(high[i])});
    if (!(high[i] >= low[i])) largest = std::nan("");
  }
  if (!(largest < std::ldexp(1.0, max_exponent - 1)))
    throw InputError({Errc::not_finite, "the bounding box of the input is not finite, or too large", {}, 0, {}, {}});
  if (longest == 0) longest = largest == 0 ? 1.0 : largest;

  // Sixteen to thirty-two sixteenths of a power of two: five bits, so that multiples of the unit are exact.
  const int exponent = std::max(std::ilogb(longest), -max_exponent + max_level);
  const double step = std::ldexp(1.0, exponent - 4);
  double side = std::max(std::ceil(longest * (1 + smallest_margin) / step), 16.0) * step;
  bool larger = false;
  for (; !larger; side *= 2) {  // again only where the box is some ulps of its coordinates wide
    const double grid = std::ldexp(1.0, std::ilogb(side) - corner_bits);
    larger = true;
    for (int i = 0; i < D; ++i) {
      const double corner = low[i] - share_below[i] * (side - (high[i] - low[i]));
      low_[i] = std::floor(corner / grid) * grid;
      larger = larger && low_[i] < low[i] && low_[i] + side > high[i];
    }
    unit_ = std::ldexp(side, -max_level);
    for (int l = 0; l <= max_level; ++l) side_[static_cast<std::size_t>(l)] = std::ldexp(side, -l);
  }
  append(none, {}, 0);
  leaf_count_ = 1;
}

template <int D>
auto Orthtree<D>::append(Node parent, const Place& at, int level) -> Node {
  Descent node;
  const double half = side_[static_cast<std::size_t>(level)] / 2;
  // Both factors and their product are exact, so that this is the double that `border` gives for the same plane.
  for (int i = 0; i < D; ++i) node.centre[i] = low_[i] + (2.0 * at[static_cast<std::size_t>(i)] + 1.0) * half;
  node.parent = parent;
  nodes_.push_back(node);
  places_.push_back({at, static_cast<std::uint8_t>(level)});
  return node_count() - 1;
}

template <int D>
auto Orthtree<D>::box(Node node) const -> Box {
  Box b;
  for (int i = 0; i < D; ++i) {
    b.low[i] = border(i, position(node, i));
    b.high[i] = border(i, position(node, i) + extent(node));
  }
  return b;
}

template <int D>
auto Orthtree<D>::leaves() const -> std::vector<Node> {
  std::vector<Node> out;
  out.reserve(leaf_count_);
  for_each_node([&](Node node) {
    if (is_leaf(node)) out.push_back(node);
  });
  return out;
}

template <int D>
bool Orthtree<D>::can_split(Node leaf) const {
  // Node numbers are 32 bits, `none` is not one of them.
  if (!is_leaf(leaf) || level(leaf) == max_level || none - node_count() < Node{children}) return false;
  const Box b = box(leaf);
  for (int i = 0; i < D; ++i)
    if (!(b.low[i] < centre(leaf)[i] && centre(leaf)[i] < b.high[i])) return false;
  return true;
}

template <int D>
auto Orthtree<D>::split(Node leaf) -> Node {
  if (!can_split(leaf)) return none;
  const Node first = node_count();
  const Place at = place(leaf);
  const int l = level(leaf) + 1;
  // Room first, so that a bad_alloc leaves the tree as it was.
  if (nodes_.capacity() < nodes_.size() + children) nodes_.reserve(2 * nodes_.size() + children);
  if (places_.capacity() < places_.size() + children) places_.reserve(2 * places_.size() + children);
  for (unsigned c = 0; c < children; ++c) {
    Place child{};
    for (unsigned i = 0; i < D; ++i) child[i] = 2 * at[i] + (c >> i & 1);
    append(leaf, child, l);
  }
  nodes_[leaf].first_child = first;
  leaf_count_ += children - 1;
  return first;
}

template <int D>
std::uint64_t Orthtree<D>::morton(Node node) const {
  const int shift = max_level - level(node);
  std::uint64_t key = 0;
  for (int b = 0; b < level(node); ++b)
    for (unsigned i = 0; i < D; ++i) key |= std::uint64_t{place(node)[i] >> b & 1} << (D * static_cast<unsigned>(b + shift) + i);
  return key;
}

template <int D>
std::uint64_t Orthtree<D>::colour(Node node, std::uint32_t period) const {
  std::uint64_t c = 0;
  for (unsigned i = D; i-- > 0;) c = c * period + place(node)[i] % period;
  return c;
}

template <int D>
auto Orthtree<D>::node_at(const Place& at, int level) const -> Node {
  Node node = root;
  for (int b = level - 1; b >= 0 && !is_leaf(node); --b) {
    unsigned child = 0;
    for (unsigned i = 0; i < D; ++i) child |= (at[i] >> b & 1) << i;
    node = first_child(node) + child;
  }
  return node;
}

template <int D>
void Orthtree<D>::append_face(Node node, int axis, unsigned bit, std::vector<Node>& out) const {
  if (is_leaf(node)) {
    out.push_back(node);
    return;
  }
  for (unsigned c = 0; c < children; ++c)
    if ((c >> axis & 1) == bit) append_face(first_child(node) + c, axis, bit, out);
}

template <int D>
void Orthtree<D>::append_face_neighbours(Node leaf, int axis, int side, std::vector<Node>& out) const {
  Place at = place(leaf);
  std::uint32_t& x = at[static_cast<std::size_t>(axis)];
  if (x == (side == 0 ? 0 : (std::uint32_t{1} << level(leaf)) - 1)) return;
  x += side == 0 ? 0xffffffffu : 1u;
  append_face(node_at(at, level(leaf)), axis, side == 0 ? 1u : 0u, out);
}

template <int D>
auto Orthtree<D>::buffer(Node leaf) const -> std::vector<Node> {
  // by_axes[m]: ends of the chains that have used the axes of the bit set m, in any order. Sets in increasing order of m
  // are complete when they are read, because m without one of its bits is smaller.
  std::array<std::vector<Node>, 1u << D> by_axes;
  by_axes[0] = {leaf};
  std::vector<Node> zone;
  for (unsigned m = 0; m < by_axes.size(); ++m) {
    std::vector<Node>& ends = by_axes[m];
    std::sort(ends.begin(), ends.end());
    ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
    for (int axis = 0; axis < D; ++axis) {
      if (m >> axis & 1) continue;
      for (const Node end : ends)
        for (int side = 0; side < 2; ++side) append_face_neighbours(end, axis, side, by_axes[m | 1u << axis]);
    }
    if (m != 0) zone.insert(zone.end(), ends.begin(), ends.end());
  }
  std::sort(zone.begin(), zone.end());
  zone.erase(std::unique(zone.begin(), zone.end()), zone.end());
  return zone;
}

template class Orthtree<2>;
template class Orthtree<3>;

}  // namespace pgdr
