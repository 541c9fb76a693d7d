// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Tests of flips within a facet: may the edge between two of its subfacets be flipped? Exact, in the facet's projection. Also
// tests of what is flat but for rounding. Pure functions; any thread that may read the vertices.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "mesh/mesh.hpp"

namespace pgdr {

/// Do the three lie on one input segment, on a line therefore, whatever rounding made of it? (Not asked of input vertices alone.)
template <int D>
bool lie_in_line(const Mesh<D>& mesh, const Domain<D>& domain, const std::array<VertexId, 3>& vertices);

/// Do the edge and the edge between the tips (the far corners of the two subfacets at it) cross? Three in line have no sides.
template <int D>
bool crosses_in_facet(const Mesh<D>& mesh, const Domain<D>& domain, EntityId facet, std::array<VertexId, 2> edge,
                      std::array<VertexId, 2> tips);

/// The facets that the constrained faces of the cells are part of, each once.
std::vector<EntityId> facets_at(const Mesh<3>& mesh, std::span<const CellId> cells);
/// Do all four lie on one of the facets, so that a cell with these corners has a volume by rounding alone?
bool lie_on_one(const Domain<3>& domain, const std::array<Home, 4>& homes, std::span<const EntityId> facets);

}  // namespace pgdr
