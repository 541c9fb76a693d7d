// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Meshes of an input other than the one that was given, as a fault in how inputs are read, joined and repaired would make them:
// each is refused for what it is.
#include <gtest/gtest.h>

#include "domain_plcs.hpp"
#include "refined_models.hpp"
#include "repair_plcs.hpp"
#include "structure_plcs.hpp"

namespace test_check_given_faults {

using namespace pgdr;
using Kind = CheckFinding::Kind;

template <int D>
CheckReport check_given(const Plc<D>& plc, const OutputMesh<D>& mesh, std::optional<double> tolerance = {}) {
  CheckOptions<D> options;
  options.input = &plc;
  options.tolerance = tolerance;
  return check(mesh, options);
}

template <int D>
OutputMesh<D> mesh_of(const Plc<D>& plc) {
  return refine<D>(plc, {}).mesh;
}

/// The mesh of `other` is refused for what `plc` has, and the right one is not.
template <int D>
void expect_told_apart(const Plc<D>& plc, const Plc<D>& other, std::vector<Kind> kinds) {
  const CheckReport right = check_given(plc, mesh_of(plc)), wrong = check_given(plc, mesh_of(other));
  EXPECT_LE(right.exit_code(), 1) << test::findings(right);
  EXPECT_EQ(wrong.exit_code(), 6);
  for (const Kind kind : kinds) EXPECT_GT(wrong.count(kind), 0u) << name(kind) << " of\n" << test::findings(wrong);
}

/// 8 x 40 x 4, with a ridge in the middle, `height` above the walls.
Plc<3> house(double height) {
  Plc<3> plc;
  for (const double y : {0.0, 40.0})
    for (const auto& [x, z] : {std::pair{0.0, 0.0}, {8.0, 0.0}, {8.0, 4.0}, {4.0, 4.0 + height}, {0.0, 4.0}})
      plc.points.push_back({{500000 + x, 4500000 + y, z}});
  test::add_polygon(plc, {0, 1, 2, 3, 4}, 1);
  test::add_polygon(plc, {5, 6, 7, 8, 9}, 1);
  for (test::Index k = 0; k < 5; ++k) test::add_polygon(plc, {k, (k + 1) % 5, 5 + (k + 1) % 5, 5 + k}, 1);
  return plc;
}

TEST(GivenFaults, AHouseWithoutARoof) {
  expect_told_apart(house(4), house(0), {Kind::stray_constraint, Kind::wrong_volume});
  expect_told_apart(house(0), house(4), {Kind::stray_constraint, Kind::facet_not_conforming});
  expect_told_apart(house(1e-3), house(0), {Kind::stray_constraint});
}

TEST(GivenFaults, AFilledTunnel) {
  const auto block = [](bool tunnel) {
    Plc<3> plc;
    test::add_box(plc, {{0, 0, 0}}, {{4, 4, 4}});
    if (!tunnel) return plc;
    test::add_box(plc, {{1, 1, 0}}, {{2, 2, 4}}, 11);
    for (int lid = 0; lid < 2; ++lid) {  // z low and z high of the box: openings in those of the block
      plc.facets[4 + lid].polygons.push_back(plc.facets[10 + lid].polygons[0]);
      plc.facets[4 + lid].holes = {{{1.5, 1.5, lid == 0 ? 0.0 : 4.0}}};
    }
    plc.facets.resize(10);
    return plc;
  };
  expect_told_apart(block(true), block(false), {Kind::facet_not_conforming, Kind::stray_constraint, Kind::missing_input_point});
  expect_told_apart(block(false), block(true), {Kind::stray_constraint, Kind::wrong_volume});
}

TEST(GivenFaults, ADeletedFibre) {
  const Plc<3> plain = test::cube();
  Plc<3> with_fibre = plain;
  test::add_box(with_fibre, {{0.25, 0.5, 0.5}}, {{0.75, 0.51, 0.51}}, 11);
  expect_told_apart(with_fibre, plain, {Kind::facet_not_conforming, Kind::missing_input_point});
  expect_told_apart(plain, with_fibre, {Kind::stray_constraint});
}

TEST(GivenFaults, ADeletedSegmentOrPoint) {
  const Plc<3> plain = test::cube();
  Plc<3> with_segment = plain;
  test::add_segment(with_segment, {{0.25, 0.5, 0.5}}, {{0.75, 0.5, 0.5}}, 5);
  expect_told_apart(with_segment, plain, {Kind::segment_not_conforming, Kind::missing_input_point});
  expect_told_apart(plain, with_segment, {Kind::stray_constraint});
  Plc<3> on_facet = plain;
  test::add_segment(on_facet, {{0, 0, 0}}, {{1, 1, 0}}, 5);
  expect_told_apart(on_facet, plain, {Kind::segment_not_conforming});
  Plc<2> square = test::square_with_hole(), without = square;
  without.segments.pop_back();
  expect_told_apart(square, without, {Kind::segment_not_conforming});
  expect_told_apart(without, square, {Kind::stray_constraint});
}

TEST(GivenFaults, AFacetOfAWrongMarker) {
  const Plc<3> plc = test::cube();
  for (std::size_t f = 0; f < plc.facets.size(); ++f) {
    Plc<3> other = plc;
    other.facets[f].marker = 77;
    expect_told_apart(plc, other, {Kind::wrong_marker});
    other.facets[f].marker = plc.facets[(f + 1) % 6].marker;
    expect_told_apart(plc, other, {Kind::wrong_marker});
  }
}

// Where facets overlap, the marker of the smaller one stays. That of the larger, which the subfacets lie on as well, is wrong
// there, wherever the facets stand in the input, and however they are turned.
TEST(GivenFaults, AMarkerOfTheWallOnItsPatch) {
  Plc<3> plc = test::cube();
  for (auto& f : plc.facets) f.marker = 1;
  const auto n = static_cast<test::Index>(plc.points.size());
  for (const auto& [x, y] : {std::pair{0.25, 0.25}, {0.5, 0.25}, {0.5, 0.75}, {0.25, 0.75}}) plc.points.push_back({{x, y, 0}});
  plc.facets.insert(plc.facets.begin() + 2, {{{n, n + 1, n + 2, n + 3}}, {}, 7});
  for (const Plc<3>& given : {plc, test::turned(plc, 0.7), test::moved(test::turned(plc, 0.7), 1, 0, 1000)}) {
    OutputMesh<3> mesh = mesh_of(given);
    EXPECT_LE(check_given(given, mesh).exit_code(), 1) << test::findings(check_given(given, mesh));
    std::size_t patched = 0;
    for (auto& s : mesh.subfacets)
      if (s.marker == 7) {
        s.marker = 1;
        ++patched;
      }
    ASSERT_GT(patched, 0u);
    const CheckReport report = check_given(given, mesh);
    EXPECT_EQ(report.exit_code(), 6);
    EXPECT_EQ(report.count(Kind::wrong_marker), patched) << test::findings(report);
  }
}

TEST(GivenFaults, AVertexThatMoved) {
  const Plc<3> plc = test::two_region_cube();
  RefineOptions<3> fine;
  fine.size = 0.4;
  const auto mesh = refine<3>(plc, fine).mesh;
  const double tolerance = 1e-9;
  EXPECT_EQ(check_given(plc, mesh, tolerance).exit_code(), 0);
  int moved = 0;
  for (const auto& s : mesh.subfacets)
    for (const auto v : s.vertices) {
      if (v < mesh.input_points || moved == 10) continue;
      ++moved;
      for (const double by : {0.9 * tolerance, 5 * tolerance}) {
        auto other = mesh;
        for (int k = 0; k < 3; ++k) other.points[v][k] += by / 2;  // over each of three planes by half of it
        const auto report = check_given(plc, other, tolerance);
        EXPECT_EQ(report.count(Kind::stray_constraint) > 0, by > tolerance) << v << test::findings(report);
      }
    }
  EXPECT_EQ(moved, 10);
}

TEST(GivenFaults, AMissingPatch) {
  const Plc<3> plc = test::two_region_cube();
  RefineOptions<3> fine;
  fine.size = 0.4;
  const auto mesh = refine<3>(plc, fine).mesh;
  int tried = 0;
  for (std::size_t s = 0; s < mesh.subfacets.size(); ++s) {
    const auto& v = mesh.subfacets[s].vertices;
    if (tried == 8 || !std::ranges::all_of(v, [&](auto u) { return mesh.points[u][2] == 0.5; })) continue;
    ++tried;
    auto other = mesh;
    other.subfacets.erase(other.subfacets.begin() + static_cast<std::ptrdiff_t>(s));
    EXPECT_GT(check_given(plc, other).count(Kind::facet_not_conforming), 0u);
  }
  EXPECT_EQ(tried, 8);
}

// Pieces that cover a place twice do not stand for one that is missing: two given facets over one place, none over the other.
TEST(GivenFaults, AreasAreNotSummedUp) {
  Plc<3> plc = test::cube();
  test::add_rectangle(plc, 2, 0.5, {{0.25, 0.25}}, {{0.5, 0.75}}, 7);
  test::add_rectangle(plc, 2, 0.5, {{0.25, 0.25}}, {{0.5, 0.75}}, 7);
  Plc<3> other = test::cube();
  test::add_rectangle(other, 2, 0.5, {{0.25, 0.25}}, {{0.75, 0.75}}, 7);
  expect_told_apart(plc, other, {Kind::stray_constraint});
}

TEST(GivenFaults, PointsThatWereJoined) {
  Plc<3> plc = test::cube();
  plc.points.push_back({{0.5, 0.5, 0.5}});
  plc.points.push_back({{0.5, 0.5, 0.5 + 1e-6}});
  Plc<3> other = plc;
  other.points.pop_back();
  const auto mesh = mesh_of(other);
  EXPECT_GT(check_given(plc, mesh).count(Kind::missing_input_point), 0u);
  EXPECT_GT(check_given(plc, mesh, 0.4e-6).count(Kind::missing_input_point), 0u);
  EXPECT_EQ(check_given(plc, mesh, 1e-6).exit_code(), 0);
}

}  // namespace test_check_given_faults
