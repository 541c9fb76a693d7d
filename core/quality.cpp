// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "pgdr/quality.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "detail/vectors.hpp"
#include "pgdr/circumsphere.hpp"

namespace pgdr {
namespace {

using detail::cross;
using detail::difference;
using detail::dot;

constexpr double degrees = 180 / std::numbers::pi;

/// Angle between two vectors, accurate near 0 and 180 too.
template <std::size_t N>
double angle_between(const std::array<double, N>& u, const std::array<double, N>& v) {
  const double c = dot(u, v);
  double s;
  if constexpr (N == 2) {
    s = std::abs(u[0] * v[1] - u[1] * v[0]);
  } else {
    const auto w = cross(u, v);
    s = std::sqrt(dot(w, w));
  }
  return std::atan2(s, c) * degrees;
}

}  // namespace

template <int D>
std::array<double, D == 2 ? 3 : 6> angles_deg(const Simplex<D>& s) {
  if constexpr (D == 2) {
    std::array<double, 3> angle;
    for (int i = 0; i < 3; ++i)
      angle[i] = angle_between(difference(s[(i + 1) % 3], s[i]), difference(s[(i + 2) % 3], s[i]));
    return angle;
  } else {
    // At edge ij the dihedral angle is that between the parts of ik and il normal to ij.
    constexpr int edges[6][4] = {{0, 1, 2, 3}, {0, 2, 1, 3}, {0, 3, 1, 2}, {1, 2, 0, 3}, {1, 3, 0, 2}, {2, 3, 0, 1}};
    std::array<double, 6> angle;
    for (int e = 0; e < 6; ++e) {
      const auto& [i, j, k, l] = edges[e];
      const auto axis = difference(s[j], s[i]);
      angle[e] = angle_between(cross(axis, difference(s[k], s[i])), cross(axis, difference(s[l], s[i])));
    }
    return angle;
  }
}

template <int D>
QualitySummary summarize_quality(const OutputMesh<D>& mesh) {
  QualitySummary q;
  for (const auto& cell : mesh.cells) {
    Simplex<D> s;
    for (int i = 0; i <= D; ++i) s[i] = mesh.points[cell[i]];
    const double ratio = std::sqrt(circumsphere<D>(s).squared_radius / shortest_edge_squared<D>(s));
    q.max_radius_edge = std::max(q.max_radius_edge, ratio);
    for (const double a : angles_deg<D>(s)) {
      q.min_angle_deg = std::min(q.min_angle_deg, a);
      q.max_angle_deg = std::max(q.max_angle_deg, a);
      ++q.histogram[std::clamp(static_cast<int>(a / 10), 0, 17)];
    }
  }
  return q;
}

template PGDR_API std::array<double, 3> angles_deg<2>(const Simplex<2>&);
template PGDR_API std::array<double, 6> angles_deg<3>(const Simplex<3>&);
template PGDR_API QualitySummary summarize_quality<2>(const OutputMesh<2>&);
template PGDR_API QualitySummary summarize_quality<3>(const OutputMesh<3>&);

}  // namespace pgdr
