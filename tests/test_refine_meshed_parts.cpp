// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Angles of what is not in the mesh: a facet may stick out of a body, and be sharp there.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include "carved_meshes.hpp"
#include "input/sharp_angles.hpp"
#include "reasons/meshed_segments.hpp"
#include "refine/meshed_parts.hpp"

namespace pgdr {
namespace {

/// The unit cube; and a facet in the plane of its top, a small part of which is over the cube. The other one meets the cube again
/// at its corner (1, 1, 1), 11 degrees beside the edge from there.
Plc<3> cube_with_barb() {
  Plc<3> plc = test::cube();
  const auto first = static_cast<std::uint32_t>(plc.points.size());
  for (const Point3& p : {Point3{0.4, 0.6, 1}, Point3{0.5, 0.6, 1}, Point3{0.5, 1.1, 1}, Point3{0.4, 1.4, 1}})
    plc.points.push_back(p);
  const auto corner = std::ranges::find(plc.points, Point3{1, 1, 1}) - plc.points.begin();
  plc.facets.push_back({{{first, first + 1, first + 2, static_cast<std::uint32_t>(corner), first + 3}}, {}, 77});
  return plc;
}

EntityId facet_of(const Domain<3>& domain, int marker) {
  for (EntityId f = 0; f < domain.facets().size(); ++f)
    if (domain.facets()[f].marker == marker) return f;
  return no_entity;
}

// A reason named such an angle (zav_l.stl of Cura), and the checker, which has the mesh and the given triangles, found none.
TEST(MeshedParts, WhatIsOutsideOfTheMeshMakesNoAngle) {
  const Domain<3> domain(cube_with_barb());
  Mesh<3> mesh;
  auto pools = mesh.make_pools();
  test::carve_mesh(domain, mesh, pools);
  const EntityId barb = facet_of(domain, 77);
  ASSERT_NE(barb, no_entity);
  const std::vector<std::uint8_t> meshed = meshed_triangles<3>(mesh, domain);
  ASSERT_EQ(meshed.size(), domain.facets().back().first_triangle + domain.facets().back().triangle_count);

  double all = 180, counted = 180;
  for (EntityId s = 0; s < domain.segments().size(); ++s) {
    const auto own = domain.facet_segments(barb);
    if (std::ranges::find(own, s) != own.end()) continue;
    const EntityRef segment{EntityKind::segment, s}, facet{EntityKind::facet, barb};
    all = std::min(all, entity_angle<3>(domain, segment, facet));
    counted = std::min(counted, counted_angle<3>(domain, segment, facet, meshed));
  }
  EXPECT_NEAR(all, std::atan2(0.1, 0.5) * 180 / std::numbers::pi, 1e-9);
  EXPECT_GE(counted, 90);  // at the edge of the cube, which the part on the top meets squarely

  for (EntityId f = 0; f < domain.facets().size(); ++f) {
    const auto count = std::count(meshed.begin() + domain.facets()[f].first_triangle,
                                  meshed.begin() + domain.facets()[f].first_triangle + domain.facets()[f].triangle_count, 1);
    if (f == barb)
      EXPECT_TRUE(count > 0 && count < static_cast<std::ptrdiff_t>(domain.facets()[f].triangle_count));
    else
      EXPECT_EQ(count, static_cast<std::ptrdiff_t>(domain.facets()[f].triangle_count));
  }
}

// Of a flap that is outside as a whole reasons named the far side (another surface in the place of zav_l.stl), which is no
// subsegment of the mesh.
TEST(MeshedParts, AFlapOutsideHasNoSegmentsButThoseOfTheMesh) {
  Plc<3> plc = test::cube();
  const auto number_of = [&](const Point3& p) {
    return static_cast<std::uint32_t>(std::ranges::find(plc.points, p) - plc.points.begin());
  };
  const auto tip = static_cast<std::uint32_t>(plc.points.size());
  const std::uint32_t a = number_of({1, 1, 1}), b = number_of({1, 1, 0});
  plc.points.push_back({1.05, 1.05, 0.5});
  plc.facets.push_back({{{a, b, tip}}, {}, 77});
  const Domain<3> domain(plc);
  Mesh<3> mesh;
  auto pools = mesh.make_pools();
  test::carve_mesh(domain, mesh, pools);
  const std::vector<std::uint8_t> meshed = meshed_triangles<3>(mesh, domain);
  const std::vector<std::uint8_t> segments = meshed_segments<3>(mesh, domain, meshed);
  ASSERT_EQ(segments.size(), domain.segments().size());
  const EntityId flap = facet_of(domain, 77);
  for (EntityId f = 0; f < domain.facets().size(); ++f) EXPECT_EQ(meshed[domain.facets()[f].first_triangle], f == flap ? 0 : 1);
  std::size_t missing = 0;
  for (EntityId s = 0; s < domain.segments().size(); ++s) {
    const auto& ends = domain.segments()[s].points;
    const bool is_at_tip = domain.points()[ends[0]] == plc.points[tip] || domain.points()[ends[1]] == plc.points[tip];
    missing += is_at_tip;
    EXPECT_EQ(segments[s], is_at_tip ? 0 : 1);
  }
  EXPECT_EQ(missing, 2u);
}

TEST(MeshedParts, NothingIsAskedWhereTheMeshHasAllFacets) {
  const Domain<3> domain(test::cube());
  Mesh<3> mesh;
  auto pools = mesh.make_pools();
  test::carve_mesh(domain, mesh, pools);
  EXPECT_TRUE(meshed_triangles<3>(mesh, domain).empty());
}

}  // namespace
}  // namespace pgdr
