// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Facets that overlap in one plane: boxes on floors and beside each other, pads, walls on both sides of a floor. The story: all
// of these were refused, at any angle, though the union of the points would not change.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <map>
#include <random>
#include <vector>

#include "domain_plcs.hpp"
#include "pgdr/diagnosis.hpp"
#include "refined_models.hpp"
#include "repair_plcs.hpp"

namespace pgdr::test_input_overlaps {

using test::has_segment;
using Ids = std::vector<std::int64_t>;

/// Adds a box, whose facets have this marker; the bottom first, then the top.
void add_box(Plc<3>& plc, const Point3& low, const Point3& high, int marker) {
  const auto n = static_cast<std::uint32_t>(plc.points.size());
  for (const double z : {low[2], high[2]})
    for (const auto& [x, y] : {std::pair{low[0], low[1]}, {high[0], low[1]}, {high[0], high[1]}, {low[0], high[1]}})
      plc.points.push_back({x, y, z});
  plc.facets.push_back({{{n, n + 3, n + 2, n + 1}}, {}, marker});
  plc.facets.push_back({{{n + 4, n + 5, n + 6, n + 7}}, {}, marker});
  for (auto& side : test::prism_sides(n, 4)) plc.facets.push_back({{side}, {}, marker});
}

void add_facet(Plc<3>& plc, const std::vector<Point3>& corners, int marker) {
  std::vector<std::uint32_t> polygon;
  for (const Point3& p : corners) {
    polygon.push_back(static_cast<std::uint32_t>(plc.points.size()));
    plc.points.push_back(p);
  }
  plc.facets.push_back({{polygon}, {}, marker});
}

/// What a mesh has to be, by labels and markers.
struct Expected {
  std::map<int, double> areas;
  std::vector<double> volumes;  // ascending
  std::size_t added = 0;        // points
};

/// Of the regions of a mesh, ascending.
std::vector<double> volumes_of(const OutputMesh<3>& mesh) {
  std::map<double, OutputMesh<3>> by_label;
  for (std::size_t c = 0; c < mesh.cells.size(); ++c) {
    OutputMesh<3>& part = by_label[mesh.regions.empty() ? 0 : mesh.regions[c]];
    part.cells.push_back(mesh.cells[c]);
  }
  std::vector<double> volumes;
  for (auto& [label, part] : by_label) {
    part.points = mesh.points;
    volumes.push_back(test::volume_of(part));
  }
  std::sort(volumes.begin(), volumes.end());
  return volumes;
}

void expect_domain(const Plc<3>& plc, const Expected& expected, double scale) {
  const Domain<3> d(plc);
  EXPECT_EQ(diagnose(d).error_count(), 0u);
  const auto added = std::ranges::count_if(d.input_of_point(), [&](std::uint32_t i) { return i >= plc.points.size(); });
  EXPECT_EQ(static_cast<std::size_t>(added), expected.added);
  std::map<int, double> areas;
  for (EntityId f = 0; f < d.facets().size(); ++f) areas[d.facets()[f].marker] += test::area(d, f);
  for (const auto& [marker, area] : expected.areas)
    EXPECT_NEAR(areas[marker], scale * scale * area, 1e-9 * scale * scale * area) << "marker " << marker;
}

void expect_mesh(const Plc<3>& plc, const Expected& expected, double scale) {
  const auto outcome = test::refine_and_check<3>(plc, {.regions = RegionMode::automatic});
  EXPECT_LE(outcome.report.exit_code(), 1) << test::findings(outcome.report);
  const auto volumes = volumes_of(outcome.result.mesh);
  ASSERT_EQ(volumes.size(), expected.volumes.size());
  for (std::size_t k = 0; k < volumes.size(); ++k)
    EXPECT_NEAR(volumes[k], std::pow(scale, 3) * expected.volumes[k], 1e-9 * std::pow(scale, 3) * expected.volumes[k]);
}

/// The input, turned exactly and with rounding, far from the origin; of polygons, and of triangles.
void expect_everywhere(const Plc<3>& given, const Expected& expected) {
  for (const Plc<3>& plc : {given, test::triangulated(given)}) {
    expect_domain(plc, expected, 1);
    expect_mesh(plc, expected, 1);
    Plc<3> exact = test::oblique(plc);
    for (int k = 0; k < 2; ++k, exact.tolerance = 0) {
      expect_domain(exact, expected, 25);
      expect_mesh(exact, expected, 25);
    }
    for (const double angle : {0.3, 1.9}) {
      expect_domain(test::turned(plc, angle), expected, 1);
      expect_mesh(test::turned(plc, angle), expected, 1);
    }
    expect_domain(test::moved(test::turned(plc), 1, 0, 1000), expected, 1);
  }
}

TEST(Overlaps, BoxOnAFloor) {
  Plc<3> plc;
  add_box(plc, {0, 0, 0}, {3, 3, 3}, 1);
  add_box(plc, {1, 1, 0}, {2, 2, 1}, 2);
  expect_everywhere(plc, {{{1, 53}, {2, 6}}, {1, 26}, 0});
  const Domain<3> d(plc);
  EXPECT_TRUE(has_segment(d, 8, 9));
  ASSERT_EQ(d.repairs().size(), 2u);
  EXPECT_EQ(d.repairs()[1].code, Errc::facets_overlap);
  EXPECT_EQ(d.repairs()[1].ids, (Ids{6, 0}));
  ASSERT_EQ(d.warnings().size(), 1u);
  EXPECT_EQ(d.warnings()[0].code, Errc::facets_overlap);
  EXPECT_EQ(d.warnings()[0].ids, (Ids{6, 0}));
}

TEST(Overlaps, HalfAFace) {
  Plc<3> plc;
  add_box(plc, {0, 0, 0}, {2, 2, 2}, 1);
  add_box(plc, {2, 0, 0}, {4, 1, 2}, 2);
  expect_everywhere(plc, {{{1, 22}, {2, 16}}, {4, 8}, 0});
}

TEST(Overlaps, AlongAWholeSide) {
  Plc<3> plc;
  add_box(plc, {0, 0, 0}, {2, 2, 2}, 1);
  add_box(plc, {2, 0, 0}, {3, 2, 1}, 2);
  expect_everywhere(plc, {{{1, 22}, {2, 10}}, {2, 8}, 0});
}

TEST(Overlaps, FacesThatCrossInOutline) {
  Plc<3> plc;
  add_box(plc, {0, 0, 0}, {2, 2, 2}, 1);
  add_box(plc, {2, 1, 1}, {4, 3, 3}, 2);
  expect_everywhere(plc, {{{1, 24}, {2, 23}}, {8, 8}, 2});
  const Domain<3> d(plc);
  const auto crossings = std::ranges::find(d.repairs(), Errc::entities_intersect, &Diagnostic::code);
  ASSERT_NE(crossings, d.repairs().end());
  EXPECT_EQ(crossings->points.size(), 2u);
  EXPECT_EQ(crossings->ids.size(), 10u);  // each with the ends of both edges
  EXPECT_TRUE(std::ranges::count(crossings->points, (std::array<double, 3>{2, 2, 1})));
  EXPECT_TRUE(std::ranges::count(crossings->points, (std::array<double, 3>{2, 1, 2})));
}

TEST(Overlaps, BoxesOnBothSidesOfAnInterface) {
  Plc<3> plc;
  add_box(plc, {-5, -5, 0}, {5, 5, 4}, 1);
  add_box(plc, {-5, -5, -4}, {5, 5, 0}, 4);
  add_box(plc, {-2, -1, 0}, {2, 1, 1}, 2);
  add_box(plc, {-1, -2, -1}, {1, 2, 0}, 3);
  expect_everywhere(plc, {{{1, 348}, {2, 28}, {3, 24}, {4, 260}}, {8, 8, 392, 392}, 4});
}

// Three pads of one plane, each over both others, on a fourth facet.
TEST(Overlaps, ThreeAtOnePlace) {
  Plc<3> plc;
  add_facet(plc, {{1, 1, 0}, {4, 1, 0}, {4, 4, 0}, {1, 4, 0}}, 11);
  add_facet(plc, {{2, 2, 0}, {5, 2, 0}, {5, 5, 0}, {2, 5, 0}}, 12);
  add_facet(plc, {{3, 0.5, 0}, {5.5, 3, 0}, {3, 5.5, 0}, {0.5, 3, 0}}, 13);
  add_box(plc, {0, 0, 0}, {6, 6, 2}, 1);
  // The diamond, |x - 3| + |y - 3| <= 2.5, has not one corner of each square as a whole, and of two a tip.
  const double in_square = 9 - 0.5 * 1.5 * 1.5 - 2 * 0.5 * 0.5 * 0.5, in_both = 4;
  expect_everywhere(plc, {{{11, 9}, {12, 5}, {13, 12.5 - 2 * in_square + in_both}}, {72}, 14});
}

TEST(Overlaps, PadAcrossTwoFacets) {
  Plc<3> plc;
  add_box(plc, {0, 0, 0}, {2, 2, 2}, 1);
  add_box(plc, {2, 0, 0}, {4, 2, 2}, 2);
  add_facet(plc, {{1, 0.5, 0}, {3, 0.75, 0}, {3, 1.5, 0}, {1, 1.5, 0}}, 7);
  std::rotate(plc.facets.rbegin(), plc.facets.rbegin() + 1, plc.facets.rend());
  expect_everywhere(plc, {{{7, 1.75}}, {8, 8}, 2});
}

TEST(Overlaps, TheSameFacetTwiceInOtherTriangles) {
  Plc<3> plc = test::triangulated(test::box());
  for (auto& f : plc.facets) f.marker = 1;
  plc.facets.push_back({{{0, 1, 3}}, {}, 2});
  plc.facets.push_back({{{1, 2, 3}}, {}, 2});
  const Domain<3> d(plc);
  EXPECT_EQ(d.points().size(), 8u);
  EXPECT_EQ(d.facets().size(), 6u);
  EXPECT_TRUE(std::ranges::all_of(d.facets(), [](const DomainFacet& f) { return f.marker == 1; }));
  for (const double angle : {0.0, 0.4, 2.2}) expect_mesh(test::turned(plc, angle), {{}, {6}, 0}, 1);
}

// Markers vanished without a word: a patch that was listed after its wall had that of the wall, and its own was nowhere. It has
// its own, wherever it is listed, and into however many triangles wall and patch are divided; of two of one size the first has
// it.
TEST(Overlaps, TheMarkerOfTheSmallerStays) {
  Plc<3> plc;
  add_box(plc, {0, 0, 0}, {4, 4, 1}, 1);
  add_facet(plc, {{1, 1, 1}, {2, 1, 1}, {2, 2, 1}, {1, 2, 1}}, 7);
  add_facet(plc, {{2, 2, 1}, {3.5, 2, 1}, {3.5, 3.5, 1}, {2, 3.5, 1}}, 8);
  add_facet(plc, {{1.5, 2, 1}, {3, 2, 1}, {3, 3.5, 1}, {1.5, 3.5, 1}}, 9);  // as large as the one before
  const Expected expected{{{1, 48 - 1 - 1.5 * 2}, {7, 1}, {8, 2.25}, {9, 0.75}}, {16}, 0};
  for (std::ptrdiff_t k = 0; k < 3; ++k, std::rotate(plc.facets.begin(), plc.facets.begin() + 4, plc.facets.end())) {
    const Domain<3> d(plc);
    std::map<int, double> areas;
    for (EntityId f = 0; f < d.facets().size(); ++f) areas[d.facets()[f].marker] += test::area(d, f);
    const bool swapped = plc.facets.back().marker == 8;
    EXPECT_EQ(d.warnings().size(), 1u);
    EXPECT_EQ(areas[7], 1);
    EXPECT_EQ(areas[8], swapped ? 0.75 : 2.25);
    if (!swapped) expect_everywhere(plc, expected);
  }
}

// Into triangles smaller than the patch: they are one facet all the same.
TEST(Overlaps, APatchOnAFineWall) {
  Plc<3> plc;
  add_box(plc, {0, 0, 0}, {4, 4, 1}, 1);
  plc.facets.erase(plc.facets.begin() + 1);
  for (int x = 0; x < 4; ++x)
    for (int y = 0; y < 4; ++y) {
      const Point3 a{double(x), double(y), 1}, b{x + 1.0, double(y), 1}, c{x + 1.0, y + 1.0, 1}, e{double(x), y + 1.0, 1};
      add_facet(plc, {a, b, c}, 1);
      add_facet(plc, {a, c, e}, 1);
    }
  add_facet(plc, {{0.5, 0.5, 1}, {2.5, 0.75, 1}, {2.25, 3, 1}}, 7);
  const Domain<3> d(plc);
  double area = 0;
  for (EntityId f = 0; f < d.facets().size(); ++f)
    if (d.facets()[f].marker == 7) area += test::area(d, f);
  EXPECT_NEAR(area, 0.5 * (2 * 2.5 - 1.75 * 0.25), 1e-12);
  expect_mesh(plc, {{}, {16}, 0}, 1);
}

// Edges of facets that stand on both sides of a floor cross inside of it.
TEST(Overlaps, WallsOnBothSidesOfAFloor) {
  Plc<3> plc;
  add_box(plc, {-3, -3, 0}, {3, 3, 2}, 1);
  add_box(plc, {-3, -3, -2}, {3, 3, 0}, 1);
  add_facet(plc, {{-2, -1.25, 0}, {2, 1, 0}, {2, 1, 1}, {-2, -1.25, 1}}, 5);
  add_facet(plc, {{-1, 2, 0}, {1.25, -2, 0}, {1.25, -2, -1}, {-1, 2, -1}}, 6);
  expect_everywhere(plc, {{}, {72, 72}, 1});
}

TEST(Overlaps, ASegmentAcrossTwoFacets) {
  Plc<3> plc = test::triangulated(test::box());
  plc.facets[0].marker = 1;
  plc.segments = {{{1, 3}, 4}};
  const Domain<3> d(plc);
  ASSERT_EQ(d.points().size(), 9u);
  EXPECT_EQ(d.points()[8], (Point3{1, 0.5, 0}));
  EXPECT_EQ(d.input_of_point()[8], 8u);
  EXPECT_EQ(diagnose(d).error_count(), 0u);
  EXPECT_EQ(std::ranges::count(d.segments(), 4, &DomainSegment::marker), 2);
}

TEST(Overlaps, AddedPointsHaveAttributes) {
  Plc<3> plc;
  add_box(plc, {0, 0, 0}, {2, 2, 2}, 1);
  add_box(plc, {2, 1, 1}, {4, 3, 3}, 2);
  for (const Point3& p : plc.points) {
    plc.point_markers.push_back(3);
    plc.point_attributes.insert(plc.point_attributes.end(), {p[0] + 2 * p[1], p[2]});
  }
  const Domain<3> d(plc);
  ASSERT_EQ(d.point_attributes().size(), 2 * d.points().size());
  for (std::size_t v = 0; v < d.points().size(); ++v) {
    const Point3& p = d.points()[v];
    EXPECT_DOUBLE_EQ(d.point_attributes()[2 * v], p[0] + 2 * p[1]);
    EXPECT_DOUBLE_EQ(d.point_attributes()[2 * v + 1], p[2]);
    EXPECT_EQ(d.point_markers()[v], d.input_of_point()[v] < plc.points.size() ? 3 : 0);
  }
}

// What comes of an input does not depend on the order of its facets, but for which marker is the first.
TEST(Overlaps, InAnyOrder) {
  std::mt19937_64 random(1);
  Plc<3> plc;
  add_box(plc, {0, 0, 0}, {6, 6, 2}, 1);
  for (int k = 0; k < 5; ++k) {
    const double c = std::cos(0.7 * k), s = std::sin(0.7 * k);
    const auto corner = [&](double u, double v) { return Point3{3 + c * u - s * v, 3 + s * u + c * v, 0}; };
    add_facet(plc, {corner(-2, -0.25), corner(2, -0.25), corner(2, 0.25), corner(-2, 0.25)}, 1);
  }
  plc = test::turned(plc);
  const Domain<3> first(plc);
  EXPECT_EQ(diagnose(first).error_count(), 0u);
  const auto sorted = [](const Domain<3>& d) {
    std::vector<Point3> points(d.points().begin(), d.points().end());
    std::sort(points.begin(), points.end(), lex_less<3>);
    return points;
  };
  for (int k = 0; k < 5; ++k) {
    std::shuffle(plc.facets.begin(), plc.facets.end(), random);
    const Domain<3> d(plc);
    EXPECT_EQ(sorted(d), sorted(first));
    EXPECT_EQ(d.segments().size(), first.segments().size());
    EXPECT_EQ(diagnose(d).error_count(), 0u);
  }
}

TEST(Overlaps, WhatCrossesIsRefusedStill) {
  Plc<3> plc;
  add_box(plc, {0, 0, 0}, {2, 2, 2}, 1);
  add_box(plc, {1, 1, 0}, {3, 3, 2}, 2);  // through its walls
  EXPECT_GT(diagnose(plc)[Finding::facets_cross].count, 0u);
  plc = test::triangulated(test::box());
  plc.segments = {{{1, 3}, 4}, {{0, 2}, 4}};  // two segments that cross in the bottom
  EXPECT_GT(diagnose(plc).error_count(), 0u);
}

}  // namespace pgdr::test_input_overlaps
