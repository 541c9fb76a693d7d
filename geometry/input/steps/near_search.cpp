// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "input/steps/near_search.hpp"

#include <algorithm>
#include <cmath>

#include "numbers/vectors.hpp"
#include "pgdr/predicates.hpp"
#include "space/make_set.hpp"

namespace pgdr::detail {
namespace {

/// How far on the way from a to b the point of the line nearest to p is; NaN if p is not within `width` of the line there.
double part_of_edge_near(const Point3& p, const Point3& a, const Point3& b, double width) {
  const auto along = difference(b, a), to = difference(p, a);
  const double t = dot(to, along) / dot(along, along);
  double square = 0;
  for (std::size_t k = 0; k < 3; ++k) square += (to[k] - t * along[k]) * (to[k] - t * along[k]);
  return t > 0 && t < 1 && square <= width * width ? t : std::nan("");
}

/// Are two edges, which are not parallel, within `width` of each other somewhere inside both?
bool pass_within(const std::array<Point3, 2>& e, const std::array<Point3, 2>& f, double width) {
  const auto u = difference(e[1], e[0]), v = difference(f[1], f[0]), w = difference(f[0], e[0]);
  const auto n = cross(u, v);
  const double square = dot(n, n), height = dot(n, w);
  if (!(height * height <= width * width * square) || !(square > 0)) return false;
  const double s = dot(cross(w, v), n) / square, t = dot(cross(w, u), n) / square;
  return s > 0 && s < 1 && t > 0 && t < 1;
}

/// Is p within `width` of the inside of the triangle?
bool is_near_triangle(const Point3& p, const std::array<Point3, 3>& t, double width) {
  const auto n = cross(difference(t[1], t[0]), difference(t[2], t[0]));
  const double height = dot(n, difference(p, t[0]));
  if (!(height * height <= width * width * dot(n, n))) return false;
  for (std::size_t i = 0; i < 3; ++i) {
    const Point3 &a = t[i], &b = t[(i + 1) % 3];
    if (!(dot(cross(difference(b, a), difference(p, a)), n) >= 0)) return false;
  }
  return true;
}

/// The edges of facets and segments, by their keys, sorted.
std::vector<std::uint64_t> constrained_edges(const FacetTriangles& faces, std::span<const OwnedEdge> segment_edges) {
  std::vector<std::uint64_t> keys;
  for (std::uint32_t t = 0; t < faces.triangles.size(); ++t)
    for (std::size_t i = 0; i < 3; ++i)
      if (faces.is_constraint(t, i)) keys.push_back(faces.key_of_edge(t, i));
  for (const auto edges : {std::span<const OwnedEdge>(faces.polygon_edges), segment_edges})
    for (const OwnedEdge& e : edges) keys.push_back(edge_key(e.edge[0], e.edge[1]));
  make_set(keys);
  return keys;
}

std::vector<PlanarEdge> edges_of(std::span<const std::uint64_t> keys) {
  std::vector<PlanarEdge> edges;
  for (const std::uint64_t key : keys) edges.push_back(edge_of(key));
  return edges;
}

}  // namespace

NearSearch::NearSearch(const BuildInput<3>& in) : in_(in), shapes_(in.points, in.scale), width_(in.tolerance * in.scale) {}

template <std::size_t N>
Box<3> NearSearch::box(const std::array<std::uint32_t, N>& corners) const {
  auto box = Box<3>::around(shapes_.scaled(corners[0]));
  for (const std::uint32_t v : corners) box.add(shapes_.scaled(v));
  return box;
}

/// Of edges or triangles, each larger by the width on all sides.
template <std::size_t N>
BoxTree<3> NearSearch::widened_boxes(std::span<const std::array<std::uint32_t, N>> simplices) const {
  std::vector<Box<3>> boxes;
  for (const auto& corners : simplices) boxes.push_back(box(corners).widened(width_));
  return BoxTree<3>(boxes);
}

std::array<Point3, 3> NearSearch::scaled(const PlanarTriangle& t) const {
  return {shapes_.scaled(t[0]), shapes_.scaled(t[1]), shapes_.scaled(t[2])};
}

NearContacts NearSearch::find(const TriangulatedFacets& facets, const ExplicitSegments<3>& segments) const {
  const FacetTriangles& faces = facets.faces;
  NearContacts on_edges(points_near_edges(facets, segments), {});
  std::vector<std::vector<std::uint32_t>> points(in_.plc.facets.size());
  for (const TriangulatedFacet& facet : faces.facets)
    for (std::uint32_t t = facet.first; t < facet.first + facet.count; ++t)
      for (std::size_t i = 0; i < 3; ++i) {
        points[facet.input].push_back(faces.triangles[t][i]);
        if (!faces.is_constraint(t, i)) continue;
        for (const NearPoint& near : on_edges.on_edge(faces.key_of_edge(t, i))) points[facet.input].push_back(near.point);
      }
  for (auto& list : points) make_set(list);
  return std::move(on_edges).with_points_in_facets(points_near_facets(faces, std::move(points)));
}

/// Edges of facets and segments, and the points within the width of them.
std::vector<NearPoint> NearSearch::points_near_edges(const TriangulatedFacets& facets,
                                                     const ExplicitSegments<3>& segments) const {
  std::vector<std::uint64_t> keys = constrained_edges(facets.faces, {});
  for (const auto& [a, b] : segments.ends())
    if (a != b) keys.push_back(edge_key(a, b));
  for (const FlatFacet& flat : facets.flat)
    for (std::size_t k = 0; k < flat.vertices.size(); ++k)
      if (const std::uint32_t a = flat.vertices[k], b = flat.vertices[(k + 1) % flat.vertices.size()]; a != b)
        keys.push_back(edge_key(a, b));
  make_set(keys);
  const std::vector<PlanarEdge> edges = edges_of(keys);
  const BoxTree<3> tree = widened_boxes(std::span<const PlanarEdge>(edges));
  std::vector<NearPoint> found;
  for (std::uint32_t v = 0; v < in_.points.size(); ++v) {
    in_.stop();
    const Point3 p = shapes_.scaled(v);
    tree.at(p, [&](std::size_t i) {
      const auto& [a, b] = edges[i];
      if (v == a || v == b) return;
      const double t = part_of_edge_near(p, shapes_.scaled(a), shapes_.scaled(b), width_);
      if (t > 0) found.push_back({keys[i], t, v});
    });
  }
  std::sort(found.begin(), found.end());
  return found;
}

/// Pairs of an input facet and a point near to its inside that is not among its `points`, which are sorted.
std::vector<std::pair<std::uint32_t, std::uint32_t>> NearSearch::points_near_facets(
    const FacetTriangles& faces, std::vector<std::vector<std::uint32_t>> points) const {
  std::vector<std::uint32_t> facet_of;
  for (const TriangulatedFacet& facet : faces.facets) facet_of.resize(facet.first + facet.count, facet.input);
  const BoxTree<3> tree = widened_boxes(std::span<const PlanarTriangle>(faces.triangles));
  std::vector<std::pair<std::uint32_t, std::uint32_t>> found;
  for (std::uint32_t v = 0; v < in_.points.size(); ++v) {
    in_.stop();
    const Point3 p = shapes_.scaled(v);
    tree.at(p, [&](std::size_t t) {
      const std::uint32_t f = facet_of[t];
      if (std::binary_search(points[f].begin(), points[f].end(), v)) return;
      if (is_near_triangle(p, scaled(faces.triangles[t]), width_)) found.emplace_back(f, v);
    });
  }
  make_set(found);
  return found;
}

void NearSearch::edges_and_triangles(const FacetTriangles& faces, std::span<const OwnedEdge> segment_edges,
                                     const std::function<void(std::uint32_t, std::uint32_t, std::uint32_t)>& visit) const {
  const BoxTree<3> tree = widened_boxes(std::span<const PlanarTriangle>(faces.triangles));
  for (const auto& [a, b] : edges_of(constrained_edges(faces, segment_edges))) {
    in_.stop();
    tree.meeting(box(PlanarEdge{a, b}), [&, a = a, b = b](std::uint32_t t) { visit(a, b, t); });
  }
}

void NearSearch::passing_edges(const FacetTriangles& faces, std::span<const OwnedEdge> segment_edges,
                               const std::function<void(const PlanarEdge&, const PlanarEdge&)>& visit) const {
  const std::vector<PlanarEdge> edges = edges_of(constrained_edges(faces, segment_edges));
  const auto& p = in_.points;
  widened_boxes(std::span<const PlanarEdge>(edges)).self_pairs([&](std::uint32_t i, std::uint32_t j) {
    in_.stop();
    const auto &e = edges[i], &f = edges[j];
    if (e[0] == f[0] || e[0] == f[1] || e[1] == f[0] || e[1] == f[1]) return;
    if (!pass_within({shapes_.scaled(e[0]), shapes_.scaled(e[1])}, {shapes_.scaled(f[0]), shapes_.scaled(f[1])}, width_)) return;
    if (orient3d(p[e[0]], p[e[1]], p[f[0]], p[f[1]]) != Sign::zero) visit(e, f);
  });
}

bool NearSearch::runs_near(std::uint32_t a, std::uint32_t b, const PlanarTriangle& t) const {
  const auto s = scaled(t);
  const Point3 p = shapes_.scaled(a), q = shapes_.scaled(b);
  const auto n = cross(difference(s[1], s[0]), difference(s[2], s[0]));
  double from = 0, to = 1;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto inward = cross(n, difference(s[(i + 1) % 3], s[i]));
    const double at_p = dot(inward, difference(p, s[i])), at_q = dot(inward, difference(q, s[i]));
    if (at_p < 0 && at_q > 0) from = std::max(from, at_p / (at_p - at_q));
    if (at_p > 0 && at_q < 0) to = std::min(to, at_p / (at_p - at_q));
  }
  const double most = width_ * std::sqrt(dot(n, n));
  const auto height = [&](double part) { return (1 - part) * dot(n, difference(p, s[0])) + part * dot(n, difference(q, s[0])); };
  // Edges that leave a corner steeply, beside the triangle but for rounding, have a part inside that is as short as the distance.
  const auto along = difference(q, p);
  const bool is_long = (to - from) * std::sqrt(dot(along, along)) > 64 * width_;
  return is_long && std::fabs(height(from)) <= most && std::fabs(height(to)) <= most;
}

bool NearSearch::is_nearly_flat(const std::array<Point3, 4>& corners_of_joint) const {
  const auto& [a, b, c, d] = corners_of_joint;
  const double most = width_ / in_.scale;
  return plane_distance(a, b, c, d) <= most && plane_distance(a, b, d, c) <= most;
}

}  // namespace pgdr::detail
