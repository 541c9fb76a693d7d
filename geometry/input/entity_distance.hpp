// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The distance of a point from an input entity, in doubles: which seeds lie on a facet, which points beside a segment, which
// entity a poor cell is near. Pure functions, any thread.
#pragma once

#include <algorithm>
#include <limits>

#include "numbers/vectors.hpp"
#include "pgdr/domain.hpp"

namespace pgdr::detail {

/// The squared distance of x from the edge ab.
template <int D>
double squared_distance_to_edge(const Point<D>& a, const Point<D>& b, const Point<D>& x) {
  double along = 0, length = 0;
  for (int i = 0; i < D; ++i) {
    along += (x[i] - a[i]) * (b[i] - a[i]);
    length += (b[i] - a[i]) * (b[i] - a[i]);
  }
  const double t = length > 0 ? std::clamp(along / length, 0.0, 1.0) : 0.0;
  Point<D> foot;
  for (int i = 0; i < D; ++i) foot[i] = a[i] + t * (b[i] - a[i]);
  return squared_distance(foot, x);
}

/// The squared distance of x from the triangle abc.
inline double squared_distance_to_triangle(const Point3& a, const Point3& b, const Point3& c, const Point3& x) {
  const double edges = std::min(
      {squared_distance_to_edge(a, b, x), squared_distance_to_edge(b, c, x), squared_distance_to_edge(c, a, x)});
  const auto normal = cross(difference(b, a), difference(c, a));
  const bool above = dot(cross(difference(b, a), difference(x, a)), normal) >= 0 &&
                     dot(cross(difference(c, b), difference(x, b)), normal) >= 0 &&
                     dot(cross(difference(a, c), difference(x, c)), normal) >= 0;
  const double square = dot(normal, normal);
  if (!above || !(square > 0)) return edges;
  const double height = dot(difference(x, a), normal);
  return std::min(edges, height * height / square);
}

/// The squared distance of x from an edge (2D) or a triangle (3D).
template <int D>
double squared_distance_to_simplex(const std::array<Point<D>, D>& s, const Point<D>& x) {
  if constexpr (D == 2)
    return squared_distance_to_edge<2>(s[0], s[1], x);
  else
    return squared_distance_to_triangle(s[0], s[1], s[2], x);
}

/// The squared distance of x from a segment or a facet. @pre it is one of these
template <int D>
double squared_distance_to(const Domain<D>& domain, EntityRef entity, const Point<D>& x) {
  const auto points = domain.points();
  if (entity.kind == EntityKind::segment) {
    const auto& ends = domain.segments()[entity.id].points;
    return squared_distance_to_edge<D>(points[ends[0]], points[ends[1]], x);
  }
  double least = std::numeric_limits<double>::infinity();
  if constexpr (D == 3)
    for (const auto& t : domain.triangles(entity.id))
      least = std::min(least, squared_distance_to_triangle(points[t[0]], points[t[1]], points[t[2]], x));
  return least;
}

}  // namespace pgdr::detail
