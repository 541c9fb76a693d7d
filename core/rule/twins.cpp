// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "rule/twins.hpp"
#include "input/entities.hpp"
#include "numbers/rounding.hpp"
#include "rule/numbers.hpp"
#include "space/distances.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace pgdr {
namespace {

/// The end of the segment, 0 or 1, that the vertex's own, another one, shares; -1 if there is none.
int common_end(const Domain<3>& domain, EntityId segment, Home home) {
  if (home.kind() != EntityKind::segment || home.id() == segment) return -1;
  const auto &ends = domain.segments()[segment].points, &others = domain.segments()[home.id()].points;
  for (const int end : {0, 1})
    if (ends[end] == others[0] || ends[end] == others[1]) return end;
  return -1;
}

}  // namespace

TwinPlaces::TwinPlaces(const Domain<3>& domain, EntityId segment, double t0, double t1, Beside where)
    : domain_(&domain), segment_(segment), t0_(t0), t1_(t1), where_(where) {
  const auto& ends = domain.segments()[segment].points;
  whole_ = detail::distance(domain.points()[ends[0]], domain.points()[ends[1]]);
}

void TwinPlaces::look_at(const VertexRecord<3>& q) {
  const double length = whole_ * (t1_ - t0_);
  if (q.home.kind() == EntityKind::vertex) {
    const double t = segment_parameter<3>(*domain_, segment_, q.point);
    if (!(t > t0_ && t < t1_)) return;
    add(t, q.point, detail::distance(point_on_segment<3>(*domain_, segment_, t), q.point), no_entity);
  } else if (const int end = common_end(*domain_, segment_, q.home); end >= 0) {
    const std::uint32_t apex = domain_->segments()[segment_].points[end];
    const double part = detail::distance(domain_->points()[apex], q.point) / whole_;
    const bool at_apex = end == 0 ? t0_ == 0 : t1_ == 1;
    double t = end == 0 ? part : 1 - part;
    if (where_ == Beside::nearest && !at_apex) t = segment_parameter<3>(*domain_, segment_, q.point);
    add(t, q.point, numbers::least_part_at_twin * length, apex);
  }
}

void TwinPlaces::add(double t, const Point3& q, double least_room, std::uint32_t apex) {
  if (!(t > t0_ && t < t1_) || whole_ * std::min(t - t0_, t1_ - t) < least_room) return;
  const SplitPlace place{t, point_on_segment<3>(*domain_, segment_, t), apex,
                         apex == no_entity ? 0.0 : detail::distance(domain_->points()[apex], q)};
  if (detail::distance(place.x, q) >= numbers::beside_subsegment * whole_ * (t1_ - t0_)) return;
  const auto rank = [&](const SplitPlace& p) {
    return std::tuple(std::abs(p.t - (t0_ + (t1_ - t0_) / 2)), p.t, p.apex, p.radius);
  };
  if (!best_ || rank(place) < rank(*best_)) best_ = place;
}

bool is_twin(const Domain<3>& domain, EntityId segment, const SplitPlace& place, const VertexRecord<3>& v) {
  if (place.apex == no_entity || v.home.kind() != EntityKind::segment || v.home.id() == segment) return false;
  const auto& ends = domain.segments()[v.home.id()].points;
  if (ends[0] != place.apex && ends[1] != place.apex) return false;
  const double tolerance = rounding::of_plane * domain.segment_magnitude(segment) +
                           numbers::twin_slack * detail::distance(place.x, v.point);
  return std::abs(detail::distance(domain.points()[place.apex], v.point) - place.radius) <= tolerance;
}

}  // namespace pgdr
