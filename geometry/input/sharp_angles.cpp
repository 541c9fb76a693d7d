// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "input/sharp_angles.hpp"

#include <algorithm>
#include <array>
#include <vector>

#include "numbers/angle_bounds.hpp"
#include "pgdr/predicates.hpp"

namespace pgdr {
namespace {

using Triangle = std::array<std::uint32_t, 3>;

std::vector<Triangle> corner_triangles(const Domain<3>& domain, EntityId facet, std::uint32_t point) {
  std::vector<Triangle> out;  // each turned so that the point is first
  for (const std::uint32_t k : domain.triangles_at(facet, point)) {
    Triangle t = domain.triangles(facet)[k - domain.facets()[facet].first_triangle];
    std::rotate(t.begin(), std::find(t.begin(), t.end(), point), t.end());
    out.push_back(t);
  }
  return out;
}

/// The third corners of the facet's triangles at a segment.
std::vector<std::uint32_t> apexes_at(const Domain<3>& domain, EntityId facet, EntityId segment) {
  const auto [a, b] = domain.segments()[segment].points;
  std::vector<std::uint32_t> out;
  for (const Triangle& t : corner_triangles(domain, facet, a)) {
    if (t[1] == b) out.push_back(t[2]);
    if (t[2] == b) out.push_back(t[1]);
  }
  return out;
}

bool wedge_at(const Domain<3>& domain, EntityId f, EntityId g, EntityId segment, double largest_cosine) {
  const auto p = domain.points();
  const auto [a, b] = domain.segments()[segment].points;
  const auto beyond = apexes_at(domain, g, segment);
  for (const std::uint32_t c : apexes_at(domain, f, segment))
    for (const std::uint32_t d : beyond)
      if (detail::dihedral_below(p[a], p[b], p[c], p[d], largest_cosine)) return true;
  return false;
}

/// The end of the segment that is not this point; no_entity if none is.
std::uint32_t far_end(const Domain<3>& domain, EntityId segment, std::uint32_t point) {
  const auto [a, b] = domain.segments()[segment].points;
  return a == point ? b : b == point ? a : no_entity;
}

}  // namespace

bool meet_too_sharply(const Domain<3>& domain, EntityRef a, EntityRef b, const AngleBounds& bounds) {
  if (a.kind != b.kind || a.id == b.id) return false;
  if (a.kind == EntityKind::facet) {
    const auto of_a = domain.facet_segments(a.id), of_b = domain.facet_segments(b.id);
    return std::any_of(of_a.begin(), of_a.end(), [&](EntityId s) {
      return std::find(of_b.begin(), of_b.end(), s) != of_b.end() && wedge_at(domain, a.id, b.id, s, bounds.largest_cosine);
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
bool is_sharp_corner(const Domain<3>& domain, std::uint32_t point, EntityId s, EntityId t, const AngleBounds& bounds) {
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
    for (const Triangle& k : corner_triangles(domain, f, point))
      if (lies_between(p[k[1]]) && lies_between(p[k[2]])) return true;
  }
  return false;
}

}  // namespace pgdr
