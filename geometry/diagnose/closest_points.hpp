// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Where points, edges and triangles are nearest to each other, in doubles. Pure functions, any thread.
#pragma once

#include <algorithm>
#include <array>

#include "numbers/vectors.hpp"

namespace pgdr::detail {

/// A point on each of two things, nearest to each other.
template <int D>
struct ClosestPoints {
  std::array<Point<D>, 2> points;
  double square = 0;  ///< of their distance
};

template <int D>
Point<D> on_edge(const Point<D>& a, const Point<D>& b, double t) {
  Point<D> p;
  for (int i = 0; i < D; ++i) p[i] = a[i] + t * (b[i] - a[i]);
  return p;
}

template <int D>
ClosestPoints<D> closest_to_point(const Point<D>& x, const Point<D>& p) {
  return {{x, p}, squared_distance(x, p)};
}

template <int D>
ClosestPoints<D> closest_to_edge(const Point<D>& x, const Point<D>& a, const Point<D>& b) {
  const auto along = difference(b, a);
  const double length = dot(along, along);
  const double t = length > 0 ? std::clamp(dot(difference(x, a), along) / length, 0.0, 1.0) : 0.0;
  return closest_to_point(x, on_edge(a, b, t));
}

inline ClosestPoints<3> closest_to_triangle(const Point3& x, const Point3& a, const Point3& b, const Point3& c) {
  const auto normal = cross(difference(b, a), difference(c, a));
  const double square = dot(normal, normal);
  const auto is_inside_of = [&](const Point3& p, const Point3& q) {
    return dot(cross(difference(q, p), difference(x, p)), normal) >= 0;
  };
  if (square > 0 && is_inside_of(a, b) && is_inside_of(b, c) && is_inside_of(c, a)) {
    const double height = dot(difference(x, a), normal) / square;
    Point3 foot;
    for (int i = 0; i < 3; ++i) foot[i] = x[i] - height * normal[i];
    return closest_to_point(x, foot);
  }
  const auto ab = closest_to_edge(x, a, b), bc = closest_to_edge(x, b, c), ca = closest_to_edge(x, c, a);
  const auto& nearer = bc.square < ab.square ? bc : ab;
  return ca.square < nearer.square ? ca : nearer;
}

/// Of the edges ab and cd.
template <int D>
ClosestPoints<D> closest_of_edges(const Point<D>& a, const Point<D>& b, const Point<D>& c, const Point<D>& d) {
  const auto u = difference(b, a), v = difference(d, c), r = difference(a, c);
  const double uu = dot(u, u), vv = dot(v, v), uv = dot(u, v), ur = dot(u, r), vr = dot(v, r);
  const double determinant = uu * vv - uv * uv;
  ClosestPoints<D> least;
  const auto take = [&](const ClosestPoints<D>& other, bool swapped) {
    if (!(other.square < least.square)) return;
    least = other;
    if (swapped) std::swap(least.points[0], least.points[1]);
  };
  least = closest_to_edge(a, c, d);
  take(closest_to_edge(b, c, d), false);
  take(closest_to_edge(c, a, b), true);
  take(closest_to_edge(d, a, b), true);
  if (!(determinant > 0)) return least;
  const double s = (uv * vr - vv * ur) / determinant, t = (uu * vr - uv * ur) / determinant;
  if (s > 0 && s < 1 && t > 0 && t < 1) take(closest_to_point(on_edge(a, b, s), on_edge(c, d, t)), false);
  return least;
}

}  // namespace pgdr::detail
