// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The selectors that come with the library, for RefineOptions::selector (empty: the circumcentre). Each is a pure function
// of the element and of the mesh about it, by correctly rounded operations alone, and puts every point inside the element's
// disk. Meant for disks of type I: those of type II are empty at the smallest proved bound, and the centre is then all
// there is. Any thread; each call as one thread.
#pragma once

#include <cstdint>

#include "pgdr/export.hpp"
#include "pgdr/point_selector.hpp"

namespace pgdr PGDR_API {

/// The factor that off-centres are best taken with: 0.6 in 3D, as Üngör suggests; in 2D a little below one, so that rounding
/// leaves the new triangle within its bound, and 0.95 makes the smaller meshes at about 20 degrees (docs/selectors.md).
template <int D>
constexpr double default_off_center_factor() {
  return D == 2 ? 0.95 : 0.6;
}

/// Üngör's off-centres (2D: section 2.2.2; 3D: of type II, section 2.3.2): from the midpoint of the shortest edge towards
/// the circumcentre, `factor` l (b + sqrt(b^2 - 1/4)) far, b being the radius-edge bound and l the length of the edge. In
/// 2D, with factor 1, the new triangle at this edge has exactly the ratio b. The circumcentre if that is nearer; if the
/// point would lie outside the disk, as near to it as the disk allows.
/// @throws UsageError bad_option unless factor > 0
template <int D>
PointSelector<D> off_center(double factor = default_off_center_factor<D>());

/// The point that deletes the fewest good cells less poor ones, of `samples` candidates. In 2D these lie on the arc Gamma of
/// section 2.2.2: the circle through the ends of the shortest edge and the off-centre, inside the disk. In 3D they lie in
/// the disk, uniformly in spherical coordinates about its centre (section 2.3.2). Among equals the first: the off-centre,
/// then those along the arc from there (2D); the circumcentre, then outwards (3D). Candidates that encroach upon an entity
/// are taken only if all do. Costs about `samples` insertions.
/// @throws UsageError bad_option unless 1 <= samples <= 1000000
template <int D>
PointSelector<D> optimized(int samples = D == 2 ? 64 : 1000);

/// Of the circumcentre and of `candidates` points of the disk, the one whose new cells have the largest smallest (dihedral)
/// angle (after Chew 1997, and Li and Teng 2001, who draw at random; here the draw is a hash of the element's corners that
/// does not depend on the unit of length). Costs about `candidates` insertions.
/// @throws UsageError bad_option unless 1 <= candidates <= 1000000
template <int D>
PointSelector<D> sliver_avoiding(int candidates = 20);

/// A point of the disk drawn at random, uniformly (section 4.1 of the dissertation leaves such selectors to later work). The draw
/// is a hash of the seed and of the element's corners, in a unit that goes with them: the mesh is the same for any number of
/// threads, and another for another seed. The circumcentre where 64 draws from a cube about the disk miss it.
template <int D>
PointSelector<D> randomized(std::uint32_t seed = 0);

}  // namespace pgdr
