// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "given/facet_sizes.hpp"

#include <algorithm>
#include <cmath>

#include "given/flat_groups.hpp"
#include "numbers/vectors.hpp"
#include "space/disjoint_sets.hpp"

namespace pgdr::checking {
namespace {

using Corners = std::array<Point3, 3>;

double area(const Corners& t) {
  const auto n = detail::cross(detail::difference(t[1], t[0]), detail::difference(t[2], t[0]));
  return std::sqrt(detail::dot(n, n)) / 2;
}

double length_of_sides(const Corners& t) {
  double sum = 0;
  for (std::size_t i = 0; i < 3; ++i) sum += std::sqrt(squared_distance(t[i], t[(i + 1) % 3]));
  return sum;
}

bool may_be_one_facet(const Corners& s, const Corners& t, double reach) {
  const auto may_be_beside = [&](const Corners& plane, const Corners& points) {
    return std::ranges::all_of(points, [&](const Point3& p) { return may_be_even(plane, p, reach); });
  };
  return may_be_beside(s, t) && may_be_beside(t, s);
}

}  // namespace

// Points move by up to twice the tolerance, and areas that differ by less than it times the lengths of their rims are equal.
FacetSizes::FacetSizes(const GivenInput<3>& input, const detail::BoxTree<3>& near, std::span<const double> reach)
    : input_(input), least_(input.plc().facets.size(), 0), most_(input.triangles().size(), 0) {
  const auto triangles = input.triangles();
  detail::DisjointSets groups(triangles.size());
  near.self_pairs([&](std::uint32_t t, std::uint32_t u) {
    const GivenTriangle &a = triangles[t], &b = triangles[u];
    if (input.marker(a) != input.marker(b) || groups.find(t) == groups.find(u)) return;
    if (a.facet == b.facet || may_be_one_facet(input.corners(a), input.corners(b), std::max(reach[t], reach[u])))
      groups.unite(t, u);
  });
  for (std::uint32_t t = 0; t < triangles.size(); ++t) {
    const Corners corners = input.corners(triangles[t]);
    const double size = area(corners), slack = 4 * reach[t] * length_of_sides(corners);
    least_[triangles[t].facet] += size - slack;
    most_[groups.find(t)] += size + slack;
  }
  for (std::uint32_t t = 0; t < triangles.size(); ++t) most_[t] = most_[groups.find(t)];
}

}  // namespace pgdr::checking
