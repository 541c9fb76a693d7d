// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The cells at a Steiner vertex, and what becomes of them when another vertex takes its place: a new one at a better place on the
// same entity, or a neighbour, onto which the vertex is contracted.
//
// A vertex on a segment is contracted onto a neighbour on it, one on a facet onto one on that, so that segments and facets stay
// unions of edges and faces. Subfacets at the vertex may not turn over in the facet's projection.
#pragma once

#include <cstddef>
#include <vector>

#include "change/edge_ring.hpp"
#include "change/replacement.hpp"

namespace pgdr {

/// See above. Plain data, to be used again.
struct VertexStar {
  VertexId vertex{};
  Home home;                  ///< of the vertex
  std::vector<CellId> cells;  ///< all at the vertex
  std::vector<int> corners;   ///< its number in each
};

/// Collects the star of a vertex of c, of at most `most_cells`. Stays: the vertex is one of the input, lies on a pinched edge, or
/// has too many cells. @pre the visit owns c
Reach collect_star(Mesh<3>& mesh, const VisitArea<3>* area, VertexId v, CellId c, std::size_t most_cells, VertexStar& star);

/// The neighbours onto which the vertex may be contracted, each once, in the order of the cells.
std::vector<VertexId> contraction_targets(const Mesh<3>& mesh, const VertexStar& star);

/// The replacement that puts `by`, a new vertex on the same entity or a neighbour, in the place of the vertex. False if a
/// subfacet would turn over, or if constrained faces or subsegments would fall together. Cells may be turned over: whoever judges
/// the replacement tells.
bool substitute(const Mesh<3>& mesh, const Domain<3>& domain, const VertexStar& star, VertexId by, Replacement<3>& r);

}  // namespace pgdr
