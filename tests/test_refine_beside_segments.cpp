// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Points beside segments, off them by rounding or little more, that no tolerance lets meet: wherever split points are rounded to,
// runs end, and no two vertices are at one place. Such inputs once had no end, or gave two vertices at one place.
#include <gtest/gtest.h>

#include <array>
#include <optional>
#include <string>

#include "pgdr/diagnosis.hpp"
#include "planar_plcs.hpp"
#include "refined_models.hpp"

namespace pgdr::test_refine_beside_segments {

using namespace test;

/// `ulps`: how far points are off, at most. Somewhat above the rounding of coordinates elements of its size can be made, but not
/// with good angles, and the checker does not take that for a reason.
void expect_sound(const Plc<2>& plc, int ulps, std::size_t most_cells, const std::string& what) {
  const RefineOptions<2> options;
  const RefineResult<2> result = refine<2>(plc, options);
  CheckOptions<2> check_options;
  check_options.input = &plc;
  check_options.tolerance = result.tolerance;
  check_options.radius_edge_bound = options.radius_edge_bound;
  check_options.delaunay = result.delaunay;
  check_options.reasons = &result.reasons;
  const CheckReport report = check<2>(result.mesh, check_options);
  EXPECT_EQ(result.stop, StopCause::finished) << what;
  EXPECT_LE(result.mesh.cells.size(), most_cells) << what;
  std::vector<Point2> points = result.mesh.points;
  std::sort(points.begin(), points.end(), lex_less<2>);
  EXPECT_EQ(std::adjacent_find(points.begin(), points.end()), points.end()) << what;
  const std::uint64_t unreasoned = ulps > 8 && ulps < 64 ? report.count(CheckFinding::Kind::bad_reason) : 0;
  EXPECT_TRUE(report.exit_code() <= 1 || report.finding_count == unreasoned) << what << findings(report);
}

/// A polygon with points on its sides, rounded, and moved by up to so many ulps of its largest coordinate.
Plc<2> polygon_with_points(Random& random, double far, double digits, int ulps) {
  Plc<2> plc;
  plc.tolerance = 0;
  const std::uint32_t corners = 3 + below(random, 3), on_side = 1 + below(random, 3);
  const auto rounded = [&](double x) { return std::round(x * digits) / digits; };
  for (std::uint32_t i = 0; i < corners; ++i) {
    const double turn = 2 * std::numbers::pi * (i + 0.4 * uniform(random)) / corners;
    plc.points.push_back({{rounded(far + std::cos(turn)), rounded(2 * far + std::sin(turn))}});
  }
  for (std::uint32_t i = 0; i < corners; ++i) add_segment(plc, i, (i + 1) % corners);
  const double ulp = std::ldexp(1.0, std::ilogb(2 * far + 1) - 52);
  for (std::uint32_t i = 0; i < corners; ++i)
    for (std::uint32_t k = 1; k <= on_side; ++k) {
      const Point2 &a = plc.points[i], &b = plc.points[(i + 1) % corners];
      Point2 p;
      for (int j = 0; j < 2; ++j)
        p[j] = a[j] + (b[j] - a[j]) * k / (on_side + 1) + ulp * (static_cast<double>(below(random, 2 * ulps + 1)) - ulps);
      plc.points.push_back(p);
    }
  return plc;
}

TEST(BesideSegments, PointsOfSidesOffByUlps) {
  for (const int ulps : {0, 1, 3, 12, 100})
    for (std::uint64_t seed = 1; seed <= 15; ++seed) {
      Random random(seed);
      const double far = std::array{0.0, 47.0, 440000.0}[seed % 3];
      expect_sound(polygon_with_points(random, far, 1000, ulps), ulps, 20000,
                   std::to_string(ulps) + " ulps, seed " + std::to_string(seed));
    }
}

/// Two triangles whose long sides are ulps apart, with a void between: split points must not reach the other side.
TEST(BesideSegments, SidesAcrossASlit) {
  for (int ulps = 1; ulps <= 20; ++ulps)
    for (const double turn : {0.3, 0.7, 1.9}) {
      const double c = std::cos(turn), s = std::sin(turn), off = ulps * 0x1p-52;
      Plc<2> plc;
      plc.tolerance = 0;
      for (const auto& [x, y] : {std::pair(-0.9, -off), {0.9, -off}, {0.1, -0.6}, {-0.85, off}, {0.95, off}, {-0.2, 0.7}})
        plc.points.push_back({{c * x - s * y, s * x + c * y}});
      for (std::uint32_t i = 0; i < 6; ++i) add_segment(plc, i, i % 3 == 2 ? i - 2 : i + 1);
      std::optional<Domain<2>> domain;
      try {
        domain.emplace(plc);
      } catch (const InputError&) {
        continue;  // they cross, by rounding
      }
      if (diagnose<2>(plc).error_count() == 0)
        expect_sound(plc, ulps, 20000, std::to_string(ulps) + " ulps, turned by " + std::to_string(turn));
    }
}

}  // namespace pgdr::test_refine_beside_segments
