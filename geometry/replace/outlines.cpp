// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "replace/outlines.hpp"

#include <cmath>
#include <map>
#include <utility>

#include "pgdr/predicates.hpp"
#include "replace/numbers.hpp"
#include "space/box_tree.hpp"
#include "space/distances.hpp"

namespace pgdr::detail {
namespace {

using Edge = std::array<std::uint32_t, 2>;
using Loop = std::vector<std::uint32_t>;

class Outline {
 public:
  Outline(const SurfaceComplex& surface, std::span<const std::uint32_t> faces)
      : s_(surface), group_(surface.groups[surface.faces[faces[0]].group]) {
    way_ = way_of(*std::min_element(faces.begin(), faces.end(), [&](std::uint32_t a, std::uint32_t b) {
      return triangle_less(s_.triangle(a), s_.triangle(b));
    }));
    collect(faces);
  }

  std::optional<Plc<3>::Facet> facet() const {
    std::vector<Loop> loops;
    if (!close(loops) || comes_near_itself()) return std::nullopt;
    const auto is_outer = [this](const Loop& loop) { return area_of(loop) > 0; };
    if (std::count_if(loops.begin(), loops.end(), is_outer) != 1) return std::nullopt;
    std::stable_partition(loops.begin(), loops.end(), is_outer);
    Plc<3>::Facet facet;
    for (std::size_t k = 1; k < loops.size(); ++k) {
      const auto seed = seed_in(loops[k]);
      if (!seed) return std::nullopt;
      facet.holes.push_back(*seed);
    }
    facet.polygons = std::move(loops);
    for (const Edge& e : inner_) facet.polygons.push_back({e[0], e[1]});
    return facet;
  }

 private:
  Sign way_of(std::uint32_t f) const {
    const auto& c = s_.faces[f].corners;
    return orient_projected(s_.at(c[0]), s_.at(c[1]), s_.at(c[2]), group_.axis);
  }

  void collect(std::span<const std::uint32_t> faces) {
    std::map<Edge, Edge> open;  // sorted: as its face runs
    for (const std::uint32_t f : faces) {
      auto c = s_.faces[f].corners;
      if (way_of(f) != way_) std::swap(c[1], c[2]);
      for (std::size_t i = 0; i < 3; ++i) {
        const Edge e{c[i], c[(i + 1) % 3]}, key{std::min(e[0], e[1]), std::max(e[0], e[1])};
        const auto [at, is_new] = open.emplace(key, e);
        if (is_new) continue;
        open.erase(at);
        if (s_.is_kept(e[0], e[1])) inner_.push_back(key);
      }
    }
    for (const auto& [key, e] : open) rim_.push_back(e);
  }

  /// The rim as loops. @returns false if it touches itself
  bool close(std::vector<Loop>& loops) const {
    std::map<std::uint32_t, std::uint32_t> next;
    for (const Edge& e : rim_)
      if (!next.emplace(e[0], e[1]).second) return false;
    while (!next.empty()) {
      Loop loop;
      const std::uint32_t first = next.begin()->first;
      for (std::uint32_t v = first;;) {
        const auto at = next.find(v);
        if (at == next.end()) return false;
        loop.push_back(v);
        v = at->second;
        next.erase(at);
        if (v == first) break;
      }
      loops.push_back(std::move(loop));
    }
    return true;
  }

  /// How far its corners are off the plane of the group.
  double thickness() const {
    double most = 0;
    for (const Edge& e : rim_) most = std::max(most, height_over(group_, s_.at(e[0])));
    for (const Edge& e : inner_)
      for (const std::uint32_t v : e) most = std::max(most, height_over(group_, s_.at(v)));
    return most;
  }

  /// How near two edges are to each other; at a common corner, how far the other corner of the shorter one is from the longer.
  double square_of_gap(const Edge& a, const Edge& b) const {
    const auto from_corner = [this](std::uint32_t corner, std::uint32_t p, std::uint32_t q) {
      if (distance(s_.at(corner), s_.at(q)) < distance(s_.at(corner), s_.at(p))) std::swap(p, q);
      return closest_of_edges(s_.at(p), s_.at(p), s_.at(corner), s_.at(q)).square;
    };
    for (const std::size_t i : {0, 1})
      for (const std::size_t j : {0, 1})
        if (a[i] == b[j]) return from_corner(a[i], a[1 - i], b[1 - j]);
    return closest_of_edges(s_.at(a[0]), s_.at(a[1]), s_.at(b[0]), s_.at(b[1])).square;
  }

  /// A strip is bent by its thickness over its width, also one that ends in a corner. Points that are put onto its edges leave
  /// these by as much as the corners are off the plane.
  bool comes_near_itself() const {
    const double least = numbers::outline_gap * thickness();
    std::vector<Edge> edges(rim_);
    edges.insert(edges.end(), inner_.begin(), inner_.end());
    std::vector<Box<3>> boxes;
    for (const Edge& e : edges) {
      Box<3> box = Box<3>::around(s_.at(e[0]));
      box.add(s_.at(e[1]));
      boxes.push_back(box.widened(least / 2));
    }
    bool is_near = false;
    BoxTree<3>(boxes).self_pairs(
        [&](std::uint32_t i, std::uint32_t j) { is_near = is_near || square_of_gap(edges[i], edges[j]) < least * least; });
    return is_near;
  }

  std::array<double, 2> projected(std::uint32_t v) const {
    return {s_.at(v)[(group_.axis + 1) % 3], s_.at(v)[(group_.axis + 2) % 3]};
  }

  /// Twice the area of the projection, positive where it runs as the faces do.
  double area_of(const Loop& loop) const {
    double twice = 0;
    const auto origin = projected(loop[0]);
    for (std::size_t k = 1; k + 1 < loop.size(); ++k) {
      const auto p = projected(loop[k]), q = projected(loop[k + 1]);
      twice += (p[0] - origin[0]) * (q[1] - origin[1]) - (p[1] - origin[1]) * (q[0] - origin[0]);
    }
    return way_ == Sign::positive ? twice : -twice;
  }

  /// A point inside of a polygon: in the middle of the widest stretch of a line between the heights of its corners.
  std::optional<Point3> seed_in(const Loop& loop) const {
    std::vector<double> levels;
    for (const std::uint32_t v : loop) levels.push_back(projected(v)[1]);
    std::sort(levels.begin(), levels.end());
    double widest = 0;
    std::array<double, 2> best{};
    for (std::size_t k = 0; k + 1 < levels.size(); ++k) {
      const double level = levels[k] + (levels[k + 1] - levels[k]) / 2;
      if (!(levels[k] < level && level < levels[k + 1])) continue;
      std::vector<double> cuts;
      for (std::size_t i = 0; i < loop.size(); ++i) {
        const auto p = projected(loop[i]), q = projected(loop[(i + 1) % loop.size()]);
        if ((p[1] < level) != (q[1] < level)) cuts.push_back(p[0] + (q[0] - p[0]) * ((level - p[1]) / (q[1] - p[1])));
      }
      std::sort(cuts.begin(), cuts.end());
      for (std::size_t i = 0; i + 1 < cuts.size(); i += 2) {
        const double width = std::min(cuts[i + 1] - cuts[i], levels[k + 1] - levels[k]);
        if (!(width > widest)) continue;
        widest = width;
        best = {cuts[i] + (cuts[i + 1] - cuts[i]) / 2, level};
      }
    }
    if (!(widest > 0)) return std::nullopt;
    return on_plane(best);
  }

  Point3 on_plane(const std::array<double, 2>& q) const {
    const int x = (group_.axis + 1) % 3, y = (group_.axis + 2) % 3;
    const auto n = [this](int i) { return group_.normal[static_cast<std::size_t>(i)]; };
    Point3 p;
    p[x] = q[0];
    p[y] = q[1];
    p[group_.axis] = group_.anchor[group_.axis] -
                     (n(x) * (q[0] - group_.anchor[x]) + n(y) * (q[1] - group_.anchor[y])) / n(group_.axis);
    return p;
  }

  const SurfaceComplex& s_;
  const FlatGroup& group_;
  Sign way_;
  std::vector<Edge> rim_, inner_;  // the former as the faces run
};

}  // namespace

std::optional<Plc<3>::Facet> polygon_of(const SurfaceComplex& surface, std::span<const std::uint32_t> faces) {
  return Outline(surface, faces).facet();
}

}  // namespace pgdr::detail
