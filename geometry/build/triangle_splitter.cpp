// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "build/triangle_splitter.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include "space/planar_cdt.hpp"

namespace pgdr::detail {
namespace {

class TriangleSplitter {
 public:
  TriangleSplitter(const BuildInput<3>& in, const PointsOnEdges<3>& on_edges, FacetTriangles& faces, BuildReport<3>& report)
      : in_(in), on_edges_(on_edges), faces_(faces), report_(report) {}

  /// Replaces the last of the triangles, one of this facet, if there are points on it.
  void split_last(const TriangulatedFacet& facet, std::span<const PointOn> inside) {
    const PlanarTriangle t = faces_.triangles.back();
    const std::uint8_t mask = faces_.masks.back();
    std::vector<std::uint32_t> vertices;
    std::vector<PlanarEdge> rim;
    std::vector<std::uint64_t> fixed;
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t a = t[(i + 1) % 3], b = t[(i + 2) % 3];
      const bool is_edge = (mask & (1u << i)) != 0;  // else a diagonal, inside of the facet
      const auto points = on_edges_.chain(a, b);
      vertices.insert(vertices.end(), points.begin() + 1, points.end());
      for (std::size_t k = 1; k < points.size(); ++k) {
        rim.push_back({points[k - 1], points[k]});
        if (is_edge) fixed.push_back(edge_key(points[k - 1], points[k]));
        if (k + 1 == points.size()) break;
        if (is_edge)
          report_.note_on_edge(points[k], a, b);
        else
          report_.note_in_facet(points[k], facet.input);
      }
    }
    for (const auto& [triangle, v] : inside) {
      vertices.push_back(v);
      report_.note_in_facet(v, facet.input);
    }
    if (vertices.size() == 3 || !planar_.build(in_.points, vertices, rim, facet.axis)) return;
    planar_.carve_outside();  // a point may be off its edge by its rounding
    faces_.resize(faces_.triangles.size() - 1);
    std::sort(fixed.begin(), fixed.end());
    for (const PlanarTriangle& s : planar_.triangles()) faces_.add(s, mask_of(s, fixed));
  }

 private:
  const BuildInput<3>& in_;
  const PointsOnEdges<3>& on_edges_;
  FacetTriangles& faces_;
  BuildReport<3>& report_;
  PlanarTriangulation planar_;
};

}  // namespace

void split_triangles(const BuildInput<3>& in, const PointsOnEdges<3>& on_edges, std::span<const PointOn> inside,
                     FacetTriangles& faces, BuildReport<3>& report) {
  const std::vector<PlanarTriangle> triangles = std::exchange(faces.triangles, {});
  const std::vector<std::uint8_t> masks = std::exchange(faces.masks, {});
  TriangleSplitter splitter(in, on_edges, faces, report);
  auto at = inside.begin();
  for (TriangulatedFacet& facet : faces.facets) {
    const std::uint32_t begin = facet.first, end = begin + facet.count;
    facet.first = static_cast<std::uint32_t>(faces.triangles.size());
    for (std::uint32_t t = begin; t < end; ++t) {
      while (at != inside.end() && at->first < t) ++at;
      auto last = at;
      while (last != inside.end() && last->first == t) ++last;
      faces.add(triangles[t], masks[t]);
      splitter.split_last(facet, {at, last});
    }
    facet.count = static_cast<std::uint32_t>(faces.triangles.size()) - facet.first;
  }
}

}  // namespace pgdr::detail
