// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "arrange/near_passes.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "numbers/vectors.hpp"

namespace pgdr::detail {
namespace {

/// The middle of the shortest way between two lines that are not parallel. The edges come in an order that is that of their
/// points.
Point3 between(std::array<Point3, 2> e, std::array<Point3, 2> f) {
  for (auto* edge : {&e, &f})
    if (lex_less((*edge)[1], (*edge)[0])) std::swap((*edge)[0], (*edge)[1]);
  if (lex_less(f[0], e[0])) std::swap(e, f);
  const Vector<3> u = difference(e[1], e[0]), v = difference(f[1], f[0]), w = difference(f[0], e[0]);
  const Vector<3> n = cross(u, v);
  const double square = dot(n, n);
  const double s = std::clamp(dot(cross(w, v), n) / square, 0.0, 1.0), t = std::clamp(dot(cross(w, u), n) / square, 0.0, 1.0);
  Point3 middle;
  for (int i = 0; i < 3; ++i) {
    const auto k = static_cast<std::size_t>(i);
    middle[i] = e[0][i] + (s * u[k] + (w[k] + t * v[k])) / 2 + 0.0;
  }
  return middle;
}

}  // namespace

std::vector<Point3> points_at_near_passes(std::span<const Diagnostic> refused) {
  std::vector<Point3> points;
  for (const Diagnostic& d : refused)
    if (d.code == Errc::entities_intersect && d.points.size() == 4) {
      const Point3 p = between({Point3{d.points[0]}, Point3{d.points[1]}}, {Point3{d.points[2]}, Point3{d.points[3]}});
      if (std::ranges::all_of(p.x, [](double x) { return std::isfinite(x); })) points.push_back(p);
    }
  std::ranges::sort(points, lex_less<3>);
  points.erase(std::unique(points.begin(), points.end()), points.end());
  return points;
}

}  // namespace pgdr::detail
