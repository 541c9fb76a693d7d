// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Thin plates with a round boss, as CAD programs triangulate them: needles from the corners of the plate to the circle, and in the
// lid, all with their corners off the plane by rounding. The walls of the plate meet the segments of these needles at more than 20
// degrees, so that their strips are split while the mesh is Delaunay yet (recovery.hpp). Left to the refinement, whose cavities the
// nearly coplanar facets cut back, they brought on tangles: one of 136 points took 80 seconds, and `pgdr check` ended with 6.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "parallel_support.hpp"

namespace pgdr::test_early_splits {

/// 2 x 2 x `thickness`, with a boss as high on its top. `sides` divided by four must be even, lest needles overlap. `off_plane`: how
/// many times 1e-9 the corner of a side is off its plane.
template <class OffPlane>
Plc<3> plate_with_boss(int sides, double thickness, const OffPlane& off_plane) {
  Plc<3> plc;
  for (const double z : {0.0, thickness})
    for (const auto& [x, y] : {std::pair(-1., -1.), std::pair(1., -1.), std::pair(1., 1.), std::pair(-1., 1.)})
      plc.points.push_back({{x, y, z}});
  for (const int level : {1, 2})
    for (int i = 0; i < sides; ++i) {
      const double angle = 2 * std::numbers::pi * i / sides - 3 * std::numbers::pi / 4;
      const double off = level == 1 ? 1e-9 * off_plane(i) : 0;
      plc.points.push_back({{0.6 * std::cos(angle), 0.6 * std::sin(angle), level * thickness + off}});
    }
  const auto add = [&](int a, int b, int c) {
    plc.facets.push_back({{{std::uint32_t(a), std::uint32_t(b), std::uint32_t(c)}}, {}, 0});
  };
  const auto rim = [&](int i) { return 8 + (i + sides) % sides; };
  const auto lid = [&](int i) { return 8 + sides + (i + sides) % sides; };
  const int quarter = sides / 4, half = quarter / 2;
  for (int c = 0; c < 4; ++c) {
    const int next = (c + 1) % 4;
    for (int i = half - quarter; i < quarter - half; ++i) add(4 + c, rim(c * quarter + i + 1), rim(c * quarter + i));
    add(4 + c, 4 + next, rim(c * quarter + quarter - half));
    add(c, next, 4 + next);
    add(c, 4 + next, 4 + c);
  }
  for (int i = 0; i < sides; ++i) {
    add(rim(i), rim(i + 1), lid(i + 1));
    add(rim(i), lid(i + 1), lid(i));
  }
  for (int i = 1; i + 1 < sides; ++i) add(lid(0), lid(i), lid(i + 1));
  add(0, 2, 1);
  add(0, 3, 2);
  return plc;
}

TEST(EarlySplits, StripsOfThinWalls) {
  const Plc<3> plc = plate_with_boss(64, 0.02, [](int i) { return i * 7919 % 17 - 8; });
  const RefineResult<3> result = test::expect_reproducible<3>(plc, {}, "boss", test::two_if_quick);
  for (const PoorReason& reason : result.reasons) EXPECT_EQ(reason.code, PoorReason::Code::small_angle);
  // One at each of the needles' corners, and some beside them. It was one of thirteen.
  EXPECT_LT(40 * result.poor_left, result.mesh.cells.size());
}

}  // namespace pgdr::test_early_splits
