// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Boundary recovery: makes every segment and facet of the domain a union of edges and faces of the triangulation, and
// marks them. The rest of the project knows `recover_boundary` alone, so that another front end can take its place.
//
// 2D: without any Steiner point; what comes out is the constrained Delaunay triangulation (boundary/segment_insertion.hpp).
// 3D: by Steiner points on segments and facets; what comes out is conforming Delaunay. Segments (after Shewchuk; Si): a
// missing subsegment is split at its middle, but next to an end where another segment makes an angle below 60 degrees on a
// sphere about that end whose radius is a power of two, so that points of neighbouring segments meet on common spheres.
// Facets: each keeps the constrained Delaunay triangulation of its points in its plane; a triangle that is no face of the
// mesh gets a point at its circumcentre, unless that encroaches upon a subsegment of the facet, which is split instead.
//
// Where no angle between segments or facets is below 60 degrees, triangles over twice the radius-edge bound (of two at least)
// are then split likewise; where angles between segments are at least 20 degrees, those of strips, over eight times the bound,
// as thin plates and walls have them. All faces of a tetrahedron within the bound are within it, so that the refinement would
// have to; but its cavities are hidden by the facets, and at long strips side by side, all of whose segments are encroached,
// they are cut back until the facets are not Delaunay in their planes any more, which nothing mends. Here no cavity is. Such a
// point keeps the length of the triangle's shortest edge from all others: of themselves these points never make the least
// distance smaller, so that there is room for finitely many. A point for a face that goes missing between them may be nearer;
// that is the recovery above, which is counted and limited more closely from then on: past that it throws. Serial.
#pragma once

#include <cstdint>

#include "cavity/delaunay.hpp"
#include "pgdr/domain.hpp"
#include "pgdr/refine_options.hpp"

namespace pgdr {

/// What the boundary recovery did.
struct RecoveryCounts {
  std::uint64_t segment_points = 0;  ///< Steiner points on segments
  std::uint64_t facet_points = 0;    ///< Steiner points on facets
  std::uint64_t improving = 0;       ///< of both, those of poor triangles
  std::uint64_t rounds = 0;          ///< over all that was missing
};

/// @pre `delaunay` has built the triangulation of domain.points(), in that order.
/// @throws InputError boundary_not_recovered, entities_intersect, with the entities' ids and coordinates.
/// @returns a StopCause other than finished if options.max_vertices, the time limit or the stop token ended it early; the
///   mesh is then without marks.
template <int D>
StopCause recover_boundary(Mesh<D>& mesh, typename Mesh<D>::Pools& pools, Delaunay<D>& delaunay,
                           const Domain<D>& domain, const RefineOptions<D>& options,
                           std::chrono::steady_clock::time_point start, RecoveryCounts& counts);

}  // namespace pgdr
