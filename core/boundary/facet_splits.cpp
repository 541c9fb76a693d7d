// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "boundary/facet_splits.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "input/bent_facets.hpp"
#include "numbers/rounding.hpp"
#include "numbers/vectors.hpp"

namespace pgdr::detail {
namespace {

/// Holds the ball, and what rounding may take for a part of it; all of space if the ball is not finite.
Box<3> box_around(const Ball<3>& ball) {
  const double radius = std::sqrt(ball.squared_radius);
  Box<3> box;
  for (int i = 0; i < 3; ++i) {
    const double reach = radius + rounding::of_pruning * (radius + std::fabs(ball.center[i]));
    const double low = ball.center[i] - reach, high = ball.center[i] + reach;
    box.low[i] = std::isfinite(low) ? low : std::numeric_limits<double>::lowest();
    box.high[i] = std::isfinite(high) ? high : std::numeric_limits<double>::max();
  }
  return box;
}

/// How far on the way from p to q the line through a and b is, in the projection.
double part_of_way(const Point3& p, const Point3& q, const Point3& a, const Point3& b, int axis) {
  const auto off_line = [&](const Point3& x) { return std::fabs(cross(difference<3>(b, a), difference<3>(x, a))[axis]); };
  const double from = off_line(p);
  return from > 0 ? from / (from + off_line(q)) : 0;
}

/// Over the diametral balls of the subsegments, in projection.
BoxTree<2> tree_of_diametral_balls(const Mesh<3>& mesh, const std::vector<Subsegment>& rim, int axis) {
  std::vector<Box<2>> boxes;
  for (const Subsegment& s : rim) {
    const Box<3> ball = box_around(diametral_ball<3>(mesh.point(s.a), mesh.point(s.b)));
    boxes.push_back({projected(ball.low, axis), projected(ball.high, axis)});
  }
  return BoxTree<2>(boxes);
}

template <class Candidate>
BoxTree<3> tree_of_equatorial_balls(const std::vector<Candidate>& candidates) {
  std::vector<Box<3>> boxes;
  for (const Candidate& c : candidates) boxes.push_back(box_around(c.ball));
  return BoxTree<3>(boxes);
}

template <class Candidate>
std::vector<Candidate> in_order(std::vector<Candidate> candidates) {
  std::sort(candidates.begin(), candidates.end(), [](const Candidate& a, const Candidate& b) {
    if (a.ball.squared_radius != b.ball.squared_radius) return a.ball.squared_radius > b.ball.squared_radius;
    return lex_less(a.ball.center, b.ball.center);
  });
  return candidates;
}

}  // namespace

FacetPatches::SplitPlan::SplitPlan(const FacetPatches& patches, EntityId facet, std::vector<Candidate> candidates)
    : facet_(facet),
      candidates_(in_order(std::move(candidates))),
      rim_(patches.subsegments(facet)),
      rim_tree_(tree_of_diametral_balls(*patches.mesh_, rim_, patches.domain_->facets()[facet].axis)),
      tree_(tree_of_equatorial_balls(candidates_)),
      places_(candidates_.size()) {
  std::vector<bool> reached(candidates_.size(), false);  // by the points before, as far as they are known
  for (std::size_t i = 0; i < candidates_.size(); ++i) {
    if (reached[i]) continue;
    const Place& at = place(patches, i);
    if (!at.in_the_way) each_reached(at.point, [&](std::size_t k) { reached[k] = true; });
  }
}

void FacetPatches::SplitPlan::renew(const FacetPatches& patches) {
  rim_ = patches.subsegments(facet_);
  rim_tree_ = tree_of_diametral_balls(*patches.mesh_, rim_, patches.domain_->facets()[facet_].axis);
  places_.assign(candidates_.size(), std::nullopt);
}

bool FacetPatches::SplitPlan::is_current(const FacetPatches& patches) const {
  std::size_t subsegments = 0;
  for (const EntityId s : patches.domain_->facet_segments(facet_)) subsegments += patches.chains_->chain(s).size() - 1;
  return subsegments == rim_.size();
}

auto FacetPatches::SplitPlan::place(const FacetPatches& patches, std::size_t candidate) -> const Place& {
  std::optional<Place>& at = places_[candidate];
  if (!at) {
    const Candidate& c = candidates_[candidate];
    const Point3 x = point_on_facet(*patches.domain_, facet_, c.ball.center);
    at = Place{x, find_in_the_way(patches, c.triangle, x)};
  }
  return *at;
}

/// The subsegment that hides x from triangle t: of those of the facet that x lies beyond, the one nearest to t. (To split one of
/// the others does nothing about t, and would go on for ever.) If there is none, the first whose diametral ball contains x.
std::optional<Subsegment> FacetPatches::SplitPlan::find_in_the_way(const FacetPatches& patches, const Triangle& t,
                                                                   const Point3& x) const {
  const int axis = patches.domain_->facets()[facet_].axis;
  const Point3 from = patches.centroid_of(t);
  std::pair<double, std::size_t> crossed{std::numeric_limits<double>::infinity(), rim_.size()};
  std::size_t encroached = rim_.size();
  auto sight = Box<2>::around(projected(from, axis));
  sight.add(projected(x, axis));
  rim_tree_.meeting(sight, [&](std::size_t i) {
    const Point3 &a = patches.mesh_->point(rim_[i].a), &b = patches.mesh_->point(rim_[i].b);
    if (orient_projected(a, b, from, axis) != orient_projected(a, b, x, axis) &&
        orient_projected(from, x, a, axis) != orient_projected(from, x, b, axis))
      crossed = std::min(crossed, std::pair(part_of_way(from, x, a, b, axis), i));
    if (in_diametral_ball<3>(a, b, x)) encroached = std::min(encroached, i);
  });
  const std::size_t first = crossed.second < rim_.size() ? crossed.second : encroached;
  if (first == rim_.size()) return std::nullopt;
  return rim_[first];
}

std::vector<FacetPatches::SplitPlan> FacetPatches::plan_splits(
    std::span<const EntityId> facets, const std::function<std::vector<Candidate>(EntityId)>& candidates_of) const {
  return bulk_->gather<SplitPlan>(facets.size(), [&](std::size_t i, std::vector<SplitPlan>& out) {
    std::vector<Candidate> candidates = candidates_of(facets[i]);
    if (!candidates.empty()) out.emplace_back(*this, facets[i], std::move(candidates));
  });
}

Point3 FacetPatches::centroid_of(const Triangle& t) const {
  Point3 c;
  for (int i = 0; i < 3; ++i) c[i] = mesh_->point(t[0])[i] / 3 + mesh_->point(t[1])[i] / 3 + mesh_->point(t[2])[i] / 3;
  return c;
}

/// A vertex that was made inside the facet.
void FacetPatches::add_inner_point(EntityId facet, VertexId v) {
  auto& inner = inner_points_[facet];
  squares_->drop_facet(facet);
  const Home home = mesh_->vertex(v).home;
  const bool own = home.kind() == EntityKind::facet && home.id() == facet;
  // New vertices have larger ids than all before.
  if (!own || (!inner.empty() && v <= inner.back())) throw not_a_plane_graph(*domain_, facet, *mesh_, std::array{v});
  inner.push_back(v);
  changed_.push_back(facet);
  ++points_;
}

/// At x, the triangle's circumcentre; where this is a vertex of the facet already, as in facets that are planar only within
/// rounding, whose triangles need not have empty circles, at the centroid.
VertexId FacetPatches::insert_inside(EntityId facet, const Candidate& c, const Point3& x) {
  const Home home(EntityKind::facet, facet);
  const VertexId v = delaunay_->insert(x, home, c.triangle[0], c.least);
  const auto& inner = inner_points_[facet];
  if (v == no_vertex || !std::binary_search(inner.begin(), inner.end(), v)) return v;
  return delaunay_->insert(point_on_facet(*domain_, facet, centroid_of(c.triangle)), home, c.triangle[0], c.least);
}

/// A triangle that a point of this round has reached already waits for the next.
bool FacetPatches::split_triangles(SplitPlan& plan, const std::function<bool()>& stop) {
  const EntityId facet = plan.facet();
  std::vector<bool> reached(plan.candidates().size(), false);
  const auto reach = [&](VertexId v) { plan.each_reached(mesh_->point(v), [&](std::size_t i) { reached[i] = true; }); };
  if (!plan.is_current(*this)) {
    plan.renew(*this);
    // What other facets have split in this round: to split it once more for a triangle that is gone would go on for ever
    // about a point where segments meet at small angles, each facet halving what its neighbour has just halved.
    for (const EntityId s : domain_->facet_segments(facet))
      for (const auto& link : chains_->chain(s))
        if (chains_->is_new(link)) reach(link.vertex);
  }
  bool any = false;
  for (std::size_t i = 0; i < reached.size(); ++i) {
    if (reached[i]) continue;
    if (stop()) break;
    const Candidate& c = plan.candidates()[i];
    const SplitPlan::Place& at = plan.place(*this, i);
    if (const auto& s = at.in_the_way) {
      if (c.least > 0 && !may_split(*s)) continue;
      const VertexId v = chains_->split(*s, c.least);
      if (v == no_vertex) continue;  // another triangle has asked for it, or it is too near
      reach(v);
      any = true;
    } else if (const VertexId v = insert_inside(facet, c, at.point); v != no_vertex) {
      add_inner_point(facet, v);
      reach(v);
      any = true;
    }
  }
  return any;
}

}  // namespace pgdr::detail
