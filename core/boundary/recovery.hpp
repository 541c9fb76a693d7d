// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Boundary recovery: makes every segment and facet of the domain a union of edges and faces of the triangulation, and marks them.
// The rest of the project knows `recover_boundary` alone, so that another method can take its place. Serial.
//
// 2D: no Steiner point is needed. The result is the constrained Delaunay triangulation (boundary/segment_insertion.hpp).
//
// 3D: Steiner points on segments and facets. The result is conforming Delaunay.
//   * Segments (after Shewchuk; Si). A missing subsegment is split at its middle. Next to an end where another segment makes an
//     angle below 60 degrees it is split on a shell about that end, so that points of neighbouring segments meet on common
//     spheres.
//   * Facets. Each keeps the constrained Delaunay triangulation of its points in its plane. A triangle that is no face of the
//     mesh gets a point at its circumcentre. If that encroaches upon a subsegment of the facet, this is split instead.
//
// Where the boundary is kept, diagonals of rectangles and the like are made by flips in the end (boundary/square_flips.hpp).
//
// Early splits, once nothing is missing. Where facets meet at 60 degrees or more, and segments at 20 or more, triangles over
// twice the radius-edge bound (of two at least) are split in the same way.
//   * Why here: the refinement would have to split them anyway, since all faces of a tetrahedron within the bound are within it.
//     But its cavities are hidden by the facets. At long strips side by side, all of whose segments are encroached, cavities are
//     cut back until the facets are not Delaunay in their planes any more, which nothing repairs. Here no cavity is cut back.
//   * Why it ends: such a point keeps the length of the triangle's shortest edge from all others. So these points never make the
//     least distance smaller by themselves, and there is room for finitely many. A point for a face that goes missing between
//     them may be nearer. Such points are limited more closely from then on, and past that limit the recovery throws.
#pragma once

#include <cstdint>

#include "cavity/delaunay.hpp"
#include "pgdr/domain.hpp"
#include "pgdr/refine_options.hpp"
#include "space/pieces.hpp"

namespace pgdr {

/// What the boundary recovery did.
struct RecoveryCounts {
  std::uint64_t segment_points = 0;  ///< Steiner points on segments
  std::uint64_t facet_points = 0;    ///< Steiner points on facets
  std::uint64_t improving = 0;       ///< of both, those of early splits
  std::uint64_t rounds = 0;          ///< passes over all that was missing
};

/// Recovers and marks the boundary. `pieces` run what can go side by side: all but the insertion of points (in 3D) and the
/// forcing of segments (in 2D), which are few where the input is fine. The result does not depend on them.
/// @pre `delaunay` has built the triangulation of domain.points(), in that order.
/// @throws InputError boundary_not_recovered, entities_intersect, with the entities' ids and coordinates.
/// @returns a StopCause other than finished if options.max_vertices, the time limit or the stop token ended it early; the
///   mesh is then without marks.
template <int D>
StopCause recover_boundary(Mesh<D>& mesh, typename Mesh<D>::Pools& pools, Delaunay<D>& delaunay, const Domain<D>& domain,
                           const RefineOptions<D>& options, std::chrono::steady_clock::time_point start, RecoveryCounts& counts,
                           const detail::Pieces& pieces = detail::OneByOne());

}  // namespace pgdr
