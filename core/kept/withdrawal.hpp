// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Takes the points that the recovery has put onto kept entities off them again, one after the other, those on facets first, the
// last one first. Without the vertex v the polygons of its fans of subfacets are triangulated anew, and each sector between them
// (kept/vertex_parts.hpp) is filled with cells of its own vertices. A sector that cannot be grows by cells beside it; at last it
// gets a point inside, and grows by what hides its faces from that, so that the point may be far from v.
//
// Why a point inside always does it, in exact numbers. The cells at v are positive: v sees each face opposite it strictly from
// inside. So does any point near enough to v. The new triangles of the fans lie in the planes of these, on whose inner side v' =
// v + eps d is for each eps > 0, as d is strictly inside of all their half-spaces: so v' sees them, too. Cells from v' to all
// faces are positive, and their boundary is that of the sector: they fill it (change/replacement.hpp). There is such a d but
// where a sector is on both sides of one fan, at the rim of a sheet, where several points do it (kept/rim_filling.hpp), or has no
// fan, at a segment of no facet. In doubles there may be no such v'; then v stays, and is counted.
//
// Points inside go again where the cells about them, or some more, can be filled without. Nothing here depends on threads.
#pragma once

#include <cstdint>
#include <stop_token>

#include "mesh/mesh.hpp"
#include "rule/kept_entities.hpp"

namespace pgdr {

/// What became of the points.
struct WithdrawalCounts {
  std::uint64_t on_segments = 0, on_facets = 0;            ///< on kept entities at first
  std::uint64_t left_on_segments = 0, left_on_facets = 0;  ///< of these, in the end
  std::uint64_t inside = 0;                                ///< points inside that have taken their place
};

/// Takes them off. @pre the boundary is marked, and what is not meshed is gone. One thread. Ends early, with points left, once
/// `stop` is requested.
WithdrawalCounts withdraw_points(Mesh<3>& mesh, Mesh<3>::Pools& pools, const Domain<3>& domain, const KeptEntities<3>& kept,
                                 const std::stop_token& stop);

}  // namespace pgdr
