// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "join/passing_points.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "join/near_tests.hpp"
#include "numbers/double_double.hpp"
#include "pgdr/predicates.hpp"

namespace pgdr::detail {
bool splits_into_shorter(const Point2& p, const Point2& q, const Point2& x) {
  const double length2 = squared_distance(p, q);
  const double along = (x[0] - p[0]) * (q[0] - p[0]) + (x[1] - p[1]) * (q[1] - p[1]);
  return along > 0 && along < length2 && squared_distance(p, x) < length2 && squared_distance(q, x) < length2;
}

bool passes_within(const Point2& p, const Point2& q, const Point2& x, double tolerance) {
  if (!splits_into_shorter(p, q, x)) return false;
  return tolerance > 0 ? part_of_edge_near<2>(x, p, q, tolerance).has_value() : orient2d(p, q, x) == Sign::zero;
}

std::vector<std::uint32_t> chain_along(std::span<const Point2> points, const PlanarEdge& edge,
                                       std::vector<std::uint32_t> inside) {
  const Point2 &p = points[edge[0]], &q = points[edge[1]];
  const auto rank = [&](std::uint32_t v) {
    return std::pair(dot(exact_difference(points[v], p), exact_difference(q, p)).rounded(), points[v].x);
  };
  std::sort(inside.begin(), inside.end(), [&](std::uint32_t v, std::uint32_t w) { return rank(v) < rank(w); });
  inside.insert(inside.begin(), edge[0]);
  inside.push_back(edge[1]);
  return inside;
}

}  // namespace pgdr::detail
