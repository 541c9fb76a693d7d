// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "cavity/bulk_insertion.hpp"

#include <algorithm>
#include <cassert>

#include "cavity/walk.hpp"

namespace pgdr::detail {
namespace {

/// Slots that the insertion of so many points takes, mostly: in the plane each makes two cells more, in space seven on average.
template <int D>
std::size_t slots_for(std::size_t points) {
  return D == 3 ? 8 * points + 128 : 2 * points + 64;
}

}  // namespace

template <int D>
std::vector<VertexId> BulkInsertion<D>::insert(std::span<const VertexId> waiting) {
  const Bulk bulk(*pieces_, stop_);
  open_slots();
  const TilePlan<D> plan(*mesh_, waiting, static_cast<std::uint32_t>(cell_at_->size()), bulk);
  std::vector<VertexId> left = plan.unplanned();
  if (plan.batches() == 0) return left;
  range_shift_ = plan.range_shift();
  visit_of_.assign(plan.ranges(), 0);
  visits_ = 0;
  for (std::size_t b = 0; b < plan.batches() && !stop_.stop_requested(); ++b) {
    const auto tiles = plan.batch(b);
    begin_batch(plan, tiles);
    pieces_->run(tiles.size(), [&](std::size_t i) { visit(*lanes_[i]); });
    end_batch(tiles.size(), left);
  }
  bulk.sort(left, std::less<>());
  return left;
}

template <int D>
void BulkInsertion<D>::begin_batch(const TilePlan<D>& plan, std::span<const std::uint32_t> tiles) {
  while (lanes_.size() < tiles.size())
    lanes_.push_back(std::make_unique<Lane>(Lane{mesh_->make_pools(), 0, {}, no_cell, {}, {}, {}}));
  for (std::size_t i = 0; i < tiles.size(); ++i) {
    const auto [waiting, claim] = plan.visit(tiles[i]);
    Lane& lane = *lanes_[i];
    lane.visit = ++visits_;
    lane.waiting = waiting;
    for (const std::uint32_t range : claim) visit_of_[range] = lane.visit;
    find_hints(lane, claim);
    lane.pools.cells.reserve(slots_for<D>(waiting.size()));
  }
}

/// Cells that the visit owns, of which it knows before it runs that nobody else deletes them: at vertices that have nearly the
/// numbers of those that wait.
template <int D>
void BulkInsertion<D>::find_hints(Lane& lane, std::span<const std::uint32_t> ranges) {
  constexpr std::uint32_t reach = 8;  // numbers
  const VertexClaim<D> claim = claim_of(lane);
  const auto owned_at = [&](std::uint32_t v) {
    const CellId c = range_.has(v) && claim.has(VertexId{v}) ? (*cell_at_)[v] : no_cell;
    return c != no_cell && claim.owns(mesh_->cell(c).vertices) ? c : no_cell;
  };
  lane.hint = no_cell;
  lane.hints.clear();
  for (std::size_t i = 0; i < lane.waiting.size(); i += points_a_hint) {
    const std::uint32_t v = index(lane.waiting[i]);
    CellId c = no_cell;
    for (std::uint32_t d = 1; d <= reach && c == no_cell; ++d) {
      c = owned_at(v + d);
      if (c == no_cell && d <= v) c = owned_at(v - d);
    }
    lane.hints.push_back(c);
    if (lane.hint == no_cell) lane.hint = c;
  }
  for (const std::uint32_t range : ranges)
    for (std::uint32_t v = range << range_shift_; lane.hint == no_cell && v < cell_at_->size() && v >> range_shift_ == range; ++v)
      lane.hint = owned_at(v);
}

template <int D>
void BulkInsertion<D>::end_batch(std::size_t visits, std::vector<VertexId>& left) {
  for (std::size_t i = 0; i < visits; ++i) {
    Lane& lane = *lanes_[i];
    left.insert(left.end(), lane.left.begin(), lane.left.end());
    lane.left.clear();
    for (const auto& [v, c] : lane.outside) (*cell_at_)[index(v)] = c;  // the last of each is alive
    lane.outside.clear();
  }
}

template <int D>
void BulkInsertion<D>::visit(Lane& lane) {
  Worker worker = take_worker();
  const VertexClaim<D> claim = claim_of(lane);
  worker->set_claim(&claim);
  for (std::size_t i = 0; i < lane.waiting.size(); ++i)
    if (!insert(lane, *worker, claim, i)) lane.left.push_back(lane.waiting[i]);
  worker->set_claim(nullptr);
  give_worker(std::move(worker));
}

/// The cell to insert the i-th point at: from where the last one was, or else from a hint.
template <int D>
CellId BulkInsertion<D>::find_seed(const Lane& lane, const VertexClaim<D>& claim, std::size_t i) const {
  const Point<D>& p = mesh_->point(lane.waiting[i]);
  const auto is_owned = [&](CellId c) { return claim.owns(mesh_->cell(c).vertices); };
  if (lane.hint == no_cell) return no_cell;
  const CellId seed = walk_to<D>(*mesh_, p, lane.hint, is_owned);
  // The visit may have deleted the cell of the hint; what is in the slot since then is its own as well.
  const CellId hint = lane.hints[i / points_a_hint];
  return seed != no_cell || hint == no_cell || !mesh_->alive(hint) ? seed : walk_to<D>(*mesh_, p, hint, is_owned);
}

template <int D>
bool BulkInsertion<D>::insert(Lane& lane, Cavity<D>& cavity, const VertexClaim<D>& claim, std::size_t i) {
  const VertexId v = lane.waiting[i];
  const Point<D>& p = mesh_->point(v);
  const CellId seed = find_seed(lane, claim, i);
  if (seed == no_cell) return false;
  lane.hint = seed;
  require_no_vertex_at<D>(*mesh_, seed, p);
  if (cavity.collect(p, seed) != Cavity<D>::Status::ok || cavity.boundary().size() > lane.pools.cells.available()) {
    cavity.release();
    return false;
  }
  assert(cavity.make_star_shaped() == Cavity<D>::Status::ok && !cavity.cut_back());
  cavity.commit(lane.pools, v);
  note_cells(lane, claim, cavity.new_cells());
  lane.hint = cavity.new_cells().front();
  return true;
}

template <int D>
void BulkInsertion<D>::note_cells(Lane& lane, const VertexClaim<D>& claim, const std::vector<CellId>& cells) {
  for (const CellId c : cells)
    for (const VertexId u : mesh_->cell(c).vertices) {
      if (claim.has(u))
        (*cell_at_)[index(u)] = c;
      else if (u != infinite_vertex)
        lane.outside.emplace_back(u, c);
    }
}

template <int D>
auto BulkInsertion<D>::take_worker() -> Worker {
  {
    const std::lock_guard lock(mutex_);
    if (!idle_.empty()) {
      Worker worker = std::move(idle_.back());
      idle_.pop_back();
      return worker;
    }
  }
  return std::make_unique<Cavity<D>>(*mesh_);
}

template <int D>
void BulkInsertion<D>::give_worker(Worker worker) {
  const std::lock_guard lock(mutex_);
  idle_.push_back(std::move(worker));
}

template <int D>
void BulkInsertion<D>::give_slots_to(Pools& pools) {
  open_slots();
  for (const auto& lane : lanes_) pools.cells.take_over(lane->pools.cells);
}

/// Makes the storage of all slots that were reserved: whoever looks through the slots finds them without a cell.
template <int D>
void BulkInsertion<D>::open_slots() {
  constexpr std::size_t block = 16;  // lanes
  Bulk(*pieces_, {}).parts((lanes_.size() + block - 1) / block, [&](std::size_t part) {
    for (std::size_t i = part * block; i < std::min(lanes_.size(), (part + 1) * block); ++i) lanes_[i]->pools.cells.open();
  });
}

template class BulkInsertion<2>;
template class BulkInsertion<3>;

}  // namespace pgdr::detail
