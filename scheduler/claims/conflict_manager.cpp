// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "claims/conflict_manager.hpp"

#include <algorithm>
#include <string>
#include <tuple>

#include "pgdr/error.hpp"

namespace pgdr {

namespace {

constexpr VisitGraph::Visit nobody = 0xffffffffu;

[[noreturn]] void fail(const std::string& message) { throw ResourceError({Errc::internal, message, {}, 0, {}, {}}); }

}  // namespace

template <int D>
ConflictManager<D>::ConflictManager(const Orthtree<D>& tree, std::uint32_t ordinary_order)
    : tree_(&tree), ordinary_order_(std::max(ordinary_order, 1u)) {}

template <int D>
bool ConflictManager<D>::is_stale(Node leaf) {
  if (cache_.size() < tree_->node_count()) cache_.resize(tree_->node_count());
  return cache_[leaf].node_count != tree_->node_count();
}

template <int D>
void ConflictManager<D>::renew(Node leaf) {
  Cached& cached = cache_[leaf];
  // A split changes BUF(leaf) only if it splits one of its leaves.
  const auto split = [this](Node l) { return !tree_->is_leaf(l); };
  if (cached.node_count == 0 || std::any_of(cached.zone.begin(), cached.zone.end(), split)) cached.zone = tree_->buffer(leaf);
  cached.node_count = tree_->node_count();
}

template <int D>
auto ConflictManager<D>::buffer(Node leaf) -> const std::vector<Node>& {
  if (is_stale(leaf)) renew(leaf);
  return cache_[leaf].zone;
}

template <int D>
std::vector<VisitRequest> ConflictManager<D>::in_order(std::span<const VisitRequest> requests) const {
  // Equal colours have disjoint claims in a uniform tree; the cap keeps the colour in 64 bits.
  const auto colour = [this](const VisitRequest& r) {
    const std::uint64_t period = r.order == whole_tree ? 1 : 2 * std::uint64_t{claim_order(r)} + 1;
    return tree_->colour(r.leaf, static_cast<std::uint32_t>(std::min<std::uint64_t>(period, 1u << 21)));
  };
  std::vector<std::pair<Node, std::uint32_t>> names;
  for (const VisitRequest& r : requests) names.emplace_back(r.leaf, r.order);
  std::sort(names.begin(), names.end());
  if (const auto twice = std::adjacent_find(names.begin(), names.end()); twice != names.end())
    fail("leaf " + std::to_string(twice->first) + " is to be visited twice with the same order");
  using Key = std::tuple<std::uint32_t, int, std::uint64_t, std::uint64_t, std::uint64_t>;
  std::vector<std::pair<Key, std::size_t>> keys;
  keys.reserve(requests.size());
  for (std::size_t i = 0; i < requests.size(); ++i) {
    const VisitRequest& r = requests[i];
    if (r.leaf >= tree_->node_count() || !tree_->is_leaf(r.leaf) || r.order == 0)
      fail("node " + std::to_string(r.leaf) + " cannot be visited: no leaf, or no order");
    keys.push_back({{r.order, tree_->level(r.leaf), r.generation, colour(r), tree_->morton(r.leaf)}, i});
  }
  std::sort(keys.begin(), keys.end());
  std::vector<VisitRequest> sorted;
  sorted.reserve(keys.size());
  for (const auto& [key, i] : keys) sorted.push_back(requests[i]);
  return sorted;
}

template <int D>
Visit<D> ConflictManager<D>::visit_of(const VisitRequest& r) {
  const std::uint32_t order = claim_order(r);
  Visit<D> visit{r, order, {}};
  if (r.order == whole_tree) return visit;
  std::vector<Node>& zone = visit.leaves;
  if (order == 1) {
    const std::vector<Node>& around = buffer(r.leaf);
    zone.reserve(around.size() + 1);
    const auto behind = std::upper_bound(around.begin(), around.end(), r.leaf);
    zone.assign(around.begin(), behind);
    zone.push_back(r.leaf);
    zone.insert(zone.end(), behind, around.end());
    return visit;
  }
  // BUF^i by breadth-first search: only leaves reached for the first time can add anything.
  reached_.resize(tree_->node_count(), 0);
  ++search_;
  reached_[r.leaf] = search_;
  zone.push_back(r.leaf);
  std::size_t fresh = 0;
  for (std::uint32_t step = 0; step < order && fresh < zone.size(); ++step)
    for (const std::size_t end = zone.size(); fresh < end; ++fresh)
      for (const Node l : buffer(zone[fresh]))
        if (reached_[l] != search_) {
          reached_[l] = search_;
          zone.push_back(l);
        }
  std::sort(zone.begin(), zone.end());
  return visit;
}

template <int D>
Generation<D> ConflictManager<D>::plan(std::span<const VisitRequest> requests) {
  Generation<D> generation;
  const std::vector<VisitRequest> sorted = in_order(requests);
  const auto count = static_cast<VisitGraph::Visit>(sorted.size());
  generation.visits.reserve(count);

  // The claimants of one leaf form a chain, so that any two of them have a path between them.
  std::vector<VisitGraph::Visit> last_claimant(tree_->node_count(), nobody);
  std::vector<VisitGraph::Visit> predecessors, waits_for(count, nobody), has_successor(count, 0);
  const auto wait = [&](VisitGraph::Visit v, VisitGraph::Visit earlier) {
    if (waits_for[earlier] == v) return;
    waits_for[earlier] = v;
    has_successor[earlier] = 1;
    predecessors.push_back(earlier);
  };
  for (VisitGraph::Visit v = 0; v < count; ++v) {
    const VisitRequest& r = sorted[v];
    generation.visits.push_back(visit_of(r));
    predecessors.clear();
    const std::vector<Node>& leaves = generation.visits.back().leaves;
    if (leaves.empty()) {
      // Whoever has no successor yet: everybody earlier leads to one of them. Only whole trees follow in the order.
      for (VisitGraph::Visit earlier = 0; earlier < v; ++earlier)
        if (!has_successor[earlier]) wait(v, earlier);
    }
    for (const Node leaf : leaves) {
      if (last_claimant[leaf] != nobody) wait(v, last_claimant[leaf]);
      last_claimant[leaf] = v;
    }
    std::sort(predecessors.begin(), predecessors.end());
    generation.graph.add_visit(predecessors);
  }
  return generation;
}

template class ConflictManager<2>;
template class ConflictManager<3>;

}  // namespace pgdr
