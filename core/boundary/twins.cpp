// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Segments that run along each other from a common end, before their subsegments are all in the mesh (twins.hpp).
#include <algorithm>
#include <cmath>
#include <tuple>

#include "boundary/state.hpp"
#include "input/entities.hpp"
#include "rule/numbers.hpp"
#include "rule/twins.hpp"
#include "space/distances.hpp"

namespace pgdr::detail {
namespace {

/// The direction of a segment away from one of its ends.
struct Direction {
  std::uint32_t apex;
  Point3 unit;
  EntityId segment;
};

/// The order by apex and first coordinate.
std::vector<Direction> directions_of(const Domain<3>& domain, const Bulk& bulk) {
  std::vector<Direction> all = bulk.gather<Direction>(domain.segments().size(), [&](std::size_t s, std::vector<Direction>& out) {
    for (const int end : {0, 1}) {
      const auto& ends = domain.segments()[s].points;
      const Point3 &p = domain.points()[ends[end]], &q = domain.points()[ends[1 - end]];
      const double length = std::sqrt(squared_distance(p, q));
      const Point3 unit{(q[0] - p[0]) / length, (q[1] - p[1]) / length, (q[2] - p[2]) / length};
      out.push_back({ends[end], unit, static_cast<EntityId>(s)});
    }
  });
  bulk.sort(all, [](const Direction& a, const Direction& b) {
    return std::tuple(a.apex, a.unit[0], a.segment) < std::tuple(b.apex, b.unit[0], b.segment);
  });
  return all;
}

}  // namespace

void SegmentChains::find_companions() {
  companions_.resize(chains_.size());
  const std::vector<Direction> all = directions_of(*domain_, *bulk_);
  using Pair = std::array<EntityId, 2>;
  const std::vector<Pair> pairs = bulk_->gather<Pair>(all.size(), [&all](std::size_t i, std::vector<Pair>& out) {
    for (std::size_t j = i + 1; j < all.size() && all[j].apex == all[i].apex; ++j) {
      if (all[j].unit[0] - all[i].unit[0] > numbers::beside_subsegment) break;
      if (!(squared_distance(all[i].unit, all[j].unit) > numbers::beside_subsegment * numbers::beside_subsegment))
        out.push_back({all[i].segment, all[j].segment});
    }
  });
  for (const auto& [s, t] : pairs) {
    companions_[s].push_back(t);
    companions_[t].push_back(s);
  }
}

/// Vertices of the companion as far from the common end as points of the piece are.
template <class Visit>
void SegmentChains::for_each_along(EntityId s, EntityId companion, double begin, double end, const Visit& visit) const {
  const auto &ends = domain_->segments()[s].points, &others = domain_->segments()[companion].points;
  const auto length_of = [&](const std::array<std::uint32_t, 2>& of) {
    return std::sqrt(squared_distance(domain_->points()[of[0]], domain_->points()[of[1]]));
  };
  const bool from_first = ends[0] == others[0] || ends[0] == others[1];
  const bool to_first = others[0] == ends[from_first ? 0 : 1];
  const double scale = length_of(ends) / length_of(others);
  const double nearest = scale * (from_first ? begin : 1 - end), farthest = scale * (from_first ? end : 1 - begin);
  const double first = to_first ? nearest : 1 - farthest, last = to_first ? farthest : 1 - nearest;
  const auto& chain = chains_[companion];
  auto at = std::lower_bound(chain.begin(), chain.end(), first, [](const Link& link, double t) { return link.t < t; });
  for (; at != chain.end() && at->t <= last; ++at) visit(at->vertex);
}

/// Input vertices close beside the segment, by parameter.
const std::vector<SegmentChains::Link>& SegmentChains::input_beside(EntityId s) {
  const auto [at, is_new] = input_beside_.try_emplace(s);
  std::vector<Link>& found = at->second;
  if (!is_new) return found;
  if (!points_tree_) {
    std::vector<Box<3>> boxes;
    for (const Point3& p : domain_->points()) boxes.push_back(Box<3>::around(p));
    points_tree_ = std::make_unique<BoxTree<3>>(boxes, TreeCut::at_medians);
  }
  const auto& ends = domain_->segments()[s].points;
  const Point3 &p = domain_->points()[ends[0]], &q = domain_->points()[ends[1]];
  const double limit = numbers::beside_subsegment * std::sqrt(squared_distance(p, q));
  const auto least = [&](const Box<3>& box, std::uint32_t) {
    Point3 middle;
    for (int i = 0; i < 3; ++i) middle[i] = box.low[i] + (box.high[i] - box.low[i]) / 2;
    return std::sqrt(closest_to_edge(middle, p, q).square) - std::sqrt(squared_distance(middle, box.high));
  };
  points_tree_->nearest(least, [&](std::uint32_t i) {
    const Point3& x = domain_->points()[i];
    if (i != ends[0] && i != ends[1] && closest_to_edge(x, p, q).square < limit * limit)
      found.push_back({delaunay_->vertices()[i], segment_parameter<3>(*domain_, s, x)});
    return limit;
  });
  std::sort(found.begin(), found.end(), [](const Link& a, const Link& b) { return a.t < b.t; });
  return found;
}

/// Where to split the piece, and the vertices whose distances from there do not count.
std::pair<double, std::vector<VertexId>> SegmentChains::split_place(EntityId s, double begin, double end) {
  TwinPlaces places(*domain_, s, begin, end, Beside::nearest);
  const auto& input = input_beside(s);
  auto at = std::lower_bound(input.begin(), input.end(), begin, [](const Link& link, double t) { return link.t < t; });
  for (; at != input.end() && at->t <= end; ++at) places.look_at(mesh_->vertex(at->vertex));
  for (const EntityId companion : companions_[s])
    for_each_along(s, companion, begin, end, [&](VertexId v) { places.look_at(mesh_->vertex(v)); });
  if (!places.best()) return {shells_.split_parameter(s, begin, end), {}};
  std::vector<VertexId> twins;
  for (const EntityId companion : companions_[s])
    for_each_along(s, companion, begin, end, [&](VertexId v) {
      if (is_twin(*domain_, s, *places.best(), mesh_->vertex(v))) twins.push_back(v);
    });
  return {places.best()->t, std::move(twins)};
}

}  // namespace pgdr::detail
