// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "visits/waiting_work.hpp"

#include <algorithm>
#include <array>

#include "pgdr/refine.hpp"
#include "space/box.hpp"

namespace pgdr::detail {

static_assert(VisitTrace::whole_tree == whole_tree);
namespace {

template <int D>
Orthtree<D> tree_over(std::span<const Point<D>> points) {
  const Box<D> box = Box<D>::of(points);
  return Orthtree<D>(box.low, box.high);
}

}  // namespace

template <int D>
WaitingWork<D>::WaitingWork(RefineContext<D>& context)
    : context_(&context),
      options_(&context.options.schedule),
      tree_(tree_over<D>(context.domain.points())),
      placement_(tree_, options_->claims, is_uniform() ? options_->split_ratio / 2 : options_->split_ratio),
      works_(tree_) {}

template <int D>
void WaitingWork<D>::append_requests(Node node, std::vector<VisitRequest>& out) const {
  const LeafWork<D>& work = works_[node];
  const bool has_ordinary_visits = by_boxes() || tree_.is_leaf(node);
  if (work.has_list()) out.push_back({node, has_ordinary_visits ? 1 : whole_tree, work.since});
  for (const SetAside<D>& s : work.set_aside)
    if (!s.entries.empty() && (has_ordinary_visits || !work.has_list())) out.push_back({node, s.order, s.since});
}

template <int D>
std::vector<VisitRequest> WaitingWork<D>::requests() const {
  std::vector<VisitRequest> all;
  tree_.for_each_node([&](Node n) { append_requests(n, all); });
  return all;
}

template <int D>
void WaitingWork<D>::prepare(const VisitRequest& request, NodeVisit<D>& visit) {
  LeafWork<D>& work = works_[request.node];
  visit.floor = floor();
  visit.granularity = options_->granularity;
  visit.treat_list = request.order == 1;
  visit.order = request.order;
  visit.generation = generation_;
  visit.level = static_cast<std::uint32_t>(tree_.level(request.node));
  visit.list = &work.list;
  if (request.order != 1) {
    visit.given = work.take_set_aside(request.order);
    return;
  }
  if (!is_uniform() && tree_.can_split(request.node)) visit.small_radius = small_radius(request.node);
}

template <int D>
void WaitingWork<D>::post(Node node, std::vector<Entry<D>>&& entries) {
  LeafWork<D>& to = works_[node];
  if (!to.has_list()) to.since = generation_;
  to.inbox.push_back(std::move(entries));
}

template <int D>
void WaitingWork<D>::relist(const Entry<D>& e) {
  LeafWork<D>& work = works_[node_of(e)];
  if (!work.has_list()) work.since = generation_;
  work.list.push(e);
}

template <int D>
void WaitingWork<D>::relist(const Entry<D>& e, std::uint32_t order) {
  if (order == 1) return relist(e);
  const Node node = node_of(e);
  if (by_boxes()) return set_aside_above(node, e);
  set_aside(order == whole_tree ? Orthtree<D>::root : node, order, e);
}

template <int D>
void WaitingWork<D>::set_aside(Node node, std::uint32_t order, const Entry<D>& e) {
  works_[node].add_set_aside(order, generation_, e);
}

/// By the rule of boxes: to a visit of the next larger node, with all of space after the root.
template <int D>
void WaitingWork<D>::set_aside_above(Node node, const Entry<D>& e) {
  const Node above = node == Orthtree<D>::root ? node : tree_.parent(node);
  set_aside(above, above == Orthtree<D>::root ? whole_tree : 2, e);
}

template <int D>
std::uint64_t WaitingWork<D>::defer(const VisitRequest& request, const std::vector<Entry<D>>& entries) {
  constexpr std::array<std::uint32_t, 2> orders{2, 4};  // of whole leaves: BUF^2, BUF^4; then the whole tree
  std::uint32_t order = whole_tree;
  for (const std::uint32_t larger : orders)
    if (larger > request.order && larger > options_->claim_order) order = std::min(order, larger);
  std::uint64_t deferred = 0;
  for (const Entry<D>& e : entries) {
    if (!e.alive(context_->mesh)) continue;
    ++deferred;
    if (by_boxes())
      set_aside_above(request.node, e);
    else
      set_aside(order == whole_tree ? Orthtree<D>::root : request.node, order, e);
  }
  return deferred;
}

/// Only what the children can take counts. By the rule of boxes the rest stays with the node, by that of leaves it must be none.
template <int D>
bool WaitingWork<D>::is_crowded(Node leaf) {
  WorkList<D>& list = works_[leaf].list;
  if (!tree_.can_split(leaf) || list.poor() == 0 || !list.is_crowded(floor())) return false;
  const double most = small_radius(leaf);
  if (!by_boxes()) return context_->largest_radius(list.first_bucket()) <= most;
  return list.is_crowded(floor(), [this, most](int bucket) { return context_->largest_radius(bucket) <= most; });
}

template <int D>
bool WaitingWork<D>::split_if_crowded(Node leaf) {
  if (!is_crowded(leaf) || tree_.split(leaf) == Orthtree<D>::none) return false;
  works_.grow();
  return true;
}

template <int D>
bool WaitingWork<D>::split(std::span<const Node> leaves, const Pieces& pieces) {
  if (!std::all_of(leaves.begin(), leaves.end(), [this](Node leaf) { return tree_.can_split(leaf); })) return false;
  for (const Node leaf : leaves) tree_.split(leaf);
  works_.grow();
  pieces.run(leaves.size(), [&](std::size_t i) { hand_down(leaves[i]); });
  return true;
}

template <int D>
void WaitingWork<D>::rename(const Renumbering<D>& to) {
  const auto rename_one = [&](Entry<D>& e) { to.rename(e.cell, e.birth); };
  tree_.for_each_node([&](Node n) {
    works_[n].for_each(rename_one);
    for (Refusal<D>& r : works_[n].list.refused)
      for (CellName& seen : r.seen) to.rename(seen.cell, seen.birth);
  });
  std::for_each(given_and_not_processed_.begin(), given_and_not_processed_.end(), rename_one);
}

template <int D>
auto WaitingWork<D>::to_come() const -> ToCome {
  std::uint64_t by_size = 0, waiting = 0;
  for (Node n = 0; n < tree_.node_count(); ++n) by_size += works_[n].list.to_come(), waiting += works_[n].list.poor();
  return {static_cast<double>(by_size), static_cast<double>(waiting)};
}

template <int D>
std::optional<PoorCount> WaitingWork<D>::count_poor(const Pieces& pieces) {
  if (!all_listed_) return std::nullopt;
  constexpr std::size_t nodes_a_piece = 16;
  std::vector<Node> nodes;
  tree_.for_each_node([&nodes](Node n) { nodes.push_back(n); });
  const std::size_t count = (nodes.size() + nodes_a_piece - 1) / nodes_a_piece;
  SlotSet counted(context_->mesh.cell_bound());
  std::vector<PoorCount> parts(count + 1);
  pieces.run(count, [&](std::size_t i) {
    constexpr std::size_t ahead = 16;  // entries, whose cells are far apart in memory
    std::vector<Entry<D>> soon;
    std::size_t at = 0;
    for (std::size_t k = i * nodes_a_piece; k < std::min(nodes.size(), (i + 1) * nodes_a_piece); ++k)
      works_[nodes[k]].for_each([&](const Entry<D>& e) {
        context_->mesh.prefetch(e.cell);
        if (soon.size() < ahead) return soon.push_back(e);
        count_if_poor(std::exchange(soon[at++ % ahead], e), counted, parts[i]);
      });
    for (const Entry<D>& e : soon) count_if_poor(e, counted, parts[i]);
  });
  for (const Entry<D>& e : given_and_not_processed_) count_if_poor(e, counted, parts[count]);
  PoorCount poor;
  for (const PoorCount& part : parts) {
    poor.cells += part.cells;
    poor.over_size = poor.over_size || part.over_size;
  }
  return poor;
}

/// A poor cell that is listed for a face that is not locally Delaunay was listed, or refused, as poor as well.
template <int D>
void WaitingWork<D>::count_if_poor(const Entry<D>& e, SlotSet& counted, PoorCount& poor) const {
  if (e.kind() != EntryKind::cell || e.which() == Entry<D>::not_delaunay || !e.alive(context_->mesh)) return;
  poor.over_size = poor.over_size || e.which() == Entry<D>::over_size;
  poor.cells += counted.add_shared(index(e.cell)) ? 1 : 0;
}

template class WaitingWork<2>;
template class WaitingWork<3>;

}  // namespace pgdr::detail
