// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// How surfaces hang together before and after what lies within the tolerance is joined.
#include "pgdr/surface_counts.hpp"

#include <gtest/gtest.h>

#include "domain_plcs.hpp"
#include "repair_plcs.hpp"

namespace pgdr::test_diagnose_surface_counts {

using test::box;
using test::triangulated;

/// Each facet with points of its own, apart from those of others by `gap`.
Plc<3> apart(const Plc<3>& plc, double gap) {
  Plc<3> out;
  for (std::uint32_t f = 0; f < plc.facets.size(); ++f) {
    auto& facet = out.facets.emplace_back();
    auto& polygon = facet.polygons.emplace_back();
    for (const std::uint32_t v : plc.facets[f].polygons[0]) {
      polygon.push_back(static_cast<std::uint32_t>(out.points.size()));
      out.points.push_back(plc.points[v]);
      out.points.back()[0] += gap * f;
    }
  }
  return out;
}

TEST(SurfaceCounts, ABox) {
  const SurfaceCounts closed{1, 0, 0};
  EXPECT_EQ(surface_counts(box()), closed);
  EXPECT_EQ(surface_counts(triangulated(box())), closed);
  EXPECT_EQ(surface_counts(Domain<3>(triangulated(box()))), closed);
  Plc<3> open = box();
  open.facets.pop_back();
  EXPECT_EQ(surface_counts(open), (SurfaceCounts{1, 1, 0}));
  open.facets.erase(open.facets.begin());  // opposite or beside: a tube, or a box with a corner off
  EXPECT_EQ(surface_counts(open).components, 1u);
  EXPECT_EQ(surface_counts(open).handles, 0u);
}

TEST(SurfaceCounts, WhatIsJoinedHangsTogether) {
  Plc<3> plc = apart(box(), 1e-9);
  EXPECT_EQ(surface_counts(plc), (SurfaceCounts{6, 6, 0}));
  plc.tolerance = 1e-7;
  EXPECT_EQ(surface_counts(Domain<3>(plc)), (SurfaceCounts{1, 0, 0}));
}

/// A box with a shaft from top to bottom: rims are polygons of holes.
TEST(SurfaceCounts, AShaftIsAHandle) {
  Plc<3> plc;
  for (const double z : {0.0, 1.0})
    for (const double half : {2.0, 1.0})
      for (const auto& [x, y] : {std::pair{-half, -half}, {half, -half}, {half, half}, {-half, half}})
        plc.points.push_back({x, y, z});
  for (const std::uint32_t n : {0u, 8u})
    plc.facets.push_back({{{n, n + 1, n + 2, n + 3}, {n + 4, n + 5, n + 6, n + 7}}, {{0, 0, n / 8.0}}, 0});
  for (const std::uint32_t n : {0u, 4u})
    for (std::uint32_t i = 0; i < 4; ++i)
      plc.facets.push_back({{{n + i, n + (i + 1) % 4, n + 8 + (i + 1) % 4, n + 8 + i}}, {}, 0});
  EXPECT_EQ(surface_counts(plc), (SurfaceCounts{1, 0, 1}));
  EXPECT_EQ(surface_counts(Domain<3>(plc)), (SurfaceCounts{1, 0, 1}));
}

// Two boxes with a facet in common are no surface.
TEST(SurfaceCounts, ThreeFacetsAtAnEdge) {
  Plc<3> plc = box();
  plc.points.push_back({1, 0.5, 1.5});
  plc.facets.push_back({{{0, 1, 8}}, {}, 0});
  EXPECT_FALSE(surface_counts(plc).handles);
}

}  // namespace pgdr::test_diagnose_surface_counts
