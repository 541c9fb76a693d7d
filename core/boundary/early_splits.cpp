// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Facets without small angles get their quality while the mesh is still Delaunay (recovery.hpp says why).
#include <algorithm>
#include <cmath>
#include <functional>
#include <tuple>

#include "boundary/facet_splits.hpp"
#include "boundary/numbers.hpp"
#include "numbers/rounding.hpp"
#include "numbers/vectors.hpp"

namespace pgdr::detail {
namespace {

template <class T>
std::array<T, 2> sorted_ends(T a, T b) {
  return {std::min(a, b), std::max(a, b)};
}

/// The unit vector perpendicular to ab, towards c.
Vector<3> direction_into(const Point3& a, const Point3& b, const Point3& c) {
  const auto along = difference(b, a), up = difference(c, a);
  const double part = dot(up, along) / dot(along, along);
  Vector<3> d;
  for (std::size_t i = 0; i < 3; ++i) d[i] = up[i] - part * along[i];
  const double length = std::sqrt(dot(d, d));
  for (double& x : d) x /= length;
  return d;
}

using Flags = std::vector<std::uint8_t>;  // several threads set different ones

/// For each end of each segment: does it make less than 20 degrees with another one there?
std::vector<std::array<bool, 2>> at_sharp_angle(const Domain<3>& domain, const Bulk& bulk) {
  const auto segments = domain.segments();
  const auto points = domain.points();
  struct Use {
    std::uint32_t point;
    EntityId segment;
    bool operator<(const Use& o) const { return std::pair(point, segment) < std::pair(o.point, o.segment); }
  };
  std::vector<Use> uses = bulk.gather<Use>(segments.size(), [&](std::size_t s, std::vector<Use>& out) {
    for (const std::uint32_t p : segments[s].points) out.push_back({p, static_cast<EntityId>(s)});
  });
  bulk.sort(uses, std::less<>());
  std::vector<std::array<bool, 2>> sharp(segments.size(), {false, false});
  const auto end_of = [&](const Use& use) { return segments[use.segment].points[0] == use.point ? 0 : 1; };
  const auto direction = [&](const Use& use) {
    return difference(points[segments[use.segment].points[1 - end_of(use)]], points[use.point]);
  };
  bulk.each(uses.size(), [&](std::size_t first) {  // of each point
    if (first > 0 && uses[first - 1].point == uses[first].point) return;
    for (std::size_t i = first; i < uses.size() && uses[i].point == uses[first].point; ++i)
      for (std::size_t j = i + 1; j < uses.size() && uses[j].point == uses[first].point; ++j) {
        bool& at_i = sharp[uses[i].segment][end_of(uses[i])];
        bool& at_j = sharp[uses[j].segment][end_of(uses[j])];
        if (at_i && at_j) continue;
        const auto u = direction(uses[i]), v = direction(uses[j]);
        const double along = dot(u, v);
        if (along > 0 && along * along > numbers::early_split_squared_cosine * dot(u, u) * dot(v, v)) at_i = at_j = true;
      }
  });
  return sharp;
}

/// A corner of a triangle of a facet, opposite of a segment.
struct CornerAtSegment {
  EntityId segment, facet;
  std::uint32_t triangle;
  int corner;
};

/// The corners opposite of segments, by segment.
std::vector<CornerAtSegment> corners_at_segments(const Domain<3>& domain, const Bulk& bulk) {
  using Ends = std::pair<std::array<std::uint32_t, 2>, EntityId>;
  std::vector<CornerAtSegment> all = bulk.gather<CornerAtSegment>(domain.facets().size(), [&](std::size_t f, auto& out) {
    const auto facet = static_cast<EntityId>(f);
    std::vector<Ends> by_ends;
    for (const EntityId s : domain.facet_segments(facet))
      by_ends.emplace_back(sorted_ends(domain.segments()[s].points[0], domain.segments()[s].points[1]), s);
    std::sort(by_ends.begin(), by_ends.end());
    const auto triangles = domain.triangles(facet);
    for (std::uint32_t t = 0; t < triangles.size(); ++t)
      for (int i = 0; i < 3; ++i) {
        const auto ends = sorted_ends(triangles[t][(i + 1) % 3], triangles[t][(i + 2) % 3]);
        const auto at = std::lower_bound(by_ends.begin(), by_ends.end(), Ends(ends, 0));
        if (at != by_ends.end() && at->first == ends) out.push_back({at->second, facet, t, i});
      }
  });
  bulk.sort(all, [](const CornerAtSegment& a, const CornerAtSegment& b) {
    return std::tuple(a.segment, a.facet, a.triangle, a.corner) < std::tuple(b.segment, b.facet, b.triangle, b.corner);
  });
  return all;
}

/// For each segment: do all facets there meet at 60 degrees at least?
Flags with_wide_ridge(const Domain<3>& domain, const Bulk& bulk) {
  const auto points = domain.points();
  const std::vector<CornerAtSegment> corners = corners_at_segments(domain, bulk);
  const auto direction = [&](const CornerAtSegment& c) {
    const auto& t = domain.triangles(c.facet)[c.triangle];
    return direction_into(points[t[(c.corner + 1) % 3]], points[t[(c.corner + 2) % 3]], points[t[c.corner]]);
  };
  Flags wide(domain.segments().size(), true);
  bulk.each(corners.size(), [&](std::size_t first) {  // of each segment
    const EntityId s = corners[first].segment;
    if (first > 0 && corners[first - 1].segment == s) return;
    std::vector<Vector<3>> into;
    for (std::size_t i = first; i < corners.size() && corners[i].segment == s; ++i) into.push_back(direction(corners[i]));
    for (std::size_t i = 0; i < into.size(); ++i)
      for (std::size_t j = 0; j < i; ++j) wide[s] = wide[s] && dot(into[i], into[j]) <= 0.5;
  });
  return wide;
}

}  // namespace

/// Finds the facets whose triangles are split early: those plane but for rounding, at all of whose segments facets meet at 60
/// degrees or more, and none of whose segments makes less than 20 degrees with another one.
void FacetPatches::find_calm_facets() {
  const Flags wide = with_wide_ridge(*domain_, *bulk_);
  const std::vector<std::array<bool, 2>> sharp = at_sharp_angle(*domain_, *bulk_);
  is_calm_.resize(triangles_.size());
  bulk_->each(triangles_.size(), [&](std::size_t i) {
    const auto f = static_cast<EntityId>(i);
    const auto segments = domain_->facet_segments(f);
    is_calm_[f] = std::all_of(segments.begin(), segments.end(), [&](EntityId s) {
      const bool plane = domain_->facets()[f].planarity_defect <= rounding::of_large_plane * domain_->segment_magnitude(s);
      return wide[s] && plane && !sharp[s][0] && !sharp[s][1];
    });
  });
}

bool FacetPatches::may_split(const Subsegment& s) const {
  return !std::binary_search(fragile_.begin(), fragile_.end(), sorted_ends(s.a, s.b));
}

/// Edges beside which triangles are so flat that a rounded point of the edge would turn them.
void FacetPatches::find_fragile() {
  using Edge = std::array<VertexId, 2>;
  fragile_ = bulk_->gather<Edge>(triangles_.size(), [this](std::size_t f, std::vector<Edge>& out) {
    for (const Triangle& t : triangles_[f])
      for (int i = 0; i < 3; ++i) {
        const VertexId v = t[i], w = t[(i + 1) % 3];
        const Point3 &a = mesh_->point(v), &b = mesh_->point(w), &c = mesh_->point(t[(i + 2) % 3]);
        double magnitude = 0;
        for (int k = 0; k < 3; ++k) magnitude = std::max({magnitude, std::fabs(a[k]), std::fabs(b[k]), std::fabs(c[k])});
        const auto ab = difference(b, a), normal = cross(ab, difference(c, a));
        const double least = rounding::of_fragile_height * magnitude;
        if (dot(normal, normal) < least * least * dot(ab, ab)) out.push_back(sorted_ends(v, w));
      }
  });
  bulk_->sort(fragile_, std::less<>());
}

/// The triangles of the facet that are over its bound.
auto FacetPatches::poor_triangles(EntityId facet, double bound, double min_edge) const -> std::vector<Candidate> {
  std::vector<Candidate> poor;
  for (const Triangle& t : triangles_[facet]) {
    const Point3 &a = mesh_->point(t[0]), &b = mesh_->point(t[1]), &c = mesh_->point(t[2]);
    const double shortest = std::min({squared_distance(a, b), squared_distance(b, c), squared_distance(c, a)});
    const Ball<3> ball = equatorial_ball(a, b, c);
    if (ball.squared_radius > bound * bound * shortest) poor.push_back({ball, t, std::max(std::sqrt(shortest), min_edge)});
  }
  return poor;
}

bool FacetPatches::split_poor_triangles(double bound, double min_edge, const std::function<bool()>& stop) {
  if (is_calm_.empty()) find_calm_facets();
  const std::vector<EntityId> facets = bulk_->gather<EntityId>(triangles_.size(),
                                                               [this](std::size_t f, std::vector<EntityId>& out) {
                                                                 if (is_calm_[f]) out.push_back(static_cast<EntityId>(f));
                                                               });
  if (facets.empty()) return false;
  std::vector<SplitPlan> poor = plan_splits(facets, [&](EntityId f) { return poor_triangles(f, bound, min_edge); });
  if (poor.empty()) return false;
  find_fragile();
  bool any = false;
  for (SplitPlan& plan : poor)
    if (!stop()) any = split_triangles(plan, stop) || any;
  return any;
}

}  // namespace pgdr::detail
