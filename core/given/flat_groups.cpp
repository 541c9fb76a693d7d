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

namespace {

/// What the heights of points above the plane of a triangle say, of which all is within r of one plane. The plane of its corners
/// is off that by at most r at these, so elsewhere by r times the barycentric coordinates; the height of a point is that and its
/// own r. The heights of two points differ by what the coordinates do, and by both of their own r.
class EvenHeights {
 public:
  explicit EvenHeights(const std::array<Point3, 3>& triangle) : frame_(triangle) {
    for (int i = 0; i < 3; ++i) at_[i] = frame_.place(triangle[i]);
    whole_ = std::abs(doubled(at_[0], at_[1], at_[2]));
  }
  double width() const { return frame_.width(); }

  struct Place {
    double height;
    std::array<double, 3> coordinates;  // barycentric ones, as they are for an area of `whole`
  };
  Place place(const Point3& x) const {
    const auto p = frame_.place(x);
    Place out{p[2], {}};
    for (int i = 0; i < 3; ++i) out.coordinates[i] = doubled(at_[(i + 1) % 3], at_[(i + 2) % 3], p) / whole_;
    return out;
  }
  static bool is_even(const Place& p, double reach) {
    double sum = 1;
    for (const double c : p.coordinates) sum += std::abs(c);
    return std::abs(p.height) <= sum * reach;
  }
  static bool are_even(const Place& p, const Place& q, double reach) {
    double sum = 2;
    for (int i = 0; i < 3; ++i) sum += std::abs(p.coordinates[i] - q.coordinates[i]);
    return std::abs(p.height - q.height) <= sum * reach;
  }

 private:
  using Coordinates = std::array<double, 3>;
  static double doubled(const Coordinates& a, const Coordinates& b, const Coordinates& c) {
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
  }

  PlaneFrame frame_;
  std::array<Coordinates, 3> at_;
  double whole_;
};

}  // namespace

bool may_be_even(const std::array<Point3, 3>& triangle, const Point3& point, double reach) {
  const EvenHeights heights(triangle);
  return heights.width() <= 10 * reach || EvenHeights::is_even(heights.place(point), reach);
}

bool may_be_even(const std::array<Point3, 3>& triangle, const std::array<Point3, 3>& other, double reach) {
  const EvenHeights heights(triangle);
  if (heights.width() <= 2 * reach) return true;
  std::array<EvenHeights::Place, 3> places;
  for (int i = 0; i < 3; ++i) places[i] = heights.place(other[i]);
  for (int i = 0; i < 3; ++i)
    if (!EvenHeights::is_even(places[i], reach) || !EvenHeights::are_even(places[i], places[(i + 1) % 3], reach)) return false;
  return true;
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
