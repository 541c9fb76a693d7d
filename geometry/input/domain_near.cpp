// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Continues the second step of a Domain (3D), where the caller wants points within a distance merged: points as near to an edge, or
// to the inside of a facet, that they do not belong to become points of it. Nothing moves: an edge goes through its new points, and
// a facet through its own, which are triangulated anew, so that both deviate from where they were by no more than that distance.
// Edges that then run along a facet, as near to it, become edges of it with those that do so exactly (domain_inner.cpp). Looks at
// the triangles of all facets as they were before.
#include <algorithm>
#include <cmath>

#include "input/domain_builder.hpp"
#include "numbers/vectors.hpp"
#include "pgdr/predicates.hpp"
#include "space/box_tree.hpp"

namespace pgdr {
using detail::CleanFacet;
using detail::edge_key;
using detail::edge_of;
using detail::make_set;
using detail::NearPoint;
using detail::PlanarEdge;

namespace {

detail::Box<3> widened(detail::Box<3> box, double width) {
  for (int k = 0; k < 3; ++k) {
    box.low[k] -= width;
    box.high[k] += width;
  }
  return box;
}

/// How far on the way from a to b the point of the line nearest to p is; NaN if p is not within `width` of the line there.
double part_of_edge_near(const Point3& p, const Point3& a, const Point3& b, double width) {
  const auto along = detail::difference(b, a), to = detail::difference(p, a);
  const double t = detail::dot(to, along) / detail::dot(along, along);
  double square = 0;
  for (std::size_t k = 0; k < 3; ++k) square += (to[k] - t * along[k]) * (to[k] - t * along[k]);
  return t > 0 && t < 1 && square <= width * width ? t : std::nan("");
}

/// Are two edges, which are not parallel, within `width` of each other somewhere inside both?
bool pass_within(const std::array<Point3, 2>& e, const std::array<Point3, 2>& f, double width) {
  const auto u = detail::difference(e[1], e[0]), v = detail::difference(f[1], f[0]), w = detail::difference(f[0], e[0]);
  const auto n = detail::cross(u, v);
  const double square = detail::dot(n, n), height = detail::dot(n, w);
  if (!(height * height <= width * width * square) || !(square > 0)) return false;
  const double s = detail::dot(detail::cross(w, v), n) / square, t = detail::dot(detail::cross(w, u), n) / square;
  return s > 0 && s < 1 && t > 0 && t < 1;
}

/// Is p within `width` of the inside of the triangle?
bool is_near_triangle(const Point3& p, const std::array<Point3, 3>& t, double width) {
  const auto n = detail::cross(detail::difference(t[1], t[0]), detail::difference(t[2], t[0]));
  const double height = detail::dot(n, detail::difference(p, t[0]));
  if (!(height * height <= width * width * detail::dot(n, n))) return false;
  for (std::size_t i = 0; i < 3; ++i) {
    const Point3 &a = t[i], &b = t[(i + 1) % 3];
    if (!(detail::dot(detail::cross(detail::difference(b, a), detail::difference(p, a)), n) >= 0)) return false;
  }
  return true;
}

}  // namespace

/// In units that neither overflow nor underflow, as choose_scale() has them.
template <int D>
Point<D> DomainBuilder<D>::scaled_point(std::uint32_t v) const {
  Point<D> p = out_.points_[v];
  for (double& x : p.x) x *= scale_;
  return p;
}

template <int D>
template <std::size_t N>
detail::Box<3> DomainBuilder<D>::scaled_box(const std::array<std::uint32_t, N>& corners) const requires(D == 3) {
  auto box = detail::Box<3>::around(scaled_point(corners[0]));
  for (const std::uint32_t v : corners) box.add(scaled_point(v));
  return box;
}

/// Of edges or triangles, each larger by near_width_ on all sides.
template <int D>
template <std::size_t N>
detail::BoxTree<3> DomainBuilder<D>::widened_boxes(std::span<const std::array<std::uint32_t, N>> simplices) const requires(D == 3) {
  std::vector<detail::Box<3>> boxes;
  for (const auto& corners : simplices) boxes.push_back(widened(scaled_box(corners), near_width_));
  return detail::BoxTree<3>(boxes);
}

template <int D>
std::array<Point<D>, 3> DomainBuilder<D>::scaled_triangle(std::uint32_t t) const requires(D == 3) {
  return {scaled_point(triangles_[t][0]), scaled_point(triangles_[t][1]), scaled_point(triangles_[t][2])};
}

/// True if anything is near what it does not belong to; what, in near_. @pre facets are triangulated
template <int D>
bool DomainBuilder<D>::find_near() requires(D == 3) {
  double largest = 0;
  for (std::uint32_t v = 0; v < out_.points_.size(); ++v)
    for (const double x : scaled_point(v).x) largest = std::max(largest, std::fabs(x));
  near_width_ = plc_.merge_within * largest;
  find_points_near_edges();
  std::vector<std::vector<std::uint32_t>> points(plc_.facets.size());
  for (const detail::TriangulatedFacet& facet : facets_)
    for (std::uint32_t t = facet.first; t < facet.first + facet.count; ++t)
      for (std::size_t i = 0; i < 3; ++i) {
        points[facet.input].push_back(triangles_[t][i]);
        if (!(masks_[t] >> i & 1)) continue;
        for (const NearPoint& near : near_on_edge(edge_key(triangles_[t][(i + 1) % 3], triangles_[t][(i + 2) % 3])))
          points[facet.input].push_back(near.point);
      }
  for (auto& list : points) make_set(list);
  find_points_near_facets(points);
  return !near_.on_edges.empty() || !near_.in_facets.empty();
}

/// Of facets and segments.
template <int D>
std::vector<std::uint64_t> DomainBuilder<D>::constrained_edges() const requires(D == 3) {
  std::vector<std::uint64_t> keys;
  for (std::uint32_t t = 0; t < triangles_.size(); ++t)
    for (std::size_t i = 0; i < 3; ++i)
      if (masks_[t] >> i & 1) keys.push_back(edge_key(triangles_[t][(i + 1) % 3], triangles_[t][(i + 2) % 3]));
  for (const auto* edges : {&polygon_edges_, &segment_edges_})
    for (const detail::OwnedEdge& e : *edges) keys.push_back(edge_key(e.edge[0], e.edge[1]));
  make_set(keys);
  return keys;
}

/// Edges of facets and segments, and the points within near_width_ of them.
template <int D>
void DomainBuilder<D>::find_points_near_edges() requires(D == 3) {
  std::vector<std::uint64_t> keys = constrained_edges();
  for (const auto& [a, b] : explicit_)
    if (a != b) keys.push_back(edge_key(a, b));
  for (const detail::FlatFacet& flat : flat_facets_)
    for (std::size_t k = 0; k < flat.vertices.size(); ++k)
      if (const std::uint32_t a = flat.vertices[k], b = flat.vertices[(k + 1) % flat.vertices.size()]; a != b) keys.push_back(edge_key(a, b));
  make_set(keys);
  std::vector<PlanarEdge> edges;
  for (const std::uint64_t key : keys) edges.push_back(edge_of(key));
  const detail::BoxTree<3> tree = widened_boxes(std::span<const PlanarEdge>(edges));
  for (std::uint32_t v = 0; v < out_.points_.size(); ++v) {
    stop_check_();
    const Point3 p = scaled_point(v);
    tree.at(p, [&](std::size_t i) {
      const auto& [a, b] = edges[i];
      if (v == a || v == b) return;
      const double t = part_of_edge_near(p, scaled_point(a), scaled_point(b), near_width_);
      if (t > 0) near_.on_edges.push_back({keys[i], t, v});
    });
  }
  std::sort(near_.on_edges.begin(), near_.on_edges.end());
}

/// `points` of each facet, sorted; gets those that are near to its inside.
template <int D>
void DomainBuilder<D>::find_points_near_facets(std::vector<std::vector<std::uint32_t>>& points) requires(D == 3) {
  std::vector<std::uint32_t> facet_of;
  for (const detail::TriangulatedFacet& facet : facets_) facet_of.resize(facet.first + facet.count, facet.input);
  const detail::BoxTree<3> tree = widened_boxes(std::span<const Triangle>(triangles_));
  for (std::uint32_t v = 0; v < out_.points_.size(); ++v) {
    stop_check_();
    const Point3 p = scaled_point(v);
    tree.at(p, [&](std::size_t t) {
      const std::uint32_t f = facet_of[t];
      if (std::binary_search(points[f].begin(), points[f].end(), v)) return;
      if (is_near_triangle(p, scaled_triangle(static_cast<std::uint32_t>(t)), near_width_)) near_.in_facets.emplace_back(f, v);
    });
  }
  make_set(near_.in_facets);
  for (const auto& [f, v] : near_.in_facets) points[f].push_back(v);
  for (auto& list : points) make_set(list);
}

template <int D>
std::span<const NearPoint> DomainBuilder<D>::near_on_edge(std::uint64_t key) const {
  const auto begin = std::lower_bound(near_.on_edges.begin(), near_.on_edges.end(), NearPoint{key, 0, 0});
  auto end = begin;
  while (end != near_.on_edges.end() && end->key == key) ++end;
  return {begin, end};
}

template <int D>
std::span<const std::pair<std::uint32_t, std::uint32_t>> DomainBuilder<D>::near_in_facet(std::uint32_t f) const {
  const auto begin = std::lower_bound(near_.in_facets.begin(), near_.in_facets.end(), std::pair{f, 0u});
  auto end = begin;
  while (end != near_.in_facets.end() && end->first == f) ++end;
  return {begin, end};
}

/// a, the points near the edge in their order, b.
template <int D>
std::vector<std::uint32_t> DomainBuilder<D>::near_chain(std::uint32_t a, std::uint32_t b) const {
  std::vector<std::uint32_t> chain{std::min(a, b)};
  for (const NearPoint& near : near_on_edge(edge_key(a, b))) chain.push_back(near.point);
  chain.push_back(std::max(a, b));
  if (b < a) std::reverse(chain.begin(), chain.end());
  return chain;
}

/// Is there anything near the facet, of one polygon, or near its edges?
template <int D>
bool DomainBuilder<D>::is_joined(std::uint32_t f) const requires(D == 3) {
  if (!near_in_facet(f).empty()) return true;
  const auto& polygon = plc_.facets[f].polygons[0];
  for (std::size_t k = 0; k < polygon.size(); ++k)
    if (!near_on_edge(edge_key(out_.point_of_input_[polygon[k]], out_.point_of_input_[polygon[(k + 1) % polygon.size()]])).empty()) return true;
  return false;
}

/// Is it a triangle with a corner near the edge opposite, so that nothing is left of it?
template <int D>
bool DomainBuilder<D>::is_joined_to_nothing(std::uint32_t f) const requires(D == 3) {
  const auto& facet = plc_.facets[f];
  if (near_.on_edges.empty() || facet.polygons.size() != 1 || facet.polygons[0].size() != 3 || !facet.holes.empty()) return false;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto at = [&](std::size_t i) { return out_.point_of_input_[facet.polygons[0][(k + i) % 3]]; };
    for (const NearPoint& near : near_on_edge(edge_key(at(1), at(2))))
      if (near.point == at(0)) return true;
  }
  return false;
}

/// The polygons go through the points near their edges; points near the inside are polygons of their own.
template <int D>
void DomainBuilder<D>::join(std::uint32_t f, CleanFacet& facet) const requires(D == 3) {
  if (near_.on_edges.empty() && near_.in_facets.empty()) return;
  std::vector<std::vector<std::uint32_t>> loops;
  for (const auto& loop : facet.loops) {
    const std::size_t n = loop.size();
    if (n < 3) {
      const auto chain = n == 2 ? near_chain(loop[0], loop[1]) : loop;
      if (n < 2) loops.push_back(loop);
      for (std::size_t k = 1; k < chain.size(); ++k) loops.push_back({chain[k - 1], chain[k]});
      continue;
    }
    auto& finer = loops.emplace_back();
    for (std::size_t k = 0; k < n; ++k) {
      const auto chain = near_chain(loop[k], loop[(k + 1) % n]);
      finer.insert(finer.end(), chain.begin(), chain.end() - 1);
    }
  }
  for (const auto& [same, v] : near_in_facet(f)) loops.push_back({v});
  facet.loops = std::move(loops);
}

/// Edges that pass each other within near_width_ and have no point there, as to let them meet would take one; and edges that run
/// along a triangle as near to it, as they cross something that must stay. (Where they meet exactly the diagnosis says so.)
/// @pre triangles_ are those of find_contacts()
template <int D>
void DomainBuilder<D>::refuse_near_crossings() const requires(D == 3) {
  near_edges_and_triangles([this](std::uint32_t a, std::uint32_t b, std::uint32_t t) {
    if (!runs_inside(a, b, t)) return;
    const std::uint32_t f = facets_[facet_of_[t]].input;
    attempt([&] {
      fail(Errc::entities_intersect,
           "the edge " + point_words(a) + " - " + point_words(b) + " runs along facet " + std::to_string(number(f)) +
               ", as near to it as points are merged, and crosses what is in it",
           plc_.source.facet_lines, f, {point_number(a), point_number(b), number(f)}, {out_.points_[a].x, out_.points_[b].x});
    });
  });
  std::vector<PlanarEdge> edges;
  for (const std::uint64_t key : constrained_edges()) edges.push_back(edge_of(key));
  const auto& p = out_.points_;
  widened_boxes(std::span<const PlanarEdge>(edges)).self_pairs([&](std::uint32_t i, std::uint32_t j) {
    stop_check_();
    const auto &e = edges[i], &f = edges[j];
    if (e[0] == f[0] || e[0] == f[1] || e[1] == f[0] || e[1] == f[1]) return;
    if (!pass_within({scaled_point(e[0]), scaled_point(e[1])}, {scaled_point(f[0]), scaled_point(f[1])}, near_width_)) return;
    if (orient3d(p[e[0]], p[e[1]], p[f[0]], p[f[1]]) == Sign::zero) return;
    attempt([&] {
      fail(Errc::entities_intersect,
           "the edges " + point_words(e[0]) + " - " + point_words(e[1]) + " and " + point_words(f[0]) + " - " + point_words(f[1]) +
               " come as near to each other as points are merged, where neither has a point",
           {}, 0, {point_number(e[0]), point_number(e[1]), point_number(f[0]), point_number(f[1])},
           {p[e[0]].x, p[e[1]].x, p[f[0]].x, p[f[1]].x});
    });
  });
}

/// For the report.
template <int D>
void DomainBuilder<D>::note_near() {
  for (const NearPoint& near : near_.on_edges) split_edges_.push_back({near.point, edge_of(near.key)[0], edge_of(near.key)[1]});
  for (const auto& [f, v] : near_.in_facets) attached_.push_back({v, f, 0});
}

/// Calls visit(a, b, t) for edges and triangles whose boxes, as much larger, meet.
template <int D>
template <class Visit>
void DomainBuilder<D>::near_edges_and_triangles(const Visit& visit) const requires(D == 3) {
  const detail::BoxTree<3> tree = widened_boxes(std::span<const Triangle>(triangles_));
  for (const std::uint64_t key : constrained_edges()) {
    stop_check_();
    const auto [a, b] = edge_of(key);
    tree.meeting(scaled_box(edge_of(key)), [&, a = a, b = b](std::size_t t) { visit(a, b, static_cast<std::uint32_t>(t)); });
  }
}

/// Triangles and edges that may run along them, although they meet nowhere.
template <int D>
void DomainBuilder<D>::find_near_inner_edges() requires(D == 3) {
  near_edges_and_triangles([this](std::uint32_t a, std::uint32_t b, std::uint32_t t) {
    if (runs_inside(a, b, t)) inner_edges_.emplace_back(t, edge_key(a, b));
  });
}

/// Is the part of ab that is seen inside of the triangle, along its normal, within near_width_ of its plane?
template <int D>
bool DomainBuilder<D>::runs_near(std::uint32_t a, std::uint32_t b, std::uint32_t t) const requires(D == 3) {
  const auto s = scaled_triangle(t);
  const Point3 p = scaled_point(a), q = scaled_point(b);
  const auto n = detail::cross(detail::difference(s[1], s[0]), detail::difference(s[2], s[0]));
  double from = 0, to = 1;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto inward = detail::cross(n, detail::difference(s[(i + 1) % 3], s[i]));
    const double at_p = detail::dot(inward, detail::difference(p, s[i])), at_q = detail::dot(inward, detail::difference(q, s[i]));
    if (at_p < 0 && at_q > 0) from = std::max(from, at_p / (at_p - at_q));
    if (at_p > 0 && at_q < 0) to = std::min(to, at_p / (at_p - at_q));
  }
  const double most = near_width_ * std::sqrt(detail::dot(n, n));
  const auto height = [&](double part) {
    return (1 - part) * detail::dot(n, detail::difference(p, s[0])) + part * detail::dot(n, detail::difference(q, s[0]));
  };
  // Edges that leave a corner steeply, beside the triangle but for rounding, have a part inside that is as short as the distance.
  const auto along = detail::difference(q, p);
  const bool is_long = (to - from) * std::sqrt(detail::dot(along, along)) > 64 * near_width_;
  return is_long && std::fabs(height(from)) <= most && std::fabs(height(to)) <= most;
}

/// Do the corners opposite lie within near_width_ of the planes of each other's triangles?
template <int D>
bool DomainBuilder<D>::is_nearly_flat(std::span<const detail::EdgeUse> joint) const requires(D == 3) {
  const auto [a, b, c, d] = corners(joint);
  const double most = near_width_ / scale_;
  return detail::plane_distance(a, b, c, d) <= most && detail::plane_distance(a, b, d, c) <= most;
}

template bool DomainBuilder<3>::find_near();
template void DomainBuilder<3>::find_near_inner_edges();
template void DomainBuilder<3>::refuse_near_crossings() const;
template bool DomainBuilder<3>::runs_near(std::uint32_t, std::uint32_t, std::uint32_t) const;
template bool DomainBuilder<3>::is_nearly_flat(std::span<const detail::EdgeUse>) const;
template std::span<const NearPoint> DomainBuilder<3>::near_on_edge(std::uint64_t) const;
template std::vector<std::uint32_t> DomainBuilder<2>::near_chain(std::uint32_t, std::uint32_t) const;
template std::vector<std::uint32_t> DomainBuilder<3>::near_chain(std::uint32_t, std::uint32_t) const;
template bool DomainBuilder<3>::is_joined(std::uint32_t) const;
template bool DomainBuilder<3>::is_joined_to_nothing(std::uint32_t) const;
template void DomainBuilder<3>::join(std::uint32_t, CleanFacet&) const;
template void DomainBuilder<2>::note_near();
template void DomainBuilder<3>::note_near();

}  // namespace pgdr
