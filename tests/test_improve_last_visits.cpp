// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The visits that end a run: where elements stay poor, vertices taken out and points leave fewer of these.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <ostream>
#include <string>
#include <vector>

#include "parallel_support.hpp"
#include "rule/cell_bounds.hpp"

namespace pgdr::test_improve_last_visits {

/// A prism over an isosceles triangle with sides of 1 that meet at this angle, 1 high; the sides are cut along diagonals.
Plc<3> wedge(double degrees) {
  const double a = degrees * std::numbers::pi / 180;
  Plc<3> plc;
  for (const double y : {0.0, 1.0}) {
    plc.points.push_back({{0, y, 0}});
    plc.points.push_back({{1, y, 0}});
    plc.points.push_back({{std::cos(a), y, std::sin(a)}});
  }
  const std::array<std::array<std::uint32_t, 3>, 8> triangles{
      {{0, 2, 1}, {3, 4, 5}, {0, 1, 4}, {0, 4, 3}, {0, 3, 5}, {0, 5, 2}, {1, 2, 5}, {1, 5, 4}}};
  for (const auto& t : triangles) plc.facets.push_back({{{t.begin(), t.end()}}, {}, 0});
  return plc;
}

struct Case {
  double degrees;
  std::uint64_t most_poor;  ///< that may be left; without these visits it were `before`
  std::uint64_t before;
};

std::ostream& operator<<(std::ostream& out, const Case& c) { return out << c.degrees << " degrees"; }

class Wedges : public testing::TestWithParam<Case> {};

// Of 1 and 2 degrees also: a point on an entity beside an element that stays as it is left that element on no list, so that it
// had no reason (check ended with 6).
TEST_P(Wedges, KeepFewPoorCells) {
  const RefineResult<3> result = test::expect_reproducible<3>(wedge(GetParam().degrees), {}, "wedge");
  EXPECT_LE(result.poor_left, GetParam().most_poor) << "before: " << GetParam().before;
  EXPECT_GE(result.reasons.size(), result.poor_left);
}

INSTANTIATE_TEST_SUITE_P(Improvement, Wedges, testing::Values(Case{1, 6, 171}, Case{2, 6, 75}, Case{5, 10, 40}, Case{10, 5, 10}),
                         [](const auto& info) { return std::to_string(static_cast<int>(info.param.degrees)); });

/// Of those with an end that is no point of the input.
double shortest_new_edge(const OutputMesh<3>& mesh, const Plc<3>& plc) {
  double least = std::numeric_limits<double>::infinity();
  const auto is_new = [&](const Point3& p) { return std::find(plc.points.begin(), plc.points.end(), p) == plc.points.end(); };
  for (const auto& cell : mesh.cells)
    for (const std::uint32_t v : cell)
      for (const std::uint32_t w : cell)
        if (v != w && is_new(mesh.points[v])) least = std::min(least, squared_distance(mesh.points[v], mesh.points[w]));
  return std::sqrt(least);
}

TEST(Improvement, HeedsTheShortestEdgeAllowed) {
  const Plc<3> plc = wedge(0.5);
  RefineOptions<3> options;
  EXPECT_LT(shortest_new_edge(test::refine_and_check<3>(plc, options).result.mesh, plc), 0.02);
  options.min_edge = 0.02;
  EXPECT_GE(shortest_new_edge(test::refine_and_check<3>(plc, options).result.mesh, plc), 0.02 * (1 - 1e-12));
}

TEST(Improvement, KeepsToTheBudget) {
  bool stopped = false, ended = false;
  for (std::uint64_t vertices = 7; vertices < 60; ++vertices) {
    RefineOptions<3> options;
    options.max_vertices = vertices;
    const test::Outcome<3> outcome = test::refine_and_check<3>(wedge(5), options);
    EXPECT_LE(outcome.result.mesh.points.size(), vertices);
    EXPECT_TRUE(!ended || outcome.result.stop == StopCause::finished) << vertices;
    stopped = stopped || outcome.result.stop == StopCause::max_vertices;
    ended = outcome.result.stop == StopCause::finished;
  }
  EXPECT_TRUE(stopped);
  EXPECT_TRUE(ended);
}

// Below the bound that theory proves these visits depend on the share of the cells that are poor: once of the slots of cells,
// of which a run with more threads has more.
TEST(Improvement, IsReproducibleBelowTheProvedBound) {
  for (const double bound : {1.4, 1.8})
    for (const double height : {0.017, 0.05, 0.2}) {
      Plc<3> plc;  // a wedge again, with whole faces
      plc.points = {{{0, 0, 0}}, {{0, 1, 0}}, {{1, 0, 0}}, {{1, 1, 0}}, {{1, 0, height}}, {{1, 1, height}}};
      for (const auto& polygon :
           std::vector<std::vector<std::uint32_t>>{{0, 2, 3, 1}, {0, 4, 5, 1}, {0, 2, 4}, {1, 3, 5}, {2, 3, 5, 4}})
        plc.facets.push_back({{polygon}, {}, 0});
      RefineOptions<3> options;
      options.radius_edge_bound = bound;
      options.schedule.floor = 20;
      const std::string what = "height " + std::to_string(height) + ", bound " + std::to_string(bound);
      test::expect_reproducible<3>(plc, options, what, test::two_if_quick);
    }
}

TEST(Excess, IsWhatBoundsSay) {
  const Simplex<3> good{{{{0, 0, 0}}, {{1, 0, 0}}, {{0, 1, 0}}, {{0, 0, 1}}}};  // circumradius sqrt(3) / 2
  const Simplex<3> needle{{{{0, 0, 0}}, {{0.0625, 0, 0}}, {{0, 1, 0}}, {{0, 0, 1}}}};
  const Simplex<3> flat{{{{0, 0, 0}}, {{1, 0, 0}}, {{0, 1, 0}}, {{1, 1, 1e-300}}}};
  CellBounds<3> bounds;
  EXPECT_EQ(bounds.excess(needle, 0), 0);
  bounds.radius_edge_bound = 2;
  EXPECT_EQ(bounds.excess(good, 0), 0);
  EXPECT_GT(bounds.excess(needle, 0), 1);
  EXPECT_LT(bounds.excess(needle, 0), 1.5);
  EXPECT_LE(bounds.excess(flat, 0), 3.5);
  bounds.size = SizingField<3>(0.8);
  EXPECT_EQ(bounds.excess(good, 0), 1);
  bounds.size = SizingField<3>(0.9);
  EXPECT_EQ(bounds.excess(good, 0), 0);
  bounds.max_measure = 0.1;  // of 1/6
  EXPECT_EQ(bounds.excess(good, 0), 1);
  bounds.max_measure = 1;
  bounds.region_measure = {1, 0.1};
  EXPECT_EQ(bounds.excess(good, 0), 0);
  EXPECT_EQ(bounds.excess(good, 1), 1);
}

}  // namespace pgdr::test_improve_last_visits
