// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The checker against the input as given, without a Domain: refined meshes pass.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "pgdr/planar_plc.hpp"
#include "refined_models.hpp"
#include "structure_plcs.hpp"

namespace test_check_given {

using namespace pgdr;
using Kind = CheckFinding::Kind;

template <int D>
CheckReport check_given(const Plc<D>& plc, const OutputMesh<D>& mesh, RegionMode regions = RegionMode::seeds,
                        std::optional<double> tolerance = {}) {
  CheckOptions<D> options;
  options.input = &plc;
  options.regions = regions;
  options.tolerance = tolerance;
  return check(mesh, options);
}

TEST(GivenCheck, StructuresPassInBothModes) {
  const auto structures = test::all_structures();
  EXPECT_GT(structures.size(), 20u);
  for (const auto& s : structures)
    for (const RegionMode mode : {RegionMode::seeds, RegionMode::automatic}) {
      RefineOptions<3> options;
      options.regions = mode;
      const auto result = refine<3>(s.plc, options);
      const auto report = check_given(s.plc, result.mesh, mode);
      for (const auto& f : report.findings)
        EXPECT_EQ(f.kind, Kind::not_delaunay) << s.name << (mode == RegionMode::seeds ? "" : ", automatic") << ": " << f.message;
    }
}

TEST(GivenCheck, TurnedStructuresPass) {
  for (const auto& s : test::all_structures()) {
    if (!s.turns) continue;
    const Plc<3> plc = test::turned(s.plc);
    RefineOptions<3> options;
    options.regions = RegionMode::automatic;
    const auto report = check_given(plc, refine<3>(plc, options).mesh, RegionMode::automatic);
    for (const auto& f : report.findings) EXPECT_EQ(f.kind, Kind::not_delaunay) << s.name << ": " << f.message;
  }
}

TEST(GivenCheck, LabelsAndModesAreToldApart) {
  for (const auto& s : test::nested_structures()) {
    RefineOptions<3> options;
    options.regions = RegionMode::automatic;
    const auto mesh = refine<3>(s.plc, options).mesh;
    const bool has_void = check_given(s.plc, mesh, RegionMode::seeds).count(Kind::wrong_volume) > 0;
    RefineOptions<3> all;
    const bool same = refine<3>(s.plc, all).mesh.cells.size() == mesh.cells.size();
    EXPECT_EQ(has_void, !same) << s.name;
    auto swapped = mesh;
    if (std::ranges::find(swapped.regions, 2.0) == swapped.regions.end()) continue;
    for (double& label : swapped.regions) label = label == 1 ? 2 : label == 2 ? 1 : label;
    EXPECT_GT(check_given(s.plc, swapped, RegionMode::automatic).count(Kind::wrong_region), 0u) << s.name;
  }
}

TEST(GivenCheck, PlanarInputsPass) {
  Plc<2> plc = test::square_with_hole();
  plc.segments.push_back({{2, 13}, 0});  // leaves the square
  plc.segments.push_back({{13, 14}, 0});
  plc.segments.push_back({{2, 14}, 0});  // twice over one line, outside
  plc.points.push_back({{5, 5}});
  plc.points.push_back({{6, 6}});
  for (const auto& p : {plc, test::turned(plc)}) {
    const auto report = check_given(p, refine<2>(p, {}).mesh);
    EXPECT_EQ(report.exit_code(), 0) << test::findings(report);
  }
}

// A box on the floor of another, whose bottom and a part of the floor are one: the mesh has that once, with the floor's marker.
TEST(GivenCheck, OverlappingFacetsPass) {
  const Point3 low{{1, 1, 0}}, high{{2, 2, 1}};
  const Plc<3> given = test::boxes({{{{0, 0, 0}}, {{3, 3, 3}}}, {low, high}});
  Plc<3> apart = given;  // the same without an overlap
  apart.facets[4].polygons.push_back(given.facets[10].polygons[0]);
  apart.facets.erase(apart.facets.begin() + 10);
  auto mesh = refine<3>(apart, {}).mesh;
  EXPECT_EQ(check_given(given, mesh).exit_code(), 0) << test::findings(check_given(given, mesh));
  Plc<3> markers = given;
  for (auto& f : markers.facets) f.marker += &f >= &markers.facets[6] ? 10 : 0;
  for (auto& s : mesh.subfacets)
    if (std::ranges::all_of(s.vertices, [&](auto v) {
          const auto& p = mesh.points[v];
          return std::min(p[0], p[1]) >= 1 && std::max(p[0], p[1]) <= 2 && p[2] <= 1;
        }))
      s.marker += 10;
  EXPECT_EQ(check_given(markers, mesh).exit_code(), 0) << "either marker";
}

// Segments that cross are compared as they were given, not as they were split.
TEST(GivenCheck, CrossingSegmentsPass) {
  Plc<2> plc;
  plc.points = {{{0, 0}}, {{1, 0.1}}, {{0.9, 1}}, {{0.1, 0.7}}};
  for (test::Index k = 0; k < 4; ++k) plc.segments.push_back({{k, (k + 1) % 4}, 1});
  plc.segments.push_back({{0, 2}, 2});
  plc.segments.push_back({{1, 3}, 3});
  std::vector<Diagnostic> repairs;
  const auto mesh = refine<2>(resolve_crossings(plc, repairs), {}).mesh;
  EXPECT_EQ(repairs.size(), 1u);
  const auto report = check_given(plc, mesh);
  EXPECT_EQ(report.exit_code(), 0) << test::findings(report);
}

// A fan of needles whose boxes all overlap, in the plane of few subfacets, and groups of points that were joined.
TEST(GivenCheck, FansAndJoinedPointsPass) {
  Plc<3> plc;
  constexpr test::Index n = 100;
  for (const double z : {0.0, 1.0})
    for (test::Index k = 0; k < n; ++k) {
      const double t = 2 * std::numbers::pi * k / n;
      plc.points.push_back({{std::cos(t), std::sin(t), z}});
    }
  for (test::Index k = 2; k < n; ++k) {
    test::add_polygon(plc, {0, k - 1, k});
    test::add_polygon(plc, {n, n + k - 1, n + k});
  }
  for (test::Index k = 0; k < n; ++k) test::add_polygon(plc, {k, (k + 1) % n, n + (k + 1) % n, n + k}, 1);
  const auto report = check_given(plc, refine<3>(plc, {}).mesh);
  EXPECT_EQ(report.exit_code(), 0) << test::findings(report);

  Plc<3> joined = test::boxes({{{{0, 0, 0}}, {{1, 1, 1}}}, {{{1, 0, 0}}, {{2, 1, 1}}}});
  for (std::size_t p = 0; p < joined.points.size(); ++p) joined.points[p][p % 3] += 1e-7 * static_cast<double>(p % 4);
  joined.tolerance = 1e-6;
  const auto of_joined = check_given(joined, refine<3>(joined, {}).mesh, RegionMode::seeds, 1e-6);
  EXPECT_EQ(of_joined.exit_code(), 0) << test::findings(of_joined);
}

// Points off a plane by less than 1e-4 of the extent: one facet, with any triangulation.
TEST(GivenCheck, BentFacetsPass) {
  for (const double bend : {1e-15, 1e-9, 5e-5, 1e-2}) {
    Plc<3> plc = test::cube();
    for (std::size_t i = 4; i < 8; ++i) plc.points[i][2] += i % 3 == 0 ? bend : 0;
    const auto report = check_given(plc, refine<3>(plc, {}).mesh);
    EXPECT_EQ(report.exit_code(), 0) << bend << "\n" << test::findings(report);
  }
}

}  // namespace test_check_given
