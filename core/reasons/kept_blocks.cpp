// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "reasons/kept_blocks.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "input/entities.hpp"
#include "numbers/finite.hpp"
#include "reasons/poor_reasons.hpp"
#include "select/blocked_places.hpp"

namespace pgdr {
namespace {

/// Around the ball and the corners, which rounding may leave outside of it.
template <std::size_t N>
detail::Box<3> box_of(const Ball<3>& ball, const std::array<Point3, N>& corners) {
  auto box = detail::Box<3>::of(corners);
  const double radius = std::sqrt(ball.squared_radius);
  if (detail::is_finite(ball.center) && std::isfinite(radius)) box.add(detail::Box<3>::around(ball.center).widened(radius));
  return box;
}

std::array<Point3, 3> corners_of(const Domain<3>& domain, const std::array<std::uint32_t, 3>& t) {
  return {domain.points()[t[0]], domain.points()[t[1]], domain.points()[t[2]]};
}

std::array<Point3, 2> ends_of(const Domain<3>& domain, EntityId segment) {
  const auto& ends = domain.segments()[segment].points;
  return {domain.points()[ends[0]], domain.points()[ends[1]]};
}

bool blocks(const Domain<3>& domain, EntityRef e, const detail::PlacesForCell& places) {
  if (e.kind == EntityKind::segment) return places.blocked_by_segment(ends_of(domain, e.id)) == places.all;
  unsigned blocked = 0;
  for (const auto& t : domain.triangles(e.id)) blocked |= places.blocked_by_triangle(corners_of(domain, t));
  return blocked == places.all;
}

}  // namespace

KeptBlocks::KeptBlocks(const Domain<3>& domain, const KeptEntities<3>& kept) : domain_(&domain) {
  std::vector<detail::Box<3>> boxes;
  for (EntityId f = 0; f < domain.facets().size(); ++f)
    if (const EntityRef e{EntityKind::facet, f}; kept.has(e))
      for (const auto& t : domain.triangles(f)) {
        const auto corners = corners_of(domain, t);
        boxes.push_back(box_of(equatorial_ball(corners[0], corners[1], corners[2]), corners));
        entities_.push_back(e);
      }
  for (EntityId s = 0; s < domain.segments().size(); ++s)
    if (const EntityRef e{EntityKind::segment, s}; kept.has(e)) {
      const auto ends = ends_of(domain, s);
      boxes.push_back(box_of(diametral_ball<3>(ends[0], ends[1]), ends));
      entities_.push_back(e);
    }
  if (!boxes.empty()) tree_.emplace(boxes);
}

std::optional<EntityRef> KeptBlocks::of_cell(const Simplex<3>& cell, double radius_edge_bound) const {
  std::optional<EntityRef> best;
  const detail::PlacesForCell places(cell, radius_edge_bound);
  if (!tree_ || !detail::is_finite(places.places[1])) return best;
  const Ball<3> doubled = doubled_circumball<3>(cell);
  double nearest = doubled.squared_radius;
  // What blocks the nearer place has it in its ball, or is met on the way there.
  tree_->meeting(detail::Box<3>::of(std::array{places.from, places.places[1]}), [&](std::uint32_t i) {
    const EntityRef e = entities_[i];
    const double far = squared_distance_to<3>(*domain_, e, doubled.center);
    if (!(far <= nearest) || (best && far == nearest) || !blocks(*domain_, e, places)) return;
    best = e;
    nearest = far;
  });
  return best;
}

}  // namespace pgdr
