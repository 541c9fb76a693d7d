// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Inputs with few coordinates whose pieces rarely fit edge to edge, and exact transformations of them.
#pragma once

#include <cmath>
#include <random>
#include <utility>
#include <vector>

#include "pgdr/plc.hpp"
#include "plc_points.hpp"

namespace pgdr::test {

/// Every axis goes to the next but `by`, coordinates times 2^exponent, plus `offset` (before scaling; of few bits).
template <int D>
Plc<D> moved(Plc<D> plc, int by, int exponent, double offset) {
  for_each_point(plc, [&](Point<D>& p) {
    Point<D> q;
    for (int i = 0; i < D; ++i) q[(i + by) % D] = std::ldexp(p[i] + offset * (i + 1), exponent);
    p = q;
  });
  return plc;
}

/// Turned by the angles of the triangle 3, 4, 5 and enlarged, without rounding: no facet is parallel to an axis.
template <int D>
Plc<D> oblique(Plc<D> plc) {
  for_each_point(plc, [](Point<D>& p) {
    for (int i = 0; i + 1 < D; ++i) {
      const double x = p[i], y = p[i + 1];
      p[i] = 3 * x - 4 * y;
      p[i + 1] = 4 * x + 3 * y;
      for (int j = 0; j < D; ++j)
        if (j != i && j != i + 1) p[j] *= 5;
    }
  });
  return plc;
}

class GridPlcs {
 public:
  explicit GridPlcs(std::uint64_t seed) : random_(seed) {}

  /// Triangles, a polygon, segments and points of {0..2}^3 in a box or not; most of them are invalid.
  Plc<3> soup() {
    plc_ = {};
    if (pick(2) == 0) box();
    for (std::uint32_t k = pick(4); k-- > 0;) facet({any(), any(), any()});
    segments(4);
    return std::move(plc_);
  }

  /// The cube [0, 2]^3, its faces and walls inside cut in pieces that do not know of each other.
  Plc<3> cube() {
    plc_ = {};
    for (int axis = 0; axis < 3; ++axis)
      for (const double at : {0.0, 2.0}) face(axis, at);
    for (int axis = 0; axis < 3; ++axis)
      if (pick(4) == 0) wall(axis);
    if (pick(3) == 0) facet({any(), any(), any()});
    if (pick(3) == 0) facet(on_a_line());
    segments(pick(3) == 0 ? 2 : 0);
    return std::move(plc_);
  }

  /// Segments of {0..3}^2, in a square or not.
  Plc<2> plane() {
    Plc<2> plc;
    const std::uint32_t steps = 3;
    for (std::uint32_t x = 0; x <= steps; ++x)
      for (std::uint32_t y = 0; y <= steps; ++y) plc.points.push_back({double(x), double(y)});
    plc.points.push_back(plc.points[pick(16)]);
    if (pick(2) == 0) plc.segments = {{{0, 3}, 1}, {{3, 15}, 2}, {{15, 12}, 3}, {{12, 0}, 4}};
    for (std::uint32_t k = pick(5) + 1; k-- > 0;) {
      const std::uint32_t a = pick(17), b = pick(17);
      if (!(plc.points[a] == plc.points[b])) plc.segments.push_back({{a, b}, 5});
    }
    return plc;
  }

 private:
  std::uint32_t pick(std::uint32_t n) { return static_cast<std::uint32_t>(random_() % n); }
  Point3 any() { return {double(pick(3)), double(pick(3)), double(pick(3))}; }

  std::uint32_t point(const Point3& p) {
    plc_.points.push_back(p);  // once a use: duplicates are merged
    return static_cast<std::uint32_t>(plc_.points.size() - 1);
  }
  void facet(const std::vector<Point3>& polygon) {
    std::vector<std::uint32_t> ids;
    for (const Point3& p : polygon) ids.push_back(point(p));
    plc_.facets.push_back({{ids}, {}, static_cast<int>(pick(8) == 0)});
  }
  void segments(std::uint32_t n) {
    for (std::uint32_t k = pick(n + 1); k-- > 0;) {
      const Point3 a = any(), b = any();
      if (!(a == b)) plc_.segments.push_back({{point(a), point(b)}, 7});
    }
    for (std::uint32_t k = pick(3); k-- > 0;) point(any());
  }
  std::vector<Point3> on_a_line() {
    Point3 a = any();
    const int axis = static_cast<int>(pick(3));
    std::vector<Point3> out(3, a);
    for (Point3& p : out) p[axis] = pick(3);
    return out;
  }

  // [u0, u1] x [w0, w1] of the plane x_axis = at, as one polygon or two triangles.
  void rectangle(int axis, double at, double u0, double u1, double w0, double w1) {
    std::vector<Point3> corners;
    for (const auto& [u, w] : {std::pair{u0, w0}, {u1, w0}, {u1, w1}, {u0, w1}}) {
      Point3 p;
      p[axis] = at;
      p[(axis + 1) % 3] = u;
      p[(axis + 2) % 3] = w;
      corners.push_back(p);
    }
    const std::uint32_t how = pick(3), k = how;
    if (how == 2) return facet(corners);
    facet({corners[k], corners[k + 1], corners[(k + 2) % 4]});
    facet({corners[k], corners[(k + 2) % 4], corners[(k + 3) % 4]});
  }
  void face(int axis, double at) {
    switch (pick(4)) {
      case 0: return rectangle(axis, at, 0, 2, 0, 2);
      case 1: rectangle(axis, at, 0, 1, 0, 2); return rectangle(axis, at, 1, 2, 0, 2);
      case 2: rectangle(axis, at, 0, 2, 0, 1); return rectangle(axis, at, 0, 2, 1, 2);
      default:
        rectangle(axis, at, 0, 1, 0, 1);
        rectangle(axis, at, 1, 2, 0, 1);
        return rectangle(axis, at, 0, 2, 1, 2);
    }
  }
  void wall(int axis) {
    const double u = pick(2), w = pick(2);
    rectangle(axis, 1, 0, 2 - u, w, 2);
  }
  void box() {
    for (int axis = 0; axis < 3; ++axis)
      for (const double at : {0.0, 2.0}) rectangle(axis, at, 0, 2, 0, 2);
  }

  std::mt19937_64 random_;
  Plc<3> plc_;
};

}  // namespace pgdr::test
