// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Reasons of cells that the optimiser leaves: the checker holds every one, and excuses the same cells.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <string>

#include "model_plcs.hpp"
#include "refined_models.hpp"
#include "structure_plcs.hpp"

namespace pgdr::test_reasons_optimized {

using Code = PoorReason::Code;

/// Meshes and checks; how many reasons have each code.
std::map<Code, int> codes(const Plc<3>& plc, RefineOptions<3> options, const std::string& what) {
  const test::Outcome<3> out = test::refine_and_check(plc, options);
  EXPECT_LE(out.report.exit_code(), 1) << what << "\n" << test::findings(out.report);
  EXPECT_EQ(out.report.explained + out.report.unexplained, out.result.optimization.left) << what;
  EXPECT_EQ(out.report.unexplained, out.result.optimization.unexplained) << what;
  EXPECT_EQ(out.result.reasons.size(), out.result.optimization.left) << what;
  std::map<Code, int> count;
  for (const PoorReason& r : out.result.reasons) {
    ++count[r.code];
    const bool known = r.code == Code::input_dihedral || r.code == Code::small_angle;
    EXPECT_EQ(known, r.angle > 0) << what;
    EXPECT_LT(r.angle, std::max(*options.min_dihedral, 14.5)) << what;
  }
  return count;
}

/// A prism over a triangle with this angle, in degrees, at the origin.
Plc<3> wedge(double degrees, double height) {
  const double angle = degrees * std::numbers::pi / 180;
  return test::prism({{{0, 0}}, {{4, 0}}, {{4 * std::cos(angle), 4 * std::sin(angle)}}}, height);
}

TEST(OptimizedReasons, WedgesBelowTheTarget) {
  for (const double degrees : {1.0, 5.0, 12.0, 14.9, 17.0, 25.0})
    for (const double target : {15.0, 20.0}) {
      RefineOptions<3> options;
      options.min_dihedral = target;
      auto count = codes(wedge(degrees, 1), options, std::to_string(degrees) + " for " + std::to_string(target));
      if (degrees < target)
        EXPECT_GT(count[Code::input_dihedral], 0) << degrees << " for " << target;
      else
        EXPECT_EQ(count[Code::input_dihedral] + count[Code::small_angle], 0) << degrees << " for " << target;
    }
}

TEST(OptimizedReasons, HoldForStructures) {
  int left = 0;
  for (const auto& s : test::all_structures()) {
    RefineOptions<3> options;
    options.min_dihedral = 20;
    options.regions = RegionMode::automatic;
    for (const auto& [code, n] : codes(s.turns ? test::turned(s.plc) : s.plc, options, s.name)) left += n;
  }
  RecordProperty("left", left);
}

}  // namespace pgdr::test_reasons_optimized
