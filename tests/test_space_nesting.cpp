// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Which volumes are solid, on all kinds of small graphs of neighbours, against the definition.
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>

#include "space/nesting.hpp"

namespace pgdr::test_space_nesting {

using Pair = std::array<std::uint32_t, 2>;

class Oracle {
 public:
  Oracle(std::uint32_t n, const std::vector<Pair>& edges) : n_(n), edges_(edges), block_(edges.size()) {
    std::iota(block_.begin(), block_.end(), 0u);
    // Two edges at u are in one biconnected component iff their other ends are connected without u.
    for (std::size_t i = 0; i < edges.size(); ++i)
      for (std::size_t j = 0; j < i; ++j)
        for (const std::uint32_t u : edges[i]) {
          if (u != edges[j][0] && u != edges[j][1]) continue;
          const std::uint32_t a = edges[i][0] + edges[i][1] - u, b = edges[j][0] + edges[j][1] - u;
          if (distances(a, u)[b] == far) continue;
          const std::uint32_t from = block_[i], to = block_[j];
          std::replace(block_.begin(), block_.end(), from, to);
        }
  }

  std::vector<bool> solids() {
    std::vector<int> solid(n_, -1);
    solid[0] = 0;
    const auto from_outside = distances(0, far);
    // Blocks in the order of their entries' distances from the outside: those before know the entry.
    std::vector<std::pair<std::uint32_t, std::uint32_t>> blocks;  // distance of the entry, block
    for (std::size_t i = 0; i < edges_.size(); ++i) blocks.emplace_back(from_outside[entry(block_[i], from_outside)], block_[i]);
    std::sort(blocks.begin(), blocks.end());
    blocks.erase(std::unique(blocks.begin(), blocks.end()), blocks.end());
    for (const auto& [unused, block] : blocks) judge(block, entry(block, from_outside), solid);
    return {solid.begin(), solid.end()};
  }

 private:
  static constexpr std::uint32_t far = 0xffffffffu;

  std::vector<std::uint32_t> distances(std::uint32_t from, std::uint32_t without) const {
    std::vector<std::uint32_t> d(n_, far);
    d[from] = 0;
    for (std::uint32_t step = 0; step < n_; ++step)
      for (const Pair& e : edges_)
        for (const auto& [a, b] : {std::pair{e[0], e[1]}, {e[1], e[0]}})
          if (a != without && b != without && d[a] != far) d[b] = std::min(d[b], d[a] + 1);
    return d;
  }

  std::uint32_t entry(std::uint32_t block, const std::vector<std::uint32_t>& distance) const {
    std::uint32_t best = far;
    for (std::size_t i = 0; i < edges_.size(); ++i)
      for (const std::uint32_t v : edges_[i])
        if (block_[i] == block && (best == far || distance[v] < distance[best])) best = v;
    return best;
  }

  // Both ways to colour the block are tried: by what is known of the entry, in turn; or all alike.
  void judge(std::uint32_t block, std::uint32_t entry, std::vector<int>& solid) const {
    std::vector<int> turn(n_, -1);
    turn[entry] = solid[entry];
    bool consistent = true;
    for (std::uint32_t step = 0; step < n_; ++step)
      for (std::size_t i = 0; i < edges_.size(); ++i) {
        if (block_[i] != block) continue;
        for (const auto& [a, b] : {std::pair{edges_[i][0], edges_[i][1]}, {edges_[i][1], edges_[i][0]}}) {
          if (turn[a] < 0) continue;
          if (turn[b] < 0) turn[b] = 1 - turn[a];
          consistent = consistent && turn[b] != turn[a];
        }
      }
    for (std::size_t i = 0; i < edges_.size(); ++i)
      for (const std::uint32_t v : edges_[i])
        if (block_[i] == block && v != entry) solid[v] = consistent ? turn[v] : 1 - solid[entry];
  }

  std::uint32_t n_;
  const std::vector<Pair>& edges_;
  std::vector<std::uint32_t> block_;
};

TEST(Nesting, RandomGraphsAgainstTheDefinition) {
  std::mt19937 random(20261121);
  int odd = 0;
  for (int k = 0; k < 4000; ++k) {
    const std::uint32_t n = 1 + random() % 10;
    std::vector<Pair> edges;
    for (std::uint32_t v = 1; v < n; ++v) edges.push_back({v, static_cast<std::uint32_t>(random() % v)});  // connected
    for (std::uint32_t extra = random() % 5; extra-- > 0 && n > 1;) {
      const std::uint32_t a = random() % n, b = random() % n;
      const auto same = [&](const Pair& e) { return std::minmax(e[0], e[1]) == std::minmax(a, b); };
      if (a != b && std::none_of(edges.begin(), edges.end(), same)) edges.push_back({a, b});
    }
    std::shuffle(edges.begin(), edges.end(), random);
    auto given = edges;
    if (!edges.empty()) given.push_back({edges[0][1], edges[0][0]});  // twice, the other way round
    const auto solid = detail::solid_by_nesting(n, given);
    EXPECT_EQ(solid, Oracle(n, edges).solids()) << k;
    for (const Pair& e : edges) odd += solid[e[0]] == solid[e[1]];
  }
  EXPECT_GT(odd, 1000);
}

TEST(Nesting, AMillionShells) {
  const std::uint32_t n = 1000000;
  std::vector<Pair> edges;
  for (std::uint32_t v = 1; v < n; ++v) edges.push_back({v - 1, v});
  const auto solid = detail::solid_by_nesting(n, edges);
  for (std::uint32_t v = 0; v < n; ++v) ASSERT_EQ(solid[v], v % 2 == 1);
}

}  // namespace pgdr::test_space_nesting
