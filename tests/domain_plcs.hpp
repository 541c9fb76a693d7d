// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Small Plcs, and what is asked of their Domains, for tests of domain preparation.
#pragma once

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>
#include <vector>

#include "pgdr/domain.hpp"
#include "plc_points.hpp"

namespace pgdr::test {

inline std::vector<std::vector<std::uint32_t>> prism_sides(std::uint32_t first, std::uint32_t n) {
  std::vector<std::vector<std::uint32_t>> sides;
  for (std::uint32_t k = 0; k < n; ++k) sides.push_back({first + k, first + (k + 1) % n, first + n + (k + 1) % n, first + n + k});
  return sides;
}

/// [0, 2] x [0, 1] x [0, 3]; facets of four points, the bottom first, then the top.
inline Plc<3> box() {
  Plc<3> plc;
  for (const double z : {0.0, 3.0})
    for (const auto& [x, y] : {std::pair{0.0, 0.0}, {2.0, 0.0}, {2.0, 1.0}, {0.0, 1.0}}) plc.points.push_back({x, y, z});
  plc.facets.push_back({{{0, 1, 2, 3}}, {}, 0});
  plc.facets.push_back({{{4, 5, 6, 7}}, {}, 0});
  for (auto& side : prism_sides(0, 4)) plc.facets.push_back({{side}, {}, 0});
  return plc;
}

/// Each facet of one polygon as a fan of triangles.
inline Plc<3> triangulated(const Plc<3>& plc) {
  Plc<3> out = plc;
  out.facets.clear();
  for (const auto& f : plc.facets)
    for (std::size_t k = 1; k + 1 < f.polygons[0].size(); ++k)
      out.facets.push_back({{{f.polygons[0][0], f.polygons[0][k], f.polygons[0][k + 1]}}, {}, f.marker});
  return out;
}

/// Numbered from 1, with lines: points from 100, segments from 300, facets from 500, holes from 700, regions from 900.
inline Plc<3> numbered(Plc<3> plc) {
  plc.first_index = 1;
  plc.source.file = "box.poly";
  for (std::uint32_t k = 0; k < 100; ++k) {
    plc.source.point_lines.push_back(100 + k);
    plc.source.segment_lines.push_back(300 + k);
    plc.source.facet_lines.push_back(500 + k);
    plc.source.hole_lines.push_back(700 + k);
    plc.source.region_lines.push_back(900 + k);
  }
  return plc;
}

/// A square plate of side 6 with a pentagonal hole of radius 1 through it.
inline Plc<3> plate_with_pentagon() {
  Plc<3> plc;
  for (const double z : {0.0, 0.5})
    for (const auto& [x, y] : {std::pair{-3.0, -3.0}, {3.0, -3.0}, {3.0, 3.0}, {-3.0, 3.0}}) plc.points.push_back({x, y, z});
  for (const double z : {0.0, 0.5})
    for (int k = 0; k < 5; ++k) {
      const double a = 2 * std::acos(-1) * k / 5;
      plc.points.push_back({std::cos(a), std::sin(a), z});
    }
  plc.facets.push_back({{{0, 1, 2, 3}, {8, 9, 10, 11, 12}}, {{0, 0, 0}}, 0});
  plc.facets.push_back({{{4, 5, 6, 7}, {13, 14, 15, 16, 17}}, {{0.25, 0, 0.5}}, 0});
  for (auto& side : prism_sides(0, 4)) plc.facets.push_back({{side}, {}, 0});
  for (auto& side : prism_sides(8, 5)) plc.facets.push_back({{side}, {}, 0});
  return plc;
}

/// By a generic rotation, its coordinates rounded, and shifted.
inline Plc<3> turned(Plc<3> plc, double angle = 0.7) {
  for_each_point(plc, [&](Point3& p) {
    for (const auto& [i, j, a] : {std::tuple{0, 1, angle}, {1, 2, 1.1 * angle}, {2, 0, 0.6}}) {
      const double x = p[i], y = p[j];
      p[i] = std::cos(a) * x - std::sin(a) * y;
      p[j] = std::sin(a) * x + std::cos(a) * y;
    }
    p[0] += 1.25;
  });
  return plc;
}

inline double area(const Point3& a, const Point3& b, const Point3& c) {
  double u[3], w[3];
  for (int i = 0; i < 3; ++i) {
    u[i] = b[i] - a[i];
    w[i] = c[i] - a[i];
  }
  return std::hypot(u[1] * w[2] - u[2] * w[1], u[2] * w[0] - u[0] * w[2], u[0] * w[1] - u[1] * w[0]) / 2;
}

inline double area(const Domain<3>& d, EntityId f) {
  double sum = 0;
  for (const auto& t : d.triangles(f)) sum += area(d.points()[t[0]], d.points()[t[1]], d.points()[t[2]]);
  return sum;
}

template <int D>
EntityId find_segment(const Domain<D>& d, std::uint32_t a, std::uint32_t b) {
  for (EntityId s = 0; s < d.segments().size(); ++s)
    if (std::minmax(d.segments()[s].points[0], d.segments()[s].points[1]) == std::minmax(a, b)) return s;
  return no_entity;
}

template <int D>
bool has_segment(const Domain<D>& d, std::uint32_t a, std::uint32_t b) {
  return find_segment(d, a, b) != no_entity;
}

}  // namespace pgdr::test
