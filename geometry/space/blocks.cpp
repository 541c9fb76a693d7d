// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Depth-first search (Hopcroft, Tarjan 1973), without recursion: there may be as many vertices as the input has room for.
#include "space/blocks.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

#include "space/make_set.hpp"

namespace pgdr::detail {

Blocks::Blocks(std::uint32_t vertices, std::vector<Pair> edges)
    : begin_(vertices + 1, 0), number_(vertices, unseen), low_(vertices) {
  for (Pair& e : edges) std::sort(e.begin(), e.end());
  make_set(edges);
  for (const auto& [a, b] : edges) {
    ++begin_[a + 1];
    ++begin_[b + 1];
  }
  std::partial_sum(begin_.begin(), begin_.end(), begin_.begin());
  std::vector<std::uint32_t> next(begin_.begin(), begin_.end() - 1);
  ends_.resize(2 * edges.size());
  for (const auto& [a, b] : edges) {
    ends_[next[a]++] = b;
    ends_[next[b]++] = a;
  }
}

void Blocks::search(std::uint32_t start) {
  if (is_seen(start)) return;
  std::vector<Step> path{{start, unseen, begin_[start]}};
  std::vector<Pair> open;
  see(start);
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
    if (!is_seen(to)) {
      open.push_back({at, to});
      see(to);
      path.push_back({to, at, begin_[to]});
    } else if (number_[to] < number_[at]) {
      open.push_back({at, to});
      low_[at] = std::min(low_[at], number_[to]);
    }
  }
}

void Blocks::close(const Pair& edge, std::vector<Pair>& open) {
  const auto first = std::find(open.rbegin(), open.rend(), edge).base() - 1;
  blocks_.emplace_back(first, open.end());
  open.erase(first, open.end());
}

}  // namespace pgdr::detail
