// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Biconnected components by depth-first search (Hopcroft, Tarjan 1973), without recursion: there may be as many volumes
// as the input has room for.
#include "space/nesting.hpp"

#include <algorithm>
#include <numeric>

#include "space/make_set.hpp"

namespace pgdr::detail {
namespace {

using Pair = std::array<std::uint32_t, 2>;
constexpr std::uint32_t unseen = 0xffffffffu;

class Nesting {
 public:
  Nesting(std::uint32_t volumes, std::vector<Pair> neighbours)
      : begin_(volumes + 1, 0), number_(volumes, unseen), low_(volumes), solid_(volumes, false) {
    for (Pair& e : neighbours) std::sort(e.begin(), e.end());
    make_set(neighbours);
    for (const auto& [a, b] : neighbours) {
      ++begin_[a + 1];
      ++begin_[b + 1];
    }
    std::partial_sum(begin_.begin(), begin_.end(), begin_.begin());
    std::vector<std::uint32_t> next(begin_.begin(), begin_.end() - 1);
    ends_.resize(2 * neighbours.size());
    for (const auto& [a, b] : neighbours) {
      ends_[next[a]++] = b;
      ends_[next[b]++] = a;
    }
  }

  std::vector<bool> run() {
    find_blocks();
    // A block is complete before the one through which it is reached.
    for (auto block = blocks_.rbegin(); block != blocks_.rend(); ++block) judge(*block);
    return std::move(solid_);
  }

 private:
  struct Block {
    std::uint32_t entry;
    std::vector<Pair> edges;
  };
  struct Step {
    std::uint32_t at, from, next;
  };

  void find_blocks() {
    std::vector<Step> path{{0, unseen, begin_[0]}};
    std::vector<Pair> open;
    number_[0] = low_[0] = count_++;
    while (!path.empty()) {
      Step& step = path.back();
      if (step.next == begin_[step.at + 1]) {
        const auto [at, from, unused] = step;
        path.pop_back();
        if (from == unseen) return;
        low_[from] = std::min(low_[from], low_[at]);
        if (low_[at] >= number_[from]) close({from, at}, open);
        continue;
      }
      const std::uint32_t at = step.at, to = ends_[step.next++];
      if (to == step.from) continue;
      if (number_[to] == unseen) {
        open.push_back({at, to});
        number_[to] = low_[to] = count_++;
        path.push_back({to, at, begin_[to]});
      } else if (number_[to] < number_[at]) {
        open.push_back({at, to});
        low_[at] = std::min(low_[at], number_[to]);
      }
    }
  }

  void close(const Pair& edge, std::vector<Pair>& open) {
    const auto first = std::find(open.rbegin(), open.rend(), edge).base() - 1;
    blocks_.push_back({edge[0], {first, open.end()}});
    open.erase(first, open.end());
  }

  // The edges of a block are in the order of the search: of each, one end is known. Its first is the entry's.
  void judge(const Block& block) {
    bool consistent = true;
    for (const auto& [at, to] : block.edges) {
      const bool forward = number_[to] > number_[at];
      if (forward)
        solid_[to] = !solid_[at];
      else
        consistent &= solid_[to] != solid_[at];
    }
    if (consistent) return;
    for (const auto& [at, to] : block.edges)
      if (number_[to] > number_[at]) solid_[to] = !solid_[block.entry];
  }

  std::vector<std::uint32_t> begin_, ends_;  ///< neighbours of each volume
  std::vector<std::uint32_t> number_, low_;  ///< order of the search; the least number that its subtree is joined to
  std::uint32_t count_ = 0;
  std::vector<Block> blocks_;
  std::vector<bool> solid_;
};

}  // namespace

std::vector<bool> solid_by_nesting(std::uint32_t volumes, std::vector<Pair> neighbours) {
  return Nesting(volumes, std::move(neighbours)).run();
}

}  // namespace pgdr::detail
