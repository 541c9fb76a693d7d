// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Polygons whose corners were printed with few digits: one facet each, off their planes by more than doubles are rounded.
// (Plates with round holes, turned and of nine digits, had faces that are not Delaunay beside the walls of the holes; caps
// of gears with six digits, 100 away from the origin, were refused, as a bend counted in proportion to that distance.)
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <tuple>

#include "input/bent_facets.hpp"
#include "parallel_support.hpp"
#include "pgdr/io.hpp"
#include "space/planar_cdt.hpp"

namespace pgdr::test_input_uneven {

/// Its outline alternates between the radii 1 and `inner`; all its faces are polygons.
Plc<3> star_prism(std::uint32_t corners, double inner, double height) {
  Plc<3> plc;
  std::vector<std::uint32_t> caps[2];
  for (const int top : {0, 1})
    for (std::uint32_t i = 0; i < corners; ++i) {
      const double angle = 2 * std::numbers::pi * i / corners, r = i % 2 == 0 ? 1 : inner;
      caps[top].push_back(static_cast<std::uint32_t>(plc.points.size()));
      plc.points.push_back({{r * std::cos(angle), r * std::sin(angle), top * height}});
    }
  for (const auto& cap : caps) plc.facets.push_back({{cap}, {}, 0});
  for (std::uint32_t i = 0; i < corners; ++i) {
    const std::uint32_t j = (i + 1) % corners;
    plc.facets.push_back({{{caps[0][i], caps[0][j], caps[1][j], caps[1][i]}}, {}, 0});
  }
  return plc;
}

Plc<3> printed(Plc<3> plc, double last_digit) {
  test::for_each_point(plc, [last_digit](Point3& p) {
    for (double& x : p.x) x = std::round(x / last_digit) * last_digit;
  });
  return plc;
}

bool is_uneven(const Plc<3>& plc) {
  const Domain<3> domain(plc);
  return std::any_of(domain.facets().begin(), domain.facets().end(), [](const auto& f) { return f.planarity_defect > 1e-12; });
}

class Uneven : public testing::TestWithParam<double> {};
INSTANTIATE_TEST_SUITE_P(Shift, Uneven, testing::Values(0, 100), testing::PrintToStringParamName());

TEST_P(Uneven, WallsOfNineDigitsHaveNoViolations) {
  for (const std::uint32_t corners : {20u, 22u, 24u, 26u, 28u, 30u, 32u, 34u}) {
    const Plc<3> plc = printed(test::turned(star_prism(corners, 1, 0.5), GetParam()), 1e-7);
    ASSERT_TRUE(is_uneven(plc));
    const auto outcome = test::refine_and_check<3>(plc, {});
    EXPECT_EQ(outcome.report.exit_code(), 0) << corners << ": " << test::findings(outcome.report);
    EXPECT_EQ(outcome.report.not_delaunay_refused, 0u);
  }
}

TEST_P(Uneven, CapsOfSixDigitsAreMeshed) {
  const Plc<3> plc = printed(test::turned(star_prism(68, 0.5, 0.5), GetParam()), 1e-4);
  ASSERT_TRUE(is_uneven(plc));
  test::expect_reproducible<3>(plc, {}, "star", test::eight_threads);
}

// Steiner points are off the plane of their facet by an ulp, here of 1e7: in its in-circle tests, which compare |x|^2, that
// counted as much as the origin is far, so that triangles were taken which are not Delaunay, along segments even flat ones, and
// both were refused. (The mesh is larger than nearby, by ten times for the first: the walls are all but squares, whose diagonal
// rounding chooses, and where the facet and the mesh choose different ones an edge is split, and with it those near it.)
TEST(FarFromTheOrigin, IsMeshed) {
  for (const auto& [corners, inner, height] : {std::tuple{68u, 0.5, 0.5}, {100u, 0.95, 0.3}}) {
    const Plc<3> far = test::turned<3>(star_prism(corners, inner, height), 1e7);
    const auto outcome = test::refine_and_check<3>(far, {});
    EXPECT_LE(outcome.report.exit_code(), 1) << corners << ": " << test::findings(outcome.report);
    if (corners == 68) test::expect_reproducible<3>(far, {}, "far", test::eight_threads);
  }
}

// Four points in the far corner of a slanted polygon, off its plane by a millionth, a hundredth of what they are apart: the
// shorter diagonal is Delaunay, whichever way they are off. (The heights of in-circle tests were |x|^2 from the polygon's first
// corner, where a millionth counts as much as circles of a thousandth. So triangles were taken that are not Delaunay; strips of a
// thickened surface, a file of six digits, were split down to rounding, and refused.)
TEST(LevelledFacet, BendsFarFromItsLevelDecideNoCircle) {
  const auto height = [](double x, double y) { return 0.9 * x + 0.3 * y; };
  Plc<3> plc;
  for (const auto& [x, y] : {std::pair{0., 0.}, {1., 0.}, {1., 1.}, {0., 1.}})
    plc.points.push_back({{x, y, height(x, y) + (x == y ? 1e-6 : -1e-6)}});
  plc.points.push_back({{0.5, 0.5, 3}});
  plc.facets.push_back({{{0, 1, 2, 3}}, {}, 0});
  for (std::uint32_t i = 0; i < 4; ++i) plc.facets.push_back({{{i, (i + 1) % 4, 4}}, {}, 0});
  const Domain<3> domain(plc);
  EntityId bent = 0;
  while (domain.facet_points(bent).size() != 4) ++bent;
  ASSERT_TRUE(detail::is_uneven(domain, bent));
  const detail::LevelledFacet levelled(domain, bent);
  for (unsigned off = 0; off < 16; ++off)
    for (const bool is_turned : {false, true}) {
      const double a = 1e-4, b = 1.05e-4;  // half of the diagonals
      std::vector<Point3> points;
      for (const auto& [u, v] : {std::pair{a, 0.}, {0., b}, {-a, 0.}, {0., -b}}) {
        // Across the slope lengths are as in the projection; along it they are longer by sqrt(1 + 0.9^2 + 0.3^2).
        const double along = u / std::sqrt(1.9), x = 0.98 + (0.9 * along - 0.3 * v) / std::sqrt(0.9),
                     y = 0.98 + (0.3 * along + 0.9 * v) / std::sqrt(0.9);
        points.push_back(levelled({{x, y, height(x, y) + ((off >> points.size() & 1) != 0 ? 1e-6 : -1e-6)}}));
      }
      if (is_turned) std::rotate(points.begin(), points.begin() + 1, points.end());
      detail::PlanarTriangulation plane;
      ASSERT_TRUE(plane.build(points, std::vector<std::uint32_t>{0, 1, 2, 3}, {}, domain.facets()[bent].axis));
      for (const auto& t : plane.triangles())
        EXPECT_EQ(std::count_if(t.begin(), t.end(), [&](std::uint32_t v) { return v % 2 == (is_turned ? 1 : 0); }), 2) << off;
    }
}

// Sixteen nearly coplanar facets about each hub. The recovery of the facets went on for ever there: a facet's triangle had
// its edge split on a shell, and in the same round its neighbour, whose triangle was gone with that edge, had the new half
// split once more; then the former's triangle between unequal shells was missing. One of nine that were refused, of 888 such
// plates.
TEST(Fans, NeighboursDoNotHalveEdgesInTurns) {
  const Plc<3> plc = read_plc<3>(PGDR_TEST_MODELS "/star_plate.off");
  const auto outcome = test::refine_and_check<3>(plc, {});
  EXPECT_LE(outcome.report.exit_code(), 1) << test::findings(outcome.report);
  EXPECT_LT(outcome.result.mesh.cells.size(), 5000u);
}

}  // namespace pgdr::test_input_uneven
