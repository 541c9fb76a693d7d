// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Points where edges and triangles of doubles meet, as rationals, and the doubles next to them. For .cpp files of this room
// alone. Pure functions, any thread.
#pragma once

#include <array>
#include <span>

#include "numbers/rational.hpp"
#include "pgdr/types.hpp"

namespace pgdr::detail {

/// A point of space, exactly.
struct ExactPoint {
  std::array<Rational::Number, 3> x;

  ExactPoint() = default;
  explicit ExactPoint(const Point3& p) : x{p[0], p[1], p[2]} {}
};

/// Where the line ab goes through the plane of p, q, r. @pre it does, in one point
ExactPoint line_through_plane(const Point3& a, const Point3& b, const Point3& p, const Point3& q, const Point3& r);
/// Where the lines ab and cd meet. @pre they do, in one point
ExactPoint meeting_of_lines(const ExactPoint& a, const ExactPoint& b, const ExactPoint& c, const ExactPoint& d);

/// The nearest doubles, of two that are equally near the one nearer to 0: a function of the point alone. No negative zeros.
Point3 rounded(const ExactPoint& p);
/// How far the doubles are from the point, rounded.
double distance(const ExactPoint& p, const Point3& q);

}  // namespace pgdr::detail
