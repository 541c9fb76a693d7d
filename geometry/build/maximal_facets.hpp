// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The facets of a Domain (3D): one of each group of facets in one plane, with its triangles and points, in the order of their
// first input facets.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "input/bent_facets.hpp"
#include "join/build_input.hpp"
#include "join/facet_triangles.hpp"
#include "pgdr/domain.hpp"

namespace pgdr::detail {

/// The members of a Domain that speak of facets, but for the segments of facets.
struct MaximalFacets {
  std::vector<DomainFacet> facets;
  std::vector<PlanarTriangle> triangles;
  std::vector<TriangleOrigin> origins;
  std::vector<std::array<std::uint32_t, 2>> further_origins;  ///< Domain::further_origins
  std::vector<std::uint32_t> points;
  std::vector<double> magnitudes, levels;
  std::vector<std::uint32_t> triangles_at_begin, triangles_at;
  std::vector<std::array<EntityId, 2>> touching;
  std::shared_ptr<const BentFacets> bent;
  std::vector<EntityId> group_of;  ///< of each of the FacetTriangles' facets

  std::span<const PlanarTriangle> triangles_of(const DomainFacet& f) const {
    return std::span(triangles).subspan(f.first_triangle, f.triangle_count);
  }
  std::span<const std::uint32_t> points_of(const DomainFacet& f) const {
    return std::span(points).subspan(f.first_point, f.point_count);
  }
};

/// `roots`: of each facet the first one of its group. Pairs of facets with more than `few_points` points that have one in common
/// are listed as touching.
MaximalFacets make_maximal_facets(const BuildInput<3>& in, const FacetTriangles& faces, std::span<const std::uint32_t> roots,
                                  std::size_t few_points);

}  // namespace pgdr::detail
