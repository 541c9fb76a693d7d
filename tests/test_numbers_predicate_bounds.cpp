// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The bounds on quality and size against rationals: at random, within some ulps of the bound, and exactly on it.
#include <gtest/gtest.h>

#include <limits>

#include "dimensions.hpp"
#include "numbers/predicate_stages.hpp"
#include "pgdr/predicates.hpp"
#include "random_simplices.hpp"
#include "sanitized.hpp"

namespace pgdr::test_numbers_predicate_bounds {

using oracle::Random;
using oracle::Rational;

constexpr double infinity = std::numeric_limits<double>::infinity();

template <class Dimension>
class Bounds : public testing::Test {};
TYPED_TEST_SUITE(Bounds, test::Dimensions);

template <int D>
struct Exact {
  Rational radius2, shortest2, det;
};

template <int D>
Exact<D> exact(const Simplex<D>& s) {
  return {oracle::circumsphere<D>(s).squared_radius, oracle::shortest_edge_squared<D>(s), abs(oracle::orient_det<D>(s))};
}

template <int D>
void expect_radius_edge(const Simplex<D>& s, double bound, bool want) {
  if (const auto filtered = detail::radius_edge_filter<D>(s, bound)) {
    EXPECT_EQ(*filtered, want);
  }
  EXPECT_EQ(detail::radius_edge_exact<D>(s, bound), want);
  EXPECT_EQ(radius_edge_within<D>(s, bound), want);
}

template <int D>
void expect_circumradius(const Simplex<D>& s, double size, bool want) {
  if (const auto filtered = detail::circumradius_filter<D>(s, size)) {
    EXPECT_EQ(*filtered, want);
  }
  EXPECT_EQ(detail::circumradius_exact<D>(s, size), want);
  EXPECT_EQ(circumradius_within<D>(s, size), want);
}

template <int D>
void expect_measure(const Simplex<D>& s, double bound, bool want) {
  if (const auto filtered = detail::measure_filter<D>(s, bound)) {
    EXPECT_EQ(*filtered, want);
  }
  EXPECT_EQ(detail::measure_exact<D>(s, bound), want);
  EXPECT_EQ(measure_within<D>(s, bound), want);
}

// x and its neighbours: where filters are blind.
std::vector<double> around(double x, Random& random) {
  std::vector<double> result{x, 1.5 * x, 0.7 * x, x * (1 + 1e-14), x * (1 - 1e-14)};
  for (double& y : result) y = oracle::nudged(random, y);
  std::erase_if(result, [](double y) { return !(y > 0 && y < infinity); });
  return result;
}

template <int D>
void check(const Simplex<D>& s, Random& random) {
  const Exact<D> e = exact<D>(s);
  const double ratio = std::sqrt(CGAL::to_double(Rational(e.radius2 / e.shortest2)));
  for (const double b : around(ratio, random)) {
    const Rational q(b);
    expect_radius_edge<D>(s, b, e.radius2 <= q * q * e.shortest2);
  }
  for (const double b : around(std::sqrt(CGAL::to_double(e.radius2)), random)) {
    const Rational q(b);
    expect_circumradius<D>(s, b, e.radius2 <= q * q);
  }
  for (const double b : around(CGAL::to_double(e.det) / (D == 3 ? 6 : 2), random))
    expect_measure<D>(s, b, e.det <= Rational(b) * (D == 3 ? 6 : 2));
}

TYPED_TEST(Bounds, AgreeWithRationals) {
  constexpr int D = TypeParam::value;
  oracle::check_simplices<D>(test::sanitized ? 40 : 150, check<D>);
}

// Numerators that are all cancellation: needles (a corner beside another one), and in space slivers (four points near a
// circle), whose radius is moderate while the volume vanishes.
TYPED_TEST(Bounds, AgreeWithRationalsOnNeedlesAndSlivers) {
  constexpr int D = TypeParam::value;
  Random random(oracle::seed());
  for (int k = 1; k < 50; ++k) {
    for (int round = 0; round < (test::sanitized ? 5 : 20); ++round) {
      Simplex<D> needle, sliver;
      for (Point<D>& p : needle) p = oracle::each<D>([&] { return oracle::uniform(random); });
      sliver = needle;
      for (int i = 0; i < D; ++i) needle[1][i] = needle[0][i] + std::ldexp(oracle::uniform(random), -k);
      for (Point<D>& p : sliver) {
        const double x = p[0] - 0.5, y = p[1] - 0.5, r = std::sqrt(x * x + y * y);
        p[0] = x / r;
        p[1] = y / r;
        if (D == 3) p[2] = std::ldexp(oracle::uniform(random), -k);
      }
      for (const Simplex<D>& s : {needle, sliver})
        if (oracle::orient<D>(s) != Sign::zero) check<D>(s, random);
      ASSERT_FALSE(this->HasFailure()) << k;
    }
  }
}

// The square of the shortest edge is lost to underflow while everything else is of ordinary size.
TEST(Bound, OfAShortestEdgeWithoutASquare) {
  const double l = 0x1.8p-537;
  const Simplex<2> s{Point2{{0, 0}}, {{l, 0}}, {{0.5, 1}}};
  const double r = std::sqrt(CGAL::to_double(exact<2>(s).radius2));
  for (const double factor : {0.99, 1 - 1e-12, 1 + 1e-12, 1.01}) expect_radius_edge<2>(s, factor * r / l, factor > 1);
}

// Corners on the sphere of radius 65 about the origin, the shortest edge of length 32: the ratio 65/32 is a double. The
// determinants are multiples of 6 resp. 2.
template <int D>
Simplex<D> with_ratio_65_over_32() {
  if constexpr (D == 2)
    return {Point2{{16, 63}}, {{-16, 63}}, {{0, -65}}};
  else
    return {Point3{{16, 63, 0}}, {{-16, 63, 0}}, {{0, -33, 56}}, {{0, -39, -52}}};
}

TYPED_TEST(Bounds, ExactlyOnTheBoundIsWithin) {
  constexpr int D = TypeParam::value;
  const auto below = [](double x) { return std::nextafter(x, 0); };
  for (const int k : {0, -20, 300, -300, 465, -830}) {
    for (const double shift : {0.0, 4096.0}) {
      SCOPED_TRACE(testing::Message() << "scale 2^" << k << ", shift " << shift);
      Simplex<D> s = with_ratio_65_over_32<D>();
      for (Point<D>& p : s)
        for (double& x : p.x) x = std::ldexp(x + shift, k);
      std::sort(s.begin(), s.end(), lex_less<D>);
      do {
        expect_radius_edge<D>(s, 65.0 / 32, true);
        expect_radius_edge<D>(s, below(65.0 / 32), false);
        expect_circumradius<D>(s, std::ldexp(65, k), true);
        expect_circumradius<D>(s, below(std::ldexp(65, k)), false);
      } while (std::next_permutation(s.begin(), s.end(), lex_less<D>));
      const double measure = CGAL::to_double(Rational(exact<D>(s).det / (D == 3 ? 6 : 2)));
      if (!(measure > 0x1p-1000 && measure < 0x1p1000)) continue;
      ASSERT_EQ(Rational(measure) * (D == 3 ? 6 : 2), exact<D>(s).det) << "the test wants an exact measure";
      expect_measure<D>(s, measure, true);
      expect_measure<D>(s, below(measure), false);
    }
  }
}

TYPED_TEST(Bounds, ThatAreNoNumbers) {
  constexpr int D = TypeParam::value;
  const Simplex<D> s = with_ratio_65_over_32<D>();
  for (const double bound : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_FALSE(radius_edge_within<D>(s, bound));
    EXPECT_FALSE(circumradius_within<D>(s, bound));
    EXPECT_FALSE(measure_within<D>(s, bound));
  }
  EXPECT_TRUE(radius_edge_within<D>(s, infinity));
  EXPECT_TRUE(circumradius_within<D>(s, infinity));
  EXPECT_TRUE(measure_within<D>(s, infinity));
  EXPECT_TRUE(radius_edge_within<D>(s, 1e300));
  EXPECT_TRUE(measure_within<D>(s, 1.7e308));
  EXPECT_FALSE(circumradius_within<D>(s, 1e-300));
  EXPECT_FALSE(measure_within<D>(s, 1e-300));
}

// A flat simplex has no circumsphere: no bound holds but infinity, and its measure is zero.
TYPED_TEST(Bounds, OfAFlatSimplex) {
  constexpr int D = TypeParam::value;
  Simplex<D> s{};
  for (std::size_t i = 0; i <= D; ++i) s[i].x.fill(0.1 * static_cast<double>(i * i));
  EXPECT_FALSE(radius_edge_within<D>(s, 1e100));
  EXPECT_FALSE(circumradius_within<D>(s, 1e100));
  EXPECT_TRUE(measure_within<D>(s, 0));
}

}  // namespace pgdr::test_numbers_predicate_bounds
