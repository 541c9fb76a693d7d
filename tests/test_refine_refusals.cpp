// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Refusals beside a small angle: subsegments that their rings refuse are not asked again and again.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "model_plcs.hpp"
#include "parallel_support.hpp"

namespace pgdr::test_refine_refusals {

/// A prism with an edge of five degrees. Were every encroached subsegment at new cells an attempt, the refused would be half as
/// many again as the committed.
TEST(Refusals, AreFewerThanWhatIsCommittedBesideASmallAngle) {
  const double rise = std::tan(5 * std::numbers::pi / 180);
  RefineOptions<3> options;
  options.size = 0.02;
  options.min_dihedral = 0;
  const auto result = test::expect_reproducible<3>(test::prism({{{0, 0}}, {{1, 0}}, {{1, rise}}}, 1), options, "wedge");
  EXPECT_GT(result.statistics.insertions_refused, 0u);
  EXPECT_LE(result.statistics.insertions_refused, result.statistics.insertions_committed);
}

}  // namespace pgdr::test_refine_refusals
