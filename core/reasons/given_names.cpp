// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "reasons/given_names.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numbers>

#include "input/sharp_angles.hpp"
#include "numbers/vectors.hpp"
#include "pgdr/predicates.hpp"

namespace pgdr {
namespace {

using detail::cross;
using detail::difference;
using detail::dot;
using detail::Vector;

/// What an entity has at one of its points: the directions to two others, and to all between. Of a segment they are one.
struct Corner {
  std::uint32_t triangle;             ///< of the facet
  std::array<std::uint32_t, 2> ends;  ///< the two others
};

std::vector<Corner> corners_at(const Domain<3>& domain, EntityRef entity, std::uint32_t point, CountedTriangles counted) {
  std::vector<Corner> corners;
  if (entity.kind == EntityKind::segment) {
    const auto& ends = domain.segments()[entity.id].points;
    for (const std::size_t k : {0, 1})
      if (ends[k] == point) corners.push_back({0, {ends[1 - k], ends[1 - k]}});
    return corners;
  }
  const std::uint32_t first = domain.facets()[entity.id].first_triangle;
  for (const std::uint32_t k : domain.triangles_at(entity.id, point)) {
    if (!counted.empty() && counted[k] == 0) continue;
    auto t = domain.triangles(entity.id)[k - first];
    std::rotate(t.begin(), std::find(t.begin(), t.end(), point), t.end());
    corners.push_back({k - first, {t[1], t[2]}});
  }
  return corners;
}

double angle_of(const Vector<3>& u, const Vector<3>& w) {
  const auto n = cross(u, w);
  return std::atan2(std::sqrt(dot(n, n)), dot(u, w));
}

/// The least of a direction and of those between two others.
double angle_to(const Vector<3>& ray, const Vector<3>& y, const Vector<3>& z) {
  double least = std::min(angle_of(ray, y), angle_of(ray, z));
  const auto n = cross(y, z);
  if (dot(cross(n, y), ray) > 0 && dot(cross(z, n), ray) > 0)
    least = std::min(least, std::abs(std::numbers::pi / 2 - angle_of(n, ray)));
  return least;
}

/// In degrees, of two corners at a point; dihedral, if they share another one, too.
double angle_between(const Domain<3>& domain, std::uint32_t point, const Corner& a, const Corner& b) {
  const auto to = [&](std::uint32_t p) { return difference(domain.points()[p], domain.points()[point]); };
  for (const std::size_t i : {0, 1})
    for (const std::size_t k : {0, 1})
      if (a.ends[i] == b.ends[k] && a.ends[0] != a.ends[1] && b.ends[0] != b.ends[1]) {
        const auto edge = to(a.ends[i]);
        return angle_of(cross(edge, to(a.ends[1 - i])), cross(edge, to(b.ends[1 - k]))) * 180 / std::numbers::pi;
      }
  double least = std::numeric_limits<double>::infinity();
  for (const std::size_t i : {0, 1}) {
    least = std::min(least, angle_to(to(a.ends[i]), to(b.ends[0]), to(b.ends[1])));
    least = std::min(least, angle_to(to(b.ends[i]), to(a.ends[0]), to(a.ends[1])));
  }
  return least * 180 / std::numbers::pi;
}

std::vector<std::uint32_t> points_of(const Domain<3>& domain, EntityRef entity) {
  std::vector<std::uint32_t> points;
  if (entity.kind == EntityKind::segment) {
    const auto& p = domain.segments()[entity.id].points;
    points.assign(p.begin(), p.end());
  } else {
    const auto p = domain.facet_points(entity.id);
    points.assign(p.begin(), p.end());
  }
  std::sort(points.begin(), points.end());
  return points;
}

}  // namespace

template <int D>
PoorReason GivenNames<D>::named(const DomainReason& reason, std::uint32_t cell) {
  const auto& [a, b] = reason.entities;
  const std::array<std::uint32_t, 2> at = triangles_at_angle(reason);
  return {cell, reason.code, {name_of(a, at[0]), name_of(b, at[1])}, reason.angle};
}

/// Of each facet, the triangle at which they meet at what is nearest to the angle that the reason states; no_entity: at none.
template <int D>
std::array<std::uint32_t, 2> GivenNames<D>::triangles_at_angle(const DomainReason& reason) const {
  std::array<std::uint32_t, 2> best{no_entity, no_entity};
  const auto& [a, b] = reason.entities;
  if (reason.code != PoorReason::Code::small_angle || !has_extent(a) || !has_extent(b)) return best;
  if constexpr (D == 3) {
    if (a.kind == EntityKind::segment && b.kind == EntityKind::segment) return best;
    const std::vector<std::uint32_t> of_a = points_of(domain_, a), of_b = points_of(domain_, b);
    std::vector<std::uint32_t> common;
    std::set_intersection(of_a.begin(), of_a.end(), of_b.begin(), of_b.end(), std::back_inserter(common));
    const CountedTriangles counted = meshed_;
    double least = std::numeric_limits<double>::infinity();
    for (const std::uint32_t v : common)
      for (const Corner& x : corners_at(domain_, a, v, counted))
        for (const Corner& y : corners_at(domain_, b, v, counted)) {
          const double off = std::abs(angle_between(domain_, v, x, y) - reason.angle);
          if (!(off < least)) continue;
          least = off;
          best = {x.triangle, y.triangle};
        }
  }
  return best;
}

template <int D>
GivenEntity GivenNames<D>::name_of(EntityRef entity, std::uint32_t triangle) {
  GivenEntity name;
  name.kind = entity.kind;
  if (entity.kind == EntityKind::segment)
    for (std::size_t k = 0; k < 2; ++k) {
      const auto& x = domain_.points()[domain_.segments()[entity.id].points[k]].x;
      std::copy(x.begin(), x.end(), name.ends[k].begin());
    }
  if (entity.kind == EntityKind::facet)
    name.facet = triangle != no_entity ? domain_.triangle_origins(entity.id)[triangle].facet : given_facet(entity.id);
  return name;
}

template <int D>
std::uint32_t GivenNames<D>::given_facet(EntityId facet) {
  if (given_of_.empty()) {
    given_of_.assign(domain_.facets().size(), no_entity);
    find_subfacets();
  }
  if (given_of_[facet] == no_entity) given_of_[facet] = find_given_facet(facet);
  return given_of_[facet];
}

template <int D>
void GivenNames<D>::find_subfacets() {
  subfacet_of_.assign(domain_.facets().size(), no_entity);
  for (std::uint32_t s = 0; s < mesh_.subfacets.size(); ++s)
    if (const EntityId f = mesh_.subfacets[s].entity; subfacet_of_[f] == no_entity) subfacet_of_[f] = s;
}

/// That with the middle of the facet's first subfacet, as it is in the mesh there.
template <int D>
std::uint32_t GivenNames<D>::find_given_facet(EntityId facet) const {
  const auto triangles = domain_.triangles(facet);
  const auto origins = domain_.triangle_origins(facet);
  if constexpr (D == 3) {
    if (subfacet_of_[facet] == no_entity) return origins[0].facet;
    const auto& v = mesh_.subfacets[subfacet_of_[facet]].vertices;
    Point3 middle;
    for (int k = 0; k < 3; ++k) middle[k] = (mesh_.points[v[0]][k] + mesh_.points[v[1]][k] + mesh_.points[v[2]][k]) / 3;
    const int axis = domain_.facets()[facet].axis;
    for (std::size_t i = 0; i < triangles.size(); ++i) {
      const auto p = [&](int k) { return domain_.points()[triangles[i][static_cast<std::size_t>(k % 3)]]; };
      const auto is_outside = [&](int k) { return orient_projected(p(k), p(k + 1), middle, axis) == Sign::negative; };
      if (!is_outside(0) && !is_outside(1) && !is_outside(2)) return origins[i].facet;
    }
  }
  return origins[0].facet;
}

template class GivenNames<2>;
template class GivenNames<3>;

}  // namespace pgdr
