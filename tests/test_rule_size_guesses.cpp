// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Guesses of sizes: what is asked when, and that a decision with wrong guesses is known to be one.
#include <gtest/gtest.h>

#include <span>
#include <vector>

#include "pgdr/error.hpp"
#include "rule/cell_quality.hpp"
#include "rule/size_guesses.hpp"

namespace pgdr::test_rule_size_guesses {

/// A tetrahedron with its right angle at x, and edges of length 1 there.
Simplex<3> corner_at(double x) { return {Point3{x, 0, 0}, Point3{x + 1, 0, 0}, Point3{x, 1, 0}, Point3{x, 0, 1}}; }
/// 1 beside the yz-plane, and a unit more for each unit farther from it.
double size_at(const Point3& p) { return 0.75 + p[0]; }
double as_it_is(const Simplex<3>&, const SizeGuesses::Numbers&, double size) { return size; }
/// Not more than what is known beside.
double cut_off(const Simplex<3>&, const SizeGuesses::Numbers& numbers, double size) { return std::min(numbers[0], size); }

class SizeGuessesTest : public testing::Test {
 protected:
  SizeGuessesTest() {
    bounds_.size = SizingField<3>::by_blocks([this](std::span<const Point3> points, std::span<double> sizes) {
      blocks_.push_back(points.size());
      for (std::size_t i = 0; i < points.size(); ++i) sizes[i] = size_at(points[i]);
    });
  }
  double right(double x) const { return size_at(centroid<3>(corner_at(x))); }

  CellBounds<3> bounds_;
  SizeGuesses guesses_{bounds_};
  std::vector<std::size_t> blocks_;  ///< points of each call
};

TEST_F(SizeGuessesTest, WhatDoesNotCountIsAskedInTheEnd) {
  guesses_.begin(corner_at(0), 0);
  EXPECT_EQ(guesses_.answer(corner_at(0), 0, as_it_is, {}), right(0));  // there was nothing to guess by
  EXPECT_EQ(blocks_, std::vector<std::size_t>{1});
  for (int x = 1; x <= 10; ++x) EXPECT_EQ(guesses_.answer(corner_at(x), 0, cut_off, {0.5}), 0.5);
  EXPECT_EQ(blocks_.size(), 1u);
  EXPECT_EQ(guesses_.guessed(), 10u);
  EXPECT_TRUE(guesses_.settle());
  EXPECT_EQ(blocks_, (std::vector<std::size_t>{1, 10}));
  guesses_.begin(corner_at(7), 0);
  EXPECT_EQ(guesses_.answer(corner_at(7), 0, as_it_is, {}), right(7));  // remembered
  EXPECT_TRUE(guesses_.settle());
  EXPECT_EQ(blocks_.size(), 2u);
}

TEST_F(SizeGuessesTest, WhereAGuessCountsAllIsAskedAtOnce) {
  guesses_.begin(corner_at(0), 0);
  guesses_.answer(corner_at(0), 0, as_it_is, {});
  guesses_.answer(corner_at(1), 0, cut_off, {0.5});
  {
    const SizeGuesses::Along others(&guesses_, [](SizeGuesses& to) {
      to.add(corner_at(3), 0);
      to.add({Point3{4, 0, 0}, Point3{4, 1, 0}, Point3{5, 0, 0}, Point3{4, 0, 1}}, 0);  // turned over: left out
    });
    EXPECT_EQ(guesses_.answer(corner_at(2), 0, as_it_is, {}), right(2));
  }
  EXPECT_EQ(blocks_, (std::vector<std::size_t>{1, 3}));
  EXPECT_EQ(guesses_.answer(corner_at(3), 0, as_it_is, {}), right(3));
  EXPECT_TRUE(guesses_.settle());
  EXPECT_EQ(blocks_.size(), 2u);
}

TEST_F(SizeGuessesTest, AShortDecisionGuessesAndIsMadeAgain) {
  guesses_.begin(corner_at(0), 0);
  guesses_.answer(corner_at(0), 0, as_it_is, {});
  double sum = 0;
  int rounds = 0;
  const SizeGuesses::Short decision(&guesses_);
  do {
    sum = 0;
    ++rounds;
    for (int x = 1; x <= 4; ++x) sum += guesses_.answer(corner_at(x), 0, as_it_is, {});
  } while (!guesses_.settle());
  EXPECT_EQ(rounds, 2);
  EXPECT_EQ(sum, right(1) + right(2) + right(3) + right(4));
  EXPECT_EQ(blocks_, (std::vector<std::size_t>{1, 4}));
}

TEST_F(SizeGuessesTest, AGuessThatShouldHaveCountedIsWrong) {
  guesses_.begin(corner_at(5), 0);
  guesses_.answer(corner_at(5), 0, as_it_is, {});
  EXPECT_EQ(guesses_.answer(corner_at(1), 0, cut_off, {3}), 3);  // by the size at 5; but the one at 1 is less
  EXPECT_FALSE(guesses_.is_wrong());
  EXPECT_EQ(guesses_.answer(corner_at(9), 0, as_it_is, {}), right(9));
  EXPECT_TRUE(guesses_.is_wrong());
  EXPECT_FALSE(guesses_.settle());
  EXPECT_EQ(guesses_.answer(corner_at(1), 0, cut_off, {3}), right(1));
  EXPECT_TRUE(guesses_.settle());
}

TEST_F(SizeGuessesTest, RegionsHaveSizesOfTheirOwn) {
  bounds_.region_size = {SizingField<3>(), SizingField<3>(0.25)};
  guesses_.begin(corner_at(0), 0);
  EXPECT_EQ(guesses_.answer(corner_at(0), 0, as_it_is, {}), right(0));
  EXPECT_EQ(guesses_.answer(corner_at(0), 1, as_it_is, {}), 0.25);
}

TEST_F(SizeGuessesTest, ManySizesAreForgotten) {
  for (int n = 0; n < 3; ++n) {
    const int base = 20000 * n;
    for (int x = 0; x < 20000; ++x) guesses_.add(corner_at(base + x), 0);
    guesses_.ask_added();
    guesses_.begin(corner_at(base), 0);
    for (int x = 0; x < 100; ++x) EXPECT_EQ(guesses_.answer(corner_at(base + x), 0, as_it_is, {}), right(base + x));
    EXPECT_TRUE(guesses_.settle());
  }
}

TEST_F(SizeGuessesTest, QualitiesByGuessesAreThoseWithoutOnceSettled) {
  bounds_.radius_edge_bound = 2;
  const CellQuality by_guesses(bounds_, 15, &guesses_), at_once(bounds_, 15);
  guesses_.begin(corner_at(0), 0);
  std::vector<double> qualities;
  do {
    qualities.clear();
    for (int x = 0; x < 20; ++x) qualities.push_back(by_guesses.of(corner_at(0.05 * x), 0));
  } while (!guesses_.settle());
  const std::size_t blocks = blocks_.size();
  EXPECT_LT(blocks, 20u);
  for (int x = 0; x < 20; ++x) {
    EXPECT_EQ(qualities[static_cast<std::size_t>(x)], at_once.of(corner_at(0.05 * x), 0)) << x;
    EXPECT_EQ(by_guesses.is_within_size(corner_at(0.05 * x), 0), bounds_.within_size(corner_at(0.05 * x), 0)) << x;
  }
}

TEST_F(SizeGuessesTest, WhatIsNoSizeIsAnError) {
  bounds_.size = SizingField<3>::by_blocks([](std::span<const Point3>, std::span<double> sizes) { sizes[0] = -1; });
  guesses_.begin(corner_at(0), 0);
  EXPECT_THROW(guesses_.answer(corner_at(0), 0, as_it_is, {}), UsageError);
}

}  // namespace pgdr::test_rule_size_guesses
