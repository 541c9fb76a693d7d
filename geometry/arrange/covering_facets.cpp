// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "arrange/covering_facets.hpp"

#include <algorithm>

#include "numbers/bounded.hpp"
#include "numbers/determinants.hpp"
#include "numbers/rational.hpp"
#include "pgdr/predicates.hpp"
#include "space/equal_rows.hpp"

namespace pgdr::detail {
namespace {

Bounded difference_of(double a, double b, const Bounded&) { return sub(Bounded(a), Bounded(b)); }
Rational difference_of(double a, double b, const Rational&) { return rational_difference(a, b); }

/// The sum of the orientations of p, q with each of three points: of the orientation with their middle the triple.
template <class T>
T middle_side(const Point3& p, const Point3& q, const std::array<Point3, 3>& t, int axis) {
  const int u = (axis + 1) % 3, w = (axis + 2) % 3;
  T sum{};
  const auto along = [&](const Point3& x) { return std::array{difference_of(x[u], p[u], T{}), difference_of(x[w], p[w], T{})}; };
  for (const Point3& c : t) sum = add(sum, orient_det(Matrix<T, 2, 2>{along(q), along(c)}));
  return sum;
}

Sign side_of_middle(const Point3& p, const Point3& q, const std::array<Point3, 3>& t, int axis) {
  if (const auto s = sign(middle_side<Bounded>(p, q, t, axis))) return *s;
  return sign(middle_side<Rational>(p, q, t, axis));
}

template <class T>
T middle_height(double level, const std::array<Point3, 3>& t, int axis) {
  T sum{};
  for (const Point3& c : t) sum = add(sum, difference_of(c[axis], level, T{}));
  return sum;
}

/// Of the middle of three points: is its coordinate `axis` below the level?
bool middle_is_below(double level, const std::array<Point3, 3>& t, int axis) {
  if (const auto s = sign(middle_height<Bounded>(level, t, axis))) return *s == Sign::negative;
  return sign(middle_height<Rational>(level, t, axis)) == Sign::negative;
}

/// The parity of the edges of a polygon that are met on the way from the middle of t along the first kept axis. Of two polygons
/// that have a common edge one has a middle on it.
template <class PointAt>
bool polygon_has_middle(std::size_t count, const PointAt& point_at, const std::array<Point3, 3>& t, int axis) {
  bool inside = false;
  for (std::size_t k = 0; k < count; ++k) {
    const Point3 &p = point_at(k), &q = point_at((k + 1) % count);
    const bool p_above = middle_is_below(p[(axis + 2) % 3], t, (axis + 2) % 3),
               q_above = middle_is_below(q[(axis + 2) % 3], t, (axis + 2) % 3);
    if (p_above == q_above) continue;
    const Sign side = q_above ? side_of_middle(p, q, t, axis) : side_of_middle(q, p, t, axis);
    if (side == Sign::positive) inside = !inside;
  }
  return inside;
}

}  // namespace

std::vector<std::uint32_t> CoveringFacets::candidates(EntityId f, std::uint32_t k) const {
  std::vector<std::uint32_t> found{domain_.triangle_origins(f)[k].facet};
  const std::uint32_t t = domain_.facets()[f].first_triangle + k;
  for (const auto& row : equal_rows(domain_.further_origins(), t, [](const auto& r) { return r[0]; }))
    if (row[1] != found[0]) found.push_back(row[1]);
  return found;
}

std::vector<CoveringFacet> CoveringFacets::of(EntityId f, std::uint32_t k) const {
  const TriangleOrigin& origin = domain_.triangle_origins(f)[k];
  const std::vector<std::uint32_t> all = candidates(f, k);
  const Triangle& t = domain_.triangles(f)[k];
  const int axis = domain_.facets()[f].axis, marker = domain_.facets()[f].marker;
  if (all.size() == 1) {
    const auto& polygon = plc_.facets[origin.facet].polygons[0];
    return {{origin.facet, polygon.size() == 3 ? is_reversed(polygon, axis) : origin.reversed}};
  }
  std::vector<CoveringFacet> found;
  for (const std::uint32_t g : all)
    if (has_middle(plc_.facets[g], t, axis)) found.push_back({g, is_reversed(plc_.facets[g].polygons[0], axis)});
  if (found.empty()) return {{origin.facet, origin.reversed}};  // it is off its facet by the tolerance
  std::stable_partition(found.begin(), found.end(),
                        [&](const CoveringFacet& c) { return plc_.facets[c.facet].marker == marker; });
  return found;
}

bool CoveringFacets::has_middle(std::span<const std::uint32_t> polygon, const Triangle& t, int axis) const {
  const auto p = domain_.points();
  return polygon_has_middle(
      polygon.size(), [&](std::size_t k) -> const Point3& { return p[at(polygon[k])]; }, {p[t[0]], p[t[1]], p[t[2]]}, axis);
}

/// Polygons do not cross, so that two points have a way between them that crosses none iff they are inside of the same ones.
bool CoveringFacets::has_middle(const Plc<3>::Facet& facet, const Triangle& t, int axis) const {
  if (!has_middle(facet.polygons[0], t, axis)) return false;
  const auto p = domain_.points();
  return std::ranges::none_of(facet.holes, [&](const Point3& hole) {
    return std::ranges::all_of(facet.polygons, [&](const auto& polygon) {
      const bool has_hole = polygon_has_middle(
          polygon.size(), [&](std::size_t k) -> const Point3& { return p[at(polygon[k])]; }, {hole, hole, hole}, axis);
      return has_hole == has_middle(polygon, t, axis);
    });
  });
}

/// By its turn at its lexicographically least corner in the projection, or where that says nothing, by its area.
bool CoveringFacets::is_reversed(std::span<const std::uint32_t> polygon, int axis) const {
  const auto p = domain_.points();
  const int u = (axis + 1) % 3, w = (axis + 2) % 3;
  const std::size_t n = polygon.size();
  const auto point = [&](std::size_t k) -> const Point3& { return p[at(polygon[k % n])]; };
  std::size_t least = 0;
  for (std::size_t k = 1; k < n; ++k)
    if (std::pair(point(k)[u], point(k)[w]) < std::pair(point(least)[u], point(least)[w])) least = k;
  const Sign turn = orient_projected(point(least + n - 1), point(least), point(least + 1), axis);
  if (turn != Sign::zero) return turn == Sign::negative;
  double area = 0;
  for (std::size_t k = 0; k < n; ++k)
    area += (point(k)[u] - point(0)[u]) * (point(k + 1)[w] - point(0)[w]) -
            (point(k)[w] - point(0)[w]) * (point(k + 1)[u] - point(0)[u]);
  return area < 0;
}

}  // namespace pgdr::detail
