// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "build/facet_areas.hpp"

#include <cmath>

#include "build/joints.hpp"
#include "input/triangle_shapes.hpp"
#include "numbers/vectors.hpp"
#include "space/make_set.hpp"

namespace pgdr::detail {

FacetAreas::FacetAreas(const BuildInput<3>& in, const FacetTriangles& faces, const EdgeUses& uses, const PlaneWidth& width)
    : groups_(faces.facets.size()), areas_(faces.facets.size()) {
  const Joints joints(in, faces);
  const TriangleShapes shapes(in.points, in.scale);
  std::vector<double> rims(faces.facets.size(), 0);
  uses.each_edge([&](std::size_t, std::span<const EdgeUse> here) {
    if (joints.is_soft(here, width)) {
      groups_.unite(here[0].owner, here[1].owner);
      return;
    }
    const auto [a, b] = edge_of(here[0].key);
    const double length = std::sqrt(squared_distance(shapes.scaled(a), shapes.scaled(b)));
    for (const EdgeUse& use : here)
      if (use.is_triangle()) rims[use.owner] += length;
  });
  for (std::uint32_t f = 0; f < faces.facets.size(); ++f) {
    FacetArea& group = areas_[groups_.find(f)];
    group.rim += rims[f];
    for (const PlanarTriangle& t : faces.of(faces.facets[f])) {
      const Vector<3> n = shapes.normal(t);
      group.area += std::sqrt(dot(n, n)) / 2;
    }
  }
}

FacetArea FacetAreas::of(std::span<const std::uint32_t> facets) {
  std::vector<std::uint32_t> groups;
  for (const std::uint32_t f : facets) groups.push_back(groups_.find(f));
  make_set(groups);
  FacetArea sum;
  for (const std::uint32_t g : groups) {
    sum.area += areas_[g].area;
    sum.rim += areas_[g].rim;
  }
  return sum;
}

}  // namespace pgdr::detail
