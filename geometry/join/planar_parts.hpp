// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// How far a polygon is from planar, and its planar parts. A polygon that rounding has bent stays one facet. One that is bent by
// more is no facet that could be refined in a plane: where its triangles meet at a fold its mesh would cut across, and what is
// apart in space may touch in the projection. So it becomes its planar parts, with segments along the folds.
#pragma once

#include <span>

#include "input/triangle_shapes.hpp"
#include "join/clean_facet.hpp"
#include "join/facet_triangles.hpp"

namespace pgdr::detail {

/// Sets `planar` and `defect` of a facet, whose triangles are the last ones of `faces`.
void measure_planarity(TriangulatedFacet& facet, const CleanFacet& clean, std::span<const Point3> points,
                       const TriangleShapes& shapes, const FacetTriangles& faces);
/// Appends the planar parts of a facet, in whose place they are; its triangles are the last ones of `faces`.
void add_planar_parts(const TriangulatedFacet& whole, const CleanFacet& clean, std::span<const Point3> points,
                      const TriangleShapes& shapes, FacetTriangles& faces);

}  // namespace pgdr::detail
