// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>

#include "numbers/corners.hpp"
#include "numbers/vectors.hpp"
#include "optimize/cell_quality.hpp"
#include "optimize/numbers.hpp"

namespace pgdr {
namespace {

using Arrow = detail::Vector<3>;
using detail::cross;
using detail::difference;
using detail::dot;

/// x u + y v
Arrow combined(double x, const Arrow& u, double y, const Arrow& v) {
  return {x * u[0] + y * v[0], x * u[1] + y * v[1], x * u[2] + y * v[2]};
}

/// A length, and its gradient with respect to where corner 3 is.
struct LengthTerm {
  double length;
  Arrow gradient;
};

/// Of the shortest edge.
LengthTerm shortest_edge(const Simplex<3>& s) {
  double least = CellBounds<3>::infinity;
  Arrow of_least{};
  bool moves = false;
  for (const auto& [i, j] : edge_ends) {
    const Arrow d = difference<3>(s[j], s[i]);
    const double squared = dot(d, d);
    if (!(squared < least)) continue;
    least = squared;
    of_least = d;
    moves = j == 3;
  }
  const double length = std::sqrt(least);
  return {length, combined(moves ? 1 / length : 0, of_least, 0, of_least)};
}

}  // namespace

void CellQuality::append_terms(const Simplex<3>& s, int region, double share, std::vector<Term>& terms) const {
  ++evaluated_;
  const Arrow a = difference<3>(s[1], s[0]), b = difference<3>(s[2], s[0]), c = difference<3>(s[3], s[0]);
  const Arrow bc = cross(b, c), ca = cross(c, a), ab = cross(a, b);
  const double det = dot(a, bc);
  if (!(det > 0)) return;
  std::array<Term, 9> all;
  int n = 0;
  if (one_minus_cos_ > 0) {
    // The inward normal of the face opposite corner i changes by u[i] x d if corner 3 goes by d.
    const std::array<Arrow, 4> normal{Arrow{-bc[0] - ca[0] - ab[0], -bc[1] - ca[1] - ab[1], -bc[2] - ca[2] - ab[2]}, bc, ca, ab};
    const std::array<Arrow, 4> u{difference<3>(s[1], s[2]), b, Arrow{-a[0], -a[1], -a[2]}, Arrow{0, 0, 0}};
    std::array<double, 4> length2;
    std::array<Arrow, 4> of_length;  // the gradient of its logarithm
    for (int i = 0; i < 4; ++i) {
      length2[i] = dot(normal[i], normal[i]);
      of_length[i] = combined(1 / length2[i], cross(normal[i], u[i]), 0, u[i]);
    }
    for (const auto& [i, j] : edge_ends) {
      const double lengths = std::sqrt(length2[i] * length2[j]), cosine = -dot(normal[i], normal[j]) / lengths;
      const Arrow of_product = combined(1, cross(normal[j], u[i]), 1, cross(normal[i], u[j]));
      const Arrow of_cosine = combined(-1 / lengths, of_product, -cosine, combined(1, of_length[i], 1, of_length[j]));
      const double slope = (cosine > 0 ? -1 : numbers::of_large_angles) / one_minus_cos_;
      const double d = cosine > 0 ? 1 - cosine : numbers::of_large_angles * (1 + cosine);
      all[n++] = {d / one_minus_cos_, combined(slope, of_cosine, 0, of_cosine)};
    }
  }
  const double a2 = dot(a, a), b2 = dot(b, b), c2 = dot(c, c), infinity = CellBounds<3>::infinity;
  Arrow centre;  // from corner 0
  for (int i = 0; i < 3; ++i) centre[i] = (a2 * bc[i] + b2 * ca[i] + c2 * ab[i]) / (2 * det);
  // The centre moves along the axis of the face opposite corner 3, as far as it takes to be as far from both ends of c.
  const double radius = std::sqrt(dot(centre, centre));
  const Arrow of_radius = combined(dot(centre, ab) / (radius * det), difference<3>({c}, {centre}), 0, c);
  const double ratio_bound = bounds_->radius_edge_bound, measure = bounds_->measure_of(region);
  if (ratio_bound < infinity) {
    const auto [length, of_shortest] = shortest_edge(s);
    const double value = std::sqrt(ratio_bound * length / radius);
    all[n++] = {value, combined(value / (2 * length), of_shortest, -value / (2 * radius), of_radius)};
  }
  if (const double size = size_for(s, region); size < infinity) {
    const double value = size / radius;
    all[n++] = {value, combined(-value / radius, of_radius, 0, of_radius)};
  }
  if (measure < infinity) {
    const double value = 6 * measure / det;
    all[n++] = {value, combined(-value / det, ab, 0, ab)};
  }
  double least = infinity;
  for (int i = 0; i < n; ++i)
    if (all[i].value < least) least = all[i].value;
  for (int i = 0; i < n; ++i)
    if (all[i].value <= share * least && std::isfinite(dot(all[i].gradient, all[i].gradient))) terms.push_back(all[i]);
}

}  // namespace pgdr
