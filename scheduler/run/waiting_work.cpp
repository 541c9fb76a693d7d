// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "run/waiting_work.hpp"

#include <algorithm>

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
WaitingWork<D>::WaitingWork(const RefineContext<D>& context)
    : context_(&context), options_(&context.options.schedule), tree_(tree_over<D>(context.domain.points())), works_(tree_) {}

template <int D>
void WaitingWork<D>::append_requests(Node leaf, std::vector<VisitRequest>& out) const {
  const LeafWork<D>& work = works_[leaf];
  if (work.has_list()) out.push_back({leaf, 1, work.since});
  for (std::size_t level = 0; level < set_aside_orders.size(); ++level)
    if (!work.set_aside[level].empty()) out.push_back({leaf, set_aside_orders[level], work.set_aside_since[level]});
}

template <int D>
std::optional<VisitRequest> WaitingWork<D>::whole_tree_request() const {
  if (whole_set_aside_.empty() && whole_list_.empty()) return std::nullopt;
  return VisitRequest{tree_.leaf_at(context_->domain.points()[0]), whole_tree, 0};
}

template <int D>
std::vector<VisitRequest> WaitingWork<D>::requests() const {
  std::vector<VisitRequest> all;
  for (Node n = 0; n < tree_.node_count(); ++n)
    if (tree_.is_leaf(n)) append_requests(n, all);
  if (const auto request = whole_tree_request()) all.push_back(*request);
  return all;
}

template <int D>
void WaitingWork<D>::prepare(const VisitRequest& request, RegionVisit<D>& visit) {
  visit.floor = floor();
  visit.granularity = options_->granularity;
  visit.treat_list = request.order == 1;
  visit.order = request.order;
  visit.generation = generation_;
  visit.level = static_cast<std::uint32_t>(tree_.level(request.leaf));
  if (request.order == whole_tree) {
    visit.list = &whole_list_;
    visit.given = std::exchange(whole_set_aside_, {});
    return;
  }
  visit.list = &works_[request.leaf].list;
  if (request.order == 1 && tree_.can_split(request.leaf)) visit.small_radius = small_radius(request.leaf);
  for (std::size_t level = 0; level < set_aside_orders.size(); ++level)
    if (set_aside_orders[level] == request.order) visit.given = std::exchange(works_[request.leaf].set_aside[level], {});
}

template <int D>
void WaitingWork<D>::post(Node leaf, std::vector<Entry<D>>&& entries) {
  LeafWork<D>& to = works_[leaf];
  if (!to.has_list()) to.since = generation_;
  to.inbox.push_back(std::move(entries));
}

template <int D>
void WaitingWork<D>::relist(const Entry<D>& e) {
  LeafWork<D>& work = works_[tree_.leaf_at(context_->place_of(e.cell))];
  if (!work.has_list()) work.since = generation_;
  work.list.push(e);
}

template <int D>
void WaitingWork<D>::set_aside(Node leaf, std::uint32_t order, const Entry<D>& e) {
  for (std::size_t level = 0; level < set_aside_orders.size(); ++level) {
    if (set_aside_orders[level] != order) continue;
    auto& waiting = works_[leaf].set_aside[level];
    if (waiting.empty()) works_[leaf].set_aside_since[level] = generation_;
    return waiting.push_back(e);
  }
  whole_set_aside_.push_back(e);
}

template <int D>
std::uint64_t WaitingWork<D>::defer(const VisitRequest& request, const std::vector<Entry<D>>& entries) {
  std::uint32_t order = whole_tree;
  for (const std::uint32_t larger : set_aside_orders)
    if (larger > request.order && larger > options_->claim_order) order = std::min(order, larger);
  std::uint64_t deferred = 0;
  for (const Entry<D>& e : entries) {
    if (!e.alive(context_->mesh)) continue;
    ++deferred;
    set_aside(request.leaf, order, e);
  }
  return deferred;
}

template <int D>
bool WaitingWork<D>::is_crowded(Node leaf) {
  WorkList<D>& list = works_[leaf].list;
  return tree_.can_split(leaf) && list.poor() > 0 && list.is_crowded(floor()) &&
         context_->largest_radius(list.first_bucket()) <= small_radius(leaf);
}

template <int D>
bool WaitingWork<D>::split_if_crowded(Node leaf) {
  if (!is_crowded(leaf) || tree_.split(leaf) == Orthtree<D>::none) return false;
  works_.grow();
  return true;
}

template <int D>
std::optional<PoorCount> WaitingWork<D>::take_poor() {
  if (!all_listed_) return std::nullopt;
  PoorCount poor;
  std::vector<bool> counted(context_->mesh.cell_bound());
  // A poor cell that is listed for a face that is not locally Delaunay was listed, or refused, as poor as well.
  const auto count = [&](const Entry<D>& e) {
    if (e.kind() != EntryKind::cell || e.which() == Entry<D>::not_delaunay) return;
    if (!e.alive(context_->mesh)) return;
    poor.over_size = poor.over_size || e.which() == Entry<D>::over_size;
    poor.cells += counted[index(e.cell)] ? 0 : 1;
    counted[index(e.cell)] = true;
  };
  const auto count_all = [&](const std::vector<Entry<D>>& entries) { std::for_each(entries.begin(), entries.end(), count); };
  for_each_list([&](WorkList<D>& list, const LeafWork<D>* work) {
    list.drain(count);
    for (const Refusal<D>& r : list.refused) count(r.entry);
    if (!work) return;
    std::for_each(work->inbox.begin(), work->inbox.end(), count_all);
    std::for_each(work->set_aside.begin(), work->set_aside.end(), count_all);
  });
  count_all(whole_set_aside_);
  count_all(given_and_not_processed_);
  return poor;
}

template class WaitingWork<2>;
template class WaitingWork<3>;

}  // namespace pgdr::detail
