// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// A joint: an edge of just two triangles, over which their facets may become one.
#pragma once

#include <array>
#include <span>

#include "build/plane_meetings.hpp"
#include "join/build_input.hpp"
#include "join/edge_uses.hpp"
#include "join/facet_triangles.hpp"

namespace pgdr::detail {

/// Questions to edges of the triangles of facets, as they are now; `uses` are all those of one edge.
class Joints {
 public:
  Joints(const BuildInput<3>& in, const FacetTriangles& faces) : in_(in), faces_(faces) {}

  /// Two triangles, of one facet or of facets with equal markers, and nothing but the polygons of these?
  bool is_joint(std::span<const EdgeUse> uses) const;
  /// Is it a joint inside one facet, or between two that are coplanar there, exactly or within the width?
  bool is_soft(std::span<const EdgeUse> uses, const PlaneWidth& width) const;
  /// Are the triangles of a joint on different sides of its edge, in this projection?
  bool opens(std::span<const EdgeUse> joint, int axis) const;
  /// Are both of planar facets, and exactly coplanar?
  bool is_flat(std::span<const EdgeUse> joint) const;
  /// The ends of a joint's edge, and the corners opposite it.
  std::array<Point3, 4> corners(std::span<const EdgeUse> joint) const;

 private:
  const BuildInput<3>& in_;
  const FacetTriangles& faces_;
};

}  // namespace pgdr::detail
