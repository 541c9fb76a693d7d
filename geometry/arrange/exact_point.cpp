// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "arrange/exact_point.hpp"

#include <cmath>
#include <limits>

namespace pgdr::detail {
namespace {

using Number = Rational::Number;
using Numbers = std::array<Number, 3>;

Numbers exact_difference(const Numbers& a, const Numbers& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }

Number exact_dot(const Numbers& a, const Numbers& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

Number exact_minor(const Numbers& a, const Numbers& b, std::size_t axis) {
  const std::size_t u = (axis + 1) % 3, w = (axis + 2) % 3;
  return a[u] * b[w] - a[w] * b[u];
}

ExactPoint between(const ExactPoint& a, const Numbers& along, const Number& part) {
  ExactPoint out;
  for (std::size_t i = 0; i < 3; ++i) out.x[i] = a.x[i] + part * along[i];
  return out;
}

/// Rationals give a double that is off by an ulp or two: from there to the nearest.
double rounded(const Number& x) {
  double d = x.convert_to<double>();
  while (true) {
    const Number off = x - d;
    if (off == 0) return d + 0.0;
    const double next = std::nextafter(
        d, off > 0 ? std::numeric_limits<double>::infinity() : -std::numeric_limits<double>::infinity());
    const Number twice = 2 * abs(off), step = abs(Number(next) - d);
    if (twice < step || (twice == step && std::fabs(d) < std::fabs(next))) return d + 0.0;
    d = next;
  }
}

}  // namespace

ExactPoint line_through_plane(const Point3& a, const Point3& b, const Point3& p, const Point3& q, const Point3& r) {
  const ExactPoint from(a), at(p);
  const Numbers along = exact_difference(ExactPoint(b).x, from.x);
  const Numbers u = exact_difference(ExactPoint(q).x, at.x), w = exact_difference(ExactPoint(r).x, at.x);
  const Numbers normal{exact_minor(u, w, 0), exact_minor(u, w, 1), exact_minor(u, w, 2)};
  const Number part = exact_dot(normal, exact_difference(at.x, from.x)) / exact_dot(normal, along);
  return between(from, along, part);
}

ExactPoint meeting_of_lines(const ExactPoint& a, const ExactPoint& b, const ExactPoint& c, const ExactPoint& d) {
  const Numbers u = exact_difference(b.x, a.x), w = exact_difference(d.x, c.x), from = exact_difference(c.x, a.x);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const Number area = exact_minor(u, w, axis);
    if (area != 0) return between(a, u, exact_minor(from, w, axis) / area);
  }
  return a;  // not reached: the lines are not parallel
}

Point3 rounded(const ExactPoint& p) { return {rounded(p.x[0]), rounded(p.x[1]), rounded(p.x[2])}; }

double distance(const ExactPoint& p, const Point3& q) {
  double square = 0;
  for (int i = 0; i < 3; ++i) {
    const double d = Number(p.x[static_cast<std::size_t>(i)] - q[i]).convert_to<double>();
    square += d * d;
  }
  return std::sqrt(square);
}

}  // namespace pgdr::detail
