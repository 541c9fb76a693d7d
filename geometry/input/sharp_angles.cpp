// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "input/sharp_angles.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "numbers/angle_bounds.hpp"
#include "numbers/corners.hpp"
#include "numbers/vectors.hpp"
#include "pgdr/predicates.hpp"

namespace pgdr {
namespace {

using Triangle = std::array<std::uint32_t, 3>;

std::vector<Triangle> corner_triangles(const Domain<3>& domain, EntityId facet, std::uint32_t point, CountedTriangles counted) {
  std::vector<Triangle> out;  // each turned so that the point is first
  for (const std::uint32_t k : domain.triangles_at(facet, point)) {
    if (!counted.empty() && counted[k] == 0) continue;
    Triangle t = domain.triangles(facet)[k - domain.facets()[facet].first_triangle];
    std::rotate(t.begin(), std::find(t.begin(), t.end(), point), t.end());
    out.push_back(t);
  }
  return out;
}

/// The third corners of the facet's triangles at a segment.
std::vector<std::uint32_t> apexes_at(const Domain<3>& domain, EntityId facet, EntityId segment, CountedTriangles counted) {
  const auto [a, b] = domain.segments()[segment].points;
  std::vector<std::uint32_t> out;
  for (const Triangle& t : corner_triangles(domain, facet, a, counted)) {
    if (t[1] == b) out.push_back(t[2]);
    if (t[2] == b) out.push_back(t[1]);
  }
  return out;
}

bool wedge_at(const Domain<3>& domain, EntityId f, EntityId g, EntityId segment, double largest_cosine,
              CountedTriangles counted) {
  const auto p = domain.points();
  const auto [a, b] = domain.segments()[segment].points;
  const auto beyond = apexes_at(domain, g, segment, counted);
  for (const std::uint32_t c : apexes_at(domain, f, segment, counted))
    for (const std::uint32_t d : beyond)
      if (detail::dihedral_below(p[a], p[b], p[c], p[d], largest_cosine)) return true;
  return false;
}

/// The end of the segment that is not this point; no_entity if none is.
std::uint32_t far_end(const Domain<3>& domain, EntityId segment, std::uint32_t point) {
  const auto [a, b] = domain.segments()[segment].points;
  return a == point ? b : b == point ? a : no_entity;
}

std::vector<Sector> sectors_at(const Domain<3>& domain, EntityRef e, std::uint32_t point, CountedTriangles counted) {
  const auto p = domain.points();
  std::vector<Sector> out;
  if (e.kind == EntityKind::segment)
    if (const std::uint32_t end = far_end(domain, e.id, point); end != no_entity) out.push_back({p[end], p[end]});
  if (e.kind == EntityKind::facet)
    for (const Triangle& t : corner_triangles(domain, e.id, point, counted)) out.push_back({p[t[1]], p[t[2]]});
  return out;
}

bool share_segment_at(const Domain<3>& domain, std::uint32_t point, EntityRef a, EntityRef b) {
  if (a == b) return true;
  if (a.kind > b.kind) std::swap(a, b);
  if (b.kind != EntityKind::facet) return false;
  const auto of_b = domain.facet_segments(b.id);
  const auto is_of_b = [&of_b](EntityId s) { return std::find(of_b.begin(), of_b.end(), s) != of_b.end(); };
  if (a.kind != EntityKind::facet) return is_of_b(a.id);
  const auto of_a = domain.facet_segments(a.id);
  return std::any_of(of_a.begin(), of_a.end(), [&](EntityId s) { return far_end(domain, s, point) != no_entity && is_of_b(s); });
}

/// sin δ = sin A / (2 B) as 1 / (2 bound); a hair less than that for the rounding of this number, so that the proof holds.
double bound_of_gaps(const AngleBounds& bounds) {
  const double k = bounds.largest_cosine;
  return bounds.radius_edge / std::sqrt((1 - k) * (1 + k)) * (1 + 0x1p-48);
}

/// Of the directions between those to b and c the nearest to that to r, if it is not one of these two. In doubles.
std::optional<detail::Vector<3>> foot_between(const detail::Vector<3>& r, const detail::Vector<3>& b,
                                              const detail::Vector<3>& c) {
  const auto n = detail::cross(b, c);
  if (!(detail::dot(detail::cross(n, b), r) > 0 && detail::dot(detail::cross(c, n), r) > 0)) return {};
  const double height = detail::dot(n, r) / detail::dot(n, n);
  return detail::Vector<3>{r[0] - height * n[0], r[1] - height * n[1], r[2] - height * n[2]};
}

/// The middle between a direction and the nearest one of a sector, and how near that is.
struct Gap {
  double squared_sine = 2;
  Point3 middle;

  void add(const Point3& v, const detail::Vector<3>& x, const detail::Vector<3>& y) {
    const auto n = detail::cross(x, y);
    const double x2 = detail::dot(x, x), y2 = detail::dot(y, y), squared = detail::dot(n, n) / (x2 * y2);
    if (!(detail::dot(x, y) > 0) || squared >= squared_sine) return;
    squared_sine = squared;
    const double scale = std::sqrt(x2 / y2);
    for (int i = 0; i < 3; ++i) middle[i] = v[i] + 0.5 * (x[i] + scale * y[i]);
  }
};

}  // namespace

std::optional<Point3> middle_of_gap(const Domain<3>& domain, std::uint32_t point, EntityRef a, EntityRef b,
                                    const AngleBounds& bounds, CountedTriangles counted) {
  if (bounds.largest_cosine >= 1 || share_segment_at(domain, point, a, b)) return {};
  return middle_of_gap(domain.points()[point], sectors_at(domain, a, point, counted), sectors_at(domain, b, point, counted),
                       bounds);
}

std::optional<Point3> middle_of_gap(const Point3& v, std::span<const Sector> a, std::span<const Sector> b,
                                    const AngleBounds& bounds) {
  if (bounds.largest_cosine >= 1) return {};
  const double bound = bound_of_gaps(bounds);
  Gap gap;
  const auto look = [&](std::span<const Sector> from, std::span<const Sector> to) {
    for (const Sector& s : from)
      for (const Point3& r : s)
        for (const auto& [c, d] : to) {
          const bool near = c == d ? detail::is_too_sharp<3>(v, r, c, bound) : detail::is_too_near_corner(v, r, c, d, bound);
          if (!near) continue;
          const auto x = detail::difference(r, v), y = detail::difference(c, v), z = detail::difference(d, v);
          const auto foot = c == d ? std::nullopt : foot_between(x, y, z);
          for (const auto& w : foot ? std::array{*foot, *foot} : std::array{y, z}) gap.add(v, x, w);
        }
  };
  look(a, b);
  look(b, a);
  return gap.squared_sine <= 1 ? std::optional(gap.middle) : std::nullopt;
}

bool is_thin_at(const Simplex<3>& s, int i, const AngleBounds& bounds) {
  if (bounds.largest_cosine >= 1) return false;
  const double bound = bound_of_gaps(bounds);
  for (int j = 0; j < 4; ++j) {
    if (j == i) continue;
    const auto [k, l] = corners_without(i, j);
    if (detail::is_too_near_corner(s[i], s[j], s[k], s[l], bound)) return true;
  }
  return false;
}

bool has_direction(const Simplex<3>& s, int i, const Point3& point) {
  for (int j = 0; j < 4; ++j) {
    Simplex<3> turned = s;
    turned[j] = point;
    if (j != i && orient<3>(turned) == Sign::negative) return false;
  }
  return true;
}

bool meet_too_sharply(const Domain<3>& domain, EntityRef a, EntityRef b, const AngleBounds& bounds, CountedTriangles counted) {
  if (a.kind != b.kind || a.id == b.id) return false;
  if (a.kind == EntityKind::facet) {
    const auto of_a = domain.facet_segments(a.id), of_b = domain.facet_segments(b.id);
    return std::any_of(of_a.begin(), of_a.end(), [&](EntityId s) {
      return std::find(of_b.begin(), of_b.end(), s) != of_b.end() &&
             wedge_at(domain, a.id, b.id, s, bounds.largest_cosine, counted);
    });
  }
  if (a.kind != EntityKind::segment) return false;
  const auto p = domain.points();
  const auto& ends = domain.segments()[a.id].points;
  return std::any_of(ends.begin(), ends.end(), [&](std::uint32_t v) {
    const std::uint32_t to_a = far_end(domain, a.id, v), to_b = far_end(domain, b.id, v);
    return to_b != no_entity && detail::is_too_sharp<3>(p[v], p[to_a], p[to_b], bounds.radius_edge);
  });
}

// The projection along the facet's axis keeps the order of directions round a point of it.
bool is_sharp_corner(const Domain<3>& domain, std::uint32_t point, EntityId s, EntityId t, const AngleBounds& bounds,
                     CountedTriangles counted) {
  const auto p = domain.points();
  const std::uint32_t of_s = far_end(domain, s, point), of_t = far_end(domain, t, point);
  if (s == t || of_s == no_entity || of_t == no_entity) return false;
  const Point3 &from = p[point], &to_s = p[of_s], &to_t = p[of_t];
  if (!detail::is_too_sharp<3>(from, to_s, to_t, bounds.radius_edge)) return false;
  const auto facets = domain.facets_of_segment(t);
  for (const EntityId f : domain.facets_of_segment(s)) {
    if (std::find(facets.begin(), facets.end(), f) == facets.end()) continue;
    const int axis = domain.facets()[f].axis;
    const Sign turn = orient_projected(from, to_s, to_t, axis);
    if (turn == Sign::zero) continue;
    const auto lies_between = [&](const Point3& x) {
      const Sign before = orient_projected(from, to_s, x, axis), after = orient_projected(from, x, to_t, axis);
      return (before == turn || after == turn) && (before == turn || before == Sign::zero) &&
             (after == turn || after == Sign::zero);
    };
    for (const Triangle& k : corner_triangles(domain, f, point, counted))
      if (lies_between(p[k[1]]) && lies_between(p[k[2]])) return true;
  }
  return false;
}

}  // namespace pgdr
