// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// When boundary recovery is given up. A terrain of 725 points with facets at a tenth of a degree was refused after 272,101
// Steiner points, with a few hundred triangles missing of ten thousand: it takes some thousand more.
#include <gtest/gtest.h>

#include <chrono>
#include <ctime>
#include <random>
#include <vector>

#include "model_plcs.hpp"
#include "refined_models.hpp"
#include "sanitized.hpp"

namespace pgdr::test_boundary_recovery_limits {

/// Squares, two triangles each, on walls; the points are up to `height` above these.
Plc<3> terrain(std::uint32_t side, double height) {
  std::mt19937 random(1);
  Plc<3> plc;
  std::vector<std::uint32_t> rim;
  const auto number = [side](std::uint32_t i, std::uint32_t j) { return i * (side + 1) + j; };
  for (std::uint32_t i = 0; i <= side; ++i)
    for (std::uint32_t j = 0; j <= side; ++j)
      plc.points.push_back({static_cast<double>(i), static_cast<double>(j), height * 0x1p-32 * random()});
  for (std::uint32_t i = 0; i < side; ++i)
    for (std::uint32_t j = 0; j < side; ++j) {
      plc.facets.push_back({{{number(i, j), number(i + 1, j), number(i + 1, j + 1)}}, {}, 0});
      plc.facets.push_back({{{number(i, j), number(i + 1, j + 1), number(i, j + 1)}}, {}, 0});
    }
  for (std::uint32_t k = 0; k < side; ++k) rim.push_back(number(k, 0));
  for (std::uint32_t k = 0; k < side; ++k) rim.push_back(number(side, k));
  for (std::uint32_t k = side; k > 0; --k) rim.push_back(number(k, side));
  for (std::uint32_t k = side; k > 0; --k) rim.push_back(number(0, k));
  std::vector<std::uint32_t> base;
  for (const std::uint32_t v : rim) {
    base.push_back(static_cast<std::uint32_t>(plc.points.size()));
    plc.points.push_back({plc.points[v][0], plc.points[v][1], -2});
  }
  for (std::size_t k = 0; k < rim.size(); ++k) {
    const std::size_t next = (k + 1) % rim.size();
    plc.facets.push_back({{{base[k], base[next], rim[next], rim[k]}}, {}, 0});
  }
  plc.facets.push_back({{{base.rbegin(), base.rend()}}, {}, 0});
  return plc;
}

/// A block on a wedge of six millionths of a degree: its boundary takes more points than there is time for.
Plc<3> block_on_a_wedge() {
  Plc<3> plc;
  const double thin = 1.064650843716545e-05;
  plc.points = {{{0, 0, 0}},       {{100, 0, 0}}, {{100, 40, 0}}, {{0, 40, 0}},    {{100, 0, thin}},
                {{100, 40, thin}}, {{0, 0, 50}},  {{100, 0, 50}}, {{100, 40, 50}}, {{0, 40, 50}}};
  for (const std::vector<std::uint32_t>& polygon : std::vector<std::vector<std::uint32_t>>{{0, 1, 2, 3},
                                                                                           {0, 4, 5, 3},
                                                                                           {6, 7, 8, 9},
                                                                                           {0, 1, 4},
                                                                                           {3, 2, 5},
                                                                                           {1, 2, 5, 4},
                                                                                           {0, 4, 7, 6},
                                                                                           {3, 5, 8, 9},
                                                                                           {4, 5, 8, 7},
                                                                                           {0, 3, 9, 6}})
    plc.facets.push_back({{polygon}, {}, 0});
  return plc;
}

/// The time was looked at between rounds alone, which take as long as all before: 39 seconds of 20. The processor's seconds, on
/// one thread: what else the machine does takes nothing of them.
TEST(RecoveryLimits, EndsInTime) {
  for (const double seconds : {0.5, 2.0}) {
    RefineOptions<3> options;
    options.time_limit = std::chrono::duration<double>(seconds);
    options.schedule.threads = 1;
    const std::clock_t begin = std::clock();
    const auto result = refine(block_on_a_wedge(), options);
    const double took = static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
    EXPECT_EQ(result.stop, StopCause::time_limit);
    EXPECT_TRUE(result.mesh.cells.empty());
    EXPECT_LT(took, (test::sanitized ? 20 : 1) * (1.1 * seconds + 1));
  }
}

TEST(RecoveryLimits, GoesOnWhileLessIsMissing) {
  const Plc<3> plc = test::sanitized ? terrain(8, 100) : terrain(24, 600);
  RefineOptions<3> recovery;
  recovery.refine = false;
  const auto result = refine(plc, recovery);
  CheckOptions<3> options;
  options.input = &plc;
  options.delaunay = result.delaunay;
  const CheckReport report = check(result.mesh, options);
  EXPECT_EQ(report.exit_code(), 0) << test::findings(report);
  const std::uint64_t points = result.statistics.segment_points + result.statistics.facet_points;
  EXPECT_GT(points, test::sanitized ? 1000u : 200000u);
}

/// Two boxes, one 1e-9 above the other, turned; `around`: in a third one, so that the gap is meshed.
Plc<3> narrow_gap(bool around) {
  Plc<3> plc = test::cube();
  test::add_box(plc, {{0.2, 0.3, 1 + 1e-9}}, {{0.7, 0.8, 2}});
  if (around) test::add_box(plc, {{-1, -1, -1}}, {{3, 3, 3}});
  return test::turned<3>(plc, 0.37);
}

// More is missing there, round by round.
TEST(RecoveryLimits, NarrowGapIsRefused) {
  RefineOptions<3> recovery;
  recovery.refine = false;
  try {
    refine(narrow_gap(true), recovery);
    FAIL() << "not refused";
  } catch (const InputError& e) {
    EXPECT_EQ(e.code(), Errc::boundary_not_recovered);
    EXPECT_FALSE(e.diagnostic().ids.empty());
  }
}

// Parts of assemblies are a hair apart; each is an island (diagnose/islands.hpp).
TEST(RecoveryLimits, NarrowGapThatIsNotMeshedNeedsFewPoints) {
  const Plc<3> plc = narrow_gap(false);
  const auto result = refine(plc, RefineOptions<3>{});
  EXPECT_LT(result.statistics.segment_points + result.statistics.facet_points, 10u);
  EXPECT_LT(result.mesh.cells.size(), 200u);
  CheckOptions<3> options;
  options.input = &plc;
  options.reasons = &result.reasons;
  const CheckReport report = check(result.mesh, options);
  EXPECT_EQ(report.exit_code(), 0) << test::findings(report);
}

}  // namespace pgdr::test_boundary_recovery_limits
