// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Planar straight line graphs for tests: random ones without crossings, fans of small angles, hairy polygons.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>
#include <set>
#include <utility>
#include <vector>

#include "pgdr/plc.hpp"
#include "pgdr/predicates.hpp"

namespace pgdr::test {

using Random = std::mt19937_64;

inline double uniform(Random& random) { return std::ldexp(static_cast<double>(random() >> 11), -53); }
inline std::uint32_t below(Random& random, std::uint64_t n) { return static_cast<std::uint32_t>(random() % n); }

inline void add_segment(Plc<2>& plc, std::uint32_t a, std::uint32_t b, int marker = 0) {
  plc.segments.push_back({{a, b}, marker});
}

/// Corners of the square from (low, low) to (high, high), and its sides.
inline void add_square(Plc<2>& plc, double low, double high, int marker = 1) {
  const auto first = static_cast<std::uint32_t>(plc.points.size());
  plc.points.insert(plc.points.end(), {{{low, low}}, {{high, low}}, {{high, high}}, {{low, high}}});
  for (std::uint32_t i = 0; i < 4; ++i) add_segment(plc, first + i, first + (i + 1) % 4, marker);
}

/// Does v lie on the segment ab, and is none of its ends?
inline bool is_inside(const std::vector<Point2>& p, std::uint32_t a, std::uint32_t b, std::uint32_t v) {
  if (v == a || v == b || orient2d(p[a], p[b], p[v]) != Sign::zero) return false;
  if (lex_less(p[b], p[a])) std::swap(a, b);
  return lex_less(p[a], p[v]) && lex_less(p[v], p[b]);
}

/// Do the segments have more in common than an end of both?
inline bool in_the_way(const std::vector<Point2>& p, std::array<std::uint32_t, 2> s, std::array<std::uint32_t, 2> t) {
  for (const auto& [u, w] : {std::pair(s, t), std::pair(t, s)})
    for (const std::uint32_t v : w)
      if (is_inside(p, u[0], u[1], v)) return true;
  if ((s[0] == t[0] && s[1] == t[1]) || (s[0] == t[1] && s[1] == t[0])) return true;
  const auto apart = [&](std::array<std::uint32_t, 2> u, std::array<std::uint32_t, 2> w) {
    const Sign a = orient2d(p[u[0]], p[u[1]], p[w[0]]), b = orient2d(p[u[0]], p[u[1]], p[w[1]]);
    return a != Sign::zero && a == -b;
  };
  return apart(s, t) && apart(t, s);
}

/// Distinct points in a square, on a grid of this many steps (0: none), and up to so many random segments that meet in
/// their ends alone; some of them long.
inline Plc<2> random_graph(std::uint32_t points, std::uint32_t segments, int grid, std::uint64_t seed) {
  Random random(seed);
  Plc<2> plc;
  add_square(plc, -1, 2);
  std::set<std::pair<double, double>> taken;
  while (plc.points.size() < points + 4) {
    Point2 p{{uniform(random), uniform(random)}};
    if (grid > 0)
      for (double& x : p.x) x = std::floor(x * grid) / grid;
    if (taken.emplace(p[0], p[1]).second) plc.points.push_back(p);
  }
  for (std::uint32_t i = 0; i < segments; ++i) {
    const std::array s{4 + below(random, points), 4 + below(random, points)};
    bool free = s[0] != s[1];
    for (std::size_t k = 4; free && k < plc.segments.size(); ++k) free = !in_the_way(plc.points, s, plc.segments[k].points);
    for (std::uint32_t v = 4; free && v < plc.points.size(); ++v) free = !is_inside(plc.points, s[0], s[1], v);
    if (free) add_segment(plc, s[0], s[1], 2);
  }
  return plc;
}

/// Segments of random lengths from one point, a small angle apart each, in a square.
inline Plc<2> fan(std::uint32_t segments, double degrees, std::uint64_t seed) {
  Random random(seed);
  Plc<2> plc;
  add_square(plc, -2, 2);
  plc.points.push_back({{0.1, 0.05}});
  for (std::uint32_t i = 0; i < segments; ++i) {
    const double angle = (7 + degrees * i) * std::numbers::pi / 180, length = 0.3 + uniform(random);
    plc.points.push_back({{0.1 + length * std::cos(angle), 0.05 + length * std::sin(angle)}});
    add_segment(plc, 4, 5 + i, 2);
  }
  return plc;
}

/// A polygon round the origin whose corners are at random distances, so that it is all needles.
inline Plc<2> hairy_polygon(std::uint32_t corners, std::uint64_t seed) {
  Random random(seed);
  Plc<2> plc;
  for (std::uint32_t i = 0; i < corners; ++i) {
    const double angle = 2 * std::numbers::pi * i / corners, length = 1 + 2 * uniform(random);
    plc.points.push_back({{length * std::cos(angle), length * std::sin(angle)}});
    add_segment(plc, i, (i + 1) % corners, 1);
  }
  return plc;
}

/// The least angle between two segments at a common point, in degrees; 180 if none have one.
inline double least_angle(const Plc<2>& plc) {
  std::vector<std::vector<double>> directions(plc.points.size());
  for (const auto& s : plc.segments)
    for (const int end : {0, 1}) {
      const Point2 &v = plc.points[s.points[end]], &w = plc.points[s.points[1 - end]];
      directions[s.points[end]].push_back(std::atan2(w[1] - v[1], w[0] - v[0]) * 180 / std::numbers::pi);
    }
  double least = 180;
  for (auto& d : directions) {
    std::sort(d.begin(), d.end());
    for (std::size_t i = 1; i < d.size(); ++i) least = std::min(least, d[i] - d[i - 1]);
    if (d.size() > 1) least = std::min(least, 360 - (d.back() - d.front()));
  }
  return least;
}

}  // namespace pgdr::test
