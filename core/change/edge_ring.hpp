// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The cells round an edge, in order, with what is constrained there.
#pragma once

#include <array>
#include <cstddef>
#include <utility>
#include <vector>

#include "mesh/mesh.hpp"
#include "mesh/visit_area.hpp"

namespace pgdr {

/// Could the cells about something be collected? Stays: there are too many, or it may not change. Not owned: to go on would need
/// cells that the visit does not own.
enum class Reach { ok, stays, not_owned };

/// See above. Plain data, to be used again.
struct EdgeRing {
  /// (ends[0], ends[1], vertices[i], vertices[i + 1]) are positively oriented.
  std::array<VertexId, 2> ends;
  std::vector<VertexId> vertices;  ///< as many as cells where it is closed, one more where it is open, at the hull
  std::vector<EntityId> walls;     ///< of each vertex: the facet of its face with the edge, or no_entity
  std::vector<CellId> cells;       ///< the i-th has the i-th and the next vertex
  bool closed = false;             ///< does it go round?
  EntityId segment = no_entity;    ///< that the edge is part of, if any

  std::vector<std::size_t> constrained() const;  ///< at which of the vertices the face with the edge is a subfacet
  VertexId vertex(std::size_t i) const { return vertices[i % vertices.size()]; }  ///< the i-th, going round
  CellId cell(std::size_t i) const { return cells[i % cells.size()]; }            ///< the i-th, going round
};

/// Collects the ring of an edge of c, of at most `longest` cells. @pre the visit owns c
Reach collect_ring(const Mesh<3>& mesh, const VisitArea<3>* area, CellId c, int edge, std::size_t longest, EdgeRing& ring);

/// The part of a ring on one side of a facet in which the edge lies, or all of it: cells [first, first + count), going round.
struct RingSide {
  std::size_t first;
  std::size_t count;
};
/// The sides of the ring if the edge could be done without: one, the whole ring, where no face at it is constrained; else those
/// between its two subfacets of one facet. None where the edge has to stay.
std::vector<RingSide> sides_without_edge(const Mesh<3>& mesh, const Domain<3>& domain, const EdgeRing& ring);

}  // namespace pgdr
