// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "join/planar_parts.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "pgdr/predicates.hpp"
#include "space/disjoint_sets.hpp"

namespace pgdr::detail {
namespace {

/// Of each triangle of the facet the least one that is reached over edges, not of the polygons, between coplanar ones. Edges
/// between others become constraints.
std::vector<std::uint32_t> find_planar_parts(const TriangulatedFacet& whole, std::span<const Point3> p, FacetTriangles& faces) {
  std::vector<std::pair<std::uint64_t, std::uint32_t>> sides;  // of an edge, 3 times the triangle plus the side
  for (std::uint32_t k = 0; k < 3 * whole.count; ++k) sides.emplace_back(faces.key_of_edge(whole.first + k / 3, k % 3), k);
  std::sort(sides.begin(), sides.end());
  DisjointSets parts(whole.count);
  for (std::size_t n = 1; n < sides.size(); ++n) {
    const std::uint32_t k = sides[n - 1].second, j = sides[n].second;
    if (sides[n - 1].first != sides[n].first || faces.is_constraint(whole.first + k / 3, k % 3)) continue;
    const PlanarTriangle& t = faces.triangles[whole.first + k / 3];
    const std::uint32_t across = faces.triangles[whole.first + j / 3][j % 3];
    if (orient3d(p[t[0]], p[t[1]], p[t[2]], p[across]) == Sign::zero) {
      parts.unite(k / 3, j / 3);
    } else {
      for (const std::uint32_t side : {k, j}) faces.masks[whole.first + side / 3] |= static_cast<std::uint8_t>(1u << side % 3);
    }
  }
  std::vector<std::uint32_t> least(whole.count);
  for (std::uint32_t k = 0; k < whole.count; ++k) least[k] = parts.find(k);
  return least;
}

}  // namespace

void measure_planarity(TriangulatedFacet& facet, const CleanFacet& clean, std::span<const Point3> points,
                       const TriangleShapes& shapes, const FacetTriangles& faces) {
  const auto area = [&](const PlanarTriangle& t) { return std::fabs(shapes.normal(t)[static_cast<std::size_t>(facet.axis)]); };
  const auto begin = faces.triangles.begin() + facet.first;
  const auto largest = std::max_element(begin, faces.triangles.end(),
                                        [&](const PlanarTriangle& s, const PlanarTriangle& t) { return area(s) < area(t); });
  const Point3 &a = points[(*largest)[0]], &b = points[(*largest)[1]], &c = points[(*largest)[2]];
  for (const std::uint32_t v : clean.vertices) {
    const Point3& p = points[v];
    if (p == a || p == b || p == c || orient3d(a, b, c, p) == Sign::zero) continue;
    facet.planar = false;
    facet.defect = std::max(facet.defect, plane_distance(a, b, c, p));
  }
}

void add_planar_parts(const TriangulatedFacet& whole, const CleanFacet& clean, std::span<const Point3> points,
                      const TriangleShapes& shapes, FacetTriangles& faces) {
  const std::vector<std::uint32_t> part = find_planar_parts(whole, points, faces);
  const std::vector<PlanarTriangle> triangles(faces.triangles.begin() + whole.first, faces.triangles.end());
  const std::vector<std::uint8_t> masks(faces.masks.begin() + whole.first, faces.masks.end());
  faces.resize(whole.first);
  std::vector<std::pair<std::uint64_t, std::uint32_t>> edges;  // and a part that has it
  for (std::uint32_t k = 0; k < whole.count; ++k) {
    if (part[k] != k) continue;
    const auto number = static_cast<std::uint32_t>(faces.facets.size());
    const auto [axis, side] = shapes.visible_side(triangles[k]);
    TriangulatedFacet out{whole.input, static_cast<std::uint32_t>(faces.triangles.size()), 0, axis};
    out.reversed = whole.reversed != (side < 0);
    for (std::uint32_t j = k; j < whole.count; ++j) {
      if (part[j] != k) continue;
      PlanarTriangle t = triangles[j];
      std::uint8_t mask = masks[j];
      for (std::size_t i = 0; i < 3; ++i) edges.emplace_back(edge_key(t[i], t[(i + 1) % 3]), number);
      if (side < 0) {
        std::swap(t[1], t[2]);
        mask = static_cast<std::uint8_t>((mask & 1) | (mask & 2) << 1 | (mask & 4) >> 1);
      }
      faces.add(t, mask);
    }
    out.count = static_cast<std::uint32_t>(faces.triangles.size()) - out.first;
    faces.facets.push_back(out);
  }
  std::sort(edges.begin(), edges.end());
  for (const PlanarEdge& e : clean.edges) {
    const auto at = std::lower_bound(edges.begin(), edges.end(), std::pair(edge_key(e[0], e[1]), 0u));
    const bool found = at != edges.end() && at->first == edge_key(e[0], e[1]);
    faces.polygon_edges.push_back({e, found ? at->second : static_cast<std::uint32_t>(faces.facets.size() - 1)});
  }
}

}  // namespace pgdr::detail
