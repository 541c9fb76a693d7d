// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Puts the visits of a generation in their total order, gives each its claim, and makes those wait for each other whose
// claims meet. A function of the tree's boxes and of the requests: not of threads, nor of the order in which
// requests are listed or leaves were split. Threads: one at a time.
//
// What is claimed is a policy (ClaimRule). In a uniform tree both claim the same: the box of a leaf, grown by its side, is {L} +
// BUF(L). Beside a coarser leaf the box takes a part of it alone. The theory of buffer zones, that insertions in leaves
// BUF^2-apart are independent, says nothing of parts of leaves; disjoint claims are safe whatever it says (claim.hpp), and an
// insertion that reaches farther is set aside.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "claims/claim.hpp"
#include "graph/visit_graph.hpp"
#include "pgdr/refine_options.hpp"
#include "tree/orthtree.hpp"

namespace pgdr {

/// A node that has work.
struct VisitRequest {
  std::uint32_t node = 0;  ///< of the tree: a leaf, unless boxes are claimed, or all of space
  /// 1 for an ordinary visit; larger for one that treats what was set aside: by the rule of boxes 2, for a node above the one
  /// whose visit it was; by that of leaves 2, 4, ... with the claim {L} + BUF^order(L). `whole_tree` for one that claims all.
  std::uint32_t order = 1;
  /// The generation in which the node's list (of that order) last became non-empty.
  std::uint64_t generation = 0;
};

/// A visit that is to run.
template <int D>
struct Visit {
  VisitRequest request;                              ///< that it answers
  ClaimRule rule = ClaimRule::boxes;                 ///< what the claim is, if it is not all of space:
  GridBox<D> box{};                                  ///< boxes: this one
  std::vector<typename Orthtree<D>::Node> leaves{};  ///< leaves: these, sorted ...
  std::uint32_t claim_order = 1;                     ///< ... the leaf and BUF^claim_order of it

  /// Does it claim all of space?
  bool whole() const { return request.order == whole_tree; }
  /// It is made when the visit runs, as that takes longer than to plan it.
  Claim<D> claim(const Orthtree<D>& tree) const;
};

/// Have the claims of visits of one plan a point in common?
template <int D>
bool meet(const Visit<D>& a, const Visit<D>& b);

/// Visits in their total order: the number of a visit in `graph` is its index.
template <int D>
struct Generation {
  std::vector<Visit<D>> visits;  ///< in their order
  VisitGraph graph;              ///< which waits for which
};

/// Orders visits so that those whose claims meet run one after the other. One thread.
template <int D>
class ConflictManager {
 public:
  using Node = typename Orthtree<D>::Node;  ///< of the tree

  /// Claims of ordinary visits are, for boxes, the leaf's box grown by `ordinary_order` times its side; for leaves, {L} +
  /// BUF^ordinary_order(L). 1 keeps the leaves that run at once BUF^2-apart in a uniform tree, 2 is stricter. The tree must
  /// outlive the manager; it may be split between calls of `plan`.
  explicit ConflictManager(const Orthtree<D>& tree, ClaimRule rule = ClaimRule::boxes, std::uint32_t ordinary_order = 1);

  /// Total order: claims of lower order first, whole trees last; then larger nodes, but of those that come late, and by the rule
  /// of boxes of what was set aside, the smaller ones; older generations; colour, so that visits next to each other in the order
  /// tend not to conflict; Morton order. A node may be asked for once per order. @throws ResourceError internal otherwise, or if
  /// it cannot be visited
  Generation<D> plan(std::span<const VisitRequest> requests);

  /// The visit that `plan` makes of the request.
  Visit<D> visit_of(const VisitRequest& r);
  /// Brings BUF of the leaf up to date, where a split may have changed it. Threads: different leaves at once, after make_room().
  void renew(Node leaf);
  /// Room for the zones of all leaves of the tree.
  void make_room();

 private:
  struct Cached {
    std::vector<Node> zone;
    Node node_count = 0;  // of the tree when the zone was last found to hold; 0 = never computed
  };
  std::uint32_t claim_order(const VisitRequest& r) const;
  std::vector<VisitRequest> in_order(std::span<const VisitRequest> requests) const;
  void require_sound(std::span<const VisitRequest> requests) const;
  std::vector<Node> zone_of(Node leaf, std::uint32_t order);

  const Orthtree<D>* tree_;
  ClaimRule rule_;
  std::uint32_t ordinary_order_;
  // Of the rule of leaves:
  std::vector<Cached> cache_;           // by node
  std::vector<std::uint64_t> reached_;  // by node: the last search that came by
  std::uint64_t search_ = 0;
};

extern template class ConflictManager<2>;
extern template class ConflictManager<3>;

}  // namespace pgdr
