// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "given/given_facet.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "numbers/vectors.hpp"
#include "pgdr/predicates.hpp"
#include "space/distances.hpp"
#include "space/make_set.hpp"
#include "space/planar_cdt.hpp"

namespace pgdr::checking {
namespace {

using detail::cross;
using detail::difference;
using detail::dot;
using detail::make_set;
using detail::PlanarEdge;
using detail::PlanarStatus;
using detail::PlanarTriangle;
using detail::Vector;

class FacetTriangulator {
 public:
  FacetTriangulator(const Plc<3>& plc, const ExplicitEdges& explicit_edges, std::uint32_t facet, double reach)
      : plc_(plc), explicit_(explicit_edges), facet_(plc.facets[facet]), reach_(reach) {}

  FacetTriangulation run() {
    FacetTriangulation out;
    read();
    if (vertices_.size() < 3 || is_flat()) return out;
    if (edges_.size() == 3 && vertices_.size() == 3 && facet_.holes.empty()) {
      out.triangles.push_back({vertices_[0], vertices_[1], vertices_[2]});
      return out;
    }
    normal_ = normal();
    if (!build_joined() && !build()) {
      out.failed = true;
      return out;
    }
    planar_.carve_outside();
    for (const Point3& seed : facet_.holes) planar_.carve_hole(seed);
    for (const auto& [a, b] : explicit_.among(vertices_))
      if (!planar_.is_constraint(a, b)) planar_.constrain(a, b);  // what does not fit is no matter of the facet
    out.triangles = planar_.triangles();
    find_inner_edges(out);
    out.bend = bend(out.triangles);
    return out;
  }

 private:
  const Point3& at(std::uint32_t v) const { return plc_.points[v]; }

  /// Of points at one place the first one stands for all.
  void read() {
    std::vector<std::uint32_t> order;
    for (const auto& polygon : facet_.polygons) order.insert(order.end(), polygon.begin(), polygon.end());
    make_set(order);
    std::stable_sort(order.begin(), order.end(), [&](std::uint32_t v, std::uint32_t w) { return lex_less(at(v), at(w)); });
    std::map<std::uint32_t, std::uint32_t> first;
    for (std::size_t i = 0; i < order.size(); ++i)
      first[order[i]] = i > 0 && at(order[i]) == at(order[i - 1]) ? first[order[i - 1]] : order[i];
    for (const auto& polygon : facet_.polygons) {
      const std::size_t n = polygon.size();
      for (std::size_t k = 0; k < n; ++k) {
        const std::uint32_t v = first[polygon[k]], w = first[polygon[(k + 1) % n]];
        vertices_.push_back(v);
        if (v != w) edges_.push_back({std::min(v, w), std::max(v, w)});
      }
    }
    make_set(vertices_);
    make_set(edges_);
  }

  bool is_flat() const {
    return std::all_of(vertices_.begin() + 2, vertices_.end(),
                       [&](std::uint32_t v) { return collinear<3>(at(vertices_[0]), at(vertices_[1]), at(v)); });
  }

  /// Of the polygon with the largest area vector.
  Vector<3> normal() const {
    Vector<3> best{};
    for (const auto& polygon : facet_.polygons) {
      Vector<3> sum{};
      for (std::size_t k = 1; k + 1 < polygon.size(); ++k) {
        const auto n = cross(difference(at(polygon[k]), at(polygon[0])), difference(at(polygon[k + 1]), at(polygon[0])));
        for (int i = 0; i < 3; ++i) sum[i] += n[i];
      }
      if (dot(sum, sum) > dot(best, best)) best = sum;
    }
    return best;
  }

  bool build() {
    std::array<int, 3> axes{0, 1, 2};
    std::stable_sort(axes.begin(), axes.end(), [&](int i, int j) { return std::abs(normal_[i]) > std::abs(normal_[j]); });
    for (const int axis : axes) {
      const auto result = planar_.build(plc_.points, vertices_, edges_, axis);
      if (result) return true;
      if (result.status != PlanarStatus::collinear && result.status != PlanarStatus::coincident) return false;
    }
    return false;
  }

  /// With what meets within the tolerance joined: an edge that ends at another one but for rounding has a gap there, through
  /// which a hole would leak. Else as it was.
  bool build_joined() {
    const auto vertices = vertices_;
    const auto edges = edges_;
    join();
    if (build()) return true;
    vertices_ = vertices;
    edges_ = edges;
    return false;
  }

  void join() {
    std::map<std::uint32_t, std::uint32_t> kept;
    std::vector<std::uint32_t> by_x = vertices_;
    std::sort(by_x.begin(), by_x.end(), [&](std::uint32_t v, std::uint32_t w) { return lex_less(at(v), at(w)); });
    for (std::size_t i = 0; i < by_x.size(); ++i) {
      kept[by_x[i]] = by_x[i];
      for (std::size_t j = i; j-- > 0 && at(by_x[i])[0] - at(by_x[j])[0] <= reach_;)
        if (squared_distance(at(by_x[i]), at(by_x[j])) <= reach_ * reach_) kept[by_x[i]] = kept[by_x[j]];
    }
    for (std::uint32_t& v : vertices_) v = kept[v];
    make_set(vertices_);
    std::erase_if(by_x, [&](std::uint32_t v) { return kept[v] != v; });
    std::vector<PlanarEdge> finer;
    for (const PlanarEdge& e : edges_) {
      const std::uint32_t a = kept[e[0]], b = kept[e[1]];
      if (a == b) continue;
      const auto d = difference(at(b), at(a));
      std::vector<std::pair<double, std::uint32_t>> along{{0, a}, {dot(d, d), b}};
      const auto [low, high] = std::minmax({at(a)[0] - reach_, at(b)[0] - reach_, at(a)[0] + reach_, at(b)[0] + reach_});
      for (auto near = std::ranges::lower_bound(by_x, low, {}, [&](std::uint32_t v) { return at(v)[0]; });
           near != by_x.end() && at(*near)[0] <= high; ++near) {
        const std::uint32_t v = *near;
        const double t = dot(difference(at(v), at(a)), d);
        if (v != a && v != b && t > 0 && t < dot(d, d) && detail::closest_to_edge(at(v), at(a), at(b)).square <= reach_ * reach_)
          along.push_back({t, v});
      }
      std::sort(along.begin(), along.end());
      for (std::size_t k = 1; k < along.size(); ++k)
        finer.push_back({std::min(along[k - 1].second, along[k].second), std::max(along[k - 1].second, along[k].second)});
    }
    make_set(finer);
    edges_ = std::move(finer);
  }

  void find_inner_edges(FacetTriangulation& out) const {
    std::vector<PlanarEdge> sides;
    for (const auto& t : out.triangles)
      for (int i = 0; i < 3; ++i) sides.push_back({std::min(t[i], t[(i + 1) % 3]), std::max(t[i], t[(i + 1) % 3])});
    std::sort(sides.begin(), sides.end());
    for (const PlanarEdge& e : edges_) {
      const auto [first, last] = std::equal_range(sides.begin(), sides.end(), e);
      if (last - first != 1) out.inner_edges.push_back(e);
    }
  }

  /// Over the plane of the largest triangle.
  double bend(const std::vector<PlanarTriangle>& triangles) const {
    Vector<3> n{};
    std::uint32_t origin = 0;
    for (const auto& t : triangles) {
      const auto m = cross(difference(at(t[1]), at(t[0])), difference(at(t[2]), at(t[0])));
      if (dot(m, m) <= dot(n, n)) continue;
      n = m;
      origin = t[0];
    }
    double low = 0, high = 0;
    const double length = std::sqrt(dot(n, n));
    for (const std::uint32_t v : vertices_) {
      const double height = length > 0 ? dot(difference(at(v), at(origin)), n) / length : 0;
      low = std::min(low, height);
      high = std::max(high, height);
    }
    return high - low;
  }

  const Plc<3>& plc_;
  const ExplicitEdges& explicit_;
  const Plc<3>::Facet& facet_;
  double reach_;
  std::vector<std::uint32_t> vertices_;
  std::vector<PlanarEdge> edges_;
  Vector<3> normal_{};
  detail::PlanarTriangulation planar_;
};

}  // namespace

ExplicitEdges::ExplicitEdges(const Plc<3>& plc, std::span<const std::uint32_t> place) : place_(place) {
  const auto add = [this](std::uint32_t a, std::uint32_t b) {
    ends_.push_back({place_[a], place_[b]});
    ends_.push_back({place_[b], place_[a]});
  };
  for (const auto& s : plc.segments) add(s.points[0], s.points[1]);
  for (const auto& facet : plc.facets)
    if (facet.polygons.size() == 1 && facet.polygons[0].size() == 2) add(facet.polygons[0][0], facet.polygons[0][1]);
  make_set(ends_);
}

std::vector<std::array<std::uint32_t, 2>> ExplicitEdges::among(std::span<const std::uint32_t> points) const {
  std::vector<std::array<std::uint32_t, 2>> found;
  if (ends_.empty() || points.size() < 4) return found;
  std::map<std::uint32_t, std::uint32_t> at;
  for (const std::uint32_t p : points) at.emplace(place_[p], p);
  for (const auto& [place, p] : at)
    for (auto e = std::ranges::lower_bound(ends_, std::array{place, 0u}); e != ends_.end() && (*e)[0] == place; ++e)
      if (const auto q = at.find((*e)[1]); q != at.end() && q->first > place) found.push_back({p, q->second});
  return found;
}

FacetTriangulation triangulate_given(const Plc<3>& plc, const ExplicitEdges& edges, std::uint32_t facet, double reach) {
  return FacetTriangulator(plc, edges, facet, reach).run();
}

}  // namespace pgdr::checking
