// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Circumspheres and balls against rationals: the error bound holds, flat simplices are rounded to nearest, results depend
// on the vertex set alone and scale with powers of two.
#include "pgdr/circumsphere.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <limits>

#include "dimensions.hpp"
#include "numbers/predicate_stages.hpp"
#include "pgdr/predicates.hpp"
#include "random_simplices.hpp"

namespace pgdr::test_numbers_circumsphere {

using oracle::Random;
using oracle::Rational;

constexpr double infinity = std::numeric_limits<double>::infinity();

template <class Dimension>
class Spheres : public testing::Test {};
TYPED_TEST_SUITE(Spheres, test::Dimensions);

template <int D>
bool finite(const Point<D>& p) {
  return std::all_of(p.x.begin(), p.x.end(), [](double x) { return std::isfinite(x); });
}

template <int D>
bool same_bits(const Point<D>& a, const Point<D>& b) {
  for (int i = 0; i < D; ++i)
    if (std::bit_cast<std::uint64_t>(a[i]) != std::bit_cast<std::uint64_t>(b[i])) return false;
  return true;
}

// No double is nearer to q than x is.
void expect_nearest(double x, const Rational& q) {
  ASSERT_TRUE(std::isfinite(x));
  const Rational distance = abs(Rational(Rational(x) - q));
  for (const double target : {-infinity, infinity}) {
    const double neighbour = std::nextafter(x, target);
    if (std::isfinite(neighbour)) {
      EXPECT_LE(distance, abs(Rational(Rational(neighbour) - q)));
    }
  }
}

template <int D>
double one_norm(const Point<D>& p) {
  double sum = 0;
  for (const double x : p.x) sum += std::fabs(x);
  return sum;
}

// The bound holds, and is as good as promised: 2^-20 of the radius besides the last rounding.
template <int D>
void check_sphere(const Simplex<D>& s) {
  const auto want = oracle::circumsphere<D>(s);
  const Circumsphere<D> got = circumsphere<D>(s);
  if (!finite<D>(got.center)) {
    EXPECT_EQ(got.center_error, infinity);
    bool overflows = false;
    for (const Rational& c : want.center) overflows |= abs(c) > Rational(std::numeric_limits<double>::max());
    EXPECT_TRUE(overflows);
    return;
  }
  ASSERT_LT(got.center_error, infinity);
  const Rational error2 = oracle::squared_distance<D>(want.center, got.center);
  const Rational bound = got.center_error;
  EXPECT_LE(error2, bound * bound);
  // (error - rounding)^2 <= 2^-40 r^2, with a factor 2 on the radius for the sums of magnitudes.
  const Rational besides = bound - Rational(0x1p-52 * one_norm<D>(got.center) + 0x1p-1069);
  if (besides > 0) {
    EXPECT_LE(besides * besides, want.squared_radius * Rational(0x1p-38));
  }
  const auto c = oracle::exact<D>(got.center);
  const Simplex<D> first{*std::min_element(s.begin(), s.end(), lex_less<D>)};
  const Rational r2 = oracle::squared_distance<D>(c, first[0]);
  if (r2 > Rational(0x1p-1000) && r2 < Rational(0x1p1000)) {
    EXPECT_LE(abs(Rational(r2 - Rational(got.squared_radius))), r2 * Rational(0x1p-49));
  }
}

TYPED_TEST(Spheres, ErrorBoundHolds) {
  constexpr int D = TypeParam::value;
  oracle::check_simplices<D>(300, [](const Simplex<D>& s, Random&) { check_sphere<D>(s); });
}

// Corner simplex, with its last corner pushed down to a height of 2^-k above the opposite face.
template <int D>
Simplex<D> flat_simplex(Random& random, int k) {
  Simplex<D> s;
  for (Point<D>& p : s)
    for (int i = 0; i < D; ++i) p[i] = oracle::uniform(random);
  for (Point<D>& p : s) p[D - 1] = D == 3 ? 0.5 * p[0] + 0.25 * p[1] : 0.5 * p[0];
  s[D][D - 1] += std::ldexp(1, -k);
  return s;
}

TYPED_TEST(Spheres, OfFlatSimplicesAreBoundedAndRoundedToNearest) {
  constexpr int D = TypeParam::value;
  Random random(oracle::seed());
  int ill = 0;
  for (int k = 1; k <= 52; ++k) {
    for (int round = 0; round < 10; ++round) {
      Simplex<D> s = flat_simplex<D>(random, k);
      if (oracle::orient<D>(s) == Sign::zero) continue;
      check_sphere<D>(s);
      const auto want = oracle::circumsphere<D>(s);
      const Point<D> rounded = detail::circumcenter_exact(s);
      for (int i = 0; i < D; ++i) expect_nearest(rounded[i], want.center[static_cast<std::size_t>(i)]);
      const Circumsphere<D> got = circumsphere<D>(s);
      // An error of some last places means that the ill-conditioned path was taken: then it is the nearest point.
      if (got.center_error <= 0x1.1p-53 * one_norm<D>(got.center)) {
        ++ill;
        EXPECT_TRUE(same_bits<D>(got.center, rounded)) << k;
      }
    }
  }
  EXPECT_GT(ill, 100);
}

TEST(Sphere, OfANearlyFlatTetrahedronIsCorrectToTheUlp) {
  // det = 1e-30 beside edges of length 1: the centre is 2.5e29 below.
  const Simplex<3> s{Point3{{0, 0, 0}}, {{1, 0, 0}}, {{0, 1, 0}}, {{1, 0.5, 1e-30}}};
  const auto want = oracle::circumsphere<3>(s);
  const Circumsphere<3> got = circumsphere<3>(s);
  for (int i = 0; i < 3; ++i) expect_nearest(got.center[i], want.center[static_cast<std::size_t>(i)]);
  EXPECT_LT(got.center_error, 1e15);
  // Flatter still, the centre overflows.
  const Circumsphere<3> none = circumsphere<3>({Point3{{0, 0, 0}}, {{1, 0, 0}}, {{0, 1, 0}}, {{1, 0.5, 1e-310}}});
  EXPECT_EQ(std::fabs(none.center[2]), infinity);
  EXPECT_EQ(none.center_error, infinity);
}

TEST(Sphere, OfWellShapedTetrahedraNeedsNoRationals) {
  Random random(oracle::seed());
  for (int round = 0; round < 1000; ++round) {
    Simplex<3> s{Point3{{1, 1, 1}}, {{1, -1, -1}}, {{-1, 1, -1}}, {{-1, -1, 1}}};
    for (Point3& p : s)
      for (double& x : p.x) x += 0.5 * oracle::uniform(random);
    const Circumsphere<3> got = circumsphere<3>(s);
    EXPECT_LT(got.center_error, 1e-13);
    EXPECT_GT(got.center_error, 0);
  }
}

TYPED_TEST(Spheres, DependOnTheVertexSetAlone) {
  constexpr int D = TypeParam::value;
  oracle::check_simplices<D>(20, [](Simplex<D> s, Random&) {
    std::sort(s.begin(), s.end(), lex_less<D>);
    const Circumsphere<D> want = circumsphere<D>(s);
    const Point<D> center = centroid<D>(s);
    const double shortest = shortest_edge_squared<D>(s);
    while (std::next_permutation(s.begin(), s.end(), lex_less<D>)) {
      const Circumsphere<D> got = circumsphere<D>(s);
      ASSERT_TRUE(same_bits<D>(got.center, want.center));
      ASSERT_EQ(got.squared_radius, want.squared_radius);
      ASSERT_EQ(got.center_error, want.center_error);
      ASSERT_TRUE(same_bits<D>(centroid<D>(s), center));
      ASSERT_EQ(shortest_edge_squared<D>(s), shortest);
    }
  });
}

TYPED_TEST(Spheres, ScaleWithPowersOfTwo) {
  constexpr int D = TypeParam::value;
  Random random(oracle::seed());
  const auto scaled = [](Point<D> p, int k) {
    for (double& x : p.x) x = std::ldexp(x, k);
    return p;
  };
  for (int round = 0; round < 300; ++round) {
    Simplex<D> s;
    for (Point<D>& p : s) p = scaled(oracle::on_sphere<D>(random), -6);
    if (round % 2)
      for (Point<D>& p : s)
        for (double& x : p.x) x += oracle::uniform(random);
    if (round % 3 == 0) s = flat_simplex<D>(random, 30);  // in rationals
    if (oracle::orient<D>(s) == Sign::zero) continue;
    const Circumsphere<D> want = circumsphere<D>(s);
    for (const int k : {-850, -300, -1, 1, 40, 300, 900}) {
      Simplex<D> t = s;
      for (Point<D>& p : t) p = scaled(p, k);
      const Circumsphere<D> got = circumsphere<D>(t);
      ASSERT_TRUE(same_bits<D>(got.center, scaled(want.center, k))) << k;
      ASSERT_TRUE(same_bits<D>(centroid<D>(t), scaled(centroid<D>(s), k)));
      if (std::abs(k) > 400) continue;  // squares leave the range of doubles
      ASSERT_EQ(got.center_error, std::ldexp(want.center_error, k));
      ASSERT_EQ(got.squared_radius, std::ldexp(want.squared_radius, 2 * k));
      ASSERT_EQ(shortest_edge_squared<D>(t), std::ldexp(shortest_edge_squared<D>(s), 2 * k));
    }
  }
}

TYPED_TEST(Spheres, ShortestEdgeAndCentroidAreAccurate) {
  constexpr int D = TypeParam::value;
  Random random(oracle::seed());
  for (int round = 0; round < 300; ++round) {
    Simplex<D> s;
    for (Point<D>& p : s) p = oracle::each<D>([&] { return oracle::uniform(random); });
    const Rational want = oracle::shortest_edge_squared<D>(s), got = shortest_edge_squared<D>(s);
    EXPECT_LE(abs(Rational(got - want)), want * Rational(0x1p-50));
    const Point<D> c = centroid<D>(s);
    for (int i = 0; i < D; ++i) {
      Rational sum = 0;
      for (const Point<D>& p : s) sum += Rational(p[i]);
      EXPECT_LE(abs(Rational(sum / (D + 1) - Rational(c[i]))), Rational(0x1p-51));
    }
  }
}

TYPED_TEST(Spheres, DiametralBallIsDecidedExactly) {
  constexpr int D = TypeParam::value;
  Random random(oracle::seed());
  int on = 0;
  for (const oracle::Family<D>& family : oracle::families<D>()) {
    SCOPED_TRACE(family.name);
    for (int round = 0; round < 300; ++round) {
      const Point<D> a = family.point(random), b = family.point(random), x = family.point(random);
      Rational dot = 0;
      for (int i = 0; i < D; ++i) dot += (Rational(a[i]) - Rational(x[i])) * (Rational(b[i]) - Rational(x[i]));
      ASSERT_EQ(in_diametral_ball<D>(a, b, x), dot < 0);
      ASSERT_EQ(in_diametral_ball<D>(b, a, x), dot < 0);
      on += dot == 0 && x != a && x != b;
      const Ball<D> ball = diametral_ball<D>(a, b), reversed = diametral_ball<D>(b, a);
      ASSERT_TRUE(same_bits<D>(ball.center, reversed.center));
      ASSERT_EQ(ball.squared_radius, reversed.squared_radius);
    }
  }
  EXPECT_GT(on, 100);
  Point<D> a{}, b{};
  b[0] = 4;
  EXPECT_EQ(diametral_ball<D>(a, b).center[0], 2);
  EXPECT_EQ(diametral_ball<D>(a, b).squared_radius, 4);
}

// Exactly: centre = a + x b + y c with equal distances, a 2x2 system.
std::array<Rational, 3> exact_center(const std::array<Point3, 3>& t) {
  const auto a = oracle::exact<3>(t[0]), b = oracle::exact<3>(t[1]), c = oracle::exact<3>(t[2]);
  Rational bb = 0, bc = 0, cc = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    bb += (b[i] - a[i]) * (b[i] - a[i]);
    bc += (b[i] - a[i]) * (c[i] - a[i]);
    cc += (c[i] - a[i]) * (c[i] - a[i]);
  }
  const Rational det = 2 * (bb * cc - bc * bc), x = (bb * cc - cc * bc) / det, y = (bb * cc - bb * bc) / det;
  std::array<Rational, 3> center;
  for (std::size_t i = 0; i < 3; ++i) center[i] = a[i] + x * (b[i] - a[i]) + y * (c[i] - a[i]);
  return center;
}

TEST(EquatorialBall, IsNearTheExactOneAndIndependentOfOrder) {
  Random random(oracle::seed());
  for (const oracle::Family<3>& family : oracle::families<3>()) {
    SCOPED_TRACE(family.name);
    for (int round = 0; round < 300; ++round) {
      std::array<Point3, 3> t{family.point(random), family.point(random), family.point(random)};
      if (round % 3 == 0)  // a nearly degenerate triangle
        for (int i = 0; i < 3; ++i) t[2][i] = oracle::nudged(random, 0.25 * t[0][i] + 0.75 * t[1][i]);
      if (collinear<3>(t[0], t[1], t[2])) continue;
      const Ball<3> ball = equatorial_ball(t[0], t[1], t[2]), turned = equatorial_ball(t[2], t[0], t[1]);
      ASSERT_TRUE(same_bits<3>(ball.center, turned.center));
      ASSERT_EQ(ball.squared_radius, turned.squared_radius);
      if (!finite<3>(ball.center)) continue;
      const auto want = exact_center(t);
      const Rational r2 = oracle::squared_distance<3>(want, t[0]);
      const Rational rounding(0x1p-52 * one_norm<3>(ball.center) + 0x1p-1070);
      ASSERT_LE(oracle::squared_distance<3>(want, ball.center), 2 * (r2 * Rational(0x1p-40) + rounding * rounding));
    }
  }
}

TEST(EquatorialBall, ContainsByTheRoundedBall) {
  const Ball<3> ball = equatorial_ball({{0, 0, 1}}, {{2, 0, 1}}, {{0, 2, 1}});
  EXPECT_EQ(ball.center, (Point3{{1, 1, 1}}));
  EXPECT_EQ(ball.squared_radius, 2);
  EXPECT_TRUE(in_equatorial_ball(ball, {{1, 1, 2}}));
  EXPECT_FALSE(in_equatorial_ball(ball, {{2, 2, 1}}));
  EXPECT_FALSE(in_equatorial_ball(ball, {{1, 1, 3}}));
}

}  // namespace pgdr::test_numbers_circumsphere
