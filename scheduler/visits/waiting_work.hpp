// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The tree, what waits in its leaves, and what waits for a visit of the whole tree. One thread at a time, except that during a
// generation a visit uses the work of the leaves that it has claimed.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "claims/conflict_manager.hpp"
#include "claims/placement.hpp"
#include "mesh/renumbering.hpp"
#include "mesh/slot_set.hpp"
#include "reasons/poor_reasons.hpp"
#include "refine/context.hpp"
#include "refine/node_visit.hpp"
#include "space/pieces.hpp"
#include "visits/leaf_work.hpp"
#include "visits/numbers.hpp"

namespace pgdr::detail {

/// Part of a run: see above.
template <int D>
class WaitingWork {
 public:
  using Node = typename Orthtree<D>::Node;

  explicit WaitingWork(RefineContext<D>& context);  ///< it must outlive this
  WaitingWork(const WaitingWork&) = delete;
  WaitingWork& operator=(const WaitingWork&) = delete;

  const Orthtree<D>& tree() const { return tree_; }
  const Placement<D>& placement() const { return placement_; }
  /// The node that the entry belongs to.
  Node node_of(const Entry<D>& e) const { return placement_.node_of(context_->place_of(e.cell), context_->radius_of(e)); }
  Orthtree<D> take_tree() { return std::move(tree_); }
  LeafWork<D>& operator[](Node n) { return works_[n]; }
  const LeafWork<D>& operator[](Node n) const { return works_[n]; }
  void begin_generation() { ++generation_; }

  /// Requests for all that waits: one for each node and order.
  std::vector<VisitRequest> requests() const;
  void append_requests(Node node, std::vector<VisitRequest>& out) const;
  bool is_empty() const { return requests().empty(); }
  /// Gives the visit the list of its node and what was set aside for it, and says when it ends.
  void prepare(const VisitRequest& request, NodeVisit<D>& visit);

  /// Puts entries that a visit of another node has found into the inbox of this one.
  void post(Node node, std::vector<Entry<D>>&& entries);
  /// Lists the entry in the node that it belongs to.
  void relist(const Entry<D>& e);
  /// Lists the entry, which a visit of this order refused: for one of its node if that is 1, else for one with a larger claim.
  void relist(const Entry<D>& e, std::uint32_t order);
  /// Sets what the visit has set aside aside for one with a larger claim, if it is still alive now that the visits that ran
  /// beside this one have ended. Returns how many entries that are.
  std::uint64_t defer(const VisitRequest& request, const std::vector<Entry<D>>& entries);
  /// Keeps what was given to a visit that the end of the run has overtaken, so that count_poor() counts it.
  void keep_given(const std::vector<Entry<D>>& given) {
    given_and_not_processed_.insert(given_and_not_processed_.end(), given.begin(), given.end());
  }

  /// Splits the leaf if it is so crowded, and its elements so small, that its children can be refined concurrently. What waits
  /// stays with the parent until hand_down().
  bool split_if_crowded(Node leaf);
  /// Hands what waits at a node that was split to its children, or a part of it where the run has to end meanwhile. Threads:
  /// different parents at once.
  void hand_down(Node parent) {
    works_.hand_down(*context_, parent, placement_.most_radius(tree_.first_child(parent)), generation_);
  }

  /// Splits these leaves, in their order, and hands what waits there down; false, and nothing is done, if one cannot be split.
  bool split(std::span<const Node> leaves, const Pieces& pieces);

  /// Calls f for the list of each node, in an order in which the order of splits has no part (Orthtree::for_each_node).
  template <class F>
  void for_each_list(F f) {
    tree_.for_each_node([&](Node n) { f(works_[n].list); });
  }

  /// About how many cells will take the place of elements that wait, by their size; and how many of these there are.
  struct ToCome {
    double by_size = 0, waiting = 0;
  };
  /// While no visit runs.
  ToCome to_come() const;

  /// For tests: renames the cells of all that waits, and of what was refused.
  void rename(const Renumbering<D>& to);

  /// Says whether every poor element is on a list between visits.
  void set_all_listed(bool all) { all_listed_ = all; }
  /// The cells over a bound, at the end of a run or where it was stopped, by what waits and what was refused: no other cell is
  /// looked at, and the size function is not called. Nothing where some may be on no list.
  std::optional<PoorCount> count_poor(const Pieces& pieces);

 private:
  std::size_t floor() const {
    return options_->floor != 0 ? options_->floor : D == 3 ? numbers::crowded_leaf : numbers::crowded_leaf_2d;
  }
  double small_radius(Node leaf) const { return options_->split_ratio * tree_.side(leaf) / 2; }
  bool by_boxes() const { return placement_.by_boxes(); }
  bool is_uniform() const { return options_->schedule == Schedule::uniform; }
  void set_aside(Node node, std::uint32_t order, const Entry<D>& e);
  void set_aside_above(Node node, const Entry<D>& e);
  bool is_crowded(Node leaf);
  void count_if_poor(const Entry<D>& e, SlotSet& counted, PoorCount& poor) const;

  RefineContext<D>* context_;
  const ScheduleOptions* options_;
  Orthtree<D> tree_;
  Placement<D> placement_;
  LeafWorks<D> works_;
  std::uint64_t generation_ = 0;  ///< that runs, or that ran last; counted from 1
  std::vector<Entry<D>> given_and_not_processed_;
  bool all_listed_ = false;
};

extern template class WaitingWork<2>;
extern template class WaitingWork<3>;

}  // namespace pgdr::detail
