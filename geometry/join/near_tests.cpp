// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "join/near_tests.hpp"

#include <algorithm>
#include <cmath>

#include "input/triangle_shapes.hpp"
#include "numbers/rounding.hpp"
#include "numbers/vectors.hpp"
#include "space/distances.hpp"

namespace pgdr::detail {

template <int D>
std::optional<double> part_of_edge_near(const Point<D>& p, const Point<D>& a, const Point<D>& b, double width) {
  const double t = part_of_edge(p, a, b);
  return t > 0 && t < 1 && squared_distance_at(p, a, b, t) <= width * width ? std::optional(t) : std::nullopt;
}

bool pass_within(const std::array<Point3, 2>& e, const std::array<Point3, 2>& f, double width) {
  const auto u = difference(e[1], e[0]), v = difference(f[1], f[0]), w = difference(f[0], e[0]);
  const auto n = cross(u, v);
  const double square = dot(n, n), height = dot(n, w);
  if (!(height * height <= width * width * square) || !(square > 0)) return false;
  const double s = dot(cross(w, v), n) / square, t = dot(cross(w, u), n) / square;
  return s > 0 && s < 1 && t > 0 && t < 1;
}

bool is_near_triangle(const Point3& p, const std::array<Point3, 3>& t, double width) {
  for (std::size_t i = 0; i < 3; ++i)
    if (squared_distance(p, t[i]) <= width * width || part_of_edge_near<3>(p, t[i], t[(i + 1) % 3], width)) return true;
  const auto u = difference(t[1], t[0]), v = difference(t[2], t[0]), to = difference(p, t[0]);
  const auto n = cross(u, v);
  for (std::size_t i = 0; i < 3; ++i)
    if (!(dot(cross(difference(t[(i + 1) % 3], t[i]), difference(p, t[i])), n) >= 0)) return false;
  const double height = std::fabs(dot(n, to)), most = width * std::sqrt(dot(n, n));
  const double error = 2 * rounding::of_determinant * std::sqrt(dot(u, u) * dot(v, v) * dot(to, to));
  if (height > most + error) return false;
  return height < most - error || plane_distance(t[0], t[1], t[2], p) <= width;
}

template std::optional<double> part_of_edge_near<2>(const Point2&, const Point2&, const Point2&, double);
template std::optional<double> part_of_edge_near<3>(const Point3&, const Point3&, const Point3&, double);

}  // namespace pgdr::detail
