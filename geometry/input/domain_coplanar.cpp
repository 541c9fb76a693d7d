// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Continues the third step of a Domain (3D): which facets become one. Two that meet at an edge of just these two, with
// equal markers, on different sides of it in their projection, are one if they are exactly coplanar; or if all points of
// both lie in one plane up to Plc::precision. A planar face of triangles that was turned, or printed with so many
// digits, is planar no more; every edge between its triangles would be a segment, at small angles with its neighbours
// wherever the triangles are long and thin.
//
// A pair of triangles does not say whether they are coplanar so far: the plane of a thin one may be any. So planes grow,
// from the largest triangle on: the plane is fitted to what it has (the sum of the normals, through the centre of area),
// and takes what has all its points within the tolerance of it.
#include <algorithm>
#include <cmath>
#include <numeric>

#include "input/domain_builder.hpp"
#include "numbers/vectors.hpp"
#include "pgdr/predicates.hpp"

namespace pgdr {
using detail::dot;
using detail::EdgeUse;

namespace {

using Triangle = std::array<std::uint32_t, 3>;
using Vector = detail::Vector<3>;

/// The plane of triangles, in coordinates of at most 1. The first one added should not be thin.
class FittedPlane {
 public:
  explicit FittedPlane(const Point3& origin) : origin_(origin) {}

  /// @param normal  (b - a) x (c - a), to either side.
  void add(const Point3& a, const Point3& b, const Point3& c, Vector normal) {
    if (dot(normal, normal_) < 0)
      for (double& x : normal) x = -x;
    const double weight = std::sqrt(dot(normal, normal));
    weight_ += weight;
    for (int i = 0; i < 3; ++i) {
      const auto k = static_cast<std::size_t>(i);
      normal_[k] += normal[k];
      centre_[k] += weight / 3 * ((a[i] - origin_[i]) + (b[i] - origin_[i]) + (c[i] - origin_[i]));
      for (const Point3* p : {&a, &b, &c}) magnitude_ = std::max(magnitude_, std::fabs((*p)[i]));
    }
  }
  bool holds(const Point3& p, double precision) const {
    Vector d;
    double magnitude = magnitude_;
    for (int i = 0; i < 3; ++i) {
      const auto k = static_cast<std::size_t>(i);
      d[k] = (p[i] - origin_[i]) - centre_[k] / weight_;
      magnitude = std::max(magnitude, std::fabs(p[i]));
    }
    return std::fabs(dot(d, normal_)) <= precision * magnitude * std::sqrt(dot(normal_, normal_));
  }

 private:
  Point3 origin_;
  Vector normal_{}, centre_{};
  double weight_ = 0, magnitude_ = 0;
};

}  // namespace

// The uses of one edge: two triangles, and nothing but the polygons of these.
template <int D>
bool DomainBuilder<D>::is_joint(std::span<const EdgeUse> uses) const requires(D == 3) {
  using Kind = EdgeUse::Kind;
  if (uses.size() < 2 || !uses[1].is_triangle()) return false;
  const EdgeUse &a = uses[0], &b = uses[1];
  // Both are planar parts of one bent polygon, of which an edge that is drawn inside of it is a segment.
  const bool within_facet = a.owner != b.owner && facets_[a.owner].input == facets_[b.owner].input;
  for (const EdgeUse& use : uses.subspan(2))
    if (use.kind != Kind::polygon || within_facet ||
        (use.owner != a.owner && use.owner != b.owner && !facets_[use.owner].mixed))
      return false;
  if (a.owner == b.owner) return a.kind == Kind::diagonal && b.kind == Kind::diagonal;
  return plc_.facets[facets_[a.owner].input].marker == plc_.facets[facets_[b.owner].input].marker;
}

/// Whether the triangles of a joint are on different sides of its edge, in this projection.
template <int D>
bool DomainBuilder<D>::opens(std::span<const EdgeUse> joint, int axis) const requires(D == 3) {
  const auto [p0, p1, c, d] = corners(joint);
  const Sign side = orient_projected(p0, p1, c, axis);
  return side != Sign::zero && side == -orient_projected(p0, p1, d, axis);
}

template <int D>
bool DomainBuilder<D>::is_flat(std::span<const EdgeUse> joint) const requires(D == 3) {
  if (!facets_[joint[0].owner].planar || !facets_[joint[1].owner].planar) return false;
  const auto [p0, p1, c, d] = corners(joint);
  return orient3d(p0, p1, c, d) == Sign::zero;
}

/// The ends of a joint's edge, and the corners opposite it.
template <int D>
std::array<Point<D>, 4> DomainBuilder<D>::corners(std::span<const EdgeUse> joint) const requires(D == 3) {
  const detail::PlanarEdge e = detail::edge_of(joint[0].key);
  const auto apex = [&](const EdgeUse& use) {
    const Triangle& t = triangles_[use.triangle];
    return t[0] ^ t[1] ^ t[2] ^ e[0] ^ e[1];
  };
  const auto& p = out_.points_;
  return {p[e[0]], p[e[1]], p[apex(joint[0])], p[apex(joint[1])]};
}

template <int D>
bool DomainBuilder<D>::is_soft(std::span<const EdgeUse> uses) const requires(D == 3) {
  if (!is_joint(uses)) return false;
  return uses[0].owner == uses[1].owner || (is_flat(uses) && opens(uses, facets_[uses[0].owner].axis));
}

template <int D>
void DomainBuilder<D>::group_coplanar() requires(D == 3) {
  parent_.resize(facets_.size());
  std::iota(parent_.begin(), parent_.end(), 0u);
  grouped_.assign(facets_.size(), 0);
  find_joints();

  std::vector<std::pair<double, std::uint32_t>> seeds;  // largest first: minus its size
  for (std::uint32_t f = 0; f < facets_.size(); ++f)
    if (joint_begin_[f] != joint_begin_[f + 1]) seeds.emplace_back(-largest_triangle(f).second, f);
  std::sort(seeds.begin(), seeds.end());
  for (const auto& [size, f] : seeds)
    if (grouped_[f] == 0) {
      stop_check_();
      grow_plane(f);
    }

  for (std::size_t begin = 0, end; begin < uses_.size(); begin = end) {
    stop_check_();
    end = begin + uses_of(begin);
    const auto uses = std::span(uses_).subspan(begin, end - begin);
    if (!is_joint(uses)) continue;
    const std::uint32_t f = uses[0].owner, g = uses[1].owner;
    soft_[begin] = f == g || (root(f) == root(g) && opens(uses, facets_[root(f)].axis));
  }
}

/// The joints between different facets, of each of these.
template <int D>
void DomainBuilder<D>::find_joints() requires(D == 3) {
  const auto each = [&](auto&& visit) {
    for (std::size_t begin = 0, end; begin < uses_.size(); begin = end) {
      end = begin + uses_of(begin);
      if (end - begin >= 2 && uses_[begin].owner != uses_[begin + 1].owner &&
          is_joint(std::span(uses_).subspan(begin, end - begin)))
        visit(static_cast<std::uint32_t>(begin));
    }
  };
  joint_begin_.assign(facets_.size() + 1, 0);
  each([&](std::uint32_t begin) {
    for (const std::size_t k : {0, 1}) ++joint_begin_[uses_[begin + k].owner + 1];
  });
  for (std::size_t f = 1; f < joint_begin_.size(); ++f) joint_begin_[f] += joint_begin_[f - 1];
  joints_.resize(joint_begin_.back());
  std::vector<std::uint32_t> next(joint_begin_);
  each([&](std::uint32_t begin) {
    for (const std::size_t k : {0, 1}) joints_[next[uses_[begin + k].owner]++] = begin;
  });
}

/// A facet's triangle of the longest normal, and this length.
template <int D>
std::pair<std::uint32_t, double> DomainBuilder<D>::largest_triangle(std::uint32_t f) const requires(D == 3) {
  std::pair<std::uint32_t, double> largest{facets_[f].first, -1};
  for (std::uint32_t t = facets_[f].first; t < facets_[f].first + facets_[f].count; ++t) {
    const auto n = normal(triangles_[t]);
    if (const double size = std::sqrt(dot(n, n)); size > largest.second) largest = {t, size};
  }
  return largest;
}

// Facets that are reached by exactly coplanar ones alone are taken as they are, whatever the doubles of the fit say.
template <int D>
void DomainBuilder<D>::grow_plane(std::uint32_t seed) requires(D == 3) {
  enum : std::uint8_t { none, exact, near };
  const auto scaled = [&](std::uint32_t v) {
    Point3 p = out_.points_[v];
    for (double& x : p.x) x *= scale_;
    return p;
  };
  const auto [first, size] = largest_triangle(seed);
  const int axis = detail::axes_by_size(normal(triangles_[first]))[0];
  FittedPlane plane(scaled(triangles_[first][0]));
  const auto add = [&](std::uint32_t f) {
    for (std::uint32_t t = facets_[f].first; t < facets_[f].first + facets_[f].count; ++t) {
      const auto& [a, b, c] = triangles_[t];
      plane.add(scaled(a), scaled(b), scaled(c), normal(triangles_[t]));
    }
  };
  const auto held = [&](std::uint32_t f) {
    for (std::uint32_t t = facets_[f].first; t < facets_[f].first + facets_[f].count; ++t)
      for (const std::uint32_t v : triangles_[t])
        if (!plane.holds(scaled(v), plc_.precision)) return false;
    return true;
  };

  std::vector<std::uint32_t> group{seed};
  grouped_[seed] = exact;
  add(seed);
  bool all_exact = true;
  for (std::size_t k = 0; k < group.size(); ++k)
    for (std::uint32_t j = joint_begin_[group[k]]; j < joint_begin_[group[k] + 1]; ++j) {
      const auto joint = std::span<const EdgeUse>(uses_).subspan(joints_[j], 2);
      const std::uint32_t g = joint[0].owner == group[k] ? joint[1].owner : joint[0].owner;
      if (grouped_[g] != none || !opens(joint, axis)) continue;
      const bool flat = grouped_[group[k]] == exact && is_flat(joint);
      if (!flat && !held(g)) continue;
      grouped_[g] = flat ? exact : near;
      all_exact &= flat;
      add(g);
      group.push_back(g);
    }
  const std::uint32_t root = *std::min_element(group.begin(), group.end());
  for (const std::uint32_t f : group) parent_[f] = root;
  if (group.size() == 1) return;
  facets_[root].axis = axis;
  facets_[root].planar &= all_exact;
}

template void DomainBuilder<3>::group_coplanar();
template bool DomainBuilder<3>::is_soft(std::span<const EdgeUse>) const;
template bool DomainBuilder<3>::is_joint(std::span<const EdgeUse>) const;
template bool DomainBuilder<3>::opens(std::span<const EdgeUse>, int) const;
template std::array<Point3, 4> DomainBuilder<3>::corners(std::span<const EdgeUse>) const;

}  // namespace pgdr
