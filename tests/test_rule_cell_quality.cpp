// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The measure of cells, against angles by the arc cosine in long doubles.
#include "optimize/cell_quality.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "numbers/corners.hpp"
#include "numbers/vectors.hpp"
#include "pgdr/predicates.hpp"

namespace pgdr::test_rule_cell_quality {

using Long = std::array<long double, 3>;
constexpr double infinity = std::numeric_limits<double>::infinity();

Long minus(const Point3& a, const Point3& b) {
  return {static_cast<long double>(a[0]) - b[0], static_cast<long double>(a[1]) - b[1], static_cast<long double>(a[2]) - b[2]};
}
Long cross(const Long& u, const Long& v) {
  return {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
}
long double dot(const Long& u, const Long& v) { return u[0] * v[0] + u[1] * v[1] + u[2] * v[2]; }
long double length(const Long& u) { return std::sqrt(dot(u, u)); }

struct Shape {
  long double least_angle = 180, largest_angle = 0;  // dihedral, in degrees
  long double radius = 0, shortest = 0, volume = 0;
};

Shape shape_of(const Simplex<3>& s) {
  Shape shape;
  shape.shortest = std::numeric_limits<long double>::infinity();
  for (int e = 0; e < 6; ++e) {
    const auto [i, j] = edge_ends[static_cast<std::size_t>(e)];
    const auto [k, l] = corners_without(i, j);
    const Long edge = minus(s[j], s[i]), u = minus(s[k], s[i]), v = minus(s[l], s[i]);
    const Long m = cross(edge, u), n = cross(edge, v);
    const long double angle = std::acos(dot(m, n) / (length(m) * length(n))) * 180 / std::numbers::pi_v<long double>;
    shape.least_angle = std::min(shape.least_angle, angle);
    shape.largest_angle = std::max(shape.largest_angle, angle);
    shape.shortest = std::min(shape.shortest, length(edge));
  }
  const Long a = minus(s[1], s[0]), b = minus(s[2], s[0]), c = minus(s[3], s[0]);
  const Long bc = cross(b, c), ca = cross(c, a), ab = cross(a, b);
  shape.volume = dot(a, bc) / 6;
  Long centre;
  for (std::size_t i = 0; i < 3; ++i)
    centre[i] = (dot(a, a) * bc[i] + dot(b, b) * ca[i] + dot(c, c) * ab[i]) / (12 * shape.volume);
  shape.radius = length(centre);
  return shape;
}

/// Round ones and flat ones, slivers and needles.
Simplex<3> some_cell(std::mt19937& random) {
  std::uniform_real_distribution<double> unit(-1, 1);
  Simplex<3> s;
  const double flat = random() % 2 ? 1 : std::ldexp(1.0, -static_cast<int>(random() % 12));
  const double thin = random() % 3 ? 1 : std::ldexp(1.0, -static_cast<int>(random() % 12));
  for (Point3& p : s) p = {{unit(random), thin * unit(random), flat * unit(random)}};
  if (orient<3>(s) == Sign::negative) std::swap(s[2], s[3]);
  return s;
}

TEST(CellQuality, ComplementOfTheCosine) {
  for (double degrees = 0; degrees <= 60; degrees += 0.125) {
    const long double half = degrees * std::numbers::pi_v<long double> / 360, exact = 2 * std::sin(half) * std::sin(half);
    EXPECT_NEAR(cosine_complement(degrees), static_cast<double>(exact), 1e-15 * static_cast<double>(exact)) << degrees;
  }
}

TEST(CellQuality, AgreesWithAnglesByTheArcCosine) {
  std::mt19937 random(1);
  CellBounds<3> bounds;
  bounds.radius_edge_bound = 2;
  bounds.size = SizingField<3>(0.75);
  bounds.max_measure = 0.05;
  const CellBounds<3> no_bounds;
  int by_each[4] = {}, perfect = 0;
  for (int round = 0; round < 1'000'000; ++round) {
    const double target = 1 + random() % 35;
    const CellQuality angles(no_bounds, target), quality(bounds, target);
    const Simplex<3> s = some_cell(random);
    const Shape shape = shape_of(s);
    const auto radians = std::numbers::pi_v<long double> / 180;
    // Of an angle t: 1 - cos t is 2 sin^2(t/2), and 1 + cos t is 2 cos^2(t/2), where the difference would lose digits.
    const auto of_angle = [&](long double t) {
      const long double sine = std::sin(t * radians / 2), cosine = std::cos(t * radians / 2);
      return t < 90 ? 2 * sine * sine : 0.7L * 2 * cosine * cosine;
    };
    const long double asked = 2 * std::sin(target * radians / 2) * std::sin(target * radians / 2);
    const double d = static_cast<double>(std::min(of_angle(shape.least_angle), of_angle(shape.largest_angle)) / asked);
    const double error = 1e-12 / static_cast<double>(asked) + 2e-9 * d;
    ASSERT_NEAR(angles.of(s, 0), std::min(d, 1.0), error) << round;
    const double parts[4] = {d, static_cast<double>(std::sqrt(2 * shape.shortest / shape.radius)),
                             static_cast<double>(0.75 / shape.radius), static_cast<double>(0.05 / shape.volume)};
    const auto least = std::min_element(parts, parts + 4);
    const double q = quality.of(s, 0);
    ASSERT_NEAR(q, std::min(*least, 1.0), error + 1e-8 * *least) << round;
    ++(*least < 1 ? by_each[least - parts] : perfect);
    // By the margin: what passes is within its bounds.
    if (q == 1) {
      ASSERT_GT(shape.least_angle, target);
      ASSERT_LE(shape.radius, 0.75);
      ASSERT_LE(shape.radius, 2 * shape.shortest);
      ASSERT_LE(shape.volume, 0.05);
    }
    // What is known to be too bad need not be measured to the end; what is not is measured as ever.
    const double enough = (random() % 1000) / 1000.0, some = quality.of(s, 0, enough);
    if (q > enough) {
      ASSERT_EQ(some, q);
    } else {
      ASSERT_LE(some, enough);
    }
  }
  for (const int n : by_each) EXPECT_GT(n, 1000);
  EXPECT_GT(perfect, 1000);
}

TEST(CellQuality, LargeAnglesCount) {
  // The largest angle that passes, by the target.
  for (const auto& [target, largest] : {std::pair{15.0, 162.1}, {20.0, 156.1}, {25.0, 150.0}, {30.0, 144.0}}) {
    const double d = cosine_complement(target), cosine = d / 0.7 - 1;
    EXPECT_NEAR(std::acos(cosine) * 180 / std::numbers::pi, largest, 0.06);
  }
}

TEST(CellQuality, IsTheSameAtEveryScaleAndInEvenPermutations) {
  std::mt19937 random(2);
  for (int round = 0; round < 20000; ++round) {
    const Simplex<3> s = some_cell(random);
    CellBounds<3> bounds, scaled_bounds;
    const int k = static_cast<int>(random() % 120) - 60;
    bounds.radius_edge_bound = scaled_bounds.radius_edge_bound = 2;
    bounds.size = SizingField<3>(0.75);
    scaled_bounds.size = SizingField<3>(std::ldexp(0.75, k));
    bounds.max_measure = 0.05;
    scaled_bounds.max_measure = std::ldexp(0.05, 3 * k);
    const CellQuality quality(bounds, 20), scaled_quality(scaled_bounds, 20);
    const double q = quality.of(s, 0);
    Simplex<3> scaled = s;
    for (Point3& p : scaled)
      for (double& x : p.x) x = std::ldexp(x, k);
    ASSERT_EQ(scaled_quality.of(scaled, 0), q) << round;
    ASSERT_EQ(quality.of(s, 0), q);
    for (const auto& order : {std::array{1, 0, 3, 2}, {2, 3, 0, 1}, {3, 2, 1, 0}, {0, 2, 3, 1}, {1, 2, 0, 3}, {3, 0, 2, 1}}) {
      const Simplex<3> turned = {s[order[0]], s[order[1]], s[order[2]], s[order[3]]};
      ASSERT_NEAR(quality.of(turned, 0), q, 1e-9) << round;
    }
    ASSERT_EQ(quality.of({s[1], s[0], s[2], s[3]}, 0), 0);  // turned over
  }
}

TEST(CellQuality, FlatCellsHaveNone) {
  CellBounds<3> bounds;
  const CellQuality angles(bounds, 15), none(bounds, 0);
  bounds.radius_edge_bound = 2;
  const Point3 o{{0, 0, 0}}, x{{1, 0, 0}}, y{{0, 1, 0}}, xy{{1, 1, 0}};
  for (const CellQuality* quality : {&angles, &none}) {
    EXPECT_EQ(quality->of({o, x, y, xy}, 0), 0);
    EXPECT_EQ(quality->of({o, x, x, y}, 0), 0);
    EXPECT_EQ(quality->of({o, o, o, o}, 0), 0);
    EXPECT_EQ(quality->evaluated(), 3u);
  }
  const Point3 high{{0.3, 0.3, std::ldexp(1.0, -60)}};
  EXPECT_LT(angles.of({o, x, y, high}, 0), 1e-12);
}

TEST(CellQuality, RegionsHaveBoundsOfTheirOwn) {
  CellBounds<3> bounds;
  bounds.region_size = {SizingField<3>(), SizingField<3>(0.5)};
  bounds.region_measure = {0.01, infinity};
  const CellQuality quality(bounds, 5);
  const Simplex<3> s = {Point3{{0, 0, 0}}, Point3{{1, 0, 0}}, Point3{{0, 1, 0}}, Point3{{0, 0, 1}}};
  EXPECT_NEAR(quality.of(s, 0), 0.06, 1e-9);              // the volume is a sixth
  EXPECT_NEAR(quality.of(s, 1), 1 / std::sqrt(3), 1e-8);  // the radius is half the root of 3
}

TEST(CellQuality, LevelsAreMonotoneAndStepsOfAHundredth) {
  EXPECT_EQ(CellQuality::level(1), 0);
  EXPECT_EQ(CellQuality::level(0), CellQuality::lowest_level);
  EXPECT_EQ(CellQuality::level(-1), CellQuality::lowest_level);
  EXPECT_EQ(CellQuality::level(std::numeric_limits<double>::quiet_NaN()), CellQuality::lowest_level);
  EXPECT_EQ(CellQuality::level(std::nextafter(1, 0)), -1);
  EXPECT_EQ(CellQuality::level(1e-300), CellQuality::lowest_level);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> powers(-30, 0);
  std::vector<double> all;
  for (int i = 0; i < 100000; ++i) all.push_back(std::pow(10, powers(random)));
  std::sort(all.begin(), all.end());
  int last = CellQuality::lowest_level;
  for (const double q : all) {
    const int level = CellQuality::level(q);
    ASSERT_GE(level, last);
    last = level;
    ASSERT_NEAR(level, std::floor(std::log(q) / std::log(1.01)), 1) << q;
    ASSERT_LE(CellQuality::least_of_level(level), q);
    ASSERT_EQ(CellQuality::level(CellQuality::least_of_level(level)), level);
    ASSERT_EQ(CellQuality::level(std::nextafter(CellQuality::least_of_level(level), 0)), level - 1);
    if (level < 0) {
      ASSERT_GT(CellQuality::least_of_level(level + 1), q);
    }
  }
}

}  // namespace pgdr::test_rule_cell_quality
