// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The cells that are needed between entities that are near. Let two parallel facets be d apart, and p a vertex on one of them.
// The subfacet of the other that p is above is not encroached upon. With w_i the barycentric coordinates of p's foot there, c
// its circumcentre and R its radius, sum w_i |foot - v_i|^2 = R^2 - |foot - c|^2 <= d^2: so one of its vertices is within sqrt 2
// d of p. A cell with such an edge has a circumradius of up to r = sqrt 2 B d, with B the bound on radius over edge, and so has
// a subfacet of it: its area is up to 3/4 sqrt 3 r^2 (2D: its length up to 2 r). Facets that are not quite parallel are as far
// apart as at the other end of such a subfacet.
#pragma once

#include "diagnose/meshed_space.hpp"
#include "diagnose/near_pieces.hpp"
#include "pgdr/estimate.hpp"

namespace pgdr::detail {

/// Looks at some hundred places on the pieces, spread evenly over their area (length). Sets `at_least` and `most_due_to`.
template <int D>
void add_cells_between(const NearPieces<D>& pieces, const MeshedSpace<D>& space, double radius_edge_bound, const Bulk& bulk,
                       CellEstimate<D>& estimate);

/// May `at_least` be more than so many cells? Each of the same places has no more than its part of them, unless something that
/// its entity has no point in common with is nearer to it than a width that follows; whatever is between the two. So no tree is
/// needed, nor what is meshed: each piece is compared with the places about it.
template <int D>
bool may_take_more_cells_between(const NearPieces<D>& pieces, double radius_edge_bound, double cells, const Bulk& bulk);

}  // namespace pgdr::detail
