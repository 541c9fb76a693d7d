// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "ranks/territory.hpp"

#include <algorithm>
#include <map>
#include <utility>

namespace pgdr::detail {
namespace {

/// The number of a place on a grid with so many places along each axis.
template <std::size_t D>
std::size_t number_of(const std::array<std::uint64_t, D>& place, std::uint64_t across) {
  std::size_t number = 0;
  for (std::size_t i = D; i-- > 0;) number = number * across + place[i];
  return number;
}

template <std::size_t D>
std::array<std::uint64_t, D> place_of_number(std::size_t number, std::uint64_t across) {
  std::array<std::uint64_t, D> place;
  for (std::size_t i = 0; i < D; ++i) {
    place[i] = number % across;
    number /= across;
  }
  return place;
}

}  // namespace

template <int D>
Territory<D>::Territory(const Orthtree<D>& tree, std::span<const Node> nodes, std::span<const int> owners, int ranks, int rank)
    : tree_(&tree), level_(tree.level(nodes.front())), rank_(rank), count_(ranks), owners_(nodes.size()) {
  const std::uint64_t extent = tree.extent(Orthtree<D>::root) / across();
  for (int i = 0; i < D; ++i)
    for (std::uint64_t half = 0; half <= across(); ++half)
      borders_[static_cast<std::size_t>(i)].push_back(tree.border(i, half * extent));
  halves_a_unit_ = static_cast<double>(across()) / tree.side(Orthtree<D>::root);
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    Halves place;
    for (std::size_t k = 0; k < D; ++k) place[k] = tree.place(nodes[i])[k];
    owners_[number_of(place, across() / 2)] = owners[i];
  }
  std::size_t places = 1;
  for (int i = 0; i < D; ++i) places *= across();
  std::map<std::pair<int, std::vector<int>>, Zone> known;
  for (std::size_t place = 0; place < places; ++place) {
    Halves halves = place_of_number<D>(place, across());
    const std::vector<int> around = ranks_around(halves);
    for (std::uint64_t& half : halves) half /= 2;
    const int own = owners_[number_of(halves, across() / 2)];
    const auto [at, is_new] = known.try_emplace({own, around}, static_cast<Zone>(zones_.size()));
    zone_.push_back(at->second);
    if (!is_new) continue;
    const bool is_held = std::find(around.begin(), around.end(), rank) != around.end();
    zones_.push_back({own, around, is_held, around.size() > (is_held ? 1u : 0u)});
  }
  std::vector<char> is_neighbour(static_cast<std::size_t>(ranks));
  for (const ZoneRecord& zone : zones_)
    if (zone.is_held)
      for (const int r : zone.holders) is_neighbour[static_cast<std::size_t>(r)] = r != rank;
  for (int r = 0; r < ranks; ++r)
    if (is_neighbour[static_cast<std::size_t>(r)]) neighbours_.push_back(r);
}

template <int D>
Territory<D> Territory<D>::of_next_level() const {
  std::vector<Node> nodes;
  std::vector<int> owners;
  for (Node node = 0; node < tree_->node_count(); ++node) {
    if (tree_->level(node) != level_ + 1) continue;
    nodes.push_back(node);
    owners.push_back(owner(node));
  }
  return {*tree_, nodes, owners, count_, rank_};
}

/// The owners of the nodes whose boxes, grown by half their side, have this half in them.
template <int D>
std::vector<int> Territory<D>::ranks_around(const Halves& halves) const {
  std::vector<int> ranks;
  for (unsigned corner = 0; corner < 1u << D; ++corner) {
    Halves node;
    bool exists = true;
    for (std::size_t i = 0; i < D; ++i) {
      const std::uint64_t at = halves[i] + 2 * (corner >> i & 1);  // one more than a half of the node, or of the one beside it
      exists = exists && at > 0 && (at - 1) / 2 < across() / 2;
      node[i] = at > 0 ? (at - 1) / 2 : 0;
    }
    if (exists) ranks.push_back(owners_[number_of(node, across() / 2)]);
  }
  std::sort(ranks.begin(), ranks.end());
  ranks.erase(std::unique(ranks.begin(), ranks.end()), ranks.end());
  return ranks;
}

/// As the borders of claims have it (Orthtree::border): what lies beyond the root counts for the half nearest to it.
template <int D>
std::uint64_t Territory<D>::half_of(const Point<D>& p, int axis) const {
  const std::vector<double>& borders = borders_[static_cast<std::size_t>(axis)];
  const double guess = (p[axis] - borders.front()) * halves_a_unit_;
  auto half = static_cast<std::uint64_t>(std::clamp(guess, 0.0, static_cast<double>(across() - 1)));
  while (half > 0 && p[axis] < borders[half]) --half;
  while (half + 1 < across() && p[axis] >= borders[half + 1]) ++half;
  return half;
}

template <int D>
auto Territory<D>::zone(const Point<D>& p) const -> Zone {
  Halves halves;
  for (int i = 0; i < D; ++i) halves[static_cast<std::size_t>(i)] = half_of(p, i);
  return zone_[number_of(halves, across())];
}

template <int D>
int Territory<D>::owner(Node node) const {
  if (tree_->level(node) < level_) return -1;
  Halves place;
  for (std::size_t i = 0; i < D; ++i) place[i] = tree_->place(node)[i] >> (tree_->level(node) - level_);
  return owners_[number_of(place, across() / 2)];
}

template <int D>
std::vector<double> Territory<D>::held_of(std::span<const Node> nodes, std::span<const double> weights) const {
  std::vector<double> held(static_cast<std::size_t>(ranks()));
  for (std::size_t n = 0; n < nodes.size(); ++n)
    for (unsigned half = 0; half < 1u << D; ++half) {
      Halves place;
      for (std::size_t i = 0; i < D; ++i) place[i] = 2 * std::uint64_t{tree_->place(nodes[n])[i]} + (half >> i & 1);
      for (const int rank : holders(zone_[number_of(place, across())]))
        held[static_cast<std::size_t>(rank)] += weights[n] / (1u << D);
    }
  return held;
}

template <int D>
bool Territory<D>::is_shared(const GridBox<D>& box) const {
  const std::uint64_t extent = tree_->extent(Orthtree<D>::root) / across();
  Halves first, last;
  for (std::size_t i = 0; i < D; ++i) {
    first[i] = box.low[i] / extent;
    last[i] = (box.high[i] - 1) / extent;
  }
  for (Halves at = first;;) {
    if (is_shared(zone_[number_of(at, across())])) return true;
    std::size_t i = 0;
    while (i < D && at[i] == last[i]) {
      at[i] = first[i];
      ++i;
    }
    if (i == D) return false;
    ++at[i];
  }
}

template class Territory<2>;
template class Territory<3>;

}  // namespace pgdr::detail
