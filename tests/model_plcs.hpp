// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The inputs that tests and benchmarks share, made here, and generic motions of them.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include "pgdr/plc.hpp"
#include "plc_points.hpp"

namespace pgdr::test {

using Index = std::uint32_t;

inline void add_polygon(Plc<3>& plc, std::vector<Index> polygon, int marker = 0) {
  plc.facets.push_back({{std::move(polygon)}, {}, marker});
}

/// Axis-aligned box with its eight corners and six quadrilaterals, markers first_marker ... first_marker + 5
/// (x low, x high, y low, y high, z low, z high).
inline void add_box(Plc<3>& plc, const Point3& low, const Point3& high, int first_marker = 1) {
  const Index base = static_cast<Index>(plc.points.size());
  for (int i = 0; i < 8; ++i)
    plc.points.push_back({{i & 1 ? high[0] : low[0], i & 2 ? high[1] : low[1], i & 4 ? high[2] : low[2]}});
  const std::array<std::array<Index, 4>, 6> faces = {
      {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}}};
  for (int f = 0; f < 6; ++f) {
    std::vector<Index> polygon;
    for (const Index v : faces[f]) polygon.push_back(base + v);
    add_polygon(plc, polygon, first_marker + f);
  }
}

inline Plc<3> cube() {
  Plc<3> plc;
  add_box(plc, {{0, 0, 0}}, {{1, 1, 1}});
  return plc;
}

/// The unit cube and two points 1e-4 apart at its centre ("points in cube" of Table 2.3).
inline Plc<3> cube_with_two_points() {
  Plc<3> plc = cube();
  plc.points.push_back({{0.5, 0.5, 0.5}});
  plc.points.push_back({{0.5001, 0.5, 0.5}});
  return plc;
}

/// A cube cut by the facet z = 1/2 into regions 10 and 20, the first with a volume bound.
inline Plc<3> two_region_cube() {
  Plc<3> plc;
  for (int i = 0; i < 12; ++i) plc.points.push_back({{double(i % 2), double(i / 2 % 2), double(i / 4) / 2}});
  for (int half = 0; half < 2; ++half) {
    const Index b = 4 * static_cast<Index>(half);
    add_polygon(plc, {b, b + 1, b + 5, b + 4}, 1);
    add_polygon(plc, {b + 2, b + 3, b + 7, b + 6}, 2);
    add_polygon(plc, {b, b + 2, b + 6, b + 4}, 3);
    add_polygon(plc, {b + 1, b + 3, b + 7, b + 5}, 4);
  }
  add_polygon(plc, {0, 1, 3, 2}, 5);
  add_polygon(plc, {4, 5, 7, 6}, 7);
  add_polygon(plc, {8, 9, 11, 10}, 6);
  plc.regions = {{{{0.5, 0.5, 0.25}}, 10, 0.0005}, {{{0.5, 0.5, 0.75}}, 20, 0}};
  return plc;
}

/// A block with a box-shaped cavity inside, taken out by a hole seed.
inline Plc<3> block_with_cavity() {
  Plc<3> plc;
  add_box(plc, {{0, 0, 0}}, {{3, 2, 2}});
  add_box(plc, {{1, 0.5, 0.75}}, {{2, 1.25, 1.5}}, 11);
  plc.holes = {{{1.5, 1, 1}}};
  return plc;
}

/// The prism over a polygon in the plane z = 0 (counter-clockwise), 0 <= z <= height.
inline Plc<3> prism(const std::vector<Point2>& outline, double height) {
  Plc<3> plc;
  const Index n = static_cast<Index>(outline.size());
  for (const double z : {0.0, height})
    for (const Point2& p : outline) plc.points.push_back({{p[0], p[1], z}});
  std::vector<Index> bottom, top;
  for (Index i = 0; i < n; ++i) {
    bottom.push_back(n - 1 - i);
    top.push_back(n + i);
    add_polygon(plc, {i, (i + 1) % n, n + (i + 1) % n, n + i}, static_cast<int>(3 + i));
  }
  add_polygon(plc, bottom, 1);
  add_polygon(plc, top, 2);
  return plc;
}

inline Plc<3> l_block() { return prism({{{0, 0}}, {{2, 0}}, {{2, 1}}, {{1, 1}}, {{1, 2}}, {{0, 2}}}, 1); }
inline Plc<3> u_block() { return prism({{{0, 0}}, {{3, 0}}, {{3, 2}}, {{2, 2}}, {{2, 1}}, {{1, 1}}, {{1, 2}}, {{0, 2}}}, 1); }

/// A plate with a hexagonal hole through it: its two large facets have a hole.
inline Plc<3> plate_with_hole() {
  Plc<3> plc;
  const std::vector<Point2> outer = {{{0, 0}}, {{4, 0}}, {{4, 3}}, {{0, 3}}};
  const std::vector<Point2> inner = {{{1, 1.5}}, {{1.5, 0.75}}, {{2.5, 0.75}}, {{3, 1.5}}, {{2.5, 2.25}}, {{1.5, 2.25}}};
  for (const double z : {0.0, 0.5}) {
    for (const Point2& p : outer) plc.points.push_back({{p[0], p[1], z}});
    for (const Point2& p : inner) plc.points.push_back({{p[0], p[1], z}});
  }
  for (Index level : {0u, 10u}) {
    Plc<3>::Facet facet;
    facet.polygons = {{level, level + 1, level + 2, level + 3},
                      {level + 4, level + 5, level + 6, level + 7, level + 8, level + 9}};
    facet.holes = {{{2, 1.5, level ? 0.5 : 0.0}}};
    facet.marker = level ? 2 : 1;
    plc.facets.push_back(facet);
  }
  for (Index i = 0; i < 4; ++i) add_polygon(plc, {i, (i + 1) % 4, 10 + (i + 1) % 4, 10 + i}, 3);
  for (Index i = 0; i < 6; ++i) add_polygon(plc, {4 + i, 4 + (i + 1) % 6, 14 + (i + 1) % 6, 14 + i}, 4);
  return plc;
}

/// A pipe along the y axis with `sides` sides inside and outside: no angle below 90 degrees, many long subsegments close
/// to one another across the wall.
inline Plc<3> pipe(Index sides, double inner, double outer) {
  Plc<3> plc;
  for (const double y : {-0.5, 0.5})
    for (const double radius : {inner, outer})
      for (Index i = 0; i < sides; ++i) {
        const double angle = 2 * 3.141592653589793 * i / sides;
        plc.points.push_back({{radius * std::cos(angle), y, radius * std::sin(angle)}});
      }
  for (Index end = 0; end < 2; ++end) {
    Plc<3>::Facet facet;
    facet.polygons.resize(2);
    for (Index ring = 0; ring < 2; ++ring)
      for (Index i = 0; i < sides; ++i) facet.polygons[ring].push_back((2 * end + ring) * sides + i);
    facet.holes = {{{0, end ? 0.5 : -0.5, 0}}};
    plc.facets.push_back(facet);
  }
  for (Index ring = 0; ring < 2; ++ring)
    for (Index i = 0; i < sides; ++i) {
      const Index a = ring * sides + i, b = ring * sides + (i + 1) % sides;
      add_polygon(plc, {a, b, 2 * sides + b, 2 * sides + a});
    }
  return plc;
}

/// A cube one of whose facets has an inner segment and an isolated point.
inline Plc<3> cube_with_marked_facet() {
  Plc<3> plc = cube();
  const Index b = static_cast<Index>(plc.points.size());
  plc.points.push_back({{0.25, 0.25, 1}});
  plc.points.push_back({{0.75, 0.25, 1}});
  plc.points.push_back({{0.5, 0.75, 1}});
  plc.facets[5].polygons.push_back({b, b + 1});
  plc.facets[5].polygons.push_back({b + 2});
  return plc;
}

/// The icosahedron, its triangles divided `levels` times, corners on the unit sphere.
inline Plc<3> icosphere(int levels) {
  const double g = (1 + std::sqrt(5.0)) / 2;
  Plc<3> plc;
  for (const double s : {-1.0, 1.0})
    for (const double t : {-g, g}) {
      plc.points.push_back({{0, s, t}});
      plc.points.push_back({{s, t, 0}});
      plc.points.push_back({{t, 0, s}});
    }
  std::vector<std::array<Index, 3>> triangles;
  auto near = [&](Index i, Index j) { return squared_distance(plc.points[i], plc.points[j]) < 4.5; };
  for (Index i = 0; i < 12; ++i)
    for (Index j = i + 1; j < 12; ++j)
      for (Index k = j + 1; k < 12; ++k)
        if (near(i, j) && near(j, k) && near(i, k)) triangles.push_back({i, j, k});
  auto to_sphere = [](Point3 p) {
    const double length = std::sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]);
    return Point3{{p[0] / length, p[1] / length, p[2] / length}};
  };
  for (Point3& p : plc.points) p = to_sphere(p);
  for (int level = 0; level < levels; ++level) {
    std::map<std::pair<Index, Index>, Index> middle;
    auto between = [&](Index a, Index b) {
      const auto [it, fresh] = middle.try_emplace(std::minmax(a, b), static_cast<Index>(plc.points.size()));
      if (fresh) {
        const Point3 &p = plc.points[a], &q = plc.points[b];
        plc.points.push_back(to_sphere({{p[0] + q[0], p[1] + q[1], p[2] + q[2]}}));
      }
      return it->second;
    };
    std::vector<std::array<Index, 3>> finer;
    for (const auto& [a, b, c] : triangles) {
      const Index ab = between(a, b), bc = between(b, c), ca = between(c, a);
      const std::array<std::array<Index, 3>, 4> parts = {{{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}}};
      finer.insert(finer.end(), parts.begin(), parts.end());
    }
    triangles = finer;
  }
  for (const auto& t : triangles) add_polygon(plc, {t[0], t[1], t[2]}, 1);
  return plc;
}

/// A square with a polygonal hole, inner segments and an isolated point.
inline Plc<2> square_with_hole() {
  Plc<2> plc;
  plc.points = {{{0, 0}},       {{4, 0}},    {{4, 4}},   {{0, 4}},     {{1, 1}},   {{2, 0.75}}, {{2.5, 1.5}},
                {{1.75, 2.25}}, {{0.75, 2}}, {{3, 2.5}}, {{3.5, 3.5}}, {{2, 3.5}}, {{3.4, 0.6}}};
  auto loop = [&](Index first, Index count, int marker) {
    for (Index i = 0; i < count; ++i) plc.segments.push_back({{first + i, first + (i + 1) % count}, marker});
  };
  loop(0, 4, 1);
  loop(4, 5, 2);
  plc.segments.push_back({{9, 10}, 3});
  plc.segments.push_back({{10, 11}, 3});
  plc.holes = {{{1.5, 1.5}}};
  return plc;
}

/// A rotation about no axis in particular.
inline Point3 turned(const Point3& p, double shift) {
  // Unit quaternion along (1, 2, 3, 4) up to rounding.
  const double w = 1 / std::sqrt(30.0), x = 2 * w, y = 3 * w, z = 4 * w;
  const double m[3][3] = {{1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)},
                          {2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)},
                          {2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)}};
  Point3 q;
  for (int i = 0; i < 3; ++i) q[i] = m[i][0] * p[0] + m[i][1] * p[1] + m[i][2] * p[2] + shift;
  return q;
}
inline Point2 turned(const Point2& p, double shift) {
  const double c = 0.6427876096865393, s = 0.766044443118978;
  return {{c * p[0] - s * p[1] + shift, s * p[0] + c * p[1] + shift}};
}

/// The model turned generically, then shifted by `shift` along every axis.
template <int D>
Plc<D> turned(Plc<D> plc, double shift = 1000) {
  for_each_point(plc, [shift](Point<D>& p) { p = turned(p, shift); });
  return plc;
}

/// The model scaled by a power of two.
template <int D>
Plc<D> scaled(Plc<D> plc, double factor) {
  for_each_point(plc, [factor](Point<D>& p) {
    for (int i = 0; i < D; ++i) p[i] *= factor;
  });
  for (auto& r : plc.regions) r.size *= D == 3 ? factor * factor * factor : factor * factor;
  return plc;
}

}  // namespace pgdr::test
