// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Where a rim comes back to one of its points, the loops are those of what lies outside of the part: of all edges that go on from
// there, the next one round the point on that side. Since the part hangs together by edges, such a loop passes no point twice.
#include "replace/flat_polygon.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "pgdr/predicates.hpp"
#include "replace/numbers.hpp"
#include "space/box_tree.hpp"
#include "space/distances.hpp"

namespace pgdr::detail {
namespace {

using Loop = std::vector<std::uint32_t>;

class FlatPolygon {
 public:
  FlatPolygon(std::span<const Point3> points, const FlatRim& rim) : points_(points), of_(rim) {}

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
    for (const PlanarEdge& e : of_.inner) facet.polygons.push_back({e[0], e[1]});
    return facet;
  }

 private:
  using Edges = std::multimap<std::uint32_t, std::uint32_t>;  // of the rim, by where they begin

  const Point3& at(std::uint32_t v) const { return points_[v]; }

  /// The rim as loops. @returns false if it touches itself and may not
  bool close(std::vector<Loop>& loops) const {
    Edges left;
    for (const PlanarEdge& e : of_.rim) left.emplace(e[0], e[1]);
    for (auto e = left.begin(); !of_.may_touch_itself && e != left.end(); ++e)
      if (left.count(e->first) > 1) return false;
    while (!left.empty()) {
      const auto [first, second] = *left.begin();
      left.erase(left.begin());
      Loop loop{first};
      for (std::uint32_t from = first, v = second;;) {
        const auto next = next_edge(left, from, v, v == first ? second : none);
        if (!next) return false;
        if (v == first && *next == second) break;
        loop.push_back(v);
        left.erase(std::find(left.lower_bound(v), left.upper_bound(v), Edges::value_type{v, *next}));
        from = v;
        v = *next;
      }
      loops.push_back(std::move(loop));
    }
    return true;
  }

  /// Where the loop that has come from `from` to v goes on. @param closing  the end of the edge that began it at v, or none
  std::optional<std::uint32_t> next_edge(const Edges& left, std::uint32_t from, std::uint32_t v, std::uint32_t closing) const {
    std::optional<std::uint32_t> best;
    const auto consider = [&](std::uint32_t w) {
      if (!best || is_before(from, v, w, *best)) best = w;
    };
    if (closing != none) consider(closing);
    const auto [begin, end] = left.equal_range(v);
    for (auto e = begin; e != end; ++e) consider(e->second);
    return best;
  }

  /// Round v from `from` on, on the side where the part is not: is a met before b?
  bool is_before(std::uint32_t from, std::uint32_t v, std::uint32_t a, std::uint32_t b) const {
    const auto turn = [&](std::uint32_t p, std::uint32_t q) {
      const Sign sign = orient_projected(at(v), at(p), at(q), of_.axis);
      return of_.way == Sign::positive ? sign : -sign;
    };
    const auto half = [&](std::uint32_t w) { return turn(from, w) == Sign::positive ? 0 : turn(from, w) == Sign::zero ? 1 : 2; };
    return half(a) != half(b) ? half(a) < half(b) : turn(a, b) == Sign::positive;
  }

  /// How far its corners are off the plane.
  double thickness() const {
    double most = 0;
    const auto look_at = [&](std::uint32_t v) {
      most = std::max(most, std::fabs(dot(of_.normal, difference(at(v), of_.anchor))));
    };
    for (const PlanarEdge& e : of_.rim) look_at(e[0]);
    for (const PlanarEdge& e : of_.inner)
      for (const std::uint32_t v : e) look_at(v);
    return most;
  }

  /// How near two edges are to each other; at a common corner, how far the other corner of the shorter one is from the longer.
  double square_of_gap(const PlanarEdge& a, const PlanarEdge& b) const {
    const auto from_corner = [this](std::uint32_t corner, std::uint32_t p, std::uint32_t q) {
      if (distance(at(corner), at(q)) < distance(at(corner), at(p))) std::swap(p, q);
      return closest_of_edges(at(p), at(p), at(corner), at(q)).square;
    };
    for (const std::size_t i : {0, 1})
      for (const std::size_t j : {0, 1})
        if (a[i] == b[j]) return from_corner(a[i], a[1 - i], b[1 - j]);
    return closest_of_edges(at(a[0]), at(a[1]), at(b[0]), at(b[1])).square;
  }

  /// A strip is bent by its thickness over its width, also one that ends in a corner. Points that are put onto its edges leave
  /// these by as much as the corners are off the plane.
  bool comes_near_itself() const {
    const double least = numbers::outline_gap * thickness();
    std::vector<PlanarEdge> edges(of_.rim);
    edges.insert(edges.end(), of_.inner.begin(), of_.inner.end());
    std::vector<Box<3>> boxes;
    for (const PlanarEdge& e : edges) {
      Box<3> box = Box<3>::around(at(e[0]));
      box.add(at(e[1]));
      boxes.push_back(box.widened(least / 2));
    }
    bool is_near = false;
    BoxTree<3>(boxes).self_pairs(
        [&](std::uint32_t i, std::uint32_t j) { is_near = is_near || square_of_gap(edges[i], edges[j]) < least * least; });
    return is_near;
  }

  std::array<double, 2> projected(std::uint32_t v) const { return {at(v)[(of_.axis + 1) % 3], at(v)[(of_.axis + 2) % 3]}; }

  /// Twice the area of the projection, positive where it runs as the faces do.
  double area_of(const Loop& loop) const {
    double twice = 0;
    const auto origin = projected(loop[0]);
    for (std::size_t k = 1; k + 1 < loop.size(); ++k) {
      const auto p = projected(loop[k]), q = projected(loop[k + 1]);
      twice += (p[0] - origin[0]) * (q[1] - origin[1]) - (p[1] - origin[1]) * (q[0] - origin[0]);
    }
    return of_.way == Sign::positive ? twice : -twice;
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
    const int x = (of_.axis + 1) % 3, y = (of_.axis + 2) % 3;
    const auto n = [this](int i) { return of_.normal[static_cast<std::size_t>(i)]; };
    Point3 p;
    p[x] = q[0];
    p[y] = q[1];
    p[of_.axis] = of_.anchor[of_.axis] - (n(x) * (q[0] - of_.anchor[x]) + n(y) * (q[1] - of_.anchor[y])) / n(of_.axis);
    return p;
  }

  static constexpr std::uint32_t none = 0xffffffffu;

  std::span<const Point3> points_;
  const FlatRim& of_;
};

}  // namespace

std::optional<Plc<3>::Facet> polygon_of(std::span<const Point3> points, const FlatRim& rim) {
  return FlatPolygon(points, rim).facet();
}

}  // namespace pgdr::detail
