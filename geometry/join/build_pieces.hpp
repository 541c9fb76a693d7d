// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The pieces of a Domain in the making.
#pragma once

#include <span>
#include <vector>

#include "join/build_input.hpp"
#include "join/facet_triangulator.hpp"
#include "space/contact.hpp"

namespace pgdr::detail {

/// Triangles, then edges that no triangle has, then points of neither. Indexes the facets of triangles.
template <int D>
std::vector<Piece> pieces_of(const BuildInput<D>& in, FacetTriangles& faces, std::span<const OwnedEdge> segment_edges,
                             std::span<const FlatFacet> flat = {});

}  // namespace pgdr::detail
