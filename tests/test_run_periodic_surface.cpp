// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Periodic sides in 3D: facets that correspond, triangle by triangle, and what cannot is refused in words.
#include <gtest/gtest.h>

#include <cmath>

#include "pgdr/check.hpp"
#include "pgdr/error.hpp"
#include "pgdr/make_periodic.hpp"
#include "pgdr/refine.hpp"

namespace pgdr::test_run_periodic_surface {

using Pairs = std::vector<PeriodicSides<3>>;
using Axes = std::array<Point3, 3>;

const Axes straight{{{{1, 0, 0}}, {{0, 1, 0}}, {{0, 0, 1}}}};
const Axes slanted{{{{1, 0, 0}}, {{0.3, 1, 0}}, {{-0.2, 0.4, 1}}}};
const Pairs all_pairs{{1, 2, {}}, {3, 4, {}}, {5, 6, {}}};

/// A cell with the markers 1, 2 at the ends of the first axis, 3, 4 and 5, 6 of the others; its points are numbered by bits.
Plc<3> cell(const Axes& axes = straight) {
  Plc<3> plc;
  for (std::uint32_t v = 0; v < 8; ++v) {
    Point3 p{};
    for (std::uint32_t k = 0; k < 3; ++k)
      for (int i = 0; i < 3; ++i) p[i] += (v >> k & 1) * axes[k][i];
    plc.points.push_back(p);
  }
  for (std::uint32_t axis = 0; axis < 3; ++axis)
    for (const std::uint32_t level : {0u, 1u}) {
      const std::uint32_t first = level << axis, u = 1u << (axis + 1) % 3, v = 1u << (axis + 2) % 3;
      plc.facets.push_back({{{first, first | u, first | u | v, first | v}}, {}, static_cast<int>(2 * axis + level + 1)});
    }
  return plc;
}

/// A square of half the width in the middle of a face, as another polygon of it; with a hole the facet is not there.
void add_square(Plc<3>& plc, std::size_t facet, bool is_hole) {
  const auto corners = plc.facets[facet].polygons[0];
  std::vector<std::uint32_t> square;
  Point3 middle{};
  for (const std::uint32_t v : corners)
    for (int i = 0; i < 3; ++i) middle[i] += plc.points[v][i] / 4;
  for (const std::uint32_t v : corners) {
    Point3 p;
    for (int i = 0; i < 3; ++i) p[i] = (plc.points[v][i] + middle[i]) / 2;
    square.push_back(static_cast<std::uint32_t>(plc.points.size()));
    plc.points.push_back(p);
  }
  plc.facets[facet].polygons.push_back(square);
  if (is_hole) plc.facets[facet].holes.push_back(middle);
}

/// A tunnel through the cell from face to face.
void add_tunnel(Plc<3>& plc) {
  for (const std::size_t facet : {0, 1}) add_square(plc, facet, true);
  const auto a = plc.facets[0].polygons[1], b = plc.facets[1].polygons[1];
  for (std::size_t i = 0; i < 4; ++i) plc.facets.push_back({{{a[i], a[(i + 1) % 4], b[(i + 1) % 4], b[i]}}, {}, 9});
}

/// A part of a wheel, so many degrees wide; its cuts have the markers 1 and 2.
Plc<3> sector(double degrees, double inner) {
  const double angle = degrees * 3.141592653589793 / 180;
  Plc<3> plc;
  for (const double z : {0.0, 0.5})
    for (const double turn : {0.0, angle})
      for (const double r : {inner, 1.0}) plc.points.push_back({{r * std::cos(turn), r * std::sin(turn), z}});
  using Polygons = std::vector<std::vector<std::uint32_t>>;
  for (const auto& [polygon, marker] :
       {std::pair{Polygons{{0, 1, 5, 4}}, 1}, std::pair{Polygons{{2, 3, 7, 6}}, 2}, std::pair{Polygons{{0, 1, 3, 2}}, 3},
        std::pair{Polygons{{4, 5, 7, 6}}, 3}, std::pair{Polygons{{1, 3, 7, 5}}, 4}, std::pair{Polygons{{0, 2, 6, 4}}, 4}})
    plc.facets.push_back({polygon, {}, marker});
  return plc;
}
Motion<3> turn_by(double degrees) {
  const double angle = degrees * 3.141592653589793 / 180, c = std::cos(angle), s = std::sin(angle);
  return {c, -s, 0, 0, s, c, 0, 0, 0, 0, 1, 0};
}

struct Made {
  PeriodicInput<3> input;
  RefineResult<3> result;
  std::vector<PeriodicPairs> pairs;
};

CheckReport checked(const Plc<3>& plc, const Made& made, const RefineOptions<3>& options, std::vector<int> kept_sides) {
  CheckOptions<3> how;
  how.input = &plc;
  how.tolerance = made.result.tolerance;
  how.radius_edge_bound = options.radius_edge_bound;
  how.size = options.size;
  how.largest_cosine = made.result.optimization.claimed_cosine;
  how.reasons = &made.result.reasons;
  how.kept_sides = std::move(kept_sides);
  return check(made.result.mesh, how);
}

Made meshed(const Plc<3>& plc, const Pairs& sides, RefineOptions<3> options = {}, std::uint32_t most_rounds = 16) {
  Made made{make_periodic(plc, sides, options, most_rounds), {}, {}};
  options.keep_boundary = made.input.keep_boundary;
  options.kept_markers = made.input.kept_markers;
  made.result = refine(made.input.plc, options);
  name_as_given(made.input, made.result.mesh, made.result.reasons);
  for (const auto& side : made.input.sides)
    made.pairs.push_back(periodic_pairs(made.result.mesh, side, 2 * made.result.tolerance));
  return made;
}

/// Meshed and checked against what was given.
Made expect_periodic(const Plc<3>& plc, const Pairs& sides, const RefineOptions<3>& options = {},
                     std::uint32_t most_rounds = 16) {
  const Made made = meshed(plc, sides, options, most_rounds);
  EXPECT_EQ(made.result.statistics.boundary_points, 0u);
  std::vector<int> markers;
  for (const auto& pair : sides) markers.insert(markers.end(), {pair.from, pair.to});
  const CheckReport report = checked(plc, made, options, markers);
  EXPECT_EQ(report.finding_count, 0u) << (report.findings.empty() ? "" : report.findings[0].message);
  EXPECT_EQ(made.pairs.size(), sides.size());
  return made;
}

TEST(PeriodicSurface, CellsOfCrystals) {
  RefineOptions<3> fine;
  fine.size = [](const Point3& p) { return 0.05 + 0.15 * std::fabs(p[0]); };
  for (const auto& axes : {straight, slanted})
    for (const auto& options : {RefineOptions<3>(), fine}) {
      const Made made = expect_periodic(cell(axes), all_pairs, options);
      EXPECT_EQ(made.result.poor_left, 0u);
      EXPECT_TRUE(made.result.size_met);
      for (const PeriodicPairs& p : made.pairs) EXPECT_GE(p.points.size(), options.size.bounded() ? 100u : 4u);
      ASSERT_EQ(made.result.regions.size(), 1u);
      EXPECT_NEAR(made.result.regions[0].volume_meshed, 1, 1e-14);
      for (const PeriodicPairs& p : made.pairs) EXPECT_LE(p.largest_gap, 3e-16);
    }
  const Made made = expect_periodic(cell(), all_pairs, fine);
  for (const PeriodicPairs& p : made.pairs) EXPECT_EQ(p.exact, p.points.size());
}

TEST(PeriodicSurface, AnyNumberOfThreads) {
  Plc<3> plc = cell(slanted);
  add_tunnel(plc);
  std::vector<OutputMesh<3>> meshes;
  for (const int threads : {1, 2, 8}) {
    RefineOptions<3> options;
    options.size = 0.08;
    options.schedule.threads = threads;
    meshes.push_back(meshed(plc, all_pairs, options).result.mesh);
  }
  ASSERT_GT(meshes[0].cells.size(), 1000u);
  for (const auto& mesh : meshes) {
    EXPECT_EQ(mesh.points, meshes[0].points);
    EXPECT_EQ(mesh.cells, meshes[0].cells);
  }
}

/// A side may be given in other triangles than its image; points and lines that one has alone the other gets.
TEST(PeriodicSurface, SidesGivenOtherwise) {
  Plc<3> plc = cell();
  plc.facets.erase(plc.facets.begin(), plc.facets.begin() + 2);
  for (const auto& [corners, marker] :
       {std::pair{std::vector<std::uint32_t>{0, 2, 6}, 1}, std::pair{std::vector<std::uint32_t>{0, 6, 4}, 1},
        std::pair{std::vector<std::uint32_t>{1, 3, 5}, 2}, std::pair{std::vector<std::uint32_t>{3, 7, 5}, 2}})
    plc.facets.push_back({{corners}, {}, marker});
  EXPECT_EQ(expect_periodic(plc, all_pairs).pairs[0].points.size(), expect_periodic(cell(), all_pairs).pairs[0].points.size());

  Plc<3> with_square = cell();
  add_square(with_square, 0, false);
  const Made made = expect_periodic(with_square, all_pairs);
  std::size_t images = 0;
  for (const auto& [v, w] : made.pairs[0].points) images += v >= 8 && v < 12 && made.result.mesh.points[w][1] != 0;
  EXPECT_EQ(images, 4u);
}

TEST(PeriodicSurface, ATunnelFromSideToSide) {
  for (const auto& axes : {straight, slanted}) {
    Plc<3> plc = cell(axes);
    add_tunnel(plc);
    const Made made = expect_periodic(plc, all_pairs);
    EXPECT_NEAR(made.result.regions.at(0).volume_meshed, 0.75, 1e-14);
  }
}

TEST(PeriodicSurface, SectorsOfWheels) {
  for (const double inner : {0.0, 0.25}) {
    Plc<3> plc = sector(60, inner);
    if (inner == 0) {  // the axis is an edge of both
      plc.facets.pop_back();
      plc.facets[2] = {{{0, 1, 3}}, {}, 3};
      plc.facets[3] = {{{4, 5, 7}}, {}, 3};
    }
    const Made made = expect_periodic(plc, {{1, 2, turn_by(60)}});
    EXPECT_EQ(made.result.poor_left, 0u);
    EXPECT_LE(made.pairs[0].largest_gap, 3e-16);
  }
}

/// A motion that takes the edge between two sides onto itself, the other way round.
TEST(PeriodicSurface, AnEdgeThatIsTurnedRound) {
  RefineOptions<3> options;
  options.size = [](const Point3& p) { return 0.06 + 0.2 * p[2]; };
  const Made made = expect_periodic(cell(), {{3, 1, Motion<3>{0, 1, 0, 0, 1, 0, 0, 0, 0, 0, -1, 1}}}, options);
  std::size_t on_edge = 0, in_the_middle = 0;
  for (const auto& [v, w] : made.pairs[0].points) {
    const Point3& p = made.result.mesh.points[v];
    on_edge += p[0] == 0;
    in_the_middle += v == w;
  }
  EXPECT_GT(on_edge, 6u);
  EXPECT_EQ(in_the_middle, 1u);
}

/// What is kept is an excuse, of these sides alone.
TEST(PeriodicSurface, ReasonsNameSides) {
  Plc<3> plc = sector(10, 0);
  plc.facets.pop_back();
  plc.facets[2] = {{{0, 1, 3}}, {}, 3};
  plc.facets[3] = {{{4, 5, 7}}, {}, 3};
  RefineOptions<3> options;
  options.size = 0.2;
  const Made made = expect_periodic(plc, {{1, 2, turn_by(10)}}, options);
  std::size_t kept = 0;
  for (const PoorReason& r : made.result.reasons) {
    if (r.code != PoorReason::Code::kept_boundary) continue;
    ++kept;
    EXPECT_EQ(r.entities[0].kind, EntityKind::facet);
    EXPECT_LT(r.entities[0].facet, 2u);
  }
  EXPECT_GT(kept, 0u);
  const CheckReport without = checked(plc, made, options, {});
  EXPECT_GT(without.count(CheckFinding::Kind::bad_reason), 0u);
}

TEST(PeriodicSurface, KeptInTheEnd) {
  RefineOptions<3> options;
  options.size = 0.15;
  const Made made = expect_periodic(cell(slanted), all_pairs, options, 1);
  EXPECT_EQ(made.input.rounds, 2u);
}

TEST(PeriodicSurface, WithoutRefinement) {
  RefineOptions<3> options;
  options.refine = false;
  EXPECT_EQ(meshed(cell(slanted), all_pairs, options).input.added_points, 0u);
}

/// Facets that are kept are those that were given; so it is up to them.
TEST(PeriodicSurface, WhereTheGivenFacetsAreKept) {
  RefineOptions<3> options;
  options.keep_boundary = true;
  const auto made = make_periodic(cell(), all_pairs, options);
  EXPECT_TRUE(made.given_facets.empty());
  EXPECT_EQ(made.plc.facets.size(), 6u);
  options.kept_markers = {9};
  EXPECT_GT(make_periodic(cell(), all_pairs, options).plc.facets.size(), 6u);
}

std::string refusal(const Plc<3>& plc, const Pairs& sides) {
  try {
    make_periodic(plc, sides, {});
  } catch (const UsageError& e) {
    EXPECT_EQ(e.code(), Errc::bad_option);
    return e.what();
  }
  return "periodic";
}

TEST(PeriodicSurfaceRefusals, InWords) {
  const Plc<3> plc = cell();
  EXPECT_EQ(refusal(plc, {{1, 1, {}}}), "the periodic sides 1 and 1 are one side");
  EXPECT_EQ(refusal(plc, {{1, 7, {}}}), "no facet has the marker 7 that a periodic side is to have");
  EXPECT_EQ(refusal(plc, {{1, 2, Motion<3>{2, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0}}}),
            "a motion of periodic sides must keep lengths and angles");
  EXPECT_EQ(
      refusal(plc, {{1, 3, {}}}),
      "the periodic sides do not match within the tolerance: the point 2 (0, 1, 0) of that with marker 1 would be at (0, 1, "
      "0) of that with marker 3, where there is no facet of it");
  EXPECT_EQ(refusal(plc, {{1, 2, {}}, {2, 1, Motion<3>{1, 0, 0, 1, 0, 1, 0, 0, 0, 0, 1, 0}}}),
            "the periodic sides 2 and 1 contradict the others: the point (1, 0, 0) would be at (2, 0, 0) and at (0, 0, 0)");
  Plc<3> with_pocket = plc;  // in the first face, as deep as half of the cell
  add_tunnel(with_pocket);
  with_pocket.facets[1] = plc.facets[1];
  for (std::size_t v = 12; v < 16; ++v) with_pocket.points[v][0] = 0.5;
  with_pocket.facets.push_back({{{12, 13, 14, 15}}, {}, 9});
  const std::string words = refusal(with_pocket, all_pairs);
  EXPECT_EQ(words.find("the periodic sides do not match within the tolerance: that with marker 1 has no facet at (0, 0."), 0u)
      << words;
  EXPECT_NE(words.find(", and that with marker 2 has one at (1, 0."), std::string::npos) << words;
  Plc<3> crossed = plc;  // lines of both sides, of which each has one
  crossed.facets[0].polygons.push_back({0, 6});
  crossed.facets[1].polygons.push_back({3, 5});
  EXPECT_EQ(refusal(crossed, all_pairs)
                .find("the lines on the periodic side with marker 1 and those that others of its chain have do not fit"),
            0u)
      << refusal(crossed, all_pairs);
}

}  // namespace pgdr::test_run_periodic_surface
