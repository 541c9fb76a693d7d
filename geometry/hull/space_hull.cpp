// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Quickhull (C. B. Barber, D. P. Dobkin, H. Huhdanpaa, The quickhull algorithm for convex hulls, ACM TOMS 22, 1996), with exact
// signs. A triangle sees a point that is strictly beyond its plane, and each point outside waits at one that sees it. The
// farthest point of a triangle comes next; the triangles that see it go, and those from it to the edges around them come. Which
// is farthest is computed in doubles, and changes nothing of the hull.
//
// Points in the plane of a triangle are not seen by it, and nothing goes wrong: a point a little nearer to the inside than p is
// in no plane of a triangle, and seen by the same triangles as p, so that these are a disc as ever. A triangle of p is no
// line: where p is on the line of an edge between one that sees it and another, it is in the plane of the former. And a point
// that waited at a triangle that goes, and is still outside, is seen by one that comes: on the way from it to a place inside of
// the triangle that goes, all of which is beyond that one's plane, it enters the new hull by new triangles.
#include "hull/space_hull.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "numbers/vectors.hpp"
#include "pgdr/predicates.hpp"
#include "space/disjoint_sets.hpp"

namespace pgdr::detail {
namespace {

/// A triangle of the hull, counterclockwise seen from outside. Edge i is from corner i to the next.
struct HullTriangle {
  std::array<std::uint32_t, 3> corners;
  std::array<std::uint32_t, 3> beyond{};  ///< the triangle at each edge
  std::vector<std::uint32_t> waiting{};   ///< points that it sees; none is with another triangle
  bool is_there = true;
};

class HullMaker {
 public:
  HullMaker(std::span<const Point3> points, std::vector<std::uint32_t> candidates)
      : p_(points), candidates_(std::move(candidates)) {}

  std::vector<std::vector<std::uint32_t>> run() {
    if (!begin()) return {};
    while (!open_.empty()) {
      const std::uint32_t t = open_.back();
      if (!triangles_[t].is_there || triangles_[t].waiting.empty())
        open_.pop_back();
      else
        add(farthest(t), t);
    }
    return facets();
  }

 private:
  using Rim = std::map<std::uint32_t, std::pair<std::uint32_t, std::uint32_t>>;  // from a corner: the next one, what is beyond

  bool sees(const HullTriangle& t, std::uint32_t v) const {
    return orient3d(p_[t.corners[0]], p_[t.corners[1]], p_[t.corners[2]], p_[v]) == Sign::positive;
  }

  /// The point of `all` with the largest of these values, of those that `fits` takes; no_entity: none.
  template <class Fits, class Value>
  static std::uint32_t largest(const std::vector<std::uint32_t>& all, const Fits& fits, const Value& value) {
    std::uint32_t best = no_entity;
    double most = 0;
    for (const std::uint32_t v : all) {
      const double x = value(v);
      if ((best == no_entity || x > most) && fits(v)) {
        best = v;
        most = x;
      }
    }
    return best;
  }

  /// A tetrahedron of four points. False if there is none.
  bool begin() {
    if (candidates_.empty()) return false;
    const auto lower = [&](std::uint32_t a, std::uint32_t b) { return lex_less(p_[a], p_[b]); };
    const auto [low, high] = std::ranges::minmax_element(candidates_, lower);
    const std::uint32_t a = *low, b = *high;
    if (a == b) return false;
    const auto along = difference(p_[b], p_[a]);
    const std::uint32_t c = largest(
        candidates_, [&](std::uint32_t v) { return !collinear<3>(p_[a], p_[b], p_[v]); },
        [&](std::uint32_t v) {
          const auto n = cross(along, difference(p_[v], p_[a]));
          return dot(n, n);
        });
    if (c == no_entity) return false;
    const auto normal = cross(along, difference(p_[c], p_[a]));
    const std::uint32_t d = largest(
        candidates_, [&](std::uint32_t v) { return orient3d(p_[a], p_[b], p_[c], p_[v]) != Sign::zero; },
        [&](std::uint32_t v) { return std::fabs(dot(normal, difference(p_[v], p_[a]))); });
    if (d == no_entity) return false;
    std::array<std::uint32_t, 4> s{a, b, c, d};
    if (orient3d(p_[a], p_[b], p_[c], p_[d]) == Sign::positive) std::swap(s[0], s[1]);
    // The first three run counterclockwise seen from outside now: the fourth is not beyond.
    triangles_ = {{{s[0], s[1], s[2]}, {1, 2, 3}},
                  {{s[1], s[0], s[3]}, {0, 3, 2}},
                  {{s[2], s[1], s[3]}, {0, 1, 3}},
                  {{s[0], s[2], s[3]}, {0, 2, 1}}};
    hand_over(candidates_, 0);
    return true;
  }

  /// Gives each point to the first of the triangles from `first` on that sees it; who is seen by none is inside.
  void hand_over(const std::vector<std::uint32_t>& points, std::size_t first) {
    for (const std::uint32_t v : points)
      for (std::size_t t = first; t < triangles_.size(); ++t)
        if (sees(triangles_[t], v)) {
          triangles_[t].waiting.push_back(v);
          break;
        }
    for (std::size_t t = first; t < triangles_.size(); ++t)
      if (!triangles_[t].waiting.empty()) open_.push_back(static_cast<std::uint32_t>(t));
  }

  std::uint32_t farthest(std::uint32_t t) const {
    const auto& c = triangles_[t].corners;
    const auto n = cross(difference(p_[c[1]], p_[c[0]]), difference(p_[c[2]], p_[c[0]]));
    return largest(
        triangles_[t].waiting, [](std::uint32_t) { return true; },
        [&](std::uint32_t v) { return dot(n, difference(p_[v], p_[c[0]])); });
  }

  /// The triangles that see v go, all that hang together with t, which does; others come.
  void add(std::uint32_t v, std::uint32_t t) {
    std::vector<std::uint32_t> gone{t}, orphans;
    triangles_[t].is_there = false;
    for (std::size_t i = 0; i < gone.size(); ++i)
      for (const std::uint32_t u : std::array(triangles_[gone[i]].beyond))
        if (triangles_[u].is_there && sees(triangles_[u], v)) {
          triangles_[u].is_there = false;
          gone.push_back(u);
        }
    Rim rim;
    for (const std::uint32_t g : gone) {
      HullTriangle& old = triangles_[g];
      for (std::size_t k = 0; k < 3; ++k)
        if (triangles_[old.beyond[k]].is_there) rim[old.corners[k]] = {old.corners[(k + 1) % 3], old.beyond[k]};
      orphans.insert(orphans.end(), old.waiting.begin(), old.waiting.end());
      old.waiting = {};
    }
    std::erase(orphans, v);
    add_fan(v, rim);
    hand_over(orphans, triangles_.size() - rim.size());
  }

  /// The triangles from v to the edges of the rim, one after the other around it.
  void add_fan(std::uint32_t v, const Rim& rim) {
    const auto first = static_cast<std::uint32_t>(triangles_.size()), count = static_cast<std::uint32_t>(rim.size());
    std::uint32_t from = rim.begin()->first;
    for (std::uint32_t i = 0; i < count; ++i) {
      const auto [to, beyond] = rim.at(from);
      triangles_.push_back({{from, to, v}, {beyond, first + (i + 1) % count, first + (i + count - 1) % count}});
      auto& other = triangles_[beyond];
      for (std::size_t k = 0; k < 3; ++k)
        if (other.corners[k] == to) other.beyond[k] = first + i;
      from = to;
    }
  }

  /// Triangles of one plane are one facet.
  std::vector<std::vector<std::uint32_t>> facets() const {
    DisjointSets planes(triangles_.size());
    const auto is_flat = [&](const HullTriangle& t, const HullTriangle& other) {
      for (const std::uint32_t v : other.corners)
        if (std::ranges::count(t.corners, v) == 0)
          return orient3d(p_[t.corners[0]], p_[t.corners[1]], p_[t.corners[2]], p_[v]) == Sign::zero;
      return true;
    };
    for (std::uint32_t t = 0; t < triangles_.size(); ++t)
      for (std::size_t k = 0; k < 3 && triangles_[t].is_there; ++k)
        if (const std::uint32_t u = triangles_[t].beyond[k]; t < u && is_flat(triangles_[t], triangles_[u])) planes.unite(t, u);
    std::map<std::uint32_t, std::map<std::uint32_t, std::uint32_t>> outlines;  // of each plane: from a corner to the next
    for (std::uint32_t t = 0; t < triangles_.size(); ++t)
      for (std::size_t k = 0; k < 3 && triangles_[t].is_there; ++k)
        if (planes.find(t) != planes.find(triangles_[t].beyond[k]))
          outlines[planes.find(t)][triangles_[t].corners[k]] = triangles_[t].corners[(k + 1) % 3];
    std::vector<std::vector<std::uint32_t>> all;
    for (const auto& [plane, next] : outlines) all.push_back(polygon(next));
    std::ranges::sort(all);
    return all;
  }

  /// The corners of an outline in their order, without those between two others, the least first.
  std::vector<std::uint32_t> polygon(const std::map<std::uint32_t, std::uint32_t>& next) const {
    std::vector<std::uint32_t> around, corners;
    for (std::uint32_t v = next.begin()->first; around.size() < next.size(); v = next.at(v)) around.push_back(v);
    for (std::size_t i = 0, n = around.size(); i < n; ++i)
      if (!collinear<3>(p_[around[(i + n - 1) % n]], p_[around[i]], p_[around[(i + 1) % n]])) corners.push_back(around[i]);
    std::rotate(corners.begin(), std::ranges::min_element(corners), corners.end());
    return corners;
  }

  std::span<const Point3> p_;
  std::vector<std::uint32_t> candidates_;
  std::vector<HullTriangle> triangles_;
  std::vector<std::uint32_t> open_;  // triangles where points wait, and some where none do any more
};

}  // namespace

std::vector<std::vector<std::uint32_t>> facets_of_hull(std::span<const Point3> points, std::vector<std::uint32_t> candidates) {
  return HullMaker(points, std::move(candidates)).run();
}

}  // namespace pgdr::detail
