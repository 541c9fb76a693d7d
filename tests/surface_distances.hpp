// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// How far one surface is from another, by samples that look at every triangle: no bound from above, but what it finds is so. By
// formulas of its own. Slow, tests only.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <vector>

#include "pgdr/domain.hpp"
#include "pgdr/plc.hpp"

namespace pgdr::test {

using Corners = std::array<Point3, 3>;

/// Minimum of |a + s u + t v - x| over the triangle: by its normal equations, else on its edges.
inline double distance_to(const Point3& x, const Corners& c) {
  const auto minus = [](const Point3& p, const Point3& q) { return Point3{{p[0] - q[0], p[1] - q[1], p[2] - q[2]}}; };
  const auto times = [](const Point3& p, const Point3& q) { return p[0] * q[0] + p[1] * q[1] + p[2] * q[2]; };
  const Point3 u = minus(c[1], c[0]), v = minus(c[2], c[0]), w = minus(x, c[0]);
  const double uu = times(u, u), uv = times(u, v), vv = times(v, v), uw = times(u, w), vw = times(v, w), d = uu * vv - uv * uv;
  double least = std::numeric_limits<double>::infinity();
  const auto take = [&](double s, double t) {
    double square = 0;
    for (int i = 0; i < 3; ++i) square += std::pow(s * u[i] + t * v[i] - w[i], 2);
    least = std::min(least, square);
  };
  const auto clamp = [](double t) { return std::clamp(t, 0.0, 1.0); };
  if (const double s = (uw * vv - vw * uv) / d, t = (vw * uu - uw * uv) / d; d > 0 && s >= 0 && t >= 0 && s + t <= 1) take(s, t);
  take(uu > 0 ? clamp(uw / uu) : 0, 0);
  take(0, vv > 0 ? clamp(vw / vv) : 0);
  const double ee = uu - 2 * uv + vv, t = ee > 0 ? clamp((uu - uv - uw + vw) / ee) : 0;
  take(1 - t, t);
  return std::sqrt(least);
}

inline double distance_to(const Point3& x, const std::vector<Corners>& surface) {
  double least = std::numeric_limits<double>::infinity();
  for (const Corners& c : surface) least = std::min(least, distance_to(x, c));
  return least;
}

/// The triangles of an input, by markers.
inline std::map<int, std::vector<Corners>> triangles_by_marker(const Plc<3>& plc) {
  const Domain<3> domain(plc);
  std::map<int, std::vector<Corners>> out;
  for (EntityId f = 0; f < domain.facets().size(); ++f)
    for (const auto& t : domain.triangles(f))
      out[domain.facets()[f].marker].push_back({domain.points()[t[0]], domain.points()[t[1]], domain.points()[t[2]]});
  return out;
}

/// The largest distance found of points of one surface from the other, marker by marker, on a grid of `steps` a side of each
/// triangle; infinite where a marker is missing.
inline double sampled_distance(const Plc<3>& from, const Plc<3>& to, int steps) {
  const auto of = triangles_by_marker(from), others = triangles_by_marker(to);
  double largest = 0;
  for (const auto& [marker, triangles] : of) {
    const auto near = others.find(marker);
    if (near == others.end()) return std::numeric_limits<double>::infinity();
    for (const Corners& c : triangles)
      for (int i = 0; i <= steps; ++i)
        for (int j = 0; i + j <= steps; ++j) {
          const double s = double(i) / steps, t = double(j) / steps;
          Point3 x;
          for (int k = 0; k < 3; ++k) x[k] = (1 - s - t) * c[0][k] + s * c[1][k] + t * c[2][k];
          largest = std::max(largest, distance_to(x, near->second));
        }
  }
  return largest;
}

}  // namespace pgdr::test
