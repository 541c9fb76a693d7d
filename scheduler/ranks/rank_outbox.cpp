// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "ranks/rank_outbox.hpp"

#include <algorithm>
#include <utility>

#include "ranks/sent_entry.hpp"

namespace pgdr::detail {

template <int D>
void RankOutbox<D>::take(Node visited, std::uint64_t phase, NodeVisit<D>& visit, LateWork<D>& late) {
  const std::vector<int>& neighbours = territory_->neighbours();
  const std::uint64_t number = tree_->morton(visited);
  std::uint64_t kept = 0;
  for (auto& box : visit.outboxes) {
    if (tree_->level(box.node) < territory_->level()) {
      for (const Entry<D>& e : box.entries) late.add_entry({phase, number, kept++}, LateWork<D>::Kind::found, box.node, 1, e);
      continue;
    }
    Letter letter{number, box.node, std::move(box.entries)};
    const int owner = territory_->owner(letter.node);
    const auto at = std::lower_bound(neighbours.begin(), neighbours.end(), owner);
    if (owner == territory_->rank())
      here_.push_back(std::move(letter));
    else if (at != neighbours.end() && *at == owner)
      there_[static_cast<std::size_t>(at - neighbours.begin())].push_back(std::move(letter));
    else
      fail_message("an element was found for a node that is too far away");
  }
  visit.outboxes.clear();
}

template <int D>
void RankOutbox<D>::put(MessageWriter& message, std::size_t neighbour) const {
  message.put(static_cast<std::uint64_t>(there_[neighbour].size()));
  for (const Letter& letter : there_[neighbour]) {
    message.put(letter.visit);
    message.put(letter.node);
    std::vector<SentEntry<D>> entries;
    for (const Entry<D>& e : letter.entries) entries.push_back(SentEntry<D>::of(*mesh_, e));
    message.put(entries);
  }
}

template <int D>
void RankOutbox<D>::get(MessageReader& message, const HeldMesh<D>& held) {
  for (auto left = message.get<std::uint64_t>(); left > 0; --left) {
    Letter letter;
    letter.visit = message.get<std::uint64_t>();
    letter.node = message.get<Node>();
    if (letter.node >= tree_->node_count() || tree_->level(letter.node) < territory_->level() ||
        territory_->owner(letter.node) != territory_->rank())
      fail_message("another rank has work for a node that is not visited here");
    for (const SentEntry<D>& sent : message.get_all<SentEntry<D>>()) letter.entries.push_back(sent.entry(*mesh_, held));
    here_.push_back(std::move(letter));
  }
}

template <int D>
void RankOutbox<D>::post(WaitingWork<D>& waiting) {
  std::stable_sort(here_.begin(), here_.end(), [](const Letter& a, const Letter& b) { return a.visit < b.visit; });
  for (Letter& letter : here_) waiting.post(letter.node, std::move(letter.entries));
  here_.clear();
}

template class RankOutbox<2>;
template class RankOutbox<3>;

}  // namespace pgdr::detail
