// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// All loops of a group are triangulated together as they are seen along an axis, and parts of the plane between them are told by
// how often the loops wind around them.
//
// Why each loop has one part of the plane inside of it: loops have at most one point in common, two and two, and no three of them
// hang together in a ring, for else they were one block of the graph of open edges. So those in a loop do not cut its inside in
// two where it lies along the loop.
#include "openings/planar_caps.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "input/edges.hpp"
#include "numbers/vectors.hpp"
#include "openings/loop_planes.hpp"
#include "pgdr/predicates.hpp"
#include "space/disjoint_sets.hpp"
#include "space/make_set.hpp"
#include "space/planar_cdt.hpp"

namespace pgdr::detail {
namespace {

/// The plane of a group of loops, as triangles.
class CapGroup {
 public:
  CapGroup(const Domain<3>& domain, std::span<const OpenLoop> loops, const LoopPlanes& planes,
           std::span<const std::uint32_t> group)
      : domain_(domain), loops_(loops), planes_(planes), group_(group) {}

  std::vector<PlanarCap> run() {
    if (!triangulate()) return {};
    find_parts();
    find_turns();
    std::vector<PlanarCap> caps;
    for (const auto& [part, sides] : sides_)
      if (turns_[part] != 0)
        if (auto cap = cap_of(part, sides)) caps.push_back(*std::move(cap));
    return caps;
  }

 private:
  /// An edge of a loop, as a triangle of the plane has it.
  struct Side {
    std::uint32_t loop, edge;  // number of the edge in the loop
    std::uint32_t triangle;
    bool is_forward;  // the triangle, counter-clockwise, runs along it as the loop does
  };
  struct EdgeOfLoop {
    std::uint64_t key;
    std::uint32_t loop, edge;
  };

  const LoopPlane& plane_of(std::uint32_t loop) const { return *planes_.of(loop); }
  std::uint32_t largest_of(std::span<const std::uint32_t> loops) const {
    return *std::ranges::max_element(loops, {}, [this](std::uint32_t l) { return plane_of(l).area; });
  }

  /// False if loops cross.
  bool triangulate() {
    axis_ = plane_of(largest_of(group_)).axis;
    std::vector<std::uint32_t> vertices;
    std::vector<PlanarEdge> constraints;
    for (const std::uint32_t l : group_) {
      const auto& points = loops_[l].points;
      is_oriented_ = is_oriented_ && loops_[l].is_oriented;
      vertices.insert(vertices.end(), points.begin(), points.end());
      for (std::uint32_t k = 0; k < points.size(); ++k) {
        const std::uint32_t next = points[(k + 1) % points.size()];
        constraints.push_back({points[k], next});
        edges_.push_back({edge_key(points[k], next), l, k});
      }
    }
    make_set(vertices);
    std::ranges::sort(edges_, {}, &EdgeOfLoop::key);
    PlanarTriangulation planar;
    if (!planar.build(domain_.points(), vertices, constraints, axis_)) return false;
    triangles_ = planar.triangles();
    return true;
  }

  /// The loop's edge, if it is one.
  std::optional<Side> side_of(std::uint32_t t, std::size_t i) const {
    const std::uint32_t a = triangles_[t][(i + 1) % 3], b = triangles_[t][(i + 2) % 3];
    const auto at = std::ranges::lower_bound(edges_, edge_key(a, b), {}, &EdgeOfLoop::key);
    if (at == edges_.end() || at->key != edge_key(a, b)) return std::nullopt;
    return Side{at->loop, at->edge, t, loops_[at->loop].points[at->edge] == a};
  }

  /// Triangles without an edge of a loop between them are one part.
  void find_parts() {
    std::vector<std::pair<std::uint64_t, std::uint32_t>> uses;
    for (std::uint32_t t = 0; t < triangles_.size(); ++t)
      for (std::size_t i = 0; i < 3; ++i) uses.emplace_back(edge_key(triangles_[t][(i + 1) % 3], triangles_[t][(i + 2) % 3]), t);
    std::ranges::sort(uses);
    DisjointSets parts(triangles_.size());
    for (std::size_t k = 0; k < uses.size(); ++k) {
      const auto& [key, t] = uses[k];
      const bool is_first = k == 0 || uses[k - 1].first != key, is_last = k + 1 == uses.size() || uses[k + 1].first != key;
      const auto loop_edge = std::ranges::lower_bound(edges_, key, {}, &EdgeOfLoop::key);
      const bool is_wall = loop_edge != edges_.end() && loop_edge->key == key;
      if (is_first && is_last && !is_wall) outside_.push_back(t);
      if (!is_first && !is_wall) parts.unite(uses[k - 1].second, t);
    }
    for (std::uint32_t t = 0; t < triangles_.size(); ++t) parts_.push_back(parts.find(t));
    for (std::uint32_t& t : outside_) t = parts_[t];
    for (std::uint32_t t = 0; t < triangles_.size(); ++t)
      for (std::size_t i = 0; i < 3; ++i)
        if (const auto side = side_of(t, i)) sides_[parts_[t]].push_back(*side);
  }

  /// How often loops wind around each part, from outside on; where they have no direction: 1 inside of one, 0 outside of two, ...
  void find_turns() {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<Side>> walls;  // by loop and edge
    for (const auto& [part, sides] : sides_)
      for (const Side& s : sides) walls[{s.loop, s.edge}].push_back(s);
    std::vector<std::uint32_t> waiting;
    const auto reach = [&](std::uint32_t part, int turns) {
      if (turns_.emplace(part, turns).second) waiting.push_back(part);
    };
    for (const std::uint32_t part : outside_) reach(part, 0);
    for (const auto& [edge, sides] : walls)  // on the rim of all
      if (sides.size() == 1) reach(parts_[sides[0].triangle], across(0, sides[0]));
    while (!waiting.empty()) {
      const std::uint32_t part = waiting.back();
      waiting.pop_back();
      for (const Side& s : sides_[part])
        for (const Side& beyond : walls[{s.loop, s.edge}])
          if (beyond.triangle != s.triangle) reach(parts_[beyond.triangle], across(turns_[part], beyond));
    }
  }
  int across(int turns, const Side& into) const {
    if (!is_oriented_) return 1 - turns;
    return into.is_forward ? turns + 1 : turns - 1;
  }

  /// None if it would lie on facets, is not in one plane, or has a hole that no point of doubles is in.
  std::optional<PlanarCap> cap_of(std::uint32_t part, std::span<const Side> sides) const {
    PlanarCap cap;
    for (const Side& s : sides) cap.loops.push_back(s.loop);
    make_set(cap.loops);
    const std::uint32_t outer = largest_of(cap.loops);
    std::rotate(cap.loops.begin(), std::ranges::find(cap.loops, outer), std::ranges::find(cap.loops, outer) + 1);
    const LoopPlane& plane = plane_of(outer);
    cap.area = 2 * plane.area;
    for (const std::uint32_t l : cap.loops) {
      if (!planes_.is_in(plane, loops_[l])) return std::nullopt;
      cap.area -= plane_of(l).area;
    }
    for (const Side& s : sides) {
      if (lies_on_facet(s, plane)) return std::nullopt;
      if (s.loop == outer) cap.turned = s.is_forward != (turns_.at(part) > 0);
    }
    for (std::size_t k = 1; k < cap.loops.size(); ++k) {
      const auto seed = point_in(cap.loops[k], part);
      if (!seed) return std::nullopt;
      cap.seeds.push_back(*seed);
    }
    return cap;
  }

  /// Does the facet that ends there lie in the plane, on this side?
  bool lies_on_facet(const Side& s, const LoopPlane& plane) const {
    const OpenLoop& loop = loops_[s.loop];
    const auto p = domain_.points();
    std::uint32_t a = loop.points[s.edge], b = loop.points[(s.edge + 1) % loop.points.size()];
    if (!s.is_forward) std::swap(a, b);
    const std::uint32_t apex = loop.edges[s.edge].apex;
    return planes_.is_in(plane, apex) && orient_projected(p[a], p[b], p[apex], axis_) == Sign::positive;
  }

  /// Inside of a loop, beyond its edges as seen from this part: the centre of the largest triangle there.
  std::optional<Point3> point_in(std::uint32_t loop, std::uint32_t part) const {
    std::optional<std::uint32_t> inside;
    for (const auto& [other, sides] : sides_)
      if (other != part && std::ranges::find(sides, loop, &Side::loop) != sides.end()) inside = other;
    if (!inside) return std::nullopt;
    const auto p = domain_.points();
    Point3 best{};
    double most = 0;
    for (std::uint32_t t = 0; t < triangles_.size(); ++t) {
      if (parts_[t] != *inside) continue;
      const auto& [a, b, c] = triangles_[t];
      const Vector<3> n = cross(difference(p[b], p[a]), difference(p[c], p[a]));
      Point3 centre;
      for (int i = 0; i < 3; ++i) centre[i] = p[a][i] / 3 + p[b][i] / 3 + p[c][i] / 3;
      const auto is_left_of = [&](std::uint32_t v, std::uint32_t w) {
        return orient_projected(p[v], p[w], centre, axis_) == Sign::positive;
      };
      if (!(dot(n, n) > most) || !is_left_of(a, b) || !is_left_of(b, c) || !is_left_of(c, a)) continue;
      most = dot(n, n);
      best = centre;
    }
    return most > 0 ? std::optional(best) : std::nullopt;
  }

  const Domain<3>& domain_;
  std::span<const OpenLoop> loops_;
  const LoopPlanes& planes_;
  std::span<const std::uint32_t> group_;
  int axis_ = 2;
  bool is_oriented_ = true;
  std::vector<EdgeOfLoop> edges_;                     // sorted
  std::vector<PlanarTriangle> triangles_;             // of the convex hull
  std::vector<std::uint32_t> parts_;                  // of each triangle
  std::vector<std::uint32_t> outside_;                // parts that reach the rim of the hull
  std::map<std::uint32_t, std::vector<Side>> sides_;  // of each part that has any
  std::map<std::uint32_t, int> turns_;                // of each part
};

}  // namespace

std::vector<PlanarCap> planar_caps(const Domain<3>& domain, std::span<const OpenLoop> loops, const StopCheck& stop) {
  const LoopPlanes planes(domain, loops, stop);
  std::vector<PlanarCap> caps;
  for (const auto& group : planes.groups(stop)) {
    stop();
    for (PlanarCap& cap : CapGroup(domain, loops, planes, group).run()) caps.push_back(std::move(cap));
  }
  std::ranges::sort(caps, {}, [](const PlanarCap& cap) { return cap.loops[0]; });
  return caps;
}

}  // namespace pgdr::detail
