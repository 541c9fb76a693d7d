// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The planar triangulation of a facet of a Domain.
#include "detail/planar_cdt.hpp"
#include "pgdr/domain.hpp"

namespace pgdr::detail {

PlanarResult triangulate_facet(const Domain<3>& domain, std::uint32_t f, PlanarTriangulation& out) {
  std::vector<PlanarEdge> edges;
  for (const EntityId s : domain.facet_segments(f)) edges.push_back(domain.segments()[s].points);
  const PlanarResult result = out.build(domain.points(), domain.facet_points(f), edges, domain.facets()[f].axis);
  if (!result) return result;
  edges.clear();
  for (const auto& [a, b, c] : domain.triangles(f)) edges.insert(edges.end(), {{a, b}, {b, c}, {c, a}});
  out.keep_left_of(edges);
  return result;
}

}  // namespace pgdr::detail
