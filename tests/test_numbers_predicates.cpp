// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Signs against rationals: every stage on manufactured degeneracy at every scale, which stage decides, the identities of
// the determinants, and the symbolic perturbation against honest little numbers.
#include "pgdr/predicates.hpp"

#include <gtest/gtest.h>

#include <thread>

#include "dimensions.hpp"
#include "numbers/predicate_stages.hpp"
#include "numbers/side_of_plane.hpp"
#include "oracles.hpp"
#include "sanitized.hpp"

namespace pgdr::test_numbers_predicates {

using detail::MaybeSign;
using detail::Middle;
using oracle::Random;
using oracle::times;

constexpr int rounds = test::sanitized ? 150 : 600;

template <int D>
std::string print(const std::vector<Point<D>>& points) {
  std::ostringstream text;
  text << std::hexfloat;
  for (const Point<D>& p : points) {
    text << '(';
    for (const double x : p.x) text << x << ' ';
    text << ") ";
  }
  return text.str();
}

// A stage may be silent, but not wrong.
void expect_agrees(const char* stage, MaybeSign got, Sign want) {
  if (got) {
    EXPECT_EQ(oracle::to_int(*got), oracle::to_int(want)) << stage;
  }
}

template <class Dimension>
class Predicates : public testing::Test {};
TYPED_TEST_SUITE(Predicates, test::Dimensions);

template <int D>
void check_orient(const Simplex<D>& s, Random& random) {
  const Sign want = oracle::orient<D>(s);
  expect_agrees("filter", detail::orient_filter<D>(s), want);
  expect_agrees("fixed point", detail::orient_middle<D>(s, Middle::fixed_point), want);
  expect_agrees("short", detail::orient_middle<D>(s, Middle::short_int), want);
  expect_agrees("expansion", detail::orient_middle<D>(s, Middle::expansion), want);
  expect_agrees("exact", detail::orient_exact<D>(s), want);
  EXPECT_EQ(orient<D>(s), want);
  if constexpr (D == 3) {
    EXPECT_EQ(detail::SideOfPlane(s[0], s[1], s[2]).of(s[3]), want);
  }
  Simplex<D> swapped = s;
  const std::size_t i = random() % (D + 1), j = (i + 1 + random() % D) % (D + 1);
  std::swap(swapped[i], swapped[j]);
  EXPECT_EQ(orient<D>(swapped), -want);
}

template <int D>
void check_in_sphere(const Simplex<D>& s, const Point<D>& p, Random& random) {
  const Sign want = oracle::in_sphere<D>(s, p);
  expect_agrees("filter", detail::in_sphere_filter<D>(s, p), want);
  expect_agrees("fixed point", detail::in_sphere_middle<D>(s, p, Middle::fixed_point), want);
  expect_agrees("short", detail::in_sphere_middle<D>(s, p, Middle::short_int), want);
  expect_agrees("expansion", detail::in_sphere_middle<D>(s, p, Middle::expansion), want);
  expect_agrees("exact", detail::in_sphere_exact<D>(s, p), want);
  EXPECT_EQ(in_sphere<D>(s, p), want);
  // Exchanging p with a corner negates the determinant.
  Simplex<D> t = s;
  const std::size_t i = random() % (D + 1);
  t[i] = p;
  EXPECT_EQ(in_sphere<D>(t, s[i]), -want);
}

TYPED_TEST(Predicates, EveryStageAgreesWithRationals) {
  constexpr int D = TypeParam::value;
  Random random(oracle::seed());
  for (const oracle::Family<D>& family : oracle::families<D>()) {
    SCOPED_TRACE(family.name);
    for (int round = 0; round < rounds; ++round) {
      Simplex<D> s;
      for (Point<D>& p : s) p = family.point(random);
      const Point<D> p = family.point(random);
      check_orient<D>(s, random);
      check_in_sphere<D>(s, p, random);
      if (this->HasFailure()) FAIL() << print<D>({s.begin(), s.end()}) << print<D>({p});
    }
  }
}

// Which arithmetic must be able to decide what; the ladder asks them in this order.
TYPED_TEST(Predicates, StagesDecideWhatTheyAreFor) {
  constexpr int D = TypeParam::value;
  Simplex<D> corner{};  // the origin and the unit vectors
  for (int i = 0; i < D; ++i) corner[static_cast<std::size_t>(i) + 1][i] = 1;
  Point<D> opposite;
  opposite.x.fill(1);
  const auto at = [](Simplex<D> s, int k) {
    for (Point<D>& p : s)
      for (double& x : p.x) x = std::ldexp(x, k);
    return s;
  };
  const auto scaled = [](Point<D> p, int k) {
    for (double& x : p.x) x = std::ldexp(x, k);
    return p;
  };

  EXPECT_EQ(detail::orient_filter<D>(corner), Sign::positive);
  EXPECT_EQ(detail::in_sphere_filter<D>(corner, scaled(opposite, -1)), Sign::positive);
  EXPECT_EQ(detail::in_sphere_filter<D>(corner, scaled(opposite, 1)), Sign::negative);
  // Exactly on the sphere: no filter, but all exact arithmetics without allocation.
  EXPECT_EQ(detail::in_sphere_filter<D>(corner, opposite), std::nullopt);
  EXPECT_EQ(detail::in_sphere_middle<D>(corner, opposite, Middle::short_int), Sign::zero);
  EXPECT_EQ(detail::in_sphere_middle<D>(corner, opposite, Middle::fixed_point), Sign::zero);
  EXPECT_EQ(detail::in_sphere_middle<D>(corner, opposite, Middle::expansion), Sign::zero);
  // Tiny: products underflow, expansions would lose terms, integers do not care.
  EXPECT_EQ(detail::in_sphere_filter<D>(at(corner, -830), scaled(opposite, -831)), std::nullopt);
  EXPECT_EQ(detail::in_sphere_middle<D>(at(corner, -830), scaled(opposite, -831), Middle::expansion), std::nullopt);
  EXPECT_EQ(detail::in_sphere_middle<D>(at(corner, -830), scaled(opposite, -831), Middle::fixed_point), Sign::positive);
  // Huge: products overflow.
  EXPECT_EQ(detail::in_sphere_filter<D>(at(corner, 465), scaled(opposite, 464)), std::nullopt);
  EXPECT_EQ(detail::in_sphere_middle<D>(at(corner, 465), scaled(opposite, 464), Middle::expansion), std::nullopt);
  EXPECT_EQ(detail::in_sphere_middle<D>(at(corner, 465), scaled(opposite, 464), Middle::fixed_point), Sign::positive);
  // Few digits, and one more.
  for (const int k : {22, 23}) {
    Simplex<D> s = corner;
    s[0][0] = std::ldexp(1, -k);
    EXPECT_EQ(detail::in_sphere_middle<D>(s, opposite, Middle::short_int).has_value(), k == 22);
    EXPECT_TRUE(detail::in_sphere_middle<D>(s, opposite, Middle::fixed_point).has_value());
  }
  // No common lattice: expansions; and not even those where a coordinate is 2^-700.
  for (const int k : {-100, -700}) {
    Simplex<D> s = corner;
    s[0][0] = std::ldexp(1, k);
    EXPECT_EQ(detail::in_sphere_filter<D>(s, opposite), std::nullopt);
    EXPECT_EQ(detail::in_sphere_middle<D>(s, opposite, Middle::fixed_point), std::nullopt);
    EXPECT_EQ(detail::in_sphere_middle<D>(s, opposite, Middle::expansion).has_value(), k == -100);
    EXPECT_EQ(in_sphere<D>(s, opposite), oracle::in_sphere<D>(s, opposite));
    EXPECT_NE(in_sphere<D>(s, opposite), Sign::zero);
  }
}

// The largest differences that short integers take, so that their products are as large as they can be.
TYPED_TEST(Predicates, ShortIntegersDoNotOverflow) {
  constexpr int D = TypeParam::value;
  Random random(20261124);
  const double most = (1 << 23) - 1;
  std::size_t decided = 0;
  for (int i = 0; i < 3000; ++i) {
    Simplex<D> s;
    Point<D> p;
    const auto draw = [&](Point<D>& q) {
      for (double& x : q.x) x = oracle::below(random, 2) * (most - oracle::below(random, 3));
    };
    for (Point<D>& q : s) draw(q);
    draw(p);
    const auto got = detail::in_sphere_middle<D>(s, p, Middle::short_int);
    decided += got.has_value() && *got != Sign::zero;
    expect_agrees("in sphere", got, oracle::in_sphere<D>(s, p));
    expect_agrees("orient", detail::orient_middle<D>(s, Middle::short_int), oracle::orient<D>(s));
    expect_agrees("angle", detail::angle_60_middle<D>(p, s[0], s[1], Middle::short_int),
                  detail::angle_60_exact<D>(p, s[0], s[1]));
  }
  EXPECT_GT(decided, 1000u);
}

TYPED_TEST(Predicates, CountsOncePerCallAndPerThread) {
  constexpr int D = TypeParam::value;
  Simplex<D> corner{};
  for (int i = 0; i < D; ++i) corner[static_cast<std::size_t>(i) + 1][i] = 1;
  Point<D> opposite, inside;
  opposite.x.fill(1);
  inside.x.fill(0.5);
  const auto counted = [](auto call) {
    const PredicateCounts before = predicate_counts();
    call();
    const PredicateCounts d = predicate_counts() - before;
    return std::array{d.filter, d.expansion, d.exact, d.perturbed};
  };
  using Counts = std::array<std::uint64_t, 4>;
  EXPECT_EQ(counted([&] { orient<D>(corner); }), (Counts{1, 0, 0, 0}));
  EXPECT_EQ(counted([&] { in_sphere<D>(corner, inside); }), (Counts{1, 0, 0, 0}));
  EXPECT_EQ(counted([&] { in_sphere<D>(corner, opposite); }), (Counts{0, 1, 0, 0}));
  EXPECT_EQ(counted([&] { in_sphere_perturbed<D>(corner, opposite); })[3], 1u);
  Simplex<D> dust = corner;
  dust[0][0] = 0x1p-700;
  EXPECT_EQ(counted([&] { in_sphere<D>(dust, opposite); }), (Counts{0, 0, 1, 0}));
  EXPECT_EQ(counted([&] { std::jthread([&] { orient<D>(corner); }).join(); }), (Counts{0, 0, 0, 0}));
  std::uint64_t elsewhere = 0;
  std::jthread([&] {
    orient<D>(corner);
    elsewhere = predicate_counts().filter;
  }).join();
  EXPECT_EQ(elsewhere, 1u);
  PredicateCounts sum{1, 2, 3, 4};
  sum += PredicateCounts{10, 20, 30, 40};
  EXPECT_EQ((std::array{sum.filter, sum.expansion, sum.exact, sum.perturbed}), (Counts{11, 22, 33, 44}));
}

// --- Perturbation

template <class P, std::size_t N>
bool distinct(const std::array<P, N>& s, const P& p) {
  for (std::size_t i = 0; i < N; ++i) {
    if (s[i] == p) return false;
    for (std::size_t j = 0; j < i; ++j)
      if (s[i] == s[j]) return false;
  }
  return true;
}

TYPED_TEST(Predicates, PerturbedAgreesWithHonestLittleNumbers) {
  constexpr int D = TypeParam::value;
  Random random(oracle::seed());
  int ties = 0;
  for (const oracle::Family<D>& family : oracle::families<D>()) {
    SCOPED_TRACE(family.name);
    for (int round = 0; round < 2 * rounds; ++round) {
      Simplex<D> s;
      for (Point<D>& p : s) p = family.point(random);
      const Point<D> p = family.point(random);
      if (!distinct(s, p) || orient<D>(s) == Sign::zero) continue;
      if (orient<D>(s) == Sign::negative) std::swap(s[0], s[1]);
      const Sign got = in_sphere_perturbed<D>(s, p);
      const Sign plain = in_sphere<D>(s, p);
      ties += plain == Sign::zero;
      if (plain != Sign::zero) {
        ASSERT_EQ(got, plain);
      } else if (family.tame) {
        ASSERT_EQ(got, oracle::in_sphere<D>(s, p, true)) << print<D>({s.begin(), s.end()}) << print<D>({p});
      }
      ASSERT_NE(got, Sign::zero);
      // The determinant is antisymmetric, ties included.
      for (std::size_t i = 0; i <= D; ++i) {
        Simplex<D> t = s;
        t[i] = p;
        const Sign o = orient<D>(t);
        if (o == Sign::zero) continue;
        if (o == Sign::negative) std::swap(t[(i + 1) % (D + 1)], t[(i + 2) % (D + 1)]);
        ASSERT_EQ(in_sphere_perturbed<D>(t, s[i]), times(-o, got));
      }
    }
  }
  EXPECT_GT(ties, 300);
}

// The lexicographically first corner has the largest height: the diagonal between its neighbours cuts it off.
TEST(Perturbed, FirstCornerOfASquareIsHighest) {
  const Point2 a{{0, 0}}, b{{1, 0}}, c{{1, 1}}, d{{0, 1}};
  EXPECT_EQ(in_sphere_perturbed<2>({b, c, d}, a), Sign::negative);
  EXPECT_EQ(in_sphere_perturbed<2>({a, b, c}, d), Sign::positive);
  EXPECT_EQ(in_sphere_perturbed<2>({a, b, d}, c), Sign::negative);
  EXPECT_EQ(in_sphere_perturbed<2>({a, c, d}, b), Sign::positive);
}

// Coplanar points, of lattice planes in general position, in planes parallel to an axis, and by one axis only rounded.
std::vector<std::array<Point3, 4>> coplanar_quadruples(Random& random) {
  std::vector<std::array<Point3, 4>> result;
  for (int round = 0; round < 6000; ++round) {
    std::array<Point3, 4> q;
    if (round % 3 == 0) {
      for (Point3& p : q) p = oracle::on_plane<3>(random);
    } else {  // rectangles with corners o, o+v, o+w, o+v+w are cocircular; v.w = 0
      const double x = oracle::below(random, 5) - 2, y = oracle::below(random, 5) - 2, z = oracle::below(random, 5) - 2;
      const Point3 v{{y, -x, 0}}, w{{x * z, y * z, -(x * x + y * y)}};
      const double step = round % 3 == 1 ? 0.125 : 1024;
      for (int i = 0; i < 4; ++i)
        for (int k = 0; k < 3; ++k) q[static_cast<std::size_t>(i)][k] = 7 * step + step * ((i & 1) * v[k] + (i >> 1) * w[k]);
      std::shuffle(q.begin(), q.end(), random);
    }
    if (distinct(std::array{q[0], q[1], q[2]}, q[3])) result.push_back(q);
  }
  return result;
}

TEST(InCirclePerturbed, AgreesWithRationalsAndWithTheSphereInThePlane) {
  Random random(oracle::seed());
  int ties = 0, compared = 0;
  for (std::array<Point3, 4> q : coplanar_quadruples(random)) {
    for (int axis = 0; axis < 3; ++axis) {
      const Sign o = orient_projected(q[0], q[1], q[2], axis);
      if (o == Sign::zero) continue;
      if (o == Sign::negative) std::swap(q[0], q[1]);
      const auto [a, b, c, p] = q;
      const Sign got = in_circle_perturbed(a, b, c, p, axis);
      const Sign plain = oracle::in_circle(q, axis, false);
      ties += plain == Sign::zero;
      expect_agrees("filter", detail::in_circle_filter({a, b, c}, p, axis), plain);
      expect_agrees("fixed point", detail::in_circle_middle({a, b, c}, p, axis, Middle::fixed_point), plain);
      expect_agrees("short", detail::in_circle_middle({a, b, c}, p, axis, Middle::short_int), plain);
      expect_agrees("expansion", detail::in_circle_middle({a, b, c}, p, axis, Middle::expansion), plain);
      expect_agrees("exact", detail::in_circle_exact({a, b, c}, p, axis), plain);
      ASSERT_EQ(got, oracle::in_circle(q, axis, true)) << print<3>({q.begin(), q.end()});
      Simplex<3> s{a, b, c, Point3{{11, -5, 3 + 0.5 * axis}}};
      if (orient<3>(s) == Sign::zero) continue;
      if (orient<3>(s) == Sign::negative) std::swap(s[0], s[1]);
      ASSERT_EQ(in_sphere_perturbed<3>(s, p), got) << print<3>({q.begin(), q.end()});
      ++compared;
    }
  }
  EXPECT_GT(ties, 1000);
  EXPECT_GT(compared, 3000);
}

// Points that are coplanar only within rounding: still the regular triangulation of fixed heights, so antisymmetric.
TEST(InCirclePerturbed, IsConsistentOffThePlane) {
  Random random(oracle::seed());
  for (int round = 0; round < 3000; ++round) {
    std::array<Point3, 4> q;
    for (Point3& p : q) {
      p = oracle::on_plane<3>(random);
      for (double& x : p.x) x = oracle::nudged(random, 0.1 * x + 100);
    }
    if (!distinct(std::array{q[0], q[1], q[2]}, q[3])) continue;
    const Sign o = orient_projected(q[0], q[1], q[2], 2), o2 = orient_projected(q[0], q[1], q[3], 2);
    if (o == Sign::zero || o2 == Sign::zero) continue;
    if (o == Sign::negative) std::swap(q[0], q[1]);
    const Sign got = in_circle_perturbed(q[0], q[1], q[2], q[3], 2);
    const Sign plain = oracle::in_circle(q, 2, false);
    if (plain != Sign::zero) {
      ASSERT_EQ(got, plain);
    }
    const Sign flipped = orient_projected(q[0], q[1], q[3], 2);
    if (flipped == Sign::negative) std::swap(q[0], q[1]);
    ASSERT_EQ(in_circle_perturbed(q[0], q[1], q[3], q[2], 2), times(-flipped, got));
  }
}

// --- Angles and lines

TYPED_TEST(Predicates, AnglesAgreeWithRationals) {
  constexpr int D = TypeParam::value;
  Random random(oracle::seed());
  int right = 0, sixty = 0;
  for (const oracle::Family<D>& family : oracle::families<D>()) {
    SCOPED_TRACE(family.name);
    for (int round = 0; round < 600; ++round) {
      const Point<D> v = family.point(random), a = family.point(random), b = family.point(random);
      oracle::Rational dot = 0, a2 = oracle::squared_distance<D>(oracle::exact<D>(v), a);
      const oracle::Rational b2 = oracle::squared_distance<D>(oracle::exact<D>(v), b);
      for (std::size_t i = 0; i < D; ++i)
        dot += (oracle::Rational(a.x[i]) - oracle::Rational(v.x[i])) * (oracle::Rational(b.x[i]) - oracle::Rational(v.x[i]));
      const oracle::Rational excess = 4 * dot * dot - a2 * b2;
      const Sign dot_sign = oracle::sign(dot), excess_sign = oracle::sign(excess);
      expect_agrees("dot filter", detail::dot_filter<D>(v, a, b), dot_sign);
      expect_agrees("dot fixed point", detail::dot_middle<D>(v, a, b, Middle::fixed_point), dot_sign);
      expect_agrees("dot short", detail::dot_middle<D>(v, a, b, Middle::short_int), dot_sign);
      expect_agrees("dot expansion", detail::dot_middle<D>(v, a, b, Middle::expansion), dot_sign);
      expect_agrees("dot exact", detail::dot_exact<D>(v, a, b), dot_sign);
      expect_agrees("60 filter", detail::angle_60_filter<D>(v, a, b), excess_sign);
      expect_agrees("60 fixed point", detail::angle_60_middle<D>(v, a, b, Middle::fixed_point), excess_sign);
      expect_agrees("60 short", detail::angle_60_middle<D>(v, a, b, Middle::short_int), excess_sign);
      expect_agrees("60 expansion", detail::angle_60_middle<D>(v, a, b, Middle::expansion), excess_sign);
      expect_agrees("60 exact", detail::angle_60_exact<D>(v, a, b), excess_sign);
      EXPECT_EQ(angle_below_90<D>(v, a, b), dot > 0);
      EXPECT_EQ(angle_below_60<D>(v, a, b), dot > 0 && excess > 0);
      right += dot == 0;
      sixty += dot > 0 && excess == 0;
      EXPECT_EQ(collinear<D>(v, a, b), dot * dot == a2 * b2);
      if (this->HasFailure()) FAIL() << print<D>({v, a, b});
    }
  }
  EXPECT_GT(right, 100);
  EXPECT_TRUE(D == 2 || sixty > 20) << sixty;
}

}  // namespace pgdr::test_numbers_predicates
