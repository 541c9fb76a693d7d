// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Changes of the vertices of a poor cell: each Steiner vertex may get a better place on its own entity, or be contracted onto a
// neighbour.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "optimize/placement.hpp"
#include "optimize/surgery.hpp"
#include "optimize/vertex_star.hpp"

namespace pgdr {

/// See above. Part of a worker: one thread at a time.
class VertexChanges {
 public:
  explicit VertexChanges(Surgery& surgery) : s_(&surgery) {}  ///< it must outlive this

  /// Moves the first corner of the cell for which the judge accepts a better place. True if one was moved.
  bool move(CellId c, Judge::Rule rule);
  /// Contracts a corner of the cell, or a vertex beyond one of its faces, onto a neighbour, as leaves the least bad cells of what
  /// the judge accepts. True if one was.
  bool contract(CellId c, Judge::Rule rule);

 private:
  std::vector<std::pair<VertexId, CellId>> vertices_about(CellId c);
  bool move_vertex(CellId c, VertexId v, Judge::Rule rule);

  Surgery* s_;
  Placement placement_;
  Star points_;
  VertexStar star_;
  Replacement<3> tried_, best_;
};

/// Sets where a vertex with this home may go: freedom, axis, and the way back onto the entity. `about`: cells at the vertex, or
/// at an edge that it splits; one of them has a subfacet of the facet.
void set_freedom(const Mesh<3>& mesh, const Domain<3>& domain, Home home, std::span<const CellId> about, Star& star);

}  // namespace pgdr
