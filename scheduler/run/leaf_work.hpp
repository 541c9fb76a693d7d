// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The work of each leaf of the tree: what waits there, and how it moves to the children when the leaf splits. One thread at a
// time, except that during a generation a visit uses the work of the leaves that it has claimed.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <vector>

#include "refine/refiner.hpp"
#include "tree/orthtree.hpp"

namespace pgdr::detail {

/// The orders of claims for what was set aside: BUF^2, BUF^4; then the whole tree, which is nobody's leaf.
inline constexpr std::array<std::uint32_t, 2> set_aside_orders{2, 4};

/// The work of one leaf.
template <int D>
struct LeafWork {
  WorkList<D> list;
  std::vector<std::vector<Entry<D>>> inbox;  ///< from visits of other leaves, in their order; not looked at yet
  std::array<std::vector<Entry<D>>, set_aside_orders.size()> set_aside;
  std::uint64_t since = 0;  ///< generation in which the list last became non-empty
  std::array<std::uint64_t, set_aside_orders.size()> set_aside_since{};
  /// Generation in which a visit that had claimed it last changed the mesh; of inner nodes, see pass_up_changes.
  std::uint64_t changed = 0;
  /// Claims with which something was refused here, one for each order, as they were first: later ones lie within, as
  /// leaves split.
  std::map<std::uint32_t, std::vector<std::uint32_t>> zones;

  bool has_list() const { return !list.empty() || !inbox.empty(); }
  /// Moves the inbox into the list.
  void open_inbox() {
    for (const auto& batch : inbox)
      for (const Entry<D>& e : batch) list.push(e);
    std::vector<std::vector<Entry<D>>>().swap(inbox);
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
  /// Makes each node know of changes in any of its parts. Until then leaves alone do.
  void pass_up_changes();
  /// Hands all that waits at a node that was split to its children, by the places of the cells
  /// (RefineContext::place_of). What was set aside starts again as ordinary. Threads: different parents at once.
  void hand_down(const RefineContext<D>& context, Node parent, std::uint64_t generation);

 private:
  const Orthtree<D>* tree_;
  std::vector<std::unique_ptr<LeafWork<D>>> works_;
};

extern template class LeafWorks<2>;
extern template class LeafWorks<3>;

}  // namespace pgdr::detail
