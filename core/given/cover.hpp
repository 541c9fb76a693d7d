// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// What of a segment, or of a triangle, is not covered by others, each of which covers what is within its reach. In doubles,
// relative to a corner of what is to be covered: reaches are wider than the rounding of that (of segments they are made so; 2
// ulps of the largest coordinate), so that what is covered leaves nothing, and what is left is wider than rounding. So no areas
// are added up: pieces that cover a place twice cannot stand for one that is missing.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "numbers/vectors.hpp"
#include "pgdr/types.hpp"
#include "space/box.hpp"

namespace pgdr::checking {

/// A segment with what is within `reach` of it.
template <int D>
struct CoveringSegment {
  std::array<Point<D>, 2> ends;
  double reach = 0;
};

/// Whether x is within r of the segment.
template <int D>
bool is_near(const Point<D>& x, const std::array<Point<D>, 2>& segment, double r) {
  const auto d = detail::difference(segment[1], segment[0]), u = detail::difference(x, segment[0]);
  const double t = std::clamp(detail::dot(u, d) / detail::dot(d, d), 0.0, 1.0);
  double squared = 0;
  for (int k = 0; k < D; ++k) squared += (u[k] - t * d[k]) * (u[k] - t * d[k]);
  return squared <= r * r;
}

/// The parts of the segment, as fractions of its length, that none of the others reaches; none of them is shorter than a
/// reach.
template <int D>
std::vector<std::array<double, 2>> uncovered_parts(const std::array<Point<D>, 2>& segment,
                                                   const std::vector<CoveringSegment<D>>& others);

/// The plane of a triangle, with coordinates of its own, and a height above it. A corner is its origin, and the triangle
/// counter-clockwise.
class PlaneFrame {
 public:
  explicit PlaneFrame(const std::array<Point3, 3>& triangle);
  /// The least height of the triangle above one of its edges; 0 if it is flat, and then nothing else may be asked.
  double width() const { return width_; }
  /// The two coordinates, and the height.
  std::array<double, 3> place(const Point3& x) const;
  Point3 in_space(const Point2& x) const;

 private:
  Point3 origin_;
  std::array<std::array<double, 3>, 3> axes_{};
  double width_ = 0;
};

/// A convex polygon in a PlaneFrame, counter-clockwise.
using FlatPolygon = std::vector<Point2>;
double area(const FlatPolygon& polygon);
double diameter(const FlatPolygon& polygon);
Point2 centre(const FlatPolygon& polygon);

/// What a triangle covers of a plane: all within its reach in the plane of what of it is within `height` of that plane.
class CoveringTriangle {
 public:
  CoveringTriangle(const PlaneFrame& frame, const std::array<Point3, 3>& triangle, double reach, double height);
  bool covers_nothing() const { return count_ == 0; }
  /// Its corners turn the other way round in the plane.
  bool turned() const { return turned_; }
  bool contains(const Point2& x) const;
  /// The part of the segment from p to q that it has, as fractions of its length; the first above the second if it has none.
  std::array<double, 2> part_of(const Point2& p, const Point2& q) const;
  /// One of its sides has all of the polygon beyond it.
  bool misses(const FlatPolygon& polygon) const;
  const detail::Box<2>& box() const { return box_; }
  /// The parts of a convex polygon that are not covered are appended.
  void subtract(const FlatPolygon& polygon, std::vector<FlatPolygon>& rest) const;

 private:
  struct HalfPlane {
    double a, b, c;  // a x + b y <= c
  };
  void add_sides(const std::array<std::array<double, 3>, 3>& corners, double reach);
  void add_level(const std::array<std::array<double, 3>, 3>& corners, double height, double sense);
  void add(const HalfPlane& side) { sides_[count_++] = side; }
  std::array<HalfPlane, 8> sides_;  ///< of edges and corners, and two of the height
  std::uint32_t count_ = 0;
  bool turned_ = false;
  detail::Box<2> box_ = detail::Box<2>::empty();
};

/// The part of the segment, as fractions of its length, within reach of the triangle; the first above the second if there is
/// none. A triangle that is not ten times as high as its reach has no plane, and so none.
std::array<double, 2> part_near(const std::array<Point3, 2>& segment, const std::array<Point3, 3>& triangle, double reach);

/// The parts of the triangle, in its frame, that none of the others covers; those thinner than `rounding` are left out. About
/// n log n for n others that do not overlap much.
std::vector<FlatPolygon> uncovered_parts(const FlatPolygon& triangle, const std::vector<CoveringTriangle>& others,
                                         double rounding);

}  // namespace pgdr::checking
