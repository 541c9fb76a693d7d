// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "rule/insertion_rule.hpp"
#include "input/entities.hpp"
#include "rule/numbers.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace pgdr {

template <int D>
bool lies_on(const Domain<D>& domain, Home home_of_vertex, EntityRef entity) {
  const EntityRef home = home_of_vertex.entity();
  if (home == entity) return true;
  if (entity.kind == EntityKind::segment) {
    const auto& ends = domain.segments()[entity.id].points;
    return home.kind == EntityKind::vertex && (home.id == ends[0] || home.id == ends[1]);
  }
  if (home.kind == EntityKind::segment) {
    const auto facets = domain.facets_of_segment(home.id);
    return std::binary_search(facets.begin(), facets.end(), entity.id);
  }
  if (home.kind != EntityKind::vertex) return false;
  const auto points = domain.facet_points(entity.id);
  return std::binary_search(points.begin(), points.end(), home.id);
}

template <int D>
Demand encroachment_demand(const Domain<D>& domain, EntityRef entity, const VertexRecord<D>& q) {
  const EntityRef home = q.home.entity();
  const bool is_independent = home.kind == EntityKind::vertex ||
                              (home.kind != EntityKind::volume && !entities_touch<D>(domain, home, entity));
  if (is_independent) return {};
  return {inherited_fraction * q.relaxed_radius, q.relaxed_radius};
}

template <int D>
double relaxed_length(const Domain<D>& domain, const VertexRecord<D>& u, const VertexRecord<D>& v) {
  const double length = std::sqrt(squared_distance(u.point, v.point));
  const double relaxed = std::min(u.relaxed_radius, v.relaxed_radius);
  if (relaxed <= length || relaxed == std::numeric_limits<double>::infinity()) return length;
  const EntityRef a = u.home.entity(), b = v.home.entity();
  const bool is_independent = a.kind != EntityKind::volume && b.kind != EntityKind::volume && !entities_touch<D>(domain, a, b);
  return is_independent ? length : relaxed;
}

std::optional<EntityPair> small_angle_across(const Domain<2>& domain, const std::array<const VertexRecord<2>*, 3>& corners,
                                             double bound) {
  int opposite = 0;
  auto squared_edge = [&](int i) { return squared_distance(corners[(i + 1) % 3]->point, corners[(i + 2) % 3]->point); };
  for (int i = 1; i < 3; ++i)
    if (squared_edge(i) < squared_edge(opposite)) opposite = i;
  const VertexRecord<2>&u = *corners[(opposite + 1) % 3], &v = *corners[(opposite + 2) % 3];
  if (u.home.kind() != EntityKind::segment || v.home.kind() != EntityKind::segment || u.home.id() == v.home.id()) return {};
  const auto &a = domain.segments()[u.home.id()].points, &b = domain.segments()[v.home.id()].points;
  for (const std::uint32_t p : a) {
    if (p != b[0] && p != b[1]) continue;
    const double to_u = squared_distance(domain.points()[p], u.point), to_v = squared_distance(domain.points()[p], v.point);
    if (!(to_u <= (1 + numbers::equally_far) * to_v && to_v <= (1 + numbers::equally_far) * to_u)) continue;
    // The angle at p is below the bound: |uv| < 2 sin(bound / 2) |pu|.
    const double sine = 1 / (2 * bound), cosine = std::sqrt(std::max(0.0, 1 - sine * sine));
    if (squared_edge(opposite) < 2 * (1 - cosine) * to_u) return EntityPair{{u.home.entity(), v.home.entity()}};
  }
  return {};
}

template bool lies_on<2>(const Domain<2>&, Home, EntityRef);
template bool lies_on<3>(const Domain<3>&, Home, EntityRef);
template Demand encroachment_demand<2>(const Domain<2>&, EntityRef, const VertexRecord<2>&);
template Demand encroachment_demand<3>(const Domain<3>&, EntityRef, const VertexRecord<3>&);
template double relaxed_length<2>(const Domain<2>&, const VertexRecord<2>&, const VertexRecord<2>&);
template double relaxed_length<3>(const Domain<3>&, const VertexRecord<3>&, const VertexRecord<3>&);

}  // namespace pgdr
