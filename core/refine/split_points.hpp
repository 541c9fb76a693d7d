// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Where a subsegment or a subfacet is split: points on the input entity, computed from it and rounded once. Pure functions of
// the mesh; any thread that may read the vertices.
#pragma once

#include <array>

#include "refine/context.hpp"

namespace pgdr {

/// Where the two vertices lie on the segment, the smaller parameter first; its ends at 0 and 1.
template <int D>
std::array<double, 2> parameters_of(const RefineContext<D>& context, EntityId segment, VertexId a, VertexId b);

/// The point that splits the subsegment ab: its middle, or a point on a shell (shells.hpp).
template <int D>
Point<D> split_point(const RefineContext<D>& context, EntityId segment, VertexId a, VertexId b);

/// The point that splits the subfacet (2D: subsegment): in 3D its circumcentre, in the facet; in 2D, at the rim of the mesh,
/// rounded to the side on which that lies.
template <int D>
Point<D> split_point_of_face(const RefineContext<D>& context, CellId c, int face);

}  // namespace pgdr
