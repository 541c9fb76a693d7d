// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// A quick look at whether it is worth while to join what is near (domain_near.cpp): one tree over the pieces of an input, and its
// points looked up in that.
#include <algorithm>
#include <cmath>

#include "detail/box_tree.hpp"
#include "detail/vectors.hpp"
#include "pgdr/domain.hpp"

namespace pgdr {
namespace {

using Corners = std::array<std::uint32_t, 3>;  // no_entity: as many as there are

/// Triangles, then segments of no triangle, then points of neither.
std::vector<Corners> pieces_of(const Domain<3>& domain) {
  std::vector<Corners> pieces;
  std::vector<bool> used(domain.points().size());
  for (EntityId f = 0; f < domain.facets().size(); ++f)
    for (const auto& t : domain.triangles(f)) pieces.push_back(t);
  for (EntityId s = 0; s < domain.segments().size(); ++s)
    if (domain.facets_of_segment(s).empty()) pieces.push_back({domain.segments()[s].points[0], domain.segments()[s].points[1], no_entity});
  for (const Corners& piece : pieces)
    for (const std::uint32_t v : piece)
      if (v != no_entity) used[v] = true;
  for (std::uint32_t v = 0; v < used.size(); ++v)
    if (!used[v]) pieces.push_back({v, no_entity, no_entity});
  return pieces;
}

double squared_distance_to_edge(const Point3& p, const Point3& a, const Point3& b) {
  const auto along = detail::difference(b, a), to = detail::difference(p, a);
  const double square = detail::dot(along, along);
  const double t = square > 0 ? std::clamp(detail::dot(to, along) / square, 0.0, 1.0) : 0;
  double sum = 0;
  for (std::size_t k = 0; k < 3; ++k) sum += (to[k] - t * along[k]) * (to[k] - t * along[k]);
  return sum;
}

/// Is p within `width` of the inside of the triangle, looked at along its normal?
bool is_over(const Point3& p, const Point3& a, const Point3& b, const Point3& c, double width) {
  const auto n = detail::cross(detail::difference(b, a), detail::difference(c, a));
  const double height = detail::dot(n, detail::difference(p, a));
  if (!(height * height <= width * width * detail::dot(n, n))) return false;
  const auto is_inside = [&](const Point3& u, const Point3& v) {
    return detail::dot(detail::cross(detail::difference(v, u), detail::difference(p, u)), n) >= 0;
  };
  return is_inside(a, b) && is_inside(b, c) && is_inside(c, a);
}

}  // namespace

bool may_join(const Domain<3>& domain, double within) {
  double largest = 0;
  for (const Point3& p : domain.points())
    for (const double x : p.x) largest = std::max(largest, std::fabs(x));
  if (!(largest > 0)) return true;
  // In units that neither overflow nor underflow.
  const int exponent = std::clamp(std::ilogb(largest), -1000, 1000);
  std::vector<Point3> points(domain.points().begin(), domain.points().end());
  for (Point3& p : points)
    for (double& x : p.x) x = std::ldexp(x, -exponent);
  const double width = 2 * within * std::ldexp(largest, -exponent);  // for the rounding here
  for (const DomainSegment& s : domain.segments())
    if (squared_distance_to_edge(points[s.points[0]], points[s.points[1]], points[s.points[1]]) <= width * width) return true;

  const std::vector<Corners> pieces = pieces_of(domain);
  std::vector<detail::Box<3>> boxes;
  boxes.reserve(pieces.size());
  for (const Corners& piece : pieces) {
    auto box = detail::Box<3>::around(points[piece[0]]);
    for (const std::uint32_t v : piece)
      if (v != no_entity) box.add(points[v]);
    for (int k = 0; k < 3; ++k) {
      box.low[k] -= width;
      box.high[k] += width;
    }
    boxes.push_back(box);
  }
  const detail::BoxTree<3> tree(boxes);
  bool found = false;
  for (std::uint32_t v = 0; v < points.size() && !found; ++v)
    tree.at(points[v], [&](std::uint32_t i) {
      const auto& [a, b, c] = pieces[i];
      if (found || v == a || v == b || v == c) return;
      const Point3& p = points[v];
      const bool has_edge = b != no_entity, has_side = c != no_entity;
      const auto is_at = [&](std::uint32_t u, std::uint32_t w) { return squared_distance_to_edge(p, points[u], points[w]) <= width * width; };
      found = has_side ? is_at(a, b) || is_at(b, c) || is_at(c, a) || is_over(p, points[a], points[b], points[c], width) : is_at(a, has_edge ? b : a);
    });
  return found;
}

}  // namespace pgdr
