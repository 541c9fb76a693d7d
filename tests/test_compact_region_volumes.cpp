// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Volumes of regions, as meshed and as given.
#include <gtest/gtest.h>

#include <cmath>

#include "pgdr/refine.hpp"
#include "structure_plcs.hpp"

namespace pgdr::test_compact_region_volumes {

using test::add_rectangle;
using test::boxes;

Plc<2> squares() {
  Plc<2> plc;
  for (const double half : {3.0, 1.0}) {
    const auto first = static_cast<std::uint32_t>(plc.points.size());
    for (const Point2& p : {Point2{{-half, -half}}, Point2{{half, -half}}, Point2{{half, half}}, Point2{{-half, half}}})
      plc.points.push_back(p);
    for (std::uint32_t i = 0; i < 4; ++i) plc.segments.push_back({{first + i, first + (i + 1) % 4}, 0});
  }
  return plc;
}

template <int D>
void expect(const std::vector<RegionVolume>& regions, const std::vector<std::array<double, 2>>& expected,
            const OutputMesh<D>& mesh) {
  ASSERT_EQ(regions.size(), expected.size());
  const std::vector<RegionVolume> of_mesh = measure_regions(mesh);
  ASSERT_EQ(of_mesh.size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    EXPECT_EQ(regions[i].label, expected[i][0]);
    EXPECT_EQ(regions[i].volume_meshed, expected[i][1]);
    ASSERT_TRUE(regions[i].volume_given.has_value());
    EXPECT_EQ(*regions[i].volume_given, expected[i][1]);
    EXPECT_EQ(of_mesh[i].label, expected[i][0]);
    EXPECT_EQ(of_mesh[i].volume_meshed, expected[i][1]);
    EXPECT_FALSE(of_mesh[i].volume_given.has_value());
  }
}

TEST(RegionVolumes, WithoutLabelsAreOne) {
  const auto plane = refine(squares(), RefineOptions<2>());
  expect<2>(plane.regions, {{0, 36}}, plane.mesh);
  const auto space = refine(boxes({{{{-2, -2, -2}}, {{2, 2, 2}}}, {{{-1, -1, -1}}, {{1, 1, 1}}}}), RefineOptions<3>());
  expect<3>(space.regions, {{0, 64}}, space.mesh);
}

TEST(RegionVolumes, AreOfLabelsAndNotOfSeeds) {
  Plc<2> plc = squares();
  plc.regions = {{{{2, 2}}, 7, 0}, {{{-2, 2}}, 7, 0}, {{{0, 0}}, -1.5, 0}};
  const auto result = refine(plc, RefineOptions<2>());
  expect<2>(result.regions, {{-1.5, 4}, {7, 32}}, result.mesh);
  plc.regions[2].attribute = 7;
  const auto one = refine(plc, RefineOptions<2>());
  expect<2>(one.regions, {{7, 36}}, one.mesh);
  plc.regions.clear();
  plc.holes = {{{0, 0}}};
  const auto ring = refine(plc, RefineOptions<2>());
  expect<2>(ring.regions, {{0, 32}}, ring.mesh);
}

// The floor is one facet, with a region above each of two parts of it, and none above the rest.
TEST(RegionVolumes, OfFacetsBetweenSeveralRegions) {
  Plc<3> plc = boxes({{{{0, 0, 0}}, {{8, 8, 4}}}});
  add_rectangle(plc, 0, 2, {{0, 0}}, {{8, 4}});
  add_rectangle(plc, 0, 5, {{0, 0}}, {{8, 4}});
  plc.regions = {{{{1, 1, 1}}, 1, 0}, {{{3, 3, 3}}, 2, 0}};
  plc.holes = {{{7, 7, 3}}};
  const auto result = refine(plc, RefineOptions<3>());
  expect<3>(result.regions, {{1, 64}, {2, 96}}, result.mesh);
}

TEST(RegionVolumes, OfTwoBoxesWithACommonFace) {
  Plc<3> plc = boxes({{{{0, 0, 0}}, {{8, 8, 4}}}, {{{0, 0, 4}}, {{8, 8, 6}}}});
  plc.regions = {{{{1, 1, 1}}, 1, 0}, {{{1, 1, 5}}, 2, 0}};
  const auto result = refine(plc, RefineOptions<3>());
  expect<3>(result.regions, {{1, 256}, {2, 128}}, result.mesh);
}

TEST(RegionVolumes, AreExactInEveryUnitOfLength) {
  for (const int exponent : {-300, -30, 200}) {
    Plc<3> plc = boxes({{{{-2, -2, -2}}, {{2, 2, 2}}}});
    for (Point3& p : plc.points)
      for (double& x : p.x) x = std::ldexp(x, exponent);
    const auto result = refine(plc, RefineOptions<3>());
    expect<3>(result.regions, {{0, std::ldexp(64, 3 * exponent)}}, result.mesh);
  }
}

TEST(RegionVolumes, AsGivenAreNotKnownWhereTheToleranceCloses) {
  Plc<2> plc = squares();
  plc.points.push_back({{3 + 1e-9, 3}});
  plc.segments[2].points[0] = static_cast<std::uint32_t>(plc.points.size() - 1);
  plc.regions = {{{{0, 0}}, 1, 0}};
  plc.tolerance = 1e-6;
  const auto result = refine(plc, RefineOptions<2>());
  ASSERT_EQ(result.regions.size(), 2u);
  EXPECT_FALSE(result.regions[0].volume_given.has_value());
  EXPECT_NEAR(result.regions[0].volume_meshed, 32, 1e-6);
  EXPECT_EQ(result.regions[1].volume_given, 4.0);
}

TEST(RegionVolumes, AsGivenAreKnownWhereTheToleranceFindsNothingToClose) {
  for (const double gap : {0.0, 1e-9}) {
    Plc<3> plc = boxes({{{{0, 0, 0}}, {{8, 8, 4}}}, {{{0, 0, 4 + gap}}, {{8, 8, 6}}}, {{{20, 0, 0}}, {{21, 1, 1}}}});
    plc.regions = {{{{1, 1, 1}}, 1, 0}, {{{1, 1, 5}}, 2, 0}, {{{20.5, 0.5, 0.5}}, 3, 0}};
    plc.tolerance = 1e-8;
    const auto result = refine(plc, RefineOptions<3>());
    ASSERT_EQ(result.regions.size(), 3u);
    EXPECT_EQ(result.regions[0].volume_given.has_value(), gap == 0);
    EXPECT_EQ(result.regions[1].volume_given.has_value(), gap == 0);
    EXPECT_EQ(result.regions[2].volume_given, 1.0);
  }
}

}  // namespace pgdr::test_compact_region_volumes
