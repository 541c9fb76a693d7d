// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Corners of the input at which no mesh meets the radius-edge bound. Where two segments of one facet (2D: any two) meet at an
// angle a with sin a < 1 / (2 bound), some subfacet at their common vertex lies between them. Its angle there is at most
// a and the edge opposite e, so that its circumradius is at least e / (2 sin a) > bound * e, while its shortest edge is at
// most e; the circumradius of a cell with that face is no smaller, its shortest edge no longer. So every mesh that keeps the
// facet has such a cell at each such corner, on each side of the facet that is in the domain.
#pragma once

#include <cstdint>
#include <span>

#include "mesh/mesh.hpp"
#include "space/bulk.hpp"

namespace pgdr {

/// How many of the cells, all alive, have a subfacet (2D: an angle) in such a corner, so that they cannot but be over the bound.
/// Takes time proportional to the segments, times the logarithm of how many there are at corners of the cells. Any thread that
/// may read the mesh.
template <int D>
std::uint64_t count_in_sharp_corners(const Mesh<D>& mesh, const Domain<D>& domain, double radius_edge_bound,
                                     std::span<const CellId> cells, const detail::Bulk& bulk);

}  // namespace pgdr
