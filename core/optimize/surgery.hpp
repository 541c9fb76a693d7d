// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// What the operations of the optimiser share: the worker's workspace, the judge, and the way into the mesh.
#pragma once

#include <cstdint>

#include "change/edge_ring.hpp"
#include "change/replacement.hpp"
#include "change/transaction.hpp"
#include "optimize/judge.hpp"
#include "refine/workspace.hpp"

namespace pgdr {

/// See above. Part of a worker: one thread at a time.
struct Surgery {
  Surgery(Workspace<3>& workspace, double min_dihedral)
      : w(&workspace),
        mesh(&workspace.mesh),
        domain(&workspace.domain),
        judge(workspace, min_dihedral),
        replacer(workspace.mesh),
        transaction(workspace.mesh, replacer) {}
  Surgery(const Surgery&) = delete;
  Surgery& operator=(const Surgery&) = delete;

  const VisitArea<3>* area() const { return w->visit->area; }              ///< of the visit; null: everything
  bool owns(CellId c) const { return !area() || area()->owns(*mesh, c); }  ///< may the visit change the cell?
  bool owns(const Point3& p) const { return !area() || area()->owns(p); }  ///< may the visit have a vertex there?
  /// Notes that cells were out of reach; then the element may be treated by a visit with a larger claim.
  Reach note(Reach reach) {
    out_of_reach = out_of_reach || reach == Reach::not_owned;
    return reach;
  }
  /// A vertex that no cell has yet.
  VertexId new_vertex(const Point3& p, Home home) { return mesh->new_vertex(w->pools, p, home, 0.f); }
  /// Takes back a vertex that no cell ever had. The last one first.
  void drop_vertex(VertexId v) { w->pools.vertices.give(index(v)); }
  /// Makes a replacement that the judge has accepted, unless that is to be kept and is not better by the size at each cell.
  bool commit(const Replacement<3>& r) {
    if (!transaction.is_on() && !judge.is_better_by_own_sizes(r)) return false;
    transaction.commit(w->pools, r);
    if (!transaction.is_on()) judge.learn_made(r, replacer.new_cells());
    return true;
  }

  Workspace<3>* w;
  Mesh<3>* mesh;
  const Domain<3>* domain;
  Judge judge;
  Replacer<3> replacer;
  Transaction transaction;
  bool out_of_reach = false;  ///< of the element that is treated: were cells out of reach?
};

}  // namespace pgdr
