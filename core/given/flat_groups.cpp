// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "given/flat_groups.hpp"

#include <algorithm>
#include <cmath>

#include "given/cover.hpp"
#include "pgdr/predicates.hpp"

namespace pgdr::checking {
namespace {

/// A side of a triangle; its ends by the number of their place.
struct Side {
  std::array<std::uint32_t, 2> ends;
  std::uint32_t triangle, apex;
};

}  // namespace

// If four points are within r of a plane, the plane of three of them is off it by at most r at these; the height of the fourth
// above their plane is its own r, and theirs times its barycentric coordinates.
bool may_be_even(const std::array<Point3, 3>& triangle, const Point3& point, double reach) {
  const PlaneFrame frame(triangle);
  if (frame.width() <= 10 * reach) return true;
  const auto p = frame.place(point);
  std::array<std::array<double, 3>, 3> at;
  for (int i = 0; i < 3; ++i) at[i] = frame.place(triangle[i]);
  const auto doubled = [](const auto& a, const auto& b, const auto& c) {
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
  };
  const double whole = std::abs(doubled(at[0], at[1], at[2]));
  double sum = 1;
  for (int i = 0; i < 3; ++i) sum += std::abs(doubled(at[i], at[(i + 1) % 3], p)) / whole;
  return std::abs(p[2]) <= sum * reach;
}

detail::DisjointSets flat_groups(const GivenInput<3>& input, std::size_t further, std::vector<std::uint32_t>* seams) {
  const auto triangles = input.triangles();
  std::vector<Side> sides;
  sides.reserve(3 * triangles.size());
  for (std::uint32_t t = 0; t < triangles.size(); ++t)
    for (int i = 0; i < 3; ++i) {
      const auto& p = triangles[t].points;
      const std::uint32_t a = input.place(p[(i + 1) % 3]), b = input.place(p[(i + 2) % 3]);
      sides.push_back({{std::min(a, b), std::max(a, b)}, t, p[i]});
    }
  std::sort(sides.begin(), sides.end(),
            [](const Side& x, const Side& y) { return x.ends != y.ends ? x.ends < y.ends : x.triangle < y.triangle; });
  detail::DisjointSets groups(triangles.size() + further);
  for (std::size_t i = 0, j; i < sides.size(); i = j) {
    for (j = i + 1; j < sides.size() && sides[j].ends == sides[i].ends;) ++j;
    if (j - i != 2) continue;
    const Side &x = sides[i], &y = sides[i + 1];
    const GivenTriangle &t = triangles[x.triangle], &u = triangles[y.triangle];
    if (input.marker(t) != input.marker(u)) continue;
    const auto p = input.corners(t), q = input.corners(u);
    const Point3 &of_t = input.point(x.apex), &of_u = input.point(y.apex);
    const bool planar = orient3d(p[0], p[1], p[2], of_u) == Sign::zero;
    if (!planar && !(may_be_even(p, of_u, input.reach()) && may_be_even(q, of_t, input.reach()))) continue;
    groups.unite(x.triangle, y.triangle);
    if (!planar && seams) seams->push_back(x.triangle);
  }
  return groups;
}

std::vector<bool> triangles_of_uneven_groups(const GivenInput<3>& input) {
  const auto triangles = input.triangles();
  std::vector<bool> uneven(triangles.size(), false);
  if (input.tolerance() == 0) return uneven;
  std::vector<std::uint32_t> seams;  // triangles at which a group is uneven
  detail::DisjointSets groups = flat_groups(input, 0, &seams);
  std::vector<bool> of_root(triangles.size(), false);
  for (const std::uint32_t t : seams) of_root[groups.find(t)] = true;
  for (std::uint32_t t = 0; t < triangles.size(); ++t) uneven[t] = of_root[groups.find(t)];
  return uneven;
}

}  // namespace pgdr::checking
