// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "input/steps/coplanar_groups.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "numbers/vectors.hpp"

namespace pgdr::detail {
namespace {

/// The plane of triangles, in coordinates of at most 1. The first one added should not be thin.
class FittedPlane {
 public:
  explicit FittedPlane(const Point3& origin) : origin_(origin) {}

  /// @param normal  (b - a) x (c - a), to either side.
  void add(const Point3& a, const Point3& b, const Point3& c, Vector<3> normal) {
    if (dot(normal, normal_) < 0)
      for (double& x : normal) x = -x;
    const double weight = std::sqrt(dot(normal, normal));
    weight_ += weight;
    for (int i = 0; i < 3; ++i) {
      const auto k = static_cast<std::size_t>(i);
      normal_[k] += normal[k];
      centre_[k] += weight / 3 * ((a[i] - origin_[i]) + (b[i] - origin_[i]) + (c[i] - origin_[i]));
    }
  }
  bool holds(const Point3& p, double tolerance) const {
    Vector<3> d;
    for (int i = 0; i < 3; ++i) {
      const auto k = static_cast<std::size_t>(i);
      d[k] = (p[i] - origin_[i]) - centre_[k] / weight_;
    }
    return std::fabs(dot(d, normal_)) <= tolerance * std::sqrt(dot(normal_, normal_));
  }

 private:
  Point3 origin_;
  Vector<3> normal_{}, centre_{};
  double weight_ = 0;
};

}  // namespace

CoplanarGroups::CoplanarGroups(const BuildInput<3>& in, FacetTriangles& faces, const EdgeUses& uses)
    : in_(in),
      shapes_(in.points, in.scale),
      faces_(faces),
      uses_(uses),
      joints_(in, faces),
      state_(faces.facets.size(), State::ungrouped),
      root_(faces.facets.size()) {
  std::iota(root_.begin(), root_.end(), 0u);
  find_joints();
  std::vector<std::pair<double, std::uint32_t>> seeds;  // largest first: minus its size
  for (std::uint32_t f = 0; f < faces_.facets.size(); ++f)
    if (at_begin_[f] != at_begin_[f + 1]) seeds.emplace_back(-largest_triangle(f).second, f);
  std::sort(seeds.begin(), seeds.end());
  for (const auto& [size, f] : seeds)
    if (state_[f] == State::ungrouped) {
      in_.stop();
      grow_plane(f);
    }
}

std::vector<bool> CoplanarGroups::find_soft_edges() const {
  std::vector<bool> soft(uses_.size(), false);
  uses_.each_edge([&](std::size_t begin, std::span<const EdgeUse> uses) {
    in_.stop();
    if (!joints_.is_joint(uses)) return;
    const std::uint32_t f = uses[0].owner, g = uses[1].owner;
    soft[begin] = f == g || (root_[f] == root_[g] && joints_.opens(uses, faces_.facets[root_[f]].axis));
  });
  return soft;
}

/// The joints between different facets, of each of these.
void CoplanarGroups::find_joints() {
  const auto each = [&](auto&& visit) {
    uses_.each_edge([&](std::size_t begin, std::span<const EdgeUse> uses) {
      if (uses.size() >= 2 && uses[0].owner != uses[1].owner && joints_.is_joint(uses)) visit(static_cast<std::uint32_t>(begin));
    });
  };
  at_begin_.assign(faces_.facets.size() + 1, 0);
  each([&](std::uint32_t begin) {
    for (const std::size_t k : {0, 1}) ++at_begin_[uses_[begin + k].owner + 1];
  });
  for (std::size_t f = 1; f < at_begin_.size(); ++f) at_begin_[f] += at_begin_[f - 1];
  at_.resize(at_begin_.back());
  std::vector<std::uint32_t> next(at_begin_);
  each([&](std::uint32_t begin) {
    for (const std::size_t k : {0, 1}) at_[next[uses_[begin + k].owner]++] = begin;
  });
}

/// A facet's triangle of the longest normal, and this length.
std::pair<std::uint32_t, double> CoplanarGroups::largest_triangle(std::uint32_t f) const {
  const TriangulatedFacet& facet = faces_.facets[f];
  std::pair<std::uint32_t, double> largest{facet.first, -1};
  for (std::uint32_t t = facet.first; t < facet.first + facet.count; ++t) {
    const auto n = shapes_.normal(faces_.triangles[t]);
    if (const double size = std::sqrt(dot(n, n)); size > largest.second) largest = {t, size};
  }
  return largest;
}

// Facets that are reached by exactly coplanar ones alone are taken as they are, whatever the doubles of the fit say.
void CoplanarGroups::grow_plane(std::uint32_t seed) {
  const PlanarTriangle& first = faces_.triangles[largest_triangle(seed).first];
  const int axis = axes_by_size(shapes_.normal(first))[0];
  FittedPlane plane(shapes_.scaled(first[0]));
  const auto add = [&](std::uint32_t f) {
    for (const PlanarTriangle& t : faces_.of(faces_.facets[f]))
      plane.add(shapes_.scaled(t[0]), shapes_.scaled(t[1]), shapes_.scaled(t[2]), shapes_.normal(t));
  };
  const auto held = [&](std::uint32_t f) {
    for (const PlanarTriangle& t : faces_.of(faces_.facets[f]))
      for (const std::uint32_t v : t)
        if (!plane.holds(shapes_.scaled(v), in_.tolerance * in_.scale)) return false;
    return true;
  };

  std::vector<std::uint32_t> group{seed};
  state_[seed] = State::exactly;
  add(seed);
  bool all_exact = true;
  for (std::size_t k = 0; k < group.size(); ++k)
    for (std::uint32_t j = at_begin_[group[k]]; j < at_begin_[group[k] + 1]; ++j) {
      const auto joint = uses_.all().subspan(at_[j], 2);
      const std::uint32_t g = joint[0].owner == group[k] ? joint[1].owner : joint[0].owner;
      if (state_[g] != State::ungrouped || !joints_.opens(joint, axis)) continue;
      const bool flat = state_[group[k]] == State::exactly && joints_.is_flat(joint);
      if (!flat && !held(g)) continue;
      state_[g] = flat ? State::exactly : State::nearly;
      all_exact &= flat;
      add(g);
      group.push_back(g);
    }
  const std::uint32_t root = *std::min_element(group.begin(), group.end());
  for (const std::uint32_t f : group) root_[f] = root;
  if (group.size() == 1) return;
  faces_.facets[root].axis = axis;
  faces_.facets[root].planar &= all_exact;
}

}  // namespace pgdr::detail
