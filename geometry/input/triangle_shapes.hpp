// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Normals of triangles of points of space, and what is seen of them along an axis.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <utility>

#include "pgdr/types.hpp"

namespace pgdr::detail {

/// Axes in the order of the size of this normal's components.
std::array<int, 3> axes_by_size(const std::array<double, 3>& normal);
/// Distance of p from the plane of abc.
double plane_distance(const Point3& a, const Point3& b, const Point3& c, const Point3& p);

/// Triangles of some points, whose coordinates are taken times `scale`.
class TriangleShapes {
 public:
  using Triangle = std::array<std::uint32_t, 3>;

  TriangleShapes(std::span<const Point3> points, double scale) : points_(points), scale_(scale) {}

  Point3 scaled(std::uint32_t v) const {
    Point3 p = points_[v];
    for (double& x : p.x) x *= scale_;
    return p;
  }
  /// (b - a) x (c - a), in doubles: from whichever corner on and whichever way round the triangle is given, the same to the last
  /// bit, but for the sign. What it decides may not depend on that.
  std::array<double, 3> normal(const Triangle& t) const;
  /// Of two that are as large: in an order of triangles that the input's has no part in.
  bool is_before(const Triangle& t, const Triangle& u) const;
  /// The axis along which most is seen of a triangle that is not flat, and its orientation then: 1 or -1.
  std::pair<int, int> visible_side(const Triangle& t) const;

 private:
  /// Its corners in the order of their coordinates; does it run the other way round then?
  std::pair<Triangle, bool> by_coordinates(Triangle t) const;

  std::span<const Point3> points_;
  double scale_;
};

}  // namespace pgdr::detail
