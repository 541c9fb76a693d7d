// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The best triangulation of a ring, against all of them.
#include "optimize/edge_removal.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <random>

#include "pgdr/predicates.hpp"

namespace pgdr::test_optimize_edge_removal {

using Triangle = std::array<std::uint8_t, 3>;
using Triangles = std::vector<Triangle>;

/// Calls look(triangles) for each triangulation of the polygon from corner i to corner j.
void each_triangulation(std::uint8_t i, std::uint8_t j, Triangles& so_far, const std::function<void()>& look) {
  if (j - i < 2) return look();
  for (auto k = static_cast<std::uint8_t>(i + 1); k < j; ++k) {
    so_far.push_back({i, k, j});
    each_triangulation(i, k, so_far, [&] { each_triangulation(k, j, so_far, look); });
    so_far.pop_back();
  }
}

/// An edge with a ring round it, or half a ring whose tips and edge are in one plane.
struct Case {
  Point3 a, b;
  std::vector<Point3> ring;
};

Case some_case(int n, bool half, std::mt19937& random, double unevenness) {
  std::uniform_real_distribution<double> unit(-1, 1);
  Case c{{{0, 0, -1}}, {{0, 0, 1}}, {}};
  for (int i = 0; i < n; ++i) {
    const double turn = half ? std::numbers::pi * i / (n - 1) : 2 * std::numbers::pi * (i + 0.2 * unit(random)) / n;
    const double r = 1 + 0.7 * unevenness * unit(random);
    const bool tip = half && (i == 0 || i == n - 1);
    c.ring.push_back({{r * (tip ? (i == 0 ? 1 : -1) : std::cos(turn)), tip ? 0 : r * std::sin(turn), unevenness * unit(random)}});
  }
  return c;
}

Simplex<3> above(const Case& c, const Triangle& t) { return {c.ring[t[0]], c.ring[t[1]], c.ring[t[2]], c.b}; }
Simplex<3> below(const Case& c, const Triangle& t) { return {c.ring[t[2]], c.ring[t[1]], c.ring[t[0]], c.a}; }

double least_quality(const Case& c, const Triangles& triangles, const CellQuality& quality) {
  double least = 1;
  for (const Triangle& t : triangles)
    for (const Simplex<3>& cell : {above(c, t), below(c, t)})
      least = std::min(least, orient<3>(cell) == Sign::positive ? quality.of(cell, 0) : 0);
  return least;
}

double volume6(const Simplex<3>& s) {
  double m[3][3];
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k < 3; ++k) m[i][k] = s[i + 1][k] - s[0][k];
  return m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) - m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
         m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
}

CellBounds<3> ratio_of(double bound) {
  CellBounds<3> bounds;
  bounds.radius_edge_bound = bound;
  return bounds;
}

TEST(EdgeRemoval, FindsTheBestOfAllTriangulations) {
  std::mt19937 random(7);
  const CellBounds<3> bounds = ratio_of(2);
  EdgeRemoval removal;
  int found = 0, perfect = 0, none = 0;
  for (int round = 0; round < 1200; ++round) {
    const CellQuality quality(bounds, round % 3 == 0 ? 5 : 25);
    const int n = 3 + round % 6;
    const bool half = round % 4 == 3;
    const Case c = some_case(n, half, random, round % 7 * 0.1);
    double best = 0;
    Triangles triangles;
    int looked_at = 0;
    each_triangulation(0, static_cast<std::uint8_t>(n - 1), triangles, [&] {
      ++looked_at;
      best = std::max(best, least_quality(c, triangles, quality));
    });
    constexpr std::array<int, 6> catalan = {1, 2, 5, 14, 42, 132};
    ASSERT_EQ(looked_at, catalan[static_cast<std::size_t>(n - 3)]);
    const double least = removal.find(c.ring, c.a, c.b, 0, quality, 0);
    ASSERT_EQ(least, best) << round;
    perfect += best == 1;
    if (best == 0) {
      ++none;
      continue;
    }
    ++found;
    ASSERT_EQ(removal.triangles().size(), static_cast<std::size_t>(n - 2));
    EXPECT_EQ(least_quality(c, removal.triangles(), quality), best) << round;
    // What is enough for the caller is not looked for, and what is a bit better is found.
    EXPECT_LE(removal.find(c.ring, c.a, c.b, 0, quality, best), best);
    EXPECT_EQ(removal.find(c.ring, c.a, c.b, 0, quality, best * (1 - 1e-9)), best);
    EXPECT_EQ(least_quality(c, removal.triangles(), quality), best) << round;
  }
  EXPECT_GT(found, 600);
  EXPECT_GT(perfect, 20);
  EXPECT_GT(none, 20);
}

TEST(EdgeRemoval, CellsTileWhatTheOldOnesDid) {
  std::mt19937 random(8);
  const CellBounds<3> bounds = ratio_of(2);
  const CellQuality quality(bounds, 20);
  EdgeRemoval removal;
  int found = 0;
  for (int round = 0; round < 300; ++round) {
    const bool half = round % 3 == 2;
    const int n = 3 + round % 12;
    const Case c = some_case(n, half, random, 0.2);
    double old_volume = 0, volume = 0;
    for (std::size_t i = 0; i + (half ? 1 : 0) < c.ring.size(); ++i) {
      const Simplex<3> cell = {c.a, c.b, c.ring[i], c.ring[(i + 1) % c.ring.size()]};
      ASSERT_EQ(orient<3>(cell), Sign::positive);
      old_volume += volume6(cell);
    }
    if (!(removal.find(c.ring, c.a, c.b, 0, quality, 0) > 0)) continue;
    ++found;
    ASSERT_EQ(removal.triangles().size(), c.ring.size() - 2);
    for (const Triangle& t : removal.triangles()) {
      ASSERT_TRUE(t[0] < t[1] && t[1] < t[2] && t[2] < n);
      EXPECT_EQ(orient<3>(above(c, t)), Sign::positive);
      EXPECT_EQ(orient<3>(below(c, t)), Sign::positive);
      volume += volume6(above(c, t)) + volume6(below(c, t));
    }
    EXPECT_NEAR(volume, old_volume, 1e-12 * old_volume);
  }
  EXPECT_GT(found, 100);
}

TEST(EdgeRemoval, MeasuresFewCells) {
  std::mt19937 random(9);
  const CellBounds<3> bounds = ratio_of(2);
  EdgeRemoval removal;
  for (int round = 0; round < 50; ++round) {
    const std::size_t n = 3 + static_cast<std::size_t>(round) % 12;
    const Case c = some_case(static_cast<int>(n), false, random, 0.3);
    const CellQuality quality(bounds, 30);
    const double least = removal.find(c.ring, c.a, c.b, 0, quality, 0);
    EXPECT_LE(quality.evaluated(), n * (n - 1) * (n - 2) / 3) << round;
    const CellQuality again(bounds, 30);
    removal.find(c.ring, c.a, c.b, 0, again, least);
    EXPECT_LE(again.evaluated(), quality.evaluated());
  }
}

TEST(EdgeRemoval, IsTheSameAtEveryScale) {
  std::mt19937 random(10);
  EdgeRemoval removal;
  const CellBounds<3> bounds = ratio_of(2);
  const CellQuality quality(bounds, 25);
  int found = 0;
  for (int round = 0; round < 100; ++round) {
    const Case c = some_case(3 + round % 8, false, random, 0.3);
    const double least = removal.find(c.ring, c.a, c.b, 0, quality, 0);
    const Triangles triangles = removal.triangles();
    found += !triangles.empty();
    for (const int k : {-40, 30}) {
      Case scaled = c;
      for (Point3* p : {&scaled.a, &scaled.b})
        for (double& x : p->x) x = std::ldexp(x, k);
      for (Point3& p : scaled.ring)
        for (double& x : p.x) x = std::ldexp(x, k);
      EXPECT_EQ(removal.find(scaled.ring, scaled.a, scaled.b, 0, quality, 0), least);
      EXPECT_EQ(removal.triangles(), triangles);
    }
  }
  EXPECT_GT(found, 50);
}

}  // namespace pgdr::test_optimize_edge_removal
