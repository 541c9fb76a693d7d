// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "pgdr/sharp_corners.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "detail/vectors.hpp"

namespace pgdr {
namespace {

constexpr double rounding = 1e-9;  // of angles, in radians

/// By the half angle (Kahan): exact to rounding near 0 as well, where the arc cosine loses half of its digits.
template <std::size_t N>
double angle_between(const std::array<double, N>& u, const std::array<double, N>& v) {
  const double lu = std::sqrt(detail::dot(u, u)), lv = std::sqrt(detail::dot(v, v));
  double apart = 0, together = 0;
  for (std::size_t k = 0; k < N; ++k) {
    apart += std::pow(u[k] / lu - v[k] / lv, 2);
    together += std::pow(u[k] / lu + v[k] / lv, 2);
  }
  return 2 * std::atan2(std::sqrt(apart), std::sqrt(together));
}

}  // namespace

template <int D>
SharpCorners<D>::SharpCorners(const Domain<D>& domain, double radius_edge_bound)
    : domain_(&domain), sine_(0.5 / radius_edge_bound) {
  std::map<std::pair<std::uint32_t, EntityId>, std::vector<EntityId>> segments_at;  // by point and facet
  for (EntityId s = 0; s < domain.segments().size(); ++s)
    for (const std::uint32_t p : domain.segments()[s].points) {
      if constexpr (D == 2) {
        segments_at[{p, no_entity}].push_back(s);
      } else {
        for (const EntityId f : domain.facets_of_segment(s)) segments_at[{p, f}].push_back(s);
      }
    }
  for (const auto& [place, segments] : segments_at) add_corners(place.first, place.second, segments);
}

template <int D>
void SharpCorners<D>::add_corners(std::uint32_t point, EntityId facet, const std::vector<EntityId>& segments) {
  const auto direction = [&](EntityId s) {
    const auto& ends = domain_->segments()[s].points;
    return detail::difference<D>(domain_->points()[ends[0] == point ? ends[1] : ends[0]], domain_->points()[point]);
  };
  for (std::size_t i = 0; i < segments.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      const Direction u = direction(segments[i]), v = direction(segments[j]);
      const double angle = angle_between(u, v);
      if (!(std::cos(angle) > 0 && std::sin(angle) < sine_)) continue;
      corners_[point].push_back({facet, {u, v}, angle});
    }
}

/// Between its sides, or on one.
template <int D>
bool SharpCorners<D>::is_in_corner(const Corner& corner, const Point<D>& at, const Point<D>& x) const {
  const Direction d = detail::difference<D>(x, at);
  return angle_between(d, corner.sides[0]) + angle_between(d, corner.sides[1]) <= corner.angle + rounding;
}

template <int D>
bool SharpCorners<D>::has_corner(const Mesh<D>& mesh, VertexId at, std::array<VertexId, 2> others, EntityId facet) const {
  const Home home = mesh.vertex(at).home;
  if (home.kind() != EntityKind::vertex) return false;
  const auto corners = corners_.find(home.id());
  if (corners == corners_.end()) return false;
  const Point<D>& p = mesh.point(at);
  return std::any_of(corners->second.begin(), corners->second.end(), [&](const Corner& corner) {
    return corner.facet == facet && is_in_corner(corner, p, mesh.point(others[0])) &&
           is_in_corner(corner, p, mesh.point(others[1]));
  });
}

template <int D>
bool SharpCorners<D>::meets(const Mesh<D>& mesh, CellId c) const {
  const auto& v = mesh.cell(c).vertices;
  const auto triangle_meets = [&](const std::array<VertexId, 3>& t, EntityId facet) {
    for (std::size_t i = 0; i < 3; ++i)
      if (has_corner(mesh, t[i], {t[(i + 1) % 3], t[(i + 2) % 3]}, facet)) return true;
    return false;
  };
  if constexpr (D == 2) {
    return triangle_meets(v, no_entity);
  } else {
    const auto* constraints = mesh.constraints(c);
    for (int f = 0; constraints && f <= D; ++f) {
      const auto& corners = face_corners<D>[f];
      if ((constraints->faces >> f & 1) &&
          triangle_meets({v[corners[0]], v[corners[1]], v[corners[2]]}, constraints->face_entity[f]))
        return true;
    }
    return false;
  }
}

template class SharpCorners<2>;
template class SharpCorners<3>;

}  // namespace pgdr
