// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Sizes near those that are known: where they are the function itself, and that they are never beyond what is known.
#include <gtest/gtest.h>

#include <random>

#include "optimize/local_sizes.hpp"

namespace pgdr::test_rule_local_sizes {

Point3 random_point(std::mt19937_64& random) {
  std::uniform_real_distribution<double> coordinate(-1, 1);
  return {coordinate(random), coordinate(random), coordinate(random)};
}

TEST(LocalSizes, AConstantIsThatNumberToTheLastBit) {
  std::mt19937_64 random(1);
  for (std::size_t count = 1; count < 60; ++count) {
    LocalSizes sizes;
    for (std::size_t i = 0; i < count; ++i) sizes.add(random_point(random), 3, 0.1);
    sizes.fit();
    EXPECT_EQ(sizes.at(random_point(random), 3), 0.1) << count;
  }
}

TEST(LocalSizes, AnAffineFunctionIsMetAmongManyCells) {
  std::mt19937_64 random(2);
  const auto f = [](const Point3& x) { return 5 + x[0] - 2 * x[1] + 0.5 * x[2]; };
  LocalSizes sizes;
  for (int i = 0; i < 40; ++i) {
    const Point3 x = random_point(random);
    sizes.add(x, 0, f(x));
  }
  sizes.fit();
  for (int i = 0; i < 20; ++i) {
    Point3 x = random_point(random);
    for (int k = 0; k < 3; ++k) x[k] /= 4;
    EXPECT_NEAR(*sizes.at(x, 0), f(x), 0.01);
  }
}

TEST(LocalSizes, NothingIsBeyondWhatIsKnown) {
  std::mt19937_64 random(3);
  LocalSizes sizes;
  sizes.add({0, 0, 0}, 0, 1);
  sizes.add({1, 0, 0}, 0, 2);
  sizes.add({0, 1, 0}, 0, 4);  // in a plane: along z they are constant
  sizes.fit();
  EXPECT_EQ(sizes.at({-9, 0, 0}, 0), 1);
  EXPECT_EQ(sizes.at({9, 9, 0}, 0), 4);
  EXPECT_EQ(sizes.at({0.25, 0.25, 0}, 0), sizes.at({0.25, 0.25, 7}, 0));
  EXPECT_NEAR(*sizes.at({0.5, 0, 0}, 0), 1.5, 0.01);
}

TEST(LocalSizes, RegionsHaveTheirOwnAndAreForgotten) {
  LocalSizes sizes;
  sizes.add({0, 0, 0}, 0, 1);
  sizes.add({0, 0, 0}, 2, 7);
  sizes.fit();
  EXPECT_EQ(sizes.at({1, 1, 1}, 0), 1);
  EXPECT_EQ(sizes.at({1, 1, 1}, 2), 7);
  EXPECT_FALSE(sizes.at({1, 1, 1}, 1));
  sizes.clear();
  EXPECT_FALSE(sizes.at({1, 1, 1}, 2));
}

}  // namespace pgdr::test_rule_local_sizes
