// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Angles against bounds: against rationals with another formula, against acos, at the bound and one ulp beside it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "numbers/angle_bounds.hpp"
#include "numbers/corners.hpp"
#include "numbers/dihedral_sign.hpp"
#include "pgdr/predicates.hpp"
#include "random_simplices.hpp"
#include "sanitized.hpp"

namespace pgdr::test_numbers_angle_bounds {

using oracle::Random;
using oracle::Rational;

constexpr int rounds = test::sanitized ? 10 : 40;

/// Cosine of an angle: its square, and its sign.
struct Cosine {
  Rational square;
  int sign;
  bool at_most(double k) const { return sign * square <= (k < 0 ? -1 : 1) * Rational(k) * Rational(k); }
  double rounded() const { return sign * std::sqrt(CGAL::to_double(square)); }
};

/// Between the parts of u and w normal to e. No cosine where one of them is zero.
std::optional<Cosine> cosine_at(const Point3& a, const Point3& b, const Point3& c, const Point3& d) {
  std::array<Rational, 3> e, u, w;
  for (int i = 0; i < 3; ++i) {
    e[i] = Rational(b[i]) - Rational(a[i]);
    u[i] = Rational(c[i]) - Rational(a[i]);
    w[i] = Rational(d[i]) - Rational(a[i]);
  }
  const auto dot = [](const auto& x, const auto& y) { return Rational(x[0] * y[0] + x[1] * y[1] + x[2] * y[2]); };
  const Rational ee = dot(e, e), eu = dot(e, u), ew = dot(e, w);
  const Rational product = ee * dot(u, w) - eu * ew, lengths = (ee * dot(u, u) - eu * eu) * (ee * dot(w, w) - ew * ew);
  if (lengths == 0) return {};
  return Cosine{product * product / lengths, product > 0 ? 1 : product < 0 ? -1 : 0};
}

std::vector<Cosine> cosines(const Simplex<3>& s) {
  std::vector<Cosine> all;
  for (const auto& [i, j] : edge_ends) {
    const auto [k, l] = corners_without(i, j);
    if (const auto c = cosine_at(s[i], s[j], s[k], s[l])) all.push_back(*c);
  }
  return all;
}

bool wanted(const std::vector<Cosine>& all, double k) {
  return all.size() == 6 && std::all_of(all.begin(), all.end(), [k](const Cosine& c) { return c.at_most(k); });
}

std::vector<double> with_neighbours(double k) { return {k, std::nextafter(k, 2), std::nextafter(k, -2), k + 8e-16, k - 8e-16}; }

TEST(AngleBounds, AgreesWithRationals) {
  int within = 0, over = 0;
  oracle::check_simplices<3>(rounds, [&](const Simplex<3>& s, Random& random) {
    std::vector<double> bounds{0, 0.5, -0.3, std::uniform_real_distribution(-1.0, 1.0)(random)};
    const auto all = cosines(s);
    for (const Cosine& c : all)
      for (const double k : with_neighbours(c.rounded())) bounds.push_back(k);
    for (const double k : bounds) {
      if (k >= 1 || k <= -1) continue;
      const bool want = wanted(all, k);
      ++(want ? within : over);
      EXPECT_EQ(dihedral_within(s, k), want) << k;
    }
  });
  EXPECT_GT(within, 25 * rounds);
  EXPECT_GT(over, 25 * rounds);
}

TEST(AngleBounds, AgreesWithAnglesOfRandomCells) {
  Random random(oracle::seed());
  std::uniform_real_distribution<double> uniform(-1, 1);
  int decided = 0;
  std::vector<std::pair<double, double>> targets;
  for (const double degrees : {5.0, 15.0, 30.0, 60.0}) targets.push_back({degrees, claimed_cosine(degrees)});
  for (int round = 0; round < 40000; ++round) {
    Simplex<3> s;
    for (Point3& p : s)
      for (double& x : p.x) x = uniform(random);
    double least = 180;
    for (const auto& [i, j] : edge_ends) {
      const auto [k, l] = corners_without(i, j);
      std::array<double, 3> e, u, w;
      for (int axis = 0; axis < 3; ++axis) {
        e[axis] = s[j][axis] - s[i][axis];
        u[axis] = s[k][axis] - s[i][axis];
        w[axis] = s[l][axis] - s[i][axis];
      }
      const auto dot = [](const auto& x, const auto& y) { return x[0] * y[0] + x[1] * y[1] + x[2] * y[2]; };
      for (auto* v : {&u, &w}) {
        const double t = dot(*v, e) / dot(e, e);
        for (int axis = 0; axis < 3; ++axis) (*v)[axis] -= t * e[axis];
      }
      const double cosine = dot(u, w) / std::sqrt(dot(u, u) * dot(w, w));
      least = std::min(least, std::acos(std::clamp(cosine, -1.0, 1.0)) * 180 / std::numbers::pi);
    }
    for (const auto& [degrees, claimed] : targets) {
      if (std::abs(least - degrees) < 1e-4) continue;
      ++decided;
      ASSERT_EQ(dihedral_within(s, claimed), least > degrees) << least;
    }
  }
  EXPECT_GT(decided, 150000);
}

TEST(AngleBounds, DoesNotDependOnOrderAndScale) {
  oracle::check_simplices<3>(rounds / 10, [&](const Simplex<3>& s, Random& random) {
    const auto all = cosines(s);
    const double k = all[random() % all.size()].rounded();
    if (k >= 1) return;
    const bool want = dihedral_within(s, k);
    std::array<int, 4> order{0, 1, 2, 3};
    do {
      const Simplex<3> permuted{s[order[0]], s[order[1]], s[order[2]], s[order[3]]};
      EXPECT_EQ(dihedral_within(permuted, k), want);
    } while (std::next_permutation(order.begin(), order.end()));
    for (const int power : {-300, -40, 40, 300}) {
      Simplex<3> scaled = s;
      bool exact = true;
      for (Point3& p : scaled)
        for (double& x : p.x) {
          const double y = std::ldexp(x, power);
          exact = exact && std::ldexp(y, -power) == x;
          x = y;
        }
      if (exact) {
        EXPECT_EQ(dihedral_within(scaled, k), want) << power;
      }
    }
  });
}

TEST(AngleBounds, RightAnglesAndAnglesThatAreBoundsExactly) {
  const Simplex<3> corner{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};  // 90 degrees, and the arc cosine of 1 / sqrt(3)
  EXPECT_TRUE(dihedral_within(corner, 0.58));
  EXPECT_FALSE(dihedral_within(corner, 0.57));
  const Simplex<3> kuhn{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {1, 1, 1}}};  // 45, 60 and 90 degrees
  const double root_half = std::sqrt(0.5);                              // the double above the root
  EXPECT_GT(Rational(root_half) * Rational(root_half) * 2, 1);
  EXPECT_TRUE(dihedral_within(kuhn, root_half));
  EXPECT_FALSE(dihedral_within(kuhn, std::nextafter(root_half, 0)));
  const Point3 a{0, 0, 0}, b{0, 0, 1}, c{1, 0, 3}, d{3, 4, -2};  // 3/5
  EXPECT_FALSE(detail::dihedral_below(a, b, c, {4, 3, 0}, 0.8000000000000002));
  EXPECT_TRUE(detail::dihedral_below(a, b, c, d, 0.5));
  EXPECT_FALSE(detail::dihedral_below(a, b, c, {1, 1, 0}, std::nextafter(root_half, 1)));
  EXPECT_TRUE(detail::dihedral_below(a, b, c, {1, 1, 0}, std::nextafter(root_half, 0)));
  EXPECT_FALSE(detail::dihedral_below(a, b, {1, 1, 0}, {1, -1, 5}, 0));  // 90 degrees are not below 90
  EXPECT_TRUE(detail::dihedral_below(a, b, {1, 1, 0}, {1, -1, 5}, -1e-300));
}

TEST(AngleBounds, FlatCellsMeetNone) {
  const Point3 a{0, 0, 0}, b{1, 0, 0}, c{0, 1, 0};
  for (const Point3& d : {Point3{1, 1, 0}, Point3{0.25, 0.25, 0}, Point3{0.5, 0, 0}, Point3{2, 0, 0}, a}) {
    EXPECT_FALSE(dihedral_within({a, b, c, d}, 0.9999999999999999));
    EXPECT_FALSE(dihedral_within({a, b, c, d}, 0));
    EXPECT_FALSE(dihedral_within({a, b, c, d}, -0.5));
    EXPECT_TRUE(dihedral_within({a, b, c, d}, 1));
  }
  EXPECT_FALSE(dihedral_within({a, b, c, {0, 0, 1}}, std::numeric_limits<double>::quiet_NaN()));
  EXPECT_FALSE(dihedral_within({a, b, c, {0, 0, 1}}, -1));
  EXPECT_FALSE(dihedral_within({a, b, c, {0.3, 0.3, 1e-290}}, 0.9999));  // below the normal range in the filter
  EXPECT_FALSE(detail::dihedral_below(a, b, {2, 0, 0}, c, 0.5));
  EXPECT_FALSE(detail::dihedral_below(a, b, c, a, 0.5));
}

TEST(AngleBounds, WedgesAgreeWithRationals) {
  int below = 0;
  oracle::check_simplices<3>(rounds, [&](const Simplex<3>& s, Random&) {
    const auto c = cosine_at(s[0], s[1], s[2], s[3]);
    if (!c) return;
    for (const double k : with_neighbours(c->rounded())) {
      if (k >= 1 || k <= -1) continue;
      below += !c->at_most(k);
      EXPECT_EQ(detail::dihedral_below(s[0], s[1], s[2], s[3], k), !c->at_most(k));
      EXPECT_EQ(detail::dihedral_below(s[1], s[0], s[3], s[2], k), !c->at_most(k));
    }
  });
  EXPECT_GT(below, 25 * rounds);
}

TEST(AngleBounds, SharpPlanarAngles) {
  Random random(oracle::seed());
  std::uniform_real_distribution<double> uniform(-1, 1);
  int sharp = 0;
  for (int round = 0; round < 20000; ++round) {
    Point3 v, a, b;
    for (Point3* p : {&v, &a, &b})
      for (double& x : p->x) x = uniform(random);
    if (round % 2)
      for (int i = 0; i < 3; ++i) b[i] = 2 * a[i] - v[i] + 0.2 * b[i];
    long double aa = 0, ab = 0, bb = 0;
    for (int i = 0; i < 3; ++i) {
      const long double x = static_cast<long double>(a[i]) - v[i], y = static_cast<long double>(b[i]) - v[i];
      aa += x * x;
      ab += x * y;
      bb += y * y;
    }
    const long double angle = std::acos(std::clamp<long double>(ab / std::sqrt(aa * bb), -1, 1));
    for (const double bound : {0.6, 1.0, 2.0, 10.0}) {
      const long double largest = std::asin(1 / (2 * static_cast<long double>(bound)));
      if (std::abs(angle - largest) < 1e-6L) continue;
      sharp += angle < largest;
      ASSERT_EQ(detail::is_too_sharp<3>(v, a, b, bound), angle < largest);
      ASSERT_EQ(detail::is_too_sharp<3>(v, b, a, bound), angle < largest);
    }
  }
  EXPECT_GT(sharp, 1000);
  const Point2 o{0, 0}, x{1, 0};
  EXPECT_TRUE(detail::is_too_sharp<2>(o, x, {3, std::sqrt(3)}, 1));  // the root is rounded down, the angle is below 30 degrees
  EXPECT_FALSE(detail::is_too_sharp<2>(o, x, {3, std::nextafter(std::sqrt(3), 2)}, 1));
  EXPECT_FALSE(detail::is_too_sharp<2>(o, x, {-1, 0.1}, 1));
  EXPECT_FALSE(detail::is_too_sharp<2>(o, x, o, 1));
  EXPECT_TRUE(detail::is_too_sharp<2>(o, x, {2, 0}, 1));
  EXPECT_FALSE(detail::is_too_sharp<2>(o, x, {2, 0}, std::numeric_limits<double>::infinity()));
  EXPECT_FALSE(detail::is_too_sharp<2>(o, x, {2, 1}, 0.5 * 3));
}

TEST(AngleBounds, DirectionsNearPlanarCorners) {
  Random random(oracle::seed());
  std::uniform_real_distribution<double> uniform(-1, 1);
  int above = 0;
  for (int round = 0; round < 4000; ++round) {
    Point3 v, r, b, c;
    for (Point3* p : {&v, &r, &b, &c})
      for (double& x : p->x) x = uniform(random);
    if (round % 2)
      for (int i = 0; i < 3; ++i) r[i] = 0.5 * (b[i] + c[i]) + 0.2 * r[i];
    // The nearest of many directions between the two; the angle between is no less than the exact one.
    const auto angle_to = [&](long double share) {
      long double xx = 0, xy = 0, yy = 0, bb = 0, cc = 0;
      for (int i = 0; i < 3; ++i) bb += std::pow(static_cast<long double>(b[i]) - v[i], 2);
      for (int i = 0; i < 3; ++i) cc += std::pow(static_cast<long double>(c[i]) - v[i], 2);
      for (int i = 0; i < 3; ++i) {
        const long double x = static_cast<long double>(r[i]) - v[i];
        const long double y = (1 - share) * (static_cast<long double>(b[i]) - v[i]) / std::sqrt(bb) +
                              share * (static_cast<long double>(c[i]) - v[i]) / std::sqrt(cc);
        xx += x * x;
        xy += x * y;
        yy += y * y;
      }
      return std::acos(std::clamp<long double>(xy / std::sqrt(xx * yy), -1, 1));
    };
    long double angle = 4;
    constexpr int steps = 256;
    for (int k = 0; k <= steps; ++k) angle = std::min(angle, angle_to(static_cast<long double>(k) / steps));
    for (const double bound : {0.6, 1.0, 2.0, 10.0}) {
      const long double largest = std::asin(1 / (2 * static_cast<long double>(bound)));
      if (std::abs(angle - largest) < 0.02L) continue;
      const bool near = detail::is_too_near_corner(v, r, b, c, bound);
      ASSERT_EQ(near, angle < largest);
      ASSERT_EQ(detail::is_too_near_corner(v, r, c, b, bound), near);
      above += near && !detail::is_too_sharp<3>(v, r, b, bound) && !detail::is_too_sharp<3>(v, r, c, bound);
    }
  }
  EXPECT_GT(above, 200);
  // Exactly: a sine of 1/4 is not below it.
  const Point3 o{0, 0, 0}, x{8, 0, 0}, y{0, 8, 0}, up{3, 6, std::sqrt(3)};  // a root rounded down; sqrt(45 + 3) = 4 sqrt(3)
  EXPECT_TRUE(detail::is_too_near_corner(o, up, x, y, 2));
  EXPECT_FALSE(detail::is_too_near_corner(o, {3, 6, std::nextafter(std::sqrt(3), 2)}, x, y, 2));
  EXPECT_TRUE(detail::is_too_near_corner(o, {3, 6, 0}, x, y, 2));
  EXPECT_FALSE(detail::is_too_near_corner(o, {-3, -6, 0}, x, y, 2));
  EXPECT_FALSE(detail::is_too_near_corner(o, o, x, y, 2));
  EXPECT_FALSE(detail::is_too_near_corner(o, {0, 0, 1}, x, x, 2));
}

/// By its series, of more than forty digits.
Rational cosine_of(const Rational& degrees) {
  static const Rational pi(
      "31415926535897932384626433832795028841971693993751058209749445923/"
      "10000000000000000000000000000000000000000000000000000000000000000");
  const Rational x = degrees * pi / 180;
  Rational term = 1, sum = 1;
  for (int k = 2; k < 80; k += 2) {
    term = -term * x * x / (k * (k - 1));
    sum += term;
  }
  return sum;
}

TEST(AngleBounds, ClaimedCosineIsTheNearestDouble) {
  EXPECT_EQ(claimed_cosine(0), 1);
  EXPECT_EQ(claimed_cosine(60), 0.5);
  EXPECT_EQ(claimed_cosine(90), 0);
  EXPECT_EQ(claimed_cosine(120), -0.5);
  EXPECT_EQ(claimed_cosine(180), -1);
  EXPECT_TRUE(std::isnan(claimed_cosine(std::numeric_limits<double>::infinity())));
  EXPECT_EQ(claimed_cosine(1e-9), 1);
  for (int thousandths = 1; thousandths < 90000; thousandths += 701) {
    const Rational exact = cosine_of(Rational(thousandths) / 1000);
    const double k = claimed_cosine(thousandths / 1000.0);
    EXPECT_LE(abs(exact - Rational(k)) * 2, Rational(std::nextafter(k, 2)) - Rational(k)) << thousandths;
    EXPECT_LE(abs(exact - Rational(k)) * 2, Rational(k) - Rational(std::nextafter(k, -2))) << thousandths;
  }
}

TEST(DihedralSign, AtARightAngle) {
  const Point3 a{{0, 0, 0}}, b{{0, 0, 1}}, c{{1, 0, 5}};
  EXPECT_EQ(detail::dihedral_sign(a, b, c, Point3{{0, 1, -7}}), Sign::zero);
  EXPECT_EQ(detail::dihedral_sign(a, b, c, Point3{{0x1p-1000, 1, 3}}), Sign::positive);
  EXPECT_EQ(detail::dihedral_sign(a, b, c, Point3{{-0x1p-1000, 1, 3}}), Sign::negative);
}

}  // namespace pgdr::test_numbers_angle_bounds
