// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Exact sums against rationals.
#include "numbers/exact_sum.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <random>

#include "numbers/rational.hpp"

namespace pgdr::test_numbers_exact_sum {

using Number = detail::Rational::Number;

/// Is `value` one of the doubles nearest to the number?
testing::AssertionResult is_nearest(double value, const Number& number) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  const auto distance = [&](double x) { return Number(abs(Number(Number(x) - number))); };
  for (const double other : {std::nextafter(value, -infinity), std::nextafter(value, infinity)})
    if (distance(other) < distance(value)) return testing::AssertionFailure() << other << " is nearer than " << value;
  return testing::AssertionSuccess();
}

TEST(ExactSum, OfNothingIsZero) { EXPECT_EQ(detail::ExactSum().divided_by(6), 0); }

TEST(ExactSum, IsRoundedToTheNearestDouble) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> mantissa(-1, 1);
  for (const int range : {1, 30, 300}) {
    std::uniform_int_distribution<int> exponent(-range, range);
    const auto number = [&] { return std::ldexp(mantissa(random), exponent(random)); };
    for (int round = 0; round < 300; ++round) {
      detail::ExactSum sum;
      Number expected = 0;
      for (int term = 0; term <= round % 7; ++term) {
        const double a = number(), b = number(), c = number();
        sum.add_product(a, b, c);
        expected += Number(a) * Number(b) * Number(c);
      }
      ASSERT_TRUE(is_nearest(sum.divided_by(1), expected));
      ASSERT_TRUE(is_nearest(sum.divided_by(6), Number(expected / 6)));
    }
  }
}

/// As processes add up what each has of them.
TEST(ExactSum, IsThatOfTheTermsWhereverTheyWereAddedUp) {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> mantissa(-1, 1);
  std::uniform_int_distribution<int> exponent(-200, 200);
  for (int round = 0; round < 100; ++round) {
    detail::ExactSum all;
    std::array<detail::ExactSum, 3> parts;
    for (int term = 0; term < round; ++term) {
      const double a = std::ldexp(mantissa(random), exponent(random)), b = mantissa(random);
      all.add_product(a, b);
      parts[random() % 2].add_product(a, b);
    }
    EXPECT_TRUE(parts[2].is_empty());
    for (const detail::ExactSum& part : {parts[0], parts[1]}) parts[2].add(detail::ExactSum::of_words(part.to_words()));
    EXPECT_EQ(parts[2].divided_by(6), all.divided_by(6));
    EXPECT_EQ(parts[2].is_empty(), round == 0);
  }
}

TEST(ExactSum, OfTermsThatCancelIsExact) {
  detail::ExactSum sum;
  for (const double sign : {1.0, -1.0}) {
    sum.add_product(sign * 0x1p1000, 0x1.8p10);
    sum.add_product(sign * 0x1p-1074, 0x1p-1074, 3);
    sum.add_product(sign * 1e300, 1e5, 7);
  }
  EXPECT_EQ(sum.divided_by(1), 0);
  sum.add_product(-0x1p-300, 0x1p-300, 6);
  EXPECT_EQ(sum.divided_by(6), -0x1p-600);
}

TEST(ExactSum, OfSumsIsThatOfAllTerms) {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> mantissa(-1, 1);
  std::uniform_int_distribution<int> exponent(-300, 300);
  for (int round = 0; round < 200; ++round) {
    detail::ExactSum all, sum;
    for (int part = 0; part < 4; ++part) {
      detail::ExactSum some;
      for (int term = 0; term < (round + part) % 5; ++term) {
        const double a = std::ldexp(mantissa(random), exponent(random)), b = mantissa(random);
        all.add_product(a, b);
        some.add_product(a, b);
      }
      sum.add(some);
    }
    EXPECT_EQ(sum.divided_by(6), all.divided_by(6)) << round;
  }
}

TEST(ExactSum, TiesGoToEven) {
  const auto one_and = [](double rest, double tiny) {
    detail::ExactSum sum;
    sum.add_product(1, 1);
    sum.add_product(rest, 1);
    sum.add_product(tiny, 0x1p-500);
    return sum.divided_by(1);
  };
  EXPECT_EQ(one_and(0x1p-53, 0), 1);
  EXPECT_EQ(one_and(0x3p-53, 0), 1 + 0x4p-53);
  EXPECT_EQ(one_and(0x1p-53, 1), 1 + 0x2p-53);
  EXPECT_EQ(one_and(0x1p-53, -1), 1);
}

TEST(ExactSum, OfDeterminantsFarFromTheOriginIsTheVolume) {
  const double x = 4.5e6 + 0.1, y = 5e5 + 0.3, z = 1e-9;
  const auto at = [&](double i, double j, double k) { return Point3{{x + i, y + j, z + k}}; };
  detail::ExactSum sum;  // outwards, by corners whose coordinates are exact sums
  const Point3 o = at(0, 0, 0), a = at(1, 0, 0), b = at(0, 1, 0), c{{x, y, 2 * z}};
  sum.add_determinant(o, b, a);
  sum.add_determinant(o, a, c);
  sum.add_determinant(o, c, b);
  sum.add_determinant(a, b, c);
  EXPECT_DOUBLE_EQ(sum.divided_by(6), ((a[0] - x) * (b[1] - y) * z) / 6);
}

}  // namespace pgdr::test_numbers_exact_sum
