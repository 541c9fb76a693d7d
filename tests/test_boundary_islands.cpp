// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Islands: parts of an input between which nothing is meshed, each triangulated by itself.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <vector>

#include "diagnose/islands.hpp"
#include "model_plcs.hpp"
#include "pgdr/check.hpp"
#include "pgdr/refine.hpp"

namespace pgdr::test_boundary_islands {

detail::Islands islands_of(const Plc<3>& plc, bool voids_by_nesting = false) {
  return detail::islands_of<3>(Domain<3>(plc), voids_by_nesting, detail::Bulk(false), detail::StopCheck({}));
}

Plc<3> boxes(const std::vector<std::array<double, 2>>& from_to) {
  Plc<3> plc;
  for (const auto& [from, to] : from_to) test::add_box(plc, {{from, from, from}}, {{to, to, to}});
  return plc;
}

void expect_sound(const Plc<3>& plc, const RefineResult<3>& result, RegionMode mode = RegionMode::seeds) {
  CheckOptions<3> options;
  options.input = &plc;
  options.reasons = &result.reasons;
  options.regions = mode;
  EXPECT_EQ(check(result.mesh, options).exit_code(), 0);
}

std::map<double, double> volumes_by_label(const RefineResult<3>& result) {
  std::map<double, double> volumes;
  for (const RegionVolume& r : result.regions) volumes[r.label] += r.volume_meshed;
  return volumes;
}

TEST(Islands, AreApartOutside) {
  const auto two = islands_of(boxes({{0, 1}, {1.5, 2}}));
  ASSERT_EQ(two.count, 2u);
  for (std::uint32_t v = 0; v < 16; ++v) EXPECT_EQ(two.of_point[v], v / 8);
  EXPECT_EQ(islands_of(boxes({{0, 1}})).count, 1u);
}

TEST(Islands, ShareWhatIsMeshed) {
  EXPECT_EQ(islands_of(boxes({{0, 3}, {1, 2}})).count, 1u);
  EXPECT_EQ(islands_of(boxes({{0, 3}, {1, 2}}), true).count, 1u);          // what is between them is meshed
  EXPECT_EQ(islands_of(boxes({{0, 5}, {1, 4}, {2, 3}}), true).count, 2u);  // the last one is in a void
  Plc<3> in_a_hole = boxes({{0, 3}, {1, 2}});
  in_a_hole.holes = {{0.5, 0.5, 0.5}};
  EXPECT_EQ(islands_of(in_a_hole).count, 1u);  // the first bounds nothing that is meshed
}

TEST(Islands, TouchingPartsAreOne) {
  Plc<3> plc = boxes({{0, 1}});
  test::add_box(plc, {{1, 0, 0}}, {{2, 1, 1}});
  EXPECT_EQ(islands_of(plc).count, 1u);
}

TEST(Islands, WhatBoundsNothingIsOfTheFirst) {
  Plc<3> plc = boxes({{0, 1}, {2, 3}});
  const auto first = static_cast<std::uint32_t>(plc.points.size());
  for (const Point3& p : {Point3{4, 0, 0}, Point3{5, 0, 0}, Point3{4, 1, 0}, Point3{2.5, 2.5, 2.5}}) plc.points.push_back(p);
  plc.facets.push_back({{{first, first + 1, first + 2}}, {}, 9});
  const auto found = islands_of(plc);
  ASSERT_EQ(found.count, 2u);
  EXPECT_EQ(std::vector(found.of_point.begin() + 16, found.of_point.end()), (std::vector<std::uint32_t>{0, 0, 0, 1}));
}

TEST(Islands, CrossingBodiesAreRefused) {
  Plc<3> plc = boxes({{0, 1}, {0.5, 1.5}});
  EXPECT_EQ(islands_of(plc).count, 1u);
  EXPECT_THROW(refine(plc, RefineOptions<3>{}), InputError);
}

/// A body with a void in which there is another body, which has a void of its own: all a hair apart.
Plc<3> body_in_a_void() {
  Plc<3> plc = boxes({{0, 10}, {2, 8}, {2 + 1e-7, 8 - 1e-4}, {4, 6}});
  plc.holes = {{2 + 5e-8, 5, 5}, {5, 5, 5}};
  plc.regions = {{{1, 1, 1}, 7, 0}, {{3, 3, 3}, 9, 0}};
  return plc;
}

TEST(Islands, SeedsAreFoundInThoseAroundThem) {
  const Plc<3> plc = body_in_a_void();
  const auto found = islands_of(plc);
  ASSERT_EQ(found.count, 2u);
  EXPECT_EQ(found.of_hole, (std::vector<std::vector<std::uint32_t>>{{0, 1}, {1}}));
  EXPECT_EQ(found.of_region, (std::vector<std::vector<std::uint32_t>>{{0}, {1}}));
  const auto result = refine(plc, RefineOptions<3>{});
  expect_sound(plc, result);
  const double side = 6 - 1e-4 - 1e-7;
  EXPECT_NEAR(volumes_by_label(result)[7], 1000 - 216, 1e-9);
  EXPECT_NEAR(volumes_by_label(result)[9], side * side * side - 8, 1e-9);
  EXPECT_LT(result.mesh.cells.size(), 2000u);
}

TEST(Islands, RegionsHaveTheNumbersOfOneTriangulation) {
  Plc<3> plc = boxes({{0, 10}, {2, 8}, {2 + 1e-7, 8 - 1e-4}, {4, 6}});
  RefineOptions<3> options;
  options.regions = RegionMode::automatic;
  const auto result = refine(plc, options);
  expect_sound(plc, result, RegionMode::automatic);
  EXPECT_NEAR(volumes_by_label(result)[1], 1000 - 216, 1e-9);
  EXPECT_EQ(volumes_by_label(result).size(), 2u);
  options.regions = RegionMode::all;  // all that is enclosed: nothing is apart
  plc = boxes({{0, 10}, {2, 8}, {12, 13}});
  EXPECT_EQ(volumes_by_label(refine(plc, options)).size(), 3u);
}

TEST(Islands, MeshesDoNotDependOnTheThreads) {
  const Plc<3> plc = body_in_a_void();
  RefineOptions<3> options;
  options.max_volume = 0.5;
  options.schedule.threads = 1;
  const auto one = refine(plc, options);
  options.schedule.threads = 8;
  const auto eight = refine(plc, options);
  EXPECT_EQ(one.mesh.cells, eight.mesh.cells);
  EXPECT_TRUE(std::ranges::equal(one.mesh.points, eight.mesh.points));
}

}  // namespace pgdr::test_boundary_islands
