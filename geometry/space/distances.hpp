// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Where points, edges and triangles are nearest to each other, and how far apart, in doubles. Pure functions, any thread.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "numbers/vectors.hpp"

namespace pgdr::detail {

/// A point on each of two things, nearest to each other.
template <int D>
struct ClosestPoints {
  std::array<Point<D>, 2> points;
  double square = 0;  ///< of their distance
};

template <int D>
double distance(const Point<D>& a, const Point<D>& b) {
  return std::sqrt(squared_distance(a, b));
}

template <int D>
Point<D> on_edge(const Point<D>& a, const Point<D>& b, double t) {
  Point<D> p;
  for (int i = 0; i < D; ++i) p[i] = a[i] + t * (b[i] - a[i]);
  return p;
}

/// Where the point of the line through a and b is that is nearest to x: 0 at a, 1 at b; 0 if they are one point.
template <int D>
double part_of_edge(const Point<D>& x, const Point<D>& a, const Point<D>& b) {
  const auto along = difference(b, a);
  const double length = dot(along, along);
  return length > 0 ? dot(difference(x, a), along) / length : 0.0;
}

/// The squared distance of x from on_edge(a, b, t), which is not rounded to coordinates for it.
template <int D>
double squared_distance_at(const Point<D>& x, const Point<D>& a, const Point<D>& b, double t) {
  double square = 0;
  for (int i = 0; i < D; ++i) {
    const double off = (x[i] - a[i]) - t * (b[i] - a[i]);
    square += off * off;
  }
  return square;
}

template <int D>
ClosestPoints<D> closest_to_point(const Point<D>& x, const Point<D>& p) {
  return {{x, p}, squared_distance(x, p)};
}

template <int D>
ClosestPoints<D> closest_to_edge(const Point<D>& x, const Point<D>& a, const Point<D>& b) {
  const double t = std::clamp(part_of_edge(x, a, b), 0.0, 1.0);
  return {{x, on_edge(a, b, t)}, squared_distance_at(x, a, b, t)};
}

inline ClosestPoints<3> closest_to_triangle(const Point3& x, const Point3& a, const Point3& b, const Point3& c) {
  const auto ab = closest_to_edge(x, a, b), bc = closest_to_edge(x, b, c), ca = closest_to_edge(x, c, a);
  const auto& nearer = bc.square < ab.square ? bc : ab;
  const auto& nearest = ca.square < nearer.square ? ca : nearer;
  const auto normal = cross(difference(b, a), difference(c, a));
  const double square = dot(normal, normal);
  const auto is_inside_of = [&](const Point3& p, const Point3& q) {
    return dot(cross(difference(q, p), difference(x, p)), normal) >= 0;
  };
  if (!(square > 0) || !is_inside_of(a, b) || !is_inside_of(b, c) || !is_inside_of(c, a)) return nearest;
  const double length = std::sqrt(square), height = dot(difference(x, a), normal) / length;
  if (!(height * height < nearest.square)) return nearest;
  Point3 foot;
  for (int i = 0; i < 3; ++i) foot[i] = x[i] - height * (normal[i] / length);
  return {{x, foot}, height * height};  // whose root is `height` as it is
}

/// A triangle abc, for the distances of many points from it.
class TriangleDistance {
 public:
  TriangleDistance(const Point3& a, const Point3& b, const Point3& c)
      : corners_{a, b, c}, along_{difference(b, a), difference(c, b), difference(a, c)} {
    for (std::size_t i = 0; i < 3; ++i) lengths_[i] = dot(along_[i], along_[i]);
    normal_ = cross(along_[0], difference(c, a));
    area_ = dot(normal_, normal_);
    root_ = std::sqrt(area_);
  }
  /// closest_to_triangle(x, a, b, c).square to the last bit.
  double square(const Point3& x) const {
    const Froms from = from_corners(x);
    return std::min({to_edge(from, 0), to_edge(from, 1), to_edge(from, 2), to_inside(from)});
  }
  /// Is it at most this? The first part that is as near says so.
  bool is_within(const Point3& x, double square) const {
    const Froms from = from_corners(x);
    return to_inside(from) <= square || to_edge(from, 0) <= square || to_edge(from, 1) <= square || to_edge(from, 2) <= square;
  }

 private:
  using Froms = std::array<Vector<3>, 3>;
  Froms from_corners(const Point3& x) const {
    return {difference(x, corners_[0]), difference(x, corners_[1]), difference(x, corners_[2])};
  }
  /// Infinite where the foot is not inside.
  double to_inside(const Froms& from) const {
    constexpr double infinite = std::numeric_limits<double>::infinity();
    if (!(area_ > 0)) return infinite;
    for (std::size_t i = 0; i < 3; ++i)
      if (!(dot(cross(along_[i], from[i]), normal_) >= 0)) return infinite;
    const double height = dot(from[0], normal_) / root_;
    return height * height;
  }
  double to_edge(const Froms& froms, std::size_t i) const {
    const auto &from = froms[i], &along = along_[i];
    const double t = std::clamp(lengths_[i] > 0 ? dot(from, along) / lengths_[i] : 0.0, 0.0, 1.0);
    double square = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const double off = from[k] - t * along[k];
      square += off * off;
    }
    return square;
  }

  std::array<Point3, 3> corners_;
  std::array<Vector<3>, 3> along_;  // from each corner to the next
  std::array<double, 3> lengths_;   // of these, squared
  Vector<3> normal_;
  double area_, root_;  // of the parallelogram: squared, and not
};
/// Of an edge (2D) or a triangle (3D).
template <int D>
ClosestPoints<D> closest_to_simplex(const Point<D>& x, const std::array<Point<D>, D>& s) {
  if constexpr (D == 2)
    return closest_to_edge(x, s[0], s[1]);
  else
    return closest_to_triangle(x, s[0], s[1], s[2]);
}

/// Of the edges ab and cd.
template <int D>
ClosestPoints<D> closest_of_edges(const Point<D>& a, const Point<D>& b, const Point<D>& c, const Point<D>& d) {
  const auto u = difference(b, a), v = difference(d, c), r = difference(a, c);
  const double uu = dot(u, u), vv = dot(v, v), uv = dot(u, v);
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
  const auto solve = [&](const Vector<D>& off) {
    const double of_u = dot(u, off), of_v = dot(v, off);
    return std::array{(uv * of_v - vv * of_u) / determinant, (uu * of_v - uv * of_u) / determinant};
  };
  // Of edges that cross at a small angle the equations lose its square: what is left of the distance is solved for once more.
  auto [s, t] = solve(r);
  Vector<D> left;
  for (int i = 0; i < D; ++i) left[i] = r[i] + s * u[i] - t * v[i];
  const auto further = solve(left);
  s += further[0];
  t += further[1];
  if (s > 0 && s < 1 && t > 0 && t < 1) take(closest_to_point(on_edge(a, b, s), on_edge(c, d, t)), false);
  return least;
}

}  // namespace pgdr::detail
