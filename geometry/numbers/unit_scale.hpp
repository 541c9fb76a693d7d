// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "pgdr/types.hpp"

namespace pgdr::detail {

/// The largest |coordinate|; 0 of no points.
inline double largest_coordinate(std::span<const Point3> points) {
  double largest = 0;
  for (const Point3& p : points)
    for (const double x : p.x) largest = std::max(largest, std::fabs(x));
  return largest;
}

/// The points times the power of two that makes the largest coordinate from one to two: products neither overflow nor underflow.
inline std::vector<Point3> in_unit_scale(std::span<const Point3> points) {
  std::vector<Point3> scaled(points.begin(), points.end());
  const double largest = largest_coordinate(points);
  if (!(largest > 0)) return scaled;
  const int exponent = std::ilogb(largest);
  for (Point3& p : scaled)
    for (double& x : p.x) x = std::ldexp(x, -exponent);
  return scaled;
}

}  // namespace pgdr::detail
