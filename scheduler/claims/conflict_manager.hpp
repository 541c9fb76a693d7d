// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Puts the visits of a generation in their total order, gives each its claim, and makes those wait for each other whose
// claims meet. A function of the tree's boxes and of the requests: not of threads, nor of the order in which
// requests are listed or leaves were split. Threads: one at a time.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "claims/claim.hpp"
#include "graph/visit_graph.hpp"
#include "tree/orthtree.hpp"

namespace pgdr {

/// A leaf that has work.
struct VisitRequest {
  std::uint32_t leaf = 0;  ///< node of the tree
  /// 1 for an ordinary visit; 2, 4, ... for one that treats what was set aside, with the claim {L} + BUF^order(L);
  /// `whole_tree` for one that claims every leaf.
  std::uint32_t order = 1;
  /// The generation in which the leaf's list (of that order) last became non-empty.
  std::uint64_t generation = 0;
};

/// A visit that is to run.
template <int D>
struct Visit {
  VisitRequest request;                            ///< that it answers
  std::uint32_t claim_order;                       ///< it holds its leaf and BUF^claim_order of it meanwhile
  std::vector<typename Orthtree<D>::Node> leaves;  ///< these, sorted; none: the whole tree

  /// The claim of these leaves. It is made when the visit runs, as that takes longer than to plan it.
  Claim<D> claim(const Orthtree<D>& tree) const { return Claim<D>::of_leaves(tree, request.leaf, leaves, claim_order); }
};

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

  /// Claims of ordinary visits are {L} + BUF^ordinary_order(L): 1 keeps the leaves that run at once BUF^2-apart, 2 is
  /// stricter. The tree must outlive the manager; it may be split between calls of `plan`.
  explicit ConflictManager(const Orthtree<D>& tree, std::uint32_t ordinary_order = 1);

  /// Total order: claims of lower order first, whole trees last; then larger leaves; older generations; colour, so that
  /// visits next to each other in the order tend not to conflict; Morton order.
  /// A leaf may be asked for once per order. @throws ResourceError internal otherwise, or if it is no leaf
  Generation<D> plan(std::span<const VisitRequest> requests);

  /// The visit that `plan` makes of the request.
  Visit<D> visit_of(const VisitRequest& r);
  /// BUF(leaf), sorted, from the cache. Valid until the next call of a member.
  const std::vector<Node>& buffer(Node leaf);
  /// Is BUF(leaf) not in the cache, or may a split have changed it?
  bool is_stale(Node leaf);
  /// Brings BUF(leaf) in the cache up to date. Threads: different leaves at once. @pre is_stale(leaf)
  void renew(Node leaf);

 private:
  struct Cached {
    std::vector<Node> zone;
    Node node_count = 0;  // of the tree when the zone was last found to hold; 0 = never computed
  };
  std::uint32_t claim_order(const VisitRequest& r) const { return r.order == 1 ? ordinary_order_ : r.order; }
  std::vector<VisitRequest> in_order(std::span<const VisitRequest> requests) const;

  const Orthtree<D>* tree_;
  std::uint32_t ordinary_order_;
  std::vector<Cached> cache_;           // by node
  std::vector<std::uint64_t> reached_;  // by node: the last search that came by
  std::uint64_t search_ = 0;
};

extern template class ConflictManager<2>;
extern template class ConflictManager<3>;

}  // namespace pgdr
