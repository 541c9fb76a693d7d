// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Facets without small angles get their quality while the mesh is still Delaunay (recovery.hpp says why).
#include <algorithm>
#include <cmath>

#include "detail/recovery_state.hpp"
#include "detail/vectors.hpp"

namespace pgdr::detail {
namespace {

template <class T>
std::array<T, 2> sorted_ends(T a, T b) {
  return {std::min(a, b), std::max(a, b)};
}

/// Of length one, square to ab, towards c.
Vector<3> direction_into(const Point3& a, const Point3& b, const Point3& c) {
  const auto along = difference(b, a), up = difference(c, a);
  const double part = dot(up, along) / dot(along, along);
  Vector<3> d;
  for (std::size_t i = 0; i < 3; ++i) d[i] = up[i] - part * along[i];
  const double length = std::sqrt(dot(d, d));
  for (double& x : d) x /= length;
  return d;
}

}  // namespace

/// No segment of a calm facet makes less than 60 degrees with another segment, nor do two facets there; and it is plane but
/// for rounding.
void FacetPatches::find_calm() {
  const auto segments = domain_->segments();
  std::vector<std::pair<std::array<std::uint32_t, 2>, EntityId>> by_ends;
  for (EntityId s = 0; s < segments.size(); ++s) by_ends.push_back({sorted_ends(segments[s].points[0], segments[s].points[1]), s});
  std::sort(by_ends.begin(), by_ends.end());
  std::vector<std::vector<Vector<3>>> into(segments.size());  // directions from each segment into its facets
  for (EntityId f = 0; f < triangles_.size(); ++f)
    for (const auto& t : domain_->triangles(f))
      for (int i = 0; i < 3; ++i) {
        const std::uint32_t a = t[i], b = t[(i + 1) % 3];
        const auto ends = sorted_ends(a, b);
        const auto at = std::lower_bound(by_ends.begin(), by_ends.end(), std::pair(ends, EntityId{0}));
        if (at == by_ends.end() || at->first != ends) continue;
        const auto points = domain_->points();
        into[at->second].push_back(direction_into(points[a], points[b], points[t[(i + 2) % 3]]));
      }
  std::vector<bool> wide(segments.size());
  for (EntityId s = 0; s < segments.size(); ++s) {
    wide[s] = !chains_->at_small_angle(s);
    for (std::size_t i = 0; i < into[s].size(); ++i)
      for (std::size_t j = 0; j < i; ++j) wide[s] = wide[s] && dot(into[s][i], into[s][j]) <= 0.5;
  }
  for (EntityId f = 0; f < triangles_.size(); ++f) {
    const auto own = domain_->facet_segments(f);
    calm_.push_back(std::all_of(own.begin(), own.end(), [&](EntityId s) {
      return wide[s] && domain_->facets()[f].planarity_defect <= 0x1p-44 * domain_->segment_magnitude(s);
    }));
  }
}

bool FacetPatches::may_split(const Subsegment& s) const {
  return !std::binary_search(fragile_.begin(), fragile_.end(), sorted_ends(s.a, s.b));
}

/// A rounded point of an edge is off it by some 2^-50 of the coordinates.
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
        const double least = 0x1p-36 * magnitude;
        if (dot(normal, normal) < least * least * dot(ab, ab)) fragile_.push_back(sorted_ends(v, w));
      }
  std::sort(fragile_.begin(), fragile_.end());
}

bool FacetPatches::improve_once(double bound, double min_edge, const std::function<bool()>& stop) {
  if (calm_.empty()) find_calm();
  if (std::find(calm_.begin(), calm_.end(), true) == calm_.end()) return false;
  find_fragile();
  bool any = false;
  for (EntityId f = 0; f < triangles_.size(); ++f) {
    if (!calm_[f]) continue;
    std::vector<Candidate> poor;
    for (const Triangle& t : triangles_[f]) {
      const Point3 &a = mesh_->point(t[0]), &b = mesh_->point(t[1]), &c = mesh_->point(t[2]);
      const double shortest = std::min({squared_distance(a, b), squared_distance(b, c), squared_distance(c, a)});
      const Ball<3> ball = equatorial_ball(a, b, c);
      if (ball.squared_radius > bound * bound * shortest) poor.push_back({ball, t, std::max(std::sqrt(shortest), min_edge)});
    }
    if (!poor.empty() && !stop()) any = split_triangles(f, std::move(poor)) || any;
  }
  return any;
}

}  // namespace pgdr::detail
