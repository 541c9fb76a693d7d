// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Facets without small angles get their quality while the mesh is still Delaunay (recovery.hpp says why).
#include <algorithm>
#include <cmath>

#include "boundary/state.hpp"
#include "numbers/rounding.hpp"
#include "numbers/vectors.hpp"

namespace pgdr::detail {
namespace {

constexpr double strips = 4;  // the factor of the bound where segments meet at less than 60 degrees

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

/// For each segment: does it make less than 20 degrees with another one?
std::vector<bool> at_sharp_angle(const Domain<3>& domain) {
  constexpr double squared_cosine = 0.8830222215594890;  // of 20 degrees
  const auto segments = domain.segments();
  const auto points = domain.points();
  std::vector<std::pair<std::uint32_t, EntityId>> by_end;
  for (EntityId s = 0; s < segments.size(); ++s)
    for (const std::uint32_t p : segments[s].points) by_end.push_back({p, s});
  std::sort(by_end.begin(), by_end.end());
  std::vector<bool> sharp(segments.size());
  const auto direction = [&](const std::pair<std::uint32_t, EntityId>& use) {
    const auto& ends = segments[use.second].points;
    return difference(points[ends[0] == use.first ? ends[1] : ends[0]], points[use.first]);
  };
  for (std::size_t i = 0; i < by_end.size(); ++i)
    for (std::size_t j = i + 1; j < by_end.size() && by_end[j].first == by_end[i].first; ++j) {
      const EntityId s = by_end[i].second, t = by_end[j].second;
      if (sharp[s] && sharp[t]) continue;
      const auto u = direction(by_end[i]), v = direction(by_end[j]);
      const double along = dot(u, v);
      if (along > 0 && along * along > squared_cosine * dot(u, u) * dot(v, v)) sharp[s] = sharp[t] = true;
    }
  return sharp;
}

/// For each segment: do all facets there meet at 60 degrees at least?
std::vector<bool> with_wide_ridge(const Domain<3>& domain) {
  const auto segments = domain.segments();
  const auto points = domain.points();
  std::vector<std::pair<std::array<std::uint32_t, 2>, EntityId>> by_ends;
  for (EntityId s = 0; s < segments.size(); ++s)
    by_ends.push_back({sorted_ends(segments[s].points[0], segments[s].points[1]), s});
  std::sort(by_ends.begin(), by_ends.end());
  std::vector<std::vector<Vector<3>>> into(segments.size());  // directions from each segment into its facets
  for (EntityId f = 0; f < domain.facets().size(); ++f)
    for (const auto& t : domain.triangles(f))
      for (int i = 0; i < 3; ++i) {
        const std::uint32_t a = t[i], b = t[(i + 1) % 3];
        const auto ends = sorted_ends(a, b);
        const auto at = std::lower_bound(by_ends.begin(), by_ends.end(), std::pair(ends, EntityId{0}));
        if (at == by_ends.end() || at->first != ends) continue;
        into[at->second].push_back(direction_into(points[a], points[b], points[t[(i + 2) % 3]]));
      }
  std::vector<bool> wide(segments.size(), true);
  for (EntityId s = 0; s < segments.size(); ++s)
    for (std::size_t i = 0; i < into[s].size(); ++i)
      for (std::size_t j = 0; j < i; ++j) wide[s] = wide[s] && dot(into[s][i], into[s][j]) <= 0.5;
  return wide;
}

}  // namespace

/// Finds the factor of each facet, by the least angle that a segment of it makes with another one. It is 0 unless the facets at
/// all of these segments meet at 60 degrees or more, and the facet is plane but for rounding.
void FacetPatches::find_factors() {
  const std::vector<bool> wide = with_wide_ridge(*domain_), sharp = at_sharp_angle(*domain_);
  for (EntityId f = 0; f < triangles_.size(); ++f) {
    double factor = 1;
    for (const EntityId s : domain_->facet_segments(f)) {
      const bool plane = domain_->facets()[f].planarity_defect <= rounding::of_large_plane * domain_->segment_magnitude(s);
      if (!wide[s] || !plane || sharp[s]) factor = 0;
      if (factor == 1 && chains_->at_small_angle(s)) factor = strips;
    }
    factors_of_bound_.push_back(factor);
  }
}

bool FacetPatches::may_split(const Subsegment& s) const {
  return !std::binary_search(fragile_.begin(), fragile_.end(), sorted_ends(s.a, s.b));
}

/// Edges beside which triangles are so flat that a rounded point of the edge would turn them.
void FacetPatches::find_fragile() {
  fragile_.clear();
  for (const auto& triangles : triangles_)
    for (const Triangle& t : triangles)
      for (int i = 0; i < 3; ++i) {
        const VertexId v = t[i], w = t[(i + 1) % 3];
        const Point3 &a = mesh_->point(v), &b = mesh_->point(w), &c = mesh_->point(t[(i + 2) % 3]);
        double magnitude = 0;
        for (int k = 0; k < 3; ++k) magnitude = std::max({magnitude, std::fabs(a[k]), std::fabs(b[k]), std::fabs(c[k])});
        const auto ab = difference(b, a), normal = cross(ab, difference(c, a));
        const double least = rounding::of_fragile_height * magnitude;
        if (dot(normal, normal) < least * least * dot(ab, ab)) fragile_.push_back(sorted_ends(v, w));
      }
  std::sort(fragile_.begin(), fragile_.end());
}

bool FacetPatches::split_poor_triangles(double bound, double min_edge, const std::function<bool()>& stop) {
  if (factors_of_bound_.empty()) find_factors();
  if (std::all_of(factors_of_bound_.begin(), factors_of_bound_.end(), [](double factor) { return factor == 0; })) return false;
  find_fragile();
  bool any = false;
  for (EntityId f = 0; f < triangles_.size(); ++f) {
    const double largest = factors_of_bound_[f] * bound;
    if (largest == 0) continue;
    std::vector<Candidate> poor;
    for (const Triangle& t : triangles_[f]) {
      const Point3 &a = mesh_->point(t[0]), &b = mesh_->point(t[1]), &c = mesh_->point(t[2]);
      const double shortest = std::min({squared_distance(a, b), squared_distance(b, c), squared_distance(c, a)});
      const Ball<3> ball = equatorial_ball(a, b, c);
      if (ball.squared_radius > largest * largest * shortest) poor.push_back({ball, t, std::max(std::sqrt(shortest), min_edge)});
    }
    if (!poor.empty() && !stop()) any = split_triangles(f, std::move(poor), stop) || any;
  }
  return any;
}

}  // namespace pgdr::detail
