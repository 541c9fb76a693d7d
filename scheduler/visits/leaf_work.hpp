// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The work of each leaf of the tree: what waits there, and how it moves to the children when the leaf splits. One thread at a
// time, except that during a generation a visit uses the work of the leaves that it has claimed.
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "refine/refiner.hpp"
#include "tree/orthtree.hpp"

namespace pgdr::detail {

/// What was set aside for a visit with a claim of this order.
template <int D>
struct SetAside {
  std::uint32_t order;
  std::uint64_t since;  ///< generation in which it last became non-empty
  std::vector<Entry<D>> entries;
};

/// The work of one leaf, or of an inner node: elements that are too large for smaller ones, and what was set aside.
template <int D>
struct LeafWork {
  WorkList<D> list;
  std::vector<std::vector<Entry<D>>> inbox;  ///< from visits of other leaves, in their order; not looked at yet
  std::vector<SetAside<D>> set_aside;        ///< at most one of an order
  std::uint64_t since = 0;                   ///< generation in which the list last became non-empty

  bool has_list() const { return !list.empty() || !inbox.empty(); }
  /// Calls f for all that waits, was set aside or refused, to be changed, but for what decides its place.
  template <class F>
  void for_each(F f) {
    list.for_each(f);
    for (auto& batch : inbox) std::for_each(batch.begin(), batch.end(), f);
    for (SetAside<D>& s : set_aside) std::for_each(s.entries.begin(), s.entries.end(), f);
    for (Refusal<D>& r : list.refused) f(r.entry);
  }
  /// Adds to what was set aside for this order.
  void add_set_aside(std::uint32_t order, std::uint64_t generation, const Entry<D>& e) {
    const auto of_order = [order](const SetAside<D>& s) { return s.order == order; };
    auto s = std::find_if(set_aside.begin(), set_aside.end(), of_order);
    if (s == set_aside.end()) s = set_aside.insert(s, {order, generation, {}});
    if (s->entries.empty()) s->since = generation;
    s->entries.push_back(e);
  }
  /// Takes out what was set aside for this order.
  std::vector<Entry<D>> take_set_aside(std::uint32_t order) {
    for (SetAside<D>& s : set_aside)
      if (s.order == order) return std::exchange(s.entries, {});
    return {};
  }
  /// Moves the inbox into the list. Where `stop()`, which is asked before each batch, says so, the rest stays.
  template <class Stop>
  void open_inbox(const Stop& stop) {
    auto batch = inbox.begin();
    for (; batch != inbox.end() && !stop(); ++batch)
      for (const Entry<D>& e : *batch) list.push(e);
    if (batch == inbox.end())
      std::vector<std::vector<Entry<D>>>().swap(inbox);
    else
      inbox.erase(inbox.begin(), batch);
  }
};

/// The work of all nodes of a tree, which must outlive it.
template <int D>
class LeafWorks {
 public:
  using Node = typename Orthtree<D>::Node;

  explicit LeafWorks(const Orthtree<D>& tree) : tree_(&tree) { grow(); }

  LeafWork<D>& operator[](Node n) { return *works_[n]; }
  const LeafWork<D>& operator[](Node n) const { return *works_[n]; }
  /// Makes room for all nodes of the tree.
  void grow() {
    while (works_.size() < tree_->node_count()) works_.push_back(std::make_unique<LeafWork<D>>());
  }
  /// Hands what waits at a node that was split to its children, by the places of the cells (RefineContext::place_of), but for
  /// elements with a circumradius above `most_radius`, which belong to the node itself. What was set aside for a visit of a leaf
  /// starts again as ordinary. Where the run has to end meanwhile the rest stays with the parent. Threads: different parents at
  /// once.
  void hand_down(RefineContext<D>& context, Node parent, double most_radius, std::uint64_t generation);

 private:
  const Orthtree<D>* tree_;
  std::vector<std::unique_ptr<LeafWork<D>>> works_;
};

extern template class LeafWorks<2>;
extern template class LeafWorks<3>;

}  // namespace pgdr::detail
