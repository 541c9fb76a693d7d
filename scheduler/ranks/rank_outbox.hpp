// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Elements that the visits of a phase found for other nodes, on their way to the ranks that visit these. One thread.
#pragma once

#include <cstdint>
#include <vector>

#include "ranks/held_mesh.hpp"
#include "ranks/late_work.hpp"
#include "ranks/territory.hpp"
#include "refine/node_visit.hpp"
#include "visits/waiting_work.hpp"

namespace pgdr::detail {

/// See above.
template <int D>
class RankOutbox {
 public:
  using Node = typename Orthtree<D>::Node;

  /// All must outlive it.
  RankOutbox(const Orthtree<D>& tree, const Territory<D>& territory, const Mesh<D>& mesh)
      : tree_(&tree), territory_(&territory), mesh_(&mesh), there_(territory.neighbours().size()) {}

  /// Takes what is in the outboxes of a visit of this node: for nodes of this rank, of its neighbours, and, to be kept, of none.
  /// @throws ResourceError internal: for a node of another rank, which would be too far away
  void take(Node visited, std::uint64_t phase, NodeVisit<D>& visit, LateWork<D>& late);
  /// Writes what is for this neighbour.
  void put(MessageWriter& message, std::size_t neighbour) const;
  /// Adds what a neighbour wrote. @throws ResourceError internal: there is no such node or cell here
  void get(MessageReader& message, const HeldMesh<D>& held);
  /// Posts what is for nodes of this rank, in the order of the visits.
  void post(WaitingWork<D>& waiting);

 private:
  struct Letter {
    std::uint64_t visit;  ///< by its Morton number, which orders the visits of a phase
    Node node;
    std::vector<Entry<D>> entries;
  };

  const Orthtree<D>* tree_;
  const Territory<D>* territory_;
  const Mesh<D>* mesh_;
  std::vector<Letter> here_;
  std::vector<std::vector<Letter>> there_;  ///< by neighbour
};

extern template class RankOutbox<2>;
extern template class RankOutbox<3>;

}  // namespace pgdr::detail
