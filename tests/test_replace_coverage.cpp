// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Coverage of polygons by triangles within a distance, against samples that look at every triangle.
#include "replace/coverage.hpp"

#include <gtest/gtest.h>

#include <random>

#include "replace/complex.hpp"
#include "surface_distances.hpp"

namespace pgdr::test_replace_coverage {

using Triangle = std::array<Point3, 3>;

constexpr double e = 0.1;

class Scene {
 public:
  explicit Scene(std::uint64_t seed) : random_(seed) {}

  double number(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }
  Point3 point(double flatness) { return {{number(0, 1), number(0, 1), number(-flatness, flatness)}}; }
  Triangle triangle(double flatness) { return {point(flatness), point(flatness), point(flatness)}; }
  /// Parts of a triangle, each corner off by no more than that.
  std::vector<Triangle> parts(const Triangle& t, int levels, double off) {
    if (levels == 0) {
      Triangle moved = t;
      for (Point3& p : moved)
        for (double& x : p.x) x += number(-off, off);
      return {moved};
    }
    std::vector<Triangle> out;
    const Point3 x = on(t, number(0.2, 0.8), 0.1);
    for (std::size_t i = 0; i < 3; ++i) {
      const auto more = parts({t[i], t[(i + 1) % 3], x}, levels - 1, off);
      out.insert(out.end(), more.begin(), more.end());
    }
    return out;
  }
  /// At these weights of corners 0 and 1.
  static Point3 on(const Triangle& t, double u, double v) {
    Point3 p;
    for (int i = 0; i < 3; ++i) p[i] = u * t[0][i] + v * t[1][i] + (1 - u - v) * t[2][i];
    return p;
  }
  Point3 sample(const Triangle& t) {
    double u = number(0, 1), v = number(0, 1);
    if (u + v > 1) u = 1 - u, v = 1 - v;
    return on(t, u, v);
  }

 private:
  std::mt19937_64 random_;
};

bool covers(const Triangle& t, std::vector<Triangle> others, std::size_t most_parts = 300) {
  detail::Cover cover(e);
  for (Triangle& o : others) {
    detail::sort_corners(o);
    cover.add(o);
  }
  cover.use(cover.between(0, cover.size()), [](std::uint32_t) { return true; });
  return cover.covers(detail::CutPolygon(t), most_parts, 10);
}

/// Never yes where a sample is beyond; yes and no are both frequent.
TEST(ReplaceCoverage, YesIsAProof) {
  Scene scene(1);
  int yes = 0, no = 0;
  for (int round = 0; round < 400; ++round) {
    const Triangle t = scene.triangle(0.3);
    auto others = scene.parts(t, 2, e * (round % 8) / 4);
    if (round % 3 == 0) others.pop_back();
    if (!covers(t, others)) {
      ++no;
      continue;
    }
    ++yes;
    for (int k = 0; k < 200; ++k) EXPECT_LE(test::distance_to(scene.sample(t), others), e * (1 + 1e-12)) << round;
  }
  EXPECT_GT(yes, 100);
  EXPECT_GT(no, 5);
}

/// Where all of it is within 15/16 of the distance by a fine grid the answer is yes, if it may look at parts enough.
TEST(ReplaceCoverage, WhatIsNearIsFound) {
  Scene scene(2);
  int asked = 0;
  for (int round = 0; round < 200; ++round) {
    const Triangle t = scene.triangle(0.3);
    const auto others = scene.parts(t, 2, e * (round % 8) / 16);
    constexpr int steps = 60;
    double farthest = 0;
    for (int i = 0; i <= steps; ++i)
      for (int j = 0; i + j <= steps; ++j)
        farthest = std::max(farthest, test::distance_to(Scene::on(t, double(i) / steps, double(j) / steps), others));
    if (farthest + 1.5 / steps > e * 15 / 16) continue;  // edges are shorter than 1.5: no point is farther from the grid
    ++asked;
    EXPECT_TRUE(covers(t, others, 1'000'000)) << round;
  }
  EXPECT_GT(asked, 50);
}

/// A strip beside others in one plane, hundreds of times as long as the distance.
TEST(ReplaceCoverage, LongStripsAreOneCut) {
  std::vector<Triangle> strips;
  for (int k = 0; k < 8; ++k) {
    const double y = k * 0.3;
    strips.push_back({Point3{{0, y, 0}}, Point3{{1000, y, 0}}, Point3{{1000, y + 0.3, 0}}});
    strips.push_back({Point3{{0, y, 0}}, Point3{{1000, y + 0.3, 0}}, Point3{{0, y + 0.3, 0}}});
  }
  const Triangle across{Point3{{1, 0.1, 0}}, Point3{{999, 0.2, 0.05}}, Point3{{500, 2.3, -0.05}}};
  EXPECT_TRUE(covers(across, strips));
  strips.erase(strips.begin() + 6, strips.begin() + 8);
  EXPECT_FALSE(covers(across, strips));
}

TEST(ReplaceCoverage, TheOrderOfTrianglesIsNoMatter) {
  Scene scene(3);
  for (int round = 0; round < 100; ++round) {
    const Triangle t = scene.triangle(0.3);
    auto others = scene.parts(t, 2, e * 0.7);
    const bool answer = covers(t, others);
    std::reverse(others.begin(), others.end());
    for (Triangle& o : others) std::swap(o[0], o[2]);
    EXPECT_EQ(covers(t, others), answer) << round;
  }
}

TEST(ReplaceCoverage, Segments) {
  detail::SegmentCover cover(e);
  cover.add({{0, 0, 0}}, {{1, 0, 0}});
  cover.add({{1, 0, 0}}, {{2, 0.05, 0}});
  EXPECT_TRUE(cover.covers({{0, 0.08, 0}}, {{2, 0, 0.04}}));
  EXPECT_FALSE(cover.covers({{0, 0.08, 0}}, {{2.2, 0, 0}}));
  EXPECT_FALSE(cover.covers({{0, 0, 0}}, {{1, 0.12, 0}}));
}

}  // namespace pgdr::test_replace_coverage
