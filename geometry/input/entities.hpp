// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// What the mesher alone asks of the entities of a Domain. Pure functions, any thread.
#pragma once

#include <algorithm>
#include <limits>

#include "pgdr/domain.hpp"
#include "space/distances.hpp"

namespace pgdr {

/// The parameter t of a point on (near) segment s, in [0, 1].
template <int D>
double segment_parameter(const Domain<D>& domain, EntityId s, const Point<D>& p);

/// True iff both are segments or facets (or an input vertex of one) with a common input vertex.
template <int D>
bool entities_touch(const Domain<D>& domain, EntityRef a, EntityRef b);

/// The squared distance of x from a segment or a facet, in doubles. @pre it is one of these
template <int D>
double squared_distance_to(const Domain<D>& domain, EntityRef entity, const Point<D>& x) {
  const auto points = domain.points();
  if (entity.kind == EntityKind::segment) {
    const auto& ends = domain.segments()[entity.id].points;
    return detail::closest_to_edge(x, points[ends[0]], points[ends[1]]).square;
  }
  double least = std::numeric_limits<double>::infinity();
  if constexpr (D == 3)
    for (const auto& t : domain.triangles(entity.id))
      least = std::min(least, detail::closest_to_triangle(x, points[t[0]], points[t[1]], points[t[2]]).square);
  return least;
}

}  // namespace pgdr
