// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "openings/loop_planes.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "numbers/double_double.hpp"
#include "numbers/vectors.hpp"
#include "pgdr/predicates.hpp"
#include "space/disjoint_sets.hpp"
#include "space/planar_cdt.hpp"
#include "space/point_places.hpp"

namespace pgdr::detail {
namespace {

/// Twice the area vector (Newell). Sums are kept in twice the digits, so that their order says nothing.
Vector<3> area_vector(const TriangleShapes& shapes, const OpenLoop& loop) {
  DoubleDoubles<3> sum{};
  const Point3 origin = shapes.scaled(loop.points[0]);
  for (std::size_t k = 2; k < loop.points.size(); ++k) {
    const Vector<3> n = cross(difference(shapes.scaled(loop.points[k - 1]), origin),
                              difference(shapes.scaled(loop.points[k]), origin));
    for (std::size_t i = 0; i < 3; ++i) sum[i] = sum[i] + DoubleDouble(n[i]);
  }
  return {sum[0].rounded(), sum[1].rounded(), sum[2].rounded()};
}

/// The triangles inside of the loop, as seen along the axis; none if it crosses or touches itself.
std::vector<PlanarTriangle> triangles_inside(std::span<const Point3> points, const OpenLoop& loop, int axis) {
  std::vector<PlanarEdge> edges;
  for (std::size_t k = 0; k < loop.points.size(); ++k)
    edges.push_back({loop.points[k], loop.points[(k + 1) % loop.points.size()]});
  PlanarTriangulation planar;
  if (!planar.build(points, loop.points, edges, axis)) return {};
  planar.carve_outside();
  return planar.triangles();
}

}  // namespace

LoopPlanes::LoopPlanes(const Domain<3>& domain, std::span<const OpenLoop> loops, const StopCheck& stop)
    : domain_(domain), loops_(loops), scale_(scale_of<3>(domain.points()).first), shapes_(domain.points(), scale_) {
  for (const OpenLoop& loop : loops) {
    stop();
    planes_.push_back(plane_of(loop));
  }
}

std::optional<LoopPlane> LoopPlanes::plane_of(const OpenLoop& loop) const {
  const Vector<3> normal = area_vector(shapes_, loop);
  const int axis = axes_by_size(normal)[0];
  const auto inside = triangles_inside(domain_.points(), loop, axis);
  if (inside.empty()) return std::nullopt;
  LoopPlane plane{axis, std::sqrt(dot(normal, normal)) / 2 / scale_ / scale_, FittedPlane(shapes_.scaled(loop.points[0])),
                  inside[0], Box<3>::around(domain_.points()[loop.points[0]])};
  double most = 0;
  for (const PlanarTriangle& t : inside) {
    const Vector<3> n = shapes_.normal(t);
    plane.fitted.add(shapes_.scaled(t[0]), shapes_.scaled(t[1]), shapes_.scaled(t[2]));
    if (dot(n, n) > most) {
      most = dot(n, n);
      plane.largest = t;
    }
  }
  for (const std::uint32_t v : loop.points) {
    if (!is_in(plane, v)) return std::nullopt;
    plane.box.add(domain_.points()[v]);
  }
  return plane;
}

bool LoopPlanes::is_in(const LoopPlane& plane, std::uint32_t point) const {
  const auto p = domain_.points();
  const auto& [a, b, c] = plane.largest;
  return plane.fitted.distance(shapes_.scaled(point)) <= domain_.tolerance() * scale_ ||
         orient3d(p[a], p[b], p[c], p[point]) == Sign::zero;
}

bool LoopPlanes::is_in(const LoopPlane& plane, const OpenLoop& loop) const {
  return std::ranges::all_of(loop.points, [&](std::uint32_t v) { return is_in(plane, v); });
}

bool LoopPlanes::has(const LoopPlane& leader, std::uint32_t loop) const {
  const Box<3>& box = planes_[loop]->box;
  for (int i = 0; i < 3; ++i)
    if (i != leader.axis && (box.low[i] < leader.box.low[i] || box.high[i] > leader.box.high[i])) return false;
  return is_in(leader, loops_[loop]);
}

std::vector<std::vector<std::uint32_t>> LoopPlanes::groups(const StopCheck& stop) const {
  std::vector<std::uint32_t> by_area;
  for (std::uint32_t l = 0; l < loops_.size(); ++l)
    if (planes_[l]) by_area.push_back(l);
  std::stable_sort(by_area.begin(), by_area.end(),
                   [this](std::uint32_t a, std::uint32_t b) { return planes_[a]->area > planes_[b]->area; });
  DisjointSets sets(loops_.size());
  for (std::size_t i = 0; i < by_area.size(); ++i) {
    stop();
    for (std::size_t k = 0; k < i; ++k)
      if (has(*planes_[by_area[k]], by_area[i])) sets.unite(by_area[k], by_area[i]);
  }
  std::ranges::sort(by_area, {}, [&sets](std::uint32_t l) { return std::pair{sets.find(l), l}; });
  std::vector<std::vector<std::uint32_t>> groups;
  for (const std::uint32_t l : by_area) {
    if (sets.find(l) == l) groups.emplace_back();
    groups.back().push_back(l);
  }
  return groups;
}

}  // namespace pgdr::detail
