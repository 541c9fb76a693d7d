// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Distances between triangles and sets of them, against points that are tried one by one.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "model_plcs.hpp"
#include "nearness/near_set.hpp"

namespace test_nearness_distance {

using namespace pgdr;
using namespace pgdr::checking;

/// From a triangle, as long doubles tell: the plane where its foot is inside, else the edges.
long double oracle(const Point3& x, const Triangle3& t) {
  using Vector = std::array<long double, 3>;
  const auto from = [](const Point3& p, const Point3& q) {
    return Vector{static_cast<long double>(q[0]) - p[0], static_cast<long double>(q[1]) - p[1],
                  static_cast<long double>(q[2]) - p[2]};
  };
  const auto dot = [](const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; };
  const auto cross = [](const Vector& a, const Vector& b) {
    return Vector{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
  };
  long double least = 1e300L;
  for (std::size_t i = 0; i < 3; ++i) {
    const Vector d = from(t[i], t[(i + 1) % 3]), w = from(t[i], x);
    const long double length = dot(d, d);
    const long double s = length > 0 ? std::clamp(dot(w, d) / length, 0.0L, 1.0L) : 0.0L;
    const Vector off{w[0] - s * d[0], w[1] - s * d[1], w[2] - s * d[2]};
    least = std::min(least, std::sqrt(dot(off, off)));
  }
  const Vector n = cross(from(t[0], t[1]), from(t[0], t[2]));
  const long double square = dot(n, n);
  bool inside = square > 0;
  for (std::size_t i = 0; i < 3; ++i) inside = inside && dot(cross(from(t[i], t[(i + 1) % 3]), from(t[i], x)), n) >= 0;
  return inside ? std::min(least, std::abs(dot(from(t[0], x), n)) / std::sqrt(square)) : least;
}

long double oracle(const Point3& x, const std::vector<Triangle3>& all) {
  long double least = 1e300L;
  for (const Triangle3& t : all) least = std::min(least, oracle(x, t));
  return least;
}

/// The largest distance of points of the piece, all those of a grid.
long double farthest(const Triangle3& piece, const std::vector<Triangle3>& all, int steps) {
  long double most = 0;
  for (int i = 0; i <= steps; ++i)
    for (int j = 0; i + j <= steps; ++j) {
      Point3 x;
      const double s = i / double(steps), t = j / double(steps);
      for (int k = 0; k < 3; ++k) x[k] = piece[0][k] + s * (piece[1][k] - piece[0][k]) + t * (piece[2][k] - piece[0][k]);
      most = std::max(most, oracle(x, all));
    }
  return most;
}

class RandomPairs {
 public:
  explicit RandomPairs(unsigned seed) : random_(seed) {}
  double real(double low, double high) { return std::uniform_real_distribution(low, high)(random_); }
  Point3 point(double r) { return {{real(-r, r), real(-r, r), real(-r, r)}}; }

  /// A triangle, and others that lie about it: parts of it that are bent, moved, and cut.
  std::pair<Triangle3, std::vector<Triangle3>> next(double noise) {
    const Triangle3 t{point(1), point(1), point(1)};
    std::vector<Triangle3> parts{t}, all;
    for (int k = 0; k < 5; ++k) {  // each in three at a point inside, or in two at one of an edge
      const std::size_t i = std::uniform_int_distribution<std::size_t>(0, parts.size() - 1)(random_);
      const Triangle3 p = parts[i];
      const bool at_edge = real(0, 1) < 0.5;
      const double a = real(0.1, 0.9), b = at_edge ? 1 - a : real(0, 1 - a);
      Point3 m;
      for (int c = 0; c < 3; ++c) m[c] = a * p[0][c] + b * p[1][c] + (1 - a - b) * p[2][c];
      parts[i] = {p[0], m, p[2]};
      parts.push_back({m, p[1], p[2]});
      if (!at_edge) parts.push_back({p[0], p[1], m});
    }
    for (Triangle3 p : parts) {
      if (real(0, 1) < 0.05) continue;  // a hole
      for (Point3& x : p)
        for (int c = 0; c < 3; ++c) x[c] += noise * real(-1, 1);
      all.push_back(p);
    }
    return {t, all};
  }

 private:
  std::mt19937 random_;
};

TEST(NearSet, SaysYesOnlyOfWhatIsNear) {
  RandomPairs pairs(1);
  int near = 0, far = 0;
  for (int k = 0; k < 400; ++k) {
    const auto [piece, others] = pairs.next(k % 2 ? 0.01 : 0.05);
    const NearSet set(others);
    const long double most = farthest(piece, others, 40);
    for (const double part : {0.5, 0.9, 0.98, 1.03, 1.1, 2.0}) {
      const auto limit = static_cast<double>(most * part);
      const auto found = set.farther(piece, limit);
      // A grid misses the farthest place by a fortieth of the piece at most, which is an eighth of what is asked for here.
      if (part < 1)
        EXPECT_TRUE(found) << k << ", " << part;
      else if (!found)
        ++near;
      if (!found) continue;
      ++far;
      if (found->is_certain) {
        EXPECT_GT(oracle(found->where, others), limit * (1 - 1e-9));
      }
      EXPECT_NEAR(static_cast<double>(oracle(found->where, others)), found->distance, 1e-12);
    }
  }
  EXPECT_GT(near, 600);
  EXPECT_GT(far, 1200);
}

TEST(NearSet, SaysYesOfAllThatIsNear) {
  RandomPairs pairs(2);
  for (int k = 0; k < 100; ++k) {
    const auto [piece, others] = pairs.next(0.02);
    const long double most = farthest(piece, others, 60) + 2.0L / 60 * 0.6L;  // no place is farther
    EXPECT_FALSE(NearSet(others).farther(piece, static_cast<double>(most * 64 / 63))) << k;
  }
}

TEST(NearSet, IsTheSameWhereverItIs) {
  RandomPairs pairs(3);
  for (int k = 0; k < 100; ++k) {
    const auto [piece, others] = pairs.next(0.02);
    const auto limit = static_cast<double>(farthest(piece, others, 30));
    const auto turn = [](Triangle3 t) {
      for (Point3& x : t) x = test::turned(x, 100);
      return t;
    };
    std::vector<Triangle3> turned;
    for (const Triangle3& t : others) turned.push_back(turn(t));
    for (const double part : {0.9, 1.2})
      EXPECT_EQ(NearSet(others).farther(piece, limit * part).has_value(),
                NearSet(turned).farther(turn(piece), limit * part).has_value())
          << k << ", " << part;
  }
}

// A piece across the common edge of others gets as small as the distance before it is on one side, if it is halved alone: a
// thousand times a thousand pieces here.
TEST(NearSet, SeamsCostNothing) {
  const auto at = [](double x, double y, double z) { return test::turned(Point3{{x, y, z}}, 10); };
  std::vector<Triangle3> fan;
  for (int i = 0; i < 500; ++i) fan.push_back({at(0, 0, 0), at(1, i / 500.0, 0), at(1, (i + 1) / 500.0, 0)});
  const NearSet set(fan);
  for (const double limit : {1e-3, 1e-6, 1e-9, 1e-12}) {
    EXPECT_FALSE(set.farther(Triangle3{at(0, 0, 0), at(1, 0, 0), at(1, 1, 0)}, limit)) << limit;
    EXPECT_FALSE(set.farther(Triangle3{at(0, 0, 0.9 * limit), at(1, 0, 0.9 * limit), at(1, 1, 0)}, limit)) << limit;
    EXPECT_TRUE(set.farther(Triangle3{at(0, 0, 0), at(1, 0, 0), at(1, 1, 1.1 * limit)}, limit)) << limit;
  }
  fan.erase(fan.begin() + 250);  // a slit half of whose width at its end is 1/1000
  EXPECT_TRUE(NearSet(fan).farther(Triangle3{at(0, 0, 0), at(1, 0, 0), at(1, 1, 0)}, 0.0009));
  EXPECT_FALSE(NearSet(fan).farther(Triangle3{at(0, 0, 0), at(1, 0, 0), at(1, 1, 0)}, 0.0011));
}

TEST(NearSet, KnowsTheLimitItself) {
  const Triangle3 below{{{{0, 0, 0}}, {{4, 0, 0}}, {{0, 4, 0}}}};
  const NearSet set(std::vector<Triangle3>{below});
  Triangle3 above = below;
  for (Point3& x : above) x[2] = 0.5;
  EXPECT_FALSE(set.farther(above, 0.5));
  EXPECT_TRUE(set.farther(above, 0.5 * (1 - 0x1p-50)));
  const Triangle3 needle{{{{0, 0, 0}}, {{1, 0, 0}}, {{2, 1e-17, 0}}}};
  EXPECT_FALSE(set.farther(needle, 1e-12));
  EXPECT_FALSE(NearSet(std::vector<Triangle3>{needle}).farther(needle, 1e-12));
}

// The point of a needle that is nearest is known as well as that of any triangle: here points of it, which are on it.
TEST(NearSet, NeedlesAreKnownWell) {
  RandomPairs pairs(5);
  for (const double width : {1e-3, 1e-6, 1e-9, 1e-12})
    for (int k = 0; k < 200; ++k) {
      const Point3 a = pairs.point(1), b = pairs.point(1), off = pairs.point(width);
      const double part = pairs.real(-0.5, 1.5), s = pairs.real(0, 1), t = pairs.real(0, 1 - s);
      Point3 c, x;
      for (int i = 0; i < 3; ++i) c[i] = a[i] + part * (b[i] - a[i]) + off[i];
      for (int i = 0; i < 3; ++i) x[i] = a[i] + s * (b[i] - a[i]) + t * (c[i] - a[i]);
      EXPECT_TRUE(is_within(x, {a, b, c}, 1e-15)) << width << ", " << std::sqrt(squared_distance_above(x, {c, a, b}));
    }
}

TEST(NearSet, SegmentsLikewise) {
  const NearSet set(std::vector<Segment3>{{{{{0, 0, 0}}, {{1, 0, 0}}}}, {{{{1, 0, 0}}, {{1, 1, 0}}}}});
  EXPECT_FALSE(set.farther(Segment3{{{{0, 0, 0.1}}, {{0.95, 0.05, 0}}}}, 0.11));
  EXPECT_FALSE(set.farther(Segment3{{{{0.5, 0, 0}}, {{1, 0.5, 0}}}}, 0.2501));
  const auto far = set.farther(Segment3{{{{0, 0, 0}}, {{1, 1, 0}}}}, 0.49);
  ASSERT_TRUE(far);
  EXPECT_TRUE(far->is_certain);
  EXPECT_NEAR(far->where[0], 0.5, 0.01);
  EXPECT_FALSE(set.farther(Segment3{{{{0, 0, 0}}, {{1, 1, 0}}}}, 0.51));
  EXPECT_TRUE(NearSet(std::vector<Segment3>{}).farther(Segment3{{{{0, 0, 0}}, {{1, 1, 0}}}}, 1e9));
}

}  // namespace test_nearness_distance
