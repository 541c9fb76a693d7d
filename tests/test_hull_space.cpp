// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The convex hull in space: against all triples of points, of points in one plane, on one line and at one place among them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>
#include <set>

#include "pgdr/convex_hull.hpp"
#include "pgdr/error.hpp"
#include "pgdr/predicates.hpp"

namespace pgdr::test_hull_space {

using Random = std::mt19937_64;
using Places = std::set<std::array<double, 3>>;

Plc<3> cloud(const std::vector<Point3>& points) {
  Plc<3> plc;
  plc.points = points;
  return plc;
}

/// The places of the corners of each facet.
std::multiset<Places> facets_of(const Plc<3>& plc) {
  std::multiset<Places> all;
  for (const auto& facet : plc.facets) {
    EXPECT_EQ(facet.polygons.size(), 1u);
    Places places;
    for (const std::uint32_t v : facet.polygons[0]) places.insert(plc.points[v].x);
    EXPECT_EQ(places.size(), facet.polygons[0].size());
    all.insert(places);
  }
  return all;
}

/// Is b between a and c, or one of them?
bool is_between(const Point3& a, const Point3& b, const Point3& c) {
  if (!collinear<3>(a, b, c)) return false;
  for (int k = 0; k < 3; ++k)
    if (b[k] < std::min(a[k], c[k]) || b[k] > std::max(a[k], c[k])) return false;
  return true;
}

/// Of these points of a plane, the corners of their hull: in no triangle of others, and between no two.
Places corners_in_plane(const std::vector<Point3>& p) {
  Places corners;
  for (std::size_t v = 0; v < p.size(); ++v) {
    bool is_corner = true;
    for (std::size_t i = 0; i < p.size() && is_corner; ++i)
      for (std::size_t j = 0; j < i && is_corner; ++j) {
        if (i == v || j == v) continue;
        if (is_between(p[i], p[v], p[j])) is_corner = false;
        for (std::size_t k = 0; k < j && is_corner; ++k) {
          if (k == v || collinear<3>(p[i], p[j], p[k])) continue;
          int axis = 0;
          while (orient_projected(p[i], p[j], p[k], axis) == Sign::zero) ++axis;
          std::set<Sign> sides;
          for (const auto& [a, b] : {std::pair(i, j), std::pair(j, k), std::pair(k, i)})
            sides.insert(orient_projected(p[a], p[b], p[v], axis));
          if (!sides.contains(Sign::positive) || !sides.contains(Sign::negative)) is_corner = false;
        }
      }
    if (is_corner) corners.insert(p[v].x);
  }
  return corners;
}

/// By all triples: a facet is what lies in a plane that has all points on one side.
std::multiset<Places> wanted(const std::vector<Point3>& given) {
  Places distinct;
  for (const Point3& p : given) distinct.insert({p[0] + 0.0, p[1] + 0.0, p[2] + 0.0});
  std::vector<Point3> p;
  for (const auto& x : distinct) p.push_back({x});
  std::set<Places> facets;
  for (std::size_t i = 0; i < p.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      for (std::size_t k = 0; k < j; ++k) {
        if (collinear<3>(p[i], p[j], p[k])) continue;
        std::vector<Point3> flat;
        bool above = false, below = false;
        for (const Point3& x : p) {
          const Sign side = orient3d(p[i], p[j], p[k], x);
          above = above || side == Sign::positive;
          below = below || side == Sign::negative;
          if (side == Sign::zero) flat.push_back(x);
        }
        if (above != below) facets.insert(corners_in_plane(flat));
      }
  return {facets.begin(), facets.end()};
}

/// Is each facet counterclockwise seen from outside, and each edge of two facets that run along it either way?
void expect_closed(const Plc<3>& plc) {
  std::multiset<std::pair<std::uint32_t, std::uint32_t>> edges;
  for (const auto& facet : plc.facets) {
    const auto& c = facet.polygons[0];
    for (std::size_t i = 0; i < c.size(); ++i) edges.emplace(c[i], c[(i + 1) % c.size()]);
    for (const Point3& x : plc.points)
      EXPECT_NE(orient3d(plc.points[c[0]], plc.points[c[1]], plc.points[c[2]], x), Sign::positive);
  }
  for (const auto& [a, b] : edges) EXPECT_EQ(edges.count({b, a}), 1u);
}

TEST(SpaceHull, AgainstAllTriples) {
  std::size_t polygons = 0;
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    Random random(seed);
    const std::uint64_t width = 2 + seed % 5;
    std::vector<Point3> points(4 + random() % 14);
    for (Point3& p : points)
      for (double& x : p.x) x = static_cast<double>(random() % width);
    const std::multiset<Places> facets = wanted(points);
    if (facets.empty()) {
      EXPECT_THROW(with_convex_hull(cloud(points)), InputError) << seed;
      continue;
    }
    const Plc<3> hull = with_convex_hull(cloud(points));
    EXPECT_EQ(facets_of(hull), facets) << seed;
    EXPECT_EQ(hull.points.size(), points.size());
    expect_closed(hull);
    for (const Places& corners : facets) polygons += corners.size() > 3;
    std::shuffle(points.begin(), points.end(), random);
    EXPECT_EQ(facets_of(with_convex_hull(cloud(points))), facets) << seed;
  }
  EXPECT_GT(polygons, 100u);
}

std::vector<Point3> grid(int n) {
  std::vector<Point3> points;
  for (int i = 0; i < n * n * n; ++i)
    points.push_back({{static_cast<double>(i % n), static_cast<double>(i / n % n), static_cast<double>(i / n / n)}});
  return points;
}

TEST(SpaceHull, OfAGrid) {
  const Plc<3> hull = with_convex_hull(cloud(grid(12)));
  ASSERT_EQ(hull.facets.size(), 6u);
  for (const auto& facet : hull.facets) EXPECT_EQ(facet.polygons[0].size(), 4u);
  EXPECT_EQ(hull.facets[0].polygons[0][0], 0u);
  expect_closed(hull);
}

TEST(SpaceHull, OfASphere) {
  Random random(7);
  std::normal_distribution<double> normal;
  std::vector<Point3> points(2000);
  for (Point3& p : points) {
    for (double& x : p.x) x = normal(random);
    const double length = std::sqrt(squared_distance(p, {}));
    for (double& x : p.x) x /= length;
  }
  const Plc<3> hull = with_convex_hull(cloud(points));
  EXPECT_EQ(hull.facets.size(), 2 * points.size() - 4);  // Euler, of triangles
  expect_closed(hull);
}

/// As large and as small as doubles go.
TEST(SpaceHull, ScalesByPowersOfTwo) {
  Random random(9);
  std::vector<Point3> points(60);
  for (Point3& p : points)
    for (double& x : p.x) x = static_cast<double>(random() % 1000);
  const Plc<3> hull = with_convex_hull(cloud(points));
  for (const int power : {-900, -300, 300, 900}) {
    std::vector<Point3> scaled(points);
    for (Point3& p : scaled)
      for (double& x : p.x) x = std::ldexp(x, power);
    const Plc<3> other = with_convex_hull(cloud(scaled));
    ASSERT_EQ(other.facets.size(), hull.facets.size()) << power;
    for (std::size_t f = 0; f < hull.facets.size(); ++f) EXPECT_EQ(other.facets[f].polygons, hull.facets[f].polygons) << power;
  }
}

TEST(SpaceHull, WhatIsThereStays) {
  Plc<3> plc = cloud(grid(2));
  plc.facets.emplace_back();
  plc.facets[0].polygons = {{7, 5, 1, 3}};
  plc.facets[0].marker = 9;
  plc.source.facet_lines = {4};
  const Plc<3> out = with_convex_hull(plc);
  ASSERT_EQ(out.facets.size(), 6u);
  EXPECT_EQ(out.facets[0].polygons, plc.facets[0].polygons);
  EXPECT_EQ(out.facets[0].marker, 9);
  EXPECT_EQ(out.source.facet_lines.size(), 6u);
  EXPECT_EQ(facets_of(out), wanted(plc.points));
  plc.facets[0].polygons[0][0] = 99;
  EXPECT_EQ(with_convex_hull(plc).facets.size(), 1u);
}

TEST(SpaceHull, FlatPointsAreRefused) {
  for (const std::size_t count : {0u, 1u, 2u, 3u, 9u}) {
    std::vector<Point3> points;
    for (std::size_t i = 0; i < count; ++i) points.push_back({{static_cast<double>(i % 3), static_cast<double>(i / 3), 0.5}});
    Plc<3> plc = cloud(points);
    plc.source.file = "flat.node";
    try {
      with_convex_hull(plc);
      ADD_FAILURE() << count;
    } catch (const InputError& e) {
      EXPECT_EQ(e.code(), Errc::no_volume);
      EXPECT_STREQ(e.what(), "flat.node: all points lie in one plane: their convex hull has no volume");
    }
  }
}

}  // namespace pgdr::test_hull_space
