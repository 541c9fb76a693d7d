// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "claims/conflict_manager.hpp"

#include <algorithm>
#include <string>
#include <tuple>
#include <utility>

#include "claims/claimants.hpp"
#include "pgdr/error.hpp"

namespace pgdr {

namespace {

[[noreturn]] void fail(const std::string& message) { throw ResourceError({Errc::internal, message, {}, 0, {}, {}}); }

}  // namespace

template <int D>
Claim<D> Visit<D>::claim(const Orthtree<D>& tree) const {
  if (whole()) return Claim<D>::whole(tree, request.node);
  if (rule == ClaimRule::boxes) return Claim<D>::of_box(tree, request.node, box);
  return Claim<D>::of_leaves(tree, request.node, leaves, claim_order);
}

template <int D>
bool meet(const Visit<D>& a, const Visit<D>& b) {
  if (a.whole() || b.whole()) return true;
  if (a.rule == ClaimRule::boxes) return a.box.meets(b.box);
  const auto is_of_b = [&b](auto leaf) { return std::binary_search(b.leaves.begin(), b.leaves.end(), leaf); };
  return std::any_of(a.leaves.begin(), a.leaves.end(), is_of_b);
}

template <int D>
ConflictManager<D>::ConflictManager(const Orthtree<D>& tree, ClaimRule rule, std::uint32_t ordinary_order)
    : tree_(&tree), rule_(rule), ordinary_order_(std::max(ordinary_order, 1u)) {}

template <int D>
std::uint32_t ConflictManager<D>::claim_order(const VisitRequest& r) const {
  return r.order == 1 || rule_ == ClaimRule::boxes ? ordinary_order_ : r.order;
}

template <int D>
void ConflictManager<D>::make_room() {
  if (cache_.size() < tree_->node_count()) cache_.resize(tree_->node_count());
}

template <int D>
void ConflictManager<D>::renew(Node leaf) {
  Cached& cached = cache_[leaf];
  if (cached.node_count == tree_->node_count()) return;
  // A split changes BUF(leaf) only if it splits one of its leaves.
  const auto split = [this](Node l) { return !tree_->is_leaf(l); };
  if (cached.node_count == 0 || std::any_of(cached.zone.begin(), cached.zone.end(), split)) cached.zone = tree_->buffer(leaf);
  cached.node_count = tree_->node_count();
}

template <int D>
void ConflictManager<D>::require_sound(std::span<const VisitRequest> requests) const {
  std::vector<std::pair<Node, std::uint32_t>> names;
  for (const VisitRequest& r : requests) {
    const bool may_be_inner = r.order == whole_tree || rule_ == ClaimRule::boxes;
    if (r.node >= tree_->node_count() || r.order == 0 || !(may_be_inner || tree_->is_leaf(r.node)))
      fail("node " + std::to_string(r.node) + " cannot be visited: no leaf, or no order");
    names.emplace_back(r.node, r.order);
  }
  std::sort(names.begin(), names.end());
  if (const auto twice = std::adjacent_find(names.begin(), names.end()); twice != names.end())
    fail("node " + std::to_string(twice->first) + " is to be visited twice with the same order");
}

template <int D>
std::vector<VisitRequest> ConflictManager<D>::in_order(std::span<const VisitRequest> requests) const {
  // Equal colours have disjoint claims in a uniform tree; the cap keeps the colour in 64 bits.
  const auto colour = [this](const VisitRequest& r) {
    const std::uint64_t period = r.order == whole_tree ? 1 : 2 * std::uint64_t{claim_order(r)} + 1;
    return tree_->colour(r.node, static_cast<std::uint32_t>(std::min<std::uint64_t>(period, 1u << 21)));
  };
  const auto level = [this](const VisitRequest& r) {
    const bool small_first = rule_ == ClaimRule::boxes && r.order > 1;
    return small_first ? -tree_->level(r.node) : tree_->level(r.node);
  };
  require_sound(requests);
  using Key = std::tuple<std::uint32_t, int, std::uint64_t, std::uint64_t, std::uint64_t>;
  std::vector<std::pair<Key, std::size_t>> keys;
  keys.reserve(requests.size());
  for (std::size_t i = 0; i < requests.size(); ++i) {
    const VisitRequest& r = requests[i];
    keys.push_back({{r.order, level(r), r.generation, colour(r), tree_->morton(r.node)}, i});
  }
  std::sort(keys.begin(), keys.end());
  std::vector<VisitRequest> sorted;
  sorted.reserve(keys.size());
  for (const auto& [key, i] : keys) sorted.push_back(requests[i]);
  return sorted;
}

/// {leaf} + BUF^order(leaf), sorted, by breadth-first search: only leaves reached for the first time can add anything.
template <int D>
auto ConflictManager<D>::zone_of(Node leaf, std::uint32_t order) -> std::vector<Node> {
  make_room();
  reached_.resize(tree_->node_count(), 0);
  reached_[leaf] = ++search_;
  std::vector<Node> zone{leaf};
  std::size_t fresh = 0;
  for (std::uint32_t step = 0; step < order && fresh < zone.size(); ++step)
    for (const std::size_t end = zone.size(); fresh < end; ++fresh) {
      renew(zone[fresh]);
      for (const Node l : cache_[zone[fresh]].zone)
        if (std::exchange(reached_[l], search_) != search_) zone.push_back(l);
    }
  std::sort(zone.begin(), zone.end());
  return zone;
}

template <int D>
Visit<D> ConflictManager<D>::visit_of(const VisitRequest& r) {
  Visit<D> visit{.request = r, .rule = rule_, .claim_order = claim_order(r)};
  if (rule_ == ClaimRule::boxes || r.order == whole_tree)
    visit.box = GridBox<D>::around(*tree_, r.order == whole_tree ? Orthtree<D>::root : r.node, visit.claim_order);
  else
    visit.leaves = zone_of(r.node, visit.claim_order);
  return visit;
}

template <int D>
Generation<D> ConflictManager<D>::plan(std::span<const VisitRequest> requests) {
  Generation<D> generation;
  generation.visits.reserve(requests.size());
  detail::Claimants<D> claimants(tree_->extent(Orthtree<D>::root));
  std::vector<GridBox<D>> boxes;
  for (const VisitRequest& r : in_order(requests)) {
    const auto v = static_cast<VisitGraph::Visit>(generation.visits.size());
    const Visit<D>& visit = generation.visits.emplace_back(visit_of(r));
    boxes.clear();
    for (const Node leaf : visit.leaves) boxes.push_back(GridBox<D>::around(*tree_, leaf, 0));
    if (boxes.empty()) boxes.push_back(visit.box);
    generation.graph.add_visit(claimants.claim(v, boxes));
  }
  return generation;
}

template bool meet(const Visit<2>&, const Visit<2>&);
template bool meet(const Visit<3>&, const Visit<3>&);
template struct Visit<2>;
template struct Visit<3>;
template class ConflictManager<2>;
template class ConflictManager<3>;

}  // namespace pgdr
