// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Cells that repeat: their sides correspond vertex by vertex, and what cannot is refused in words.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>

#include "pgdr/check.hpp"
#include "pgdr/error.hpp"
#include "pgdr/make_periodic.hpp"
#include "pgdr/refine.hpp"

namespace pgdr::test_run_periodic {

using Pairs = std::vector<PeriodicSides<2>>;

/// A cell with corners in this order, whose sides have the markers 1, 2, ... and so many pieces each, with a round hole of
/// marker 9.
Plc<2> cell(const std::vector<Point2>& corners, const std::vector<int>& pieces, Point2 middle, double radius, double turn = 0) {
  const double c = std::cos(turn), s = std::sin(turn);
  Plc<2> plc;
  const auto add = [&](double x, double y) { plc.points.push_back({{c * x - s * y, s * x + c * y}}); };
  const std::size_t n = corners.size();
  for (std::size_t i = 0; i < n; ++i)
    for (int k = 0; k < pieces[i]; ++k) {
      const Point2 &a = corners[i], &b = corners[(i + 1) % n];
      const double t = static_cast<double>(k) / pieces[i];
      const auto v = static_cast<std::uint32_t>(plc.points.size());
      add(a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1]));
      plc.segments.push_back({{v, v + 1}, static_cast<int>(i) + 1});
    }
  plc.segments.back().points[1] = 0;
  constexpr std::uint32_t round = 16;
  const auto first = static_cast<std::uint32_t>(plc.points.size());
  for (std::uint32_t k = 0; k < round && radius > 0; ++k) {
    const double angle = 2 * 3.141592653589793 * k / round;
    add(middle[0] + radius * std::cos(angle), middle[1] + radius * std::sin(angle));
    plc.segments.push_back({{first + k, first + (k + 1) % round}, 9});
  }
  if (radius > 0) plc.holes.push_back({{c * middle[0] - s * middle[1], s * middle[0] + c * middle[1]}});
  return plc;
}

const std::vector<Point2> square{{{0, 0}}, {{1, 0}}, {{1, 1}}, {{0, 1}}};
const std::vector<Point2> sheared{{{0, 0}}, {{1, 0}}, {{1.375, 1}}, {{0.375, 1}}};

/// Meshed and checked: the pairs.
std::vector<PeriodicPairs> expect_periodic(const Plc<2>& plc, const Pairs& sides, RefineOptions<2> options = {},
                                           std::uint32_t most_rounds = 16) {
  const PeriodicInput<2> made = make_periodic(plc, sides, options, most_rounds);
  EXPECT_EQ(made.plc.points.size(), plc.points.size() + made.added_points);
  options.keep_boundary = options.keep_boundary || made.keep_boundary;
  const RefineResult<2> result = refine(made.plc, options);
  CheckOptions<2> checked;
  checked.input = &plc;
  checked.tolerance = result.tolerance;
  checked.radius_edge_bound = options.radius_edge_bound;
  checked.size = options.size;
  checked.reasons = &result.reasons;
  checked.delaunay = true;
  const CheckReport report = check(result.mesh, checked);
  EXPECT_EQ(report.finding_count, 0u) << (report.findings.empty() ? "" : report.findings[0].message);
  std::vector<PeriodicPairs> pairs;
  for (const auto& side : made.sides) pairs.push_back(periodic_pairs(result.mesh, side, 2 * result.tolerance));
  for (const PeriodicPairs& p : pairs) EXPECT_EQ(p.walls + 1, p.points.size());
  return pairs;
}

TEST(Periodic, Cells) {
  RefineOptions<2> fine;
  fine.size = [](const Point2& p) { return 0.0005 + 0.01 * std::fabs(p[0]); };
  for (const double turn : {0.0, 0.37, 2.0})
    for (const auto& corners : {square, sheared})
      for (const auto& pieces : {std::vector{1, 1, 1, 1}, std::vector{3, 1, 2, 5}})
        for (const auto& options : {RefineOptions<2>(), fine}) {
          const Plc<2> plc = cell(corners, pieces, {{0.85, 0.3}}, 0.05, turn);
          const auto pairs = expect_periodic(plc, {{4, 2}, {1, 3}}, options);
          ASSERT_EQ(pairs.size(), 2u);
          EXPECT_GT(pairs[0].points.size(), 4u);
          if (turn != 0) continue;
          EXPECT_EQ(pairs[0].exact, pairs[0].points.size());
          EXPECT_EQ(pairs[1].exact, pairs[1].points.size());
        }
}

TEST(Periodic, ASectorTurnedByAMotion) {
  const double c = 0.5, s = std::sqrt(0.75);
  const Plc<2> plc = cell({{{0, 0}}, {{2, 0}}, {{2 * c, 2 * s}}}, {1, 1, 1}, {{1.2, 0.3}}, 0.1);
  const Motion<2> turn{c, -s, 0, s, c, 0};
  const auto pairs = expect_periodic(plc, {{1, 3, turn}});
  EXPECT_GT(pairs[0].points.size(), 5u);
  EXPECT_LE(pairs[0].largest_gap, 1e-15);
}

/// Where the rounds are over all of the boundary is kept, and the sides correspond all the same.
TEST(Periodic, KeptInTheEnd) {
  RefineOptions<2> options;
  options.size = 0.001;
  const Plc<2> plc = cell(sheared, {1, 1, 1, 1}, {{0.9, 0.3}}, 0.06);
  EXPECT_FALSE(make_periodic(plc, Pairs{{4, 2}, {1, 3}}, options).keep_boundary);
  const PeriodicInput<2> made = make_periodic(plc, Pairs{{4, 2}, {1, 3}}, options, 1);
  EXPECT_TRUE(made.keep_boundary);
  EXPECT_EQ(made.rounds, 1u);
  expect_periodic(plc, {{4, 2}, {1, 3}}, options, 1);
}

TEST(Periodic, KeptAsItIs) {
  RefineOptions<2> options;
  options.keep_boundary = true;
  const auto pairs = expect_periodic(cell(square, {4, 3, 4, 3}, {{0.5, 0.5}}, 0.2), {{4, 2}, {1, 3}}, options);
  EXPECT_EQ(pairs[0].points.size(), 4u);
  EXPECT_EQ(pairs[1].points.size(), 5u);
}

/// Three sides of a strip in a chain, and a fourth pair that closes it.
TEST(Periodic, Chains) {
  Plc<2> plc;
  for (int x = 0; x < 3; ++x)
    for (int y = 0; y < 2; ++y) plc.points.push_back({{static_cast<double>(x), static_cast<double>(y)}});
  plc.segments = {{{0, 1}, 1}, {{2, 3}, 2}, {{4, 5}, 3}, {{0, 2}, 4}, {{2, 4}, 4}, {{1, 3}, 5}, {{3, 5}, 5}};
  RefineOptions<2> options;
  options.size = [](const Point2& p) { return 0.001 + 0.01 * p[0]; };
  for (const Pairs& sides :
       {Pairs{{1, 2}, {2, 3}}, Pairs{{1, 2}, {2, 3}, {1, 3}}, Pairs{{3, 2}, {2, 1}, {4, 5}}, Pairs{{1, 3}, {2, 3}}}) {
    const auto pairs = expect_periodic(plc, sides, options);
    EXPECT_GT(pairs[0].points.size(), 10u);
    EXPECT_EQ(pairs[0].points.size(), pairs[1].points.size());
  }
}

/// The words; each has the numbers of points that are of the input, unless it is of markers alone.
std::string refusal(const Plc<2>& plc, const Pairs& sides) {
  try {
    make_periodic(plc, sides, {});
  } catch (const UsageError& e) {
    EXPECT_EQ(e.code(), Errc::bad_option);
    EXPECT_EQ(e.diagnostic().ids.empty(), e.diagnostic().points.empty());
    return e.what();
  }
  return "periodic";
}

TEST(PeriodicRefusals, InWords) {
  const Plc<2> plc = cell(square, {1, 1, 1, 1}, {}, 0);
  EXPECT_EQ(refusal(plc, {{4, 4}}), "the periodic sides 4 and 4 are one side");
  EXPECT_EQ(refusal(plc, {{4, 7}}), "no segment has the marker 7 that a periodic side is to have");
  EXPECT_EQ(
      refusal(plc, {{4, 3}}),
      "the periodic sides do not match within the tolerance: the point 3 (0, 1) of that with marker 4 would be at (0, 2) of "
      "that with marker 3, where there is no segment of it");
  EXPECT_EQ(refusal(plc, {{4, 2}, {2, 4, Motion<2>{1, 0, 1, 0, 1, 0}}}),
            "the periodic sides 2 and 4 contradict the others: the point (1, 0) would be at (2, 0) and at (0, 0)");
  EXPECT_EQ(refusal(plc, {{4, 2, Motion<2>{2, 0, 1, 0, 1, 0}}}), "a motion of periodic sides must keep lengths and angles");
  Plc<2> bent = cell(square, {1, 2, 1, 1}, {}, 0);
  bent.points[2][0] = 1.25;
  bent.first_index = 1;
  EXPECT_EQ(refusal(bent, {{4, 2}}),
            "the periodic sides do not match within the tolerance: the point 3 (1.25, 0.5) of that with marker 2 would be at "
            "(0.25, 0.5) of that with marker 4, where there is no segment of it");
  Plc<2> open = cell(square, {1, 3, 1, 1}, {}, 0);
  open.segments[2].marker = 8;  // the middle of side 2
  EXPECT_EQ(
      refusal(open, {{4, 2}}),
      "the periodic sides with markers 4 and 2 do not match: one of them alone has a segment between (0, 0.3333333333333333) "
      "and (0, 0.6666666666666666), on the other (1, 0.3333333333333333) and (1, 0.6666666666666666)");
}

TEST(PeriodicRefusals, OfMeshes) {
  OutputMesh<2> mesh;
  mesh.points = {{{0, 0}}, {{1, 0}}, {{1, 1}}, {{0, 1}}, {{1, 0.5}}};
  mesh.subsegments = {{{0, 3}, 4}, {{1, 2}, 2}, {{0, 1}, 1}};
  EXPECT_EQ(periodic_pairs<2>(mesh, {4, 2, {}}, 0).points, (std::vector<std::array<std::uint32_t, 2>>{{0, 1}, {3, 2}}));
  const auto words = [&](const PeriodicSides<2>& sides) -> std::string {
    try {
      periodic_pairs<2>(mesh, sides, 1e-9);
    } catch (const UsageError& e) {
      return e.what();
    }
    return "";
  };
  EXPECT_EQ(words({4, 2, Motion<2>{1, 0, 1, 0, 1, 1e-6}}),
            "vertex 0 of the side with marker 4 has no image within the tolerance on that with marker 2, at (0, 0)");
  EXPECT_EQ(words({4, 2, Motion<2>{2, 0, 1, 0, 1, 0}}), "a motion of periodic sides must keep lengths and angles");
  EXPECT_EQ(words({4, 5, {}}), "no segment has the marker 5 that a periodic side is to have");
  mesh.subsegments[1].vertices = {1, 4};
  mesh.subsegments.push_back({{2, 4}, 2});
  EXPECT_EQ(words({4, 2, {}}), "vertex 4 of the side with marker 2 is the image of none of that with marker 4, at (1, 0.5)");
  EXPECT_EQ(words({2, 4, {}}),
            "vertex 4 of the side with marker 2 has no image within the tolerance on that with marker 4, at (1, 0.5)");
}

}  // namespace pgdr::test_run_periodic
