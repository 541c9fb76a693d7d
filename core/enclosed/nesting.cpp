// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// RegionMode::automatic and the numbers of volumes (region_mode.hpp), from the input alone. Biconnected components by the cycles
// that a breadth-first tree makes with each other edge: two edges are in one component iff a chain of such cycles, each with an
// edge of the next, joins them; and a component is consistent iff all its cycles have an even number of edges.
#include <algorithm>
#include <set>

#include "enclosed/input_volumes.hpp"
#include "space/disjoint_sets.hpp"

namespace pgdr::checking {
namespace {

constexpr std::uint32_t no_volume = 0xffffffffu;

using Neighbours = std::vector<std::set<std::uint32_t>>;

/// A breadth-first tree of the volumes from the outside; its edges go by their ends away from the outside.
class NestingTree {
 public:
  explicit NestingTree(const Neighbours& neighbours)
      : parent_(neighbours.size(), no_volume),
        depth_(neighbours.size(), 0),
        classes_(neighbours.size()),
        odd_(neighbours.size(), 0) {
    order_.push_back(0);
    for (std::size_t i = 0; i < order_.size(); ++i)
      for (const std::uint32_t v : neighbours[order_[i]]) {
        if (v == 0 || parent_[v] != no_volume) continue;
        parent_[v] = order_[i];
        depth_[v] = depth_[order_[i]] + 1;
        order_.push_back(v);
      }
    for (std::uint32_t v = 0; v < neighbours.size(); ++v)
      for (const std::uint32_t w : neighbours[v])
        if (v < w && parent_[v] != w && parent_[w] != v) close_cycle(v, w);
  }

  std::vector<bool> solids() {
    std::vector<bool> solid(parent_.size(), false);
    std::vector<std::uint32_t> entry(parent_.size(), no_volume);  // of a class: its volume nearest to the outside
    for (const std::uint32_t v : order_) {
      if (v == 0) continue;
      const std::uint32_t c = classes_.find(v);
      if (entry[c] == no_volume) entry[c] = parent_[v];
      solid[v] = !solid[odd_[c] ? entry[c] : parent_[v]];
    }
    return solid;
  }

 private:
  void join(std::uint32_t v, std::uint32_t w) {
    const std::uint8_t odd = odd_[classes_.find(v)] | odd_[classes_.find(w)];
    classes_.unite(v, w);
    odd_[classes_.find(v)] = odd;
  }

  void close_cycle(std::uint32_t v, std::uint32_t w) {
    const bool odd = depth_[v] % 2 == depth_[w] % 2;
    const std::uint32_t some = depth_[v] > depth_[w] ? v : w;  // not the outside
    while (v != w) {
      if (depth_[v] < depth_[w]) std::swap(v, w);
      join(v, some);
      v = parent_[v];
    }
    if (odd) odd_[classes_.find(some)] = 1;
  }

  std::vector<std::uint32_t> parent_, depth_, order_;
  detail::DisjointSets classes_;
  std::vector<std::uint8_t> odd_;
};

}  // namespace

template <int D>
void InputVolumes<D>::nest() {
  Neighbours neighbours(volumes_.size());
  for (const auto& [a, b] : sides_) {
    if (a == b) continue;
    neighbours[a].insert(b);
    neighbours[b].insert(a);
  }
  const std::vector<bool> solid = NestingTree(neighbours).solids();
  for (std::size_t v = 0; v < volumes_.size(); ++v)
    if (!solid[v] && volumes_[v].seeds.empty()) volumes_[v].kept = false;
}

template <int D>
void InputVolumes<D>::number() {
  // Of each volume the least of the lesser ends of its segments: further points of pieces may be points of the mesh.
  std::vector<std::optional<Point<D>>> least(volumes_.size());
  const auto add = [&](const std::array<std::uint32_t, 2>& segment, std::uint32_t wall) {
    const Point<D>& a = lex_less(walls_.points[segment[1]], walls_.points[segment[0]]) ? walls_.points[segment[1]]
                                                                                       : walls_.points[segment[0]];
    for (const std::uint32_t v : sides_[wall])
      if (!least[v] || lex_less(a, *least[v])) least[v] = a;
  };
  if constexpr (D == 2) {
    for (std::uint32_t w = 0; w < sides_.size(); ++w) add(walls_.simplices[w], w);
  } else {
    for (const auto& [segment, wall] : at_segments_) add(walls_.segments[segment], wall);
  }
  std::vector<std::uint32_t> order;
  std::vector<double> of_seeds;
  for (std::uint32_t v = 0; v < volumes_.size(); ++v) {
    if (!volumes_[v].kept) continue;
    if (volumes_[v].seeds.empty()) order.push_back(v);
    for (const std::uint32_t seed : volumes_[v].seeds) of_seeds.push_back(walls_.regions[seed].attribute);
  }
  const auto before = [&](std::uint32_t v, std::uint32_t w) {
    return least[v] && least[w] ? lex_less(*least[v], *least[w]) : !least[v] && least[w];
  };
  std::stable_sort(order.begin(), order.end(), before);
  std::vector<double> labels;
  for (double label = 1; labels.size() < order.size(); ++label)
    if (std::find(of_seeds.begin(), of_seeds.end(), label) == of_seeds.end()) labels.push_back(label);
  for (std::size_t i = 0, j; i < order.size(); i = j) {
    for (j = i + 1; j < order.size() && !before(order[i], order[j]);) ++j;
    for (std::size_t k = i; k < j; ++k) volumes_[order[k]].numbered = {labels[i], labels[j - 1]};
  }
}

template void InputVolumes<2>::nest();
template void InputVolumes<3>::nest();
template void InputVolumes<2>::number();
template void InputVolumes<3>::number();

}  // namespace pgdr::checking
