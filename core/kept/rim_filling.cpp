// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "kept/rim_filling.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "kept/numbers.hpp"
#include "numbers/vectors.hpp"
#include "pgdr/predicates.hpp"
#include "space/make_set.hpp"
#include "space/planar_cdt.hpp"

namespace pgdr {
namespace {

/// Of the largest of the triangles, of length one; zero if there is none of an area.
std::array<double, 3> unit_normal_of(const Mesh<3>& mesh, std::span<const VertexParts::Triangle> triangles) {
  std::array<double, 3> best{};
  double largest = 0;
  for (const auto& t : triangles) {
    const auto p = mesh.points(t.corners);
    const auto n = detail::cross(detail::difference<3>(p[1], p[0]), detail::difference<3>(p[2], p[0]));
    const double square = detail::dot(n, n);
    if (!(square > largest)) continue;
    largest = square;
    const double length = std::sqrt(square);
    best = {n[0] / length, n[1] / length, n[2] / length};
  }
  return best;
}

}  // namespace

auto RimFilling::corner(VertexId v) const -> Corner {
  return static_cast<Corner>(std::lower_bound(old_.begin(), old_.end(), v) - old_.begin());
}

/// All of the hull, and on which side of the sheet's plane each is.
void RimFilling::take_vertices(const Hull& hull, std::span<const VertexParts::Triangle> fan) {
  old_.clear();
  for (const auto& face : hull.faces) old_.insert(old_.end(), face.begin(), face.end());
  detail::make_set(old_);
  points_.clear();
  sides_.clear();
  for (const VertexId v : old_) {
    points_.push_back(mesh_->point(v));
    double height = 0;
    for (int i = 0; i < 3; ++i) height += normal_[static_cast<std::size_t>(i)] * (points_.back()[i] - center_[i]);
    sides_.push_back(height > 0 ? Side::above : height < 0 ? Side::below : Side::in_plane);
  }
  base_.clear();
  for (const auto& t : fan) {
    base_.push_back({corner(t.corners[0]), corner(t.corners[1]), corner(t.corners[2])});
    for (const Corner c : base_.back()) sides_[c] = Side::in_plane;
  }
}

/// The point halfway from v to where the edge crosses the plane.
auto RimFilling::crossing(Corner q, Corner r) -> Corner {
  const Edge key{std::min(q, r), std::max(q, r)};
  const auto known = std::ranges::find(crossings_, key, &std::pair<Edge, Corner>::first);
  if (known != crossings_.end()) return known->second;
  std::array<double, 2> height{};
  for (std::size_t k = 0; k < 2; ++k)
    for (int i = 0; i < 3; ++i) height[k] += normal_[static_cast<std::size_t>(i)] * (points_[key[k]][i] - center_[i]);
  const double part = height[0] / (height[0] - height[1]);
  Point3 x;
  for (int i = 0; i < 3; ++i) {
    const double from = points_[key[0]][i], at = from + part * (points_[key[1]][i] - from);
    x[i] = center_[i] + (at - center_[i]) / 2;
  }
  points_.push_back(x);
  sides_.push_back(Side::in_plane);
  crossings_.emplace_back(key, static_cast<Corner>(points_.size() - 1));
  return crossings_.back().second;
}

/// A face with one corner in the plane, and one on each side.
void RimFilling::divide_at_vertex(const Face& face) {
  const auto at = static_cast<std::size_t>(std::ranges::find_if(face, [this](Corner c) { return sides_[c] == Side::in_plane; }) -
                                           face.begin());
  const Corner z = face[at], r = face[(at + 1) % 3], t = face[(at + 2) % 3], x = crossing(r, t);
  add_near(sides_[r], {z, r, x});
  add_near(sides_[t], {z, x, t});
  outer_.push_back({z, r, t, x});
  curve_.push_back({z, x});
}

/// A face with a corner alone on its side.
void RimFilling::divide_across(const Face& face) {
  std::size_t at = 0;
  while (sides_[face[at]] == sides_[face[(at + 1) % 3]] || sides_[face[at]] == sides_[face[(at + 2) % 3]]) ++at;
  const Corner q = face[at], r = face[(at + 1) % 3], t = face[(at + 2) % 3], x = crossing(q, r), y = crossing(q, t);
  add_near(sides_[q], {q, x, y});
  add_near(sides_[r], {x, r, t});
  add_near(sides_[r], {x, t, y});
  outer_.push_back({q, r, t, x});
  outer_.push_back({q, x, t, y});
  curve_.push_back({x, y});
}

/// A face of the link, seen from v. False if it lies in the plane.
bool RimFilling::divide(const Face& face) {
  const auto count = [&](Side side) { return std::ranges::count_if(face, [&](Corner c) { return sides_[c] == side; }); };
  const auto above = count(Side::above), below = count(Side::below);
  if (above == 0 && below == 0) return false;
  if (below == 0 || above == 0)
    add_near(below == 0 ? Side::above : Side::below, face);
  else if (above + below == 2)
    divide_at_vertex(face);
  else
    divide_across(face);
  return true;
}

/// Edges of the link in the plane that are not on the sheet are of the curve, too: each is seen from above once.
void RimFilling::follow_edges_in_plane() {
  std::vector<Edge> of_sheet;
  for (const Face& t : base_)
    for (std::size_t i = 0; i < 3; ++i) of_sheet.push_back({std::min(t[i], t[(i + 1) % 3]), std::max(t[i], t[(i + 1) % 3])});
  for (const Face& f : above_)
    for (std::size_t i = 0; i < 3; ++i) {
      const Edge e{std::min(f[i], f[(i + 1) % 3]), std::max(f[i], f[(i + 1) % 3])};
      if (e[1] >= old_.size() || sides_[e[0]] != Side::in_plane || sides_[e[1]] != Side::in_plane) continue;
      if (std::ranges::find(of_sheet, e) == of_sheet.end()) curve_.push_back(e);
    }
}

/// Triangulates what the curve and the rim bound, with the orientation of the sheet. False if the curve is not one from end to
/// end.
bool RimFilling::close_ring(const std::array<VertexId, 2>& rim) {
  Corner a = corner(rim[0]), b = corner(rim[1]);
  const bool is_left = std::ranges::any_of(
      base_, [&](const Face& t) { return (t[0] == a && t[1] == b) || (t[1] == a && t[2] == b) || (t[2] == a && t[0] == b); });
  if (!is_left) std::swap(a, b);  // the sheet is left of a-b
  std::vector<Corner> ring{b, a};
  std::vector<Edge> left = curve_;
  while (ring.back() != b) {
    const auto next = std::ranges::find_if(left, [&](const Edge& e) { return e[0] == ring.back() || e[1] == ring.back(); });
    if (next == left.end()) return false;
    ring.push_back((*next)[0] == ring.back() ? (*next)[1] : (*next)[0]);
    left.erase(next);
  }
  ring.pop_back();
  if (!left.empty() || ring.size() < 3) return false;
  std::vector<detail::PlanarEdge> outline;
  for (std::size_t i = 0; i < ring.size(); ++i) outline.push_back({ring[i], ring[(i + 1) % ring.size()]});
  detail::PlanarTriangulation plane;
  if (!plane.build(points_, ring, outline, axis_)) return false;
  plane.keep_left_of(outline);
  const auto made = plane.triangles();
  if (made.size() != ring.size() - 2) return false;
  base_.insert(base_.end(), made.begin(), made.end());
  return true;
}

/// Puts a point on each side, at the longest step that does.
bool RimFilling::place_pyramids() {
  double longest = 0;
  for (const Point3& p : points_) longest = std::max(longest, squared_distance(p, center_));
  const auto upper = static_cast<Corner>(points_.size()), lower = upper + 1;
  points_.resize(points_.size() + 2);
  const auto add = [this](Face face, Corner apex) {
    const Simplex<3> s{points_[face[0]], points_[face[1]], points_[face[2]], points_[apex]};
    cells_.push_back({face[0], face[1], face[2], apex});
    return orient<3>(s) == Sign::positive;
  };
  const auto turned = [](const Face& f) { return Face{f[0], f[2], f[1]}; };
  double step = std::sqrt(longest);
  for (int k = 0; k < numbers::most_halvings; ++k, step /= 2) {
    for (int i = 0; i < 3; ++i) {
      points_[upper][i] = center_[i] + step * normal_[static_cast<std::size_t>(i)];
      points_[lower][i] = center_[i] - step * normal_[static_cast<std::size_t>(i)];
    }
    cells_ = outer_;
    const bool fits = std::ranges::all_of(above_, [&](const Face& f) { return add(f, upper); }) &&
                      std::ranges::all_of(below_, [&](const Face& f) { return add(f, lower); }) &&
                      std::ranges::all_of(base_, [&](const Face& f) { return add(f, upper) && add(turned(f), lower); });
    if (fits) return true;
  }
  return false;
}

bool RimFilling::fill(const Hull& hull, VertexId v, std::span<const VertexParts::Triangle> fan,
                      const std::array<VertexId, 2>& rim) {
  normal_ = unit_normal_of(*mesh_, fan);
  if (normal_ == std::array<double, 3>{} || !hull.edges.empty() || !hull.inside.empty()) return false;
  center_ = mesh_->point(v);
  axis_ = domain_->facets()[fan[0].facet].axis;
  take_vertices(hull, fan);
  above_.clear();
  below_.clear();
  crossings_.clear();
  curve_.clear();
  outer_.clear();
  std::vector<Face> sheet = base_;
  for (Face& t : sheet) std::ranges::sort(t);
  for (const auto& f : hull.faces) {
    const Face face{corner(f[0]), corner(f[1]), corner(f[2])};
    Face sorted = face;
    std::ranges::sort(sorted);
    if (std::ranges::find(sheet, sorted) == sheet.end() && !divide(face)) return false;
  }
  follow_edges_in_plane();
  if (!close_ring(rim) || !place_pyramids()) return false;
  return std::ranges::all_of(outer_, [this](const auto& c) {
    return orient<3>({points_[c[0]], points_[c[1]], points_[c[2]], points_[c[3]]}) == Sign::positive;
  });
}

}  // namespace pgdr
