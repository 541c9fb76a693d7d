// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Seeded point sets with manufactured degeneracy, distinct points, for tests of triangulations.
#pragma once

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "pgdr/types.hpp"

namespace pgdr::test {

template <int D>
struct PointSet {
  std::string name;
  std::vector<Point<D>> points;
};

template <int D>
void make_distinct(std::vector<Point<D>>& points, std::mt19937_64& random) {
  std::sort(points.begin(), points.end(), lex_less<D>);
  points.erase(std::unique(points.begin(), points.end()), points.end());
  std::shuffle(points.begin(), points.end(), random);
}

/// Sets with a full-dimensional hull.
template <int D>
std::vector<PointSet<D>> point_sets(std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> unit(0, 1);
  std::vector<PointSet<D>> sets;
  auto add = [&](std::string name, std::vector<Point<D>> points) {
    make_distinct<D>(points, random);
    sets.push_back({std::move(name), std::move(points)});
  };
  auto random_point = [&](double scale) {
    Point<D> p;
    for (int i = 0; i < D; ++i) p[i] = scale * unit(random);
    return p;
  };
  std::vector<Point<D>> points;
  for (int i = 0; i < 120; ++i) points.push_back(random_point(1));
  add("random", points);

  points.clear();
  const int side = D == 2 ? 10 : 5;
  for (int i = 0; i < side * side * (D == 3 ? side : 1); ++i) {
    Point<D> p;
    for (int a = 0, k = i; a < D; ++a, k /= side) p[a] = k % side;
    points.push_back(p);
  }
  add("grid", points);
  for (auto& p : points)
    for (int a = 0; a < D; ++a)
      if (unit(random) < 0.2) p[a] = std::nextafter(p[a], unit(random) < 0.5 ? -1e9 : 1e9);
  add("grid moved by ulps", points);

  // Integer points on one sphere about the origin: all signs and permutations of (1, 5, 7) and (5, 5, 5); of (7, 24), ...
  points.clear();
  if constexpr (D == 3) {
    for (int p = 0; p < 6; ++p)
      for (int s = 0; s < 8; ++s) {
        const int perm[6][3] = {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};
        const double v[3] = {1, 5, 7};
        Point<D> q;
        for (int a = 0; a < 3; ++a) q[a] = v[perm[p][a]] * (s >> a & 1 ? 1 : -1);
        points.push_back(q);
        for (int a = 0; a < 3; ++a) q[a] = 5.0 * (s >> a & 1 ? 1 : -1);
        points.push_back(q);
      }
  } else {
    for (const auto& [x, y] : {std::pair{7., 24.}, {15., 20.}, {0., 25.}})
      for (int s = 0; s < 8; ++s) {
        const double a = s & 1 ? x : -x, b = s & 2 ? y : -y;
        points.push_back(s & 4 ? Point<D>{{a, b}} : Point<D>{{b, a}});
      }
  }
  add("cospherical", points);
  points.push_back(Point<D>{});
  add("cospherical with centre", points);

  points.clear();
  for (int c = 0; c < 6; ++c) {
    const Point<D> center = random_point(1);
    for (int i = 0; i < 20; ++i) {
      Point<D> p = random_point(std::pow(10.0, -2.0 * c));
      for (int a = 0; a < D; ++a) p[a] += center[a];
      points.push_back(p);
    }
  }
  add("clustered", points);

  points.clear();
  for (int i = 0; i < 30; ++i) {
    Point<D> p{};
    p[0] = i;
    points.push_back(p);
  }
  for (int i = 0; i < D; ++i) points.push_back(random_point(30));
  add("collinear and few more", points);

  points.clear();
  for (int i = 0; i < 49; ++i) {
    Point<D> p{};
    p[0] = i % 7;
    p[1] = i / 7;
    points.push_back(p);
  }
  points.push_back(random_point(7));
  points.push_back(random_point(-7));
  add("coplanar and two more", points);
  return sets;
}

}  // namespace pgdr::test
