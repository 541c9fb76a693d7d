// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "build/plane_subdivider.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "build/contact_resolver.hpp"
#include "build/plane_clusters.hpp"
#include "build/triangle_splitter.hpp"
#include "input/triangle_shapes.hpp"
#include "numbers/vectors.hpp"
#include "pgdr/predicates.hpp"
#include "space/box_tree.hpp"
#include "space/make_set.hpp"

namespace pgdr::detail {
namespace {

/// Each round adds the points where edges cross as they are; pieces of edges, which are off them by the rounding of these points,
/// may cross once more where three of them nearly meet. That is over after two or three rounds, or goes on: then it is left to
/// the diagnosis.
constexpr int most_rounds = 8;

constexpr bool opposite(Sign a, Sign b) { return a != Sign::zero && a == -b; }

/// Do the insides of two edges cross, seen along the axis?
bool cross_along(std::span<const Point3> p, const PlanarEdge& e, const PlanarEdge& f, int axis) {
  if (e[0] == f[0] || e[0] == f[1] || e[1] == f[0] || e[1] == f[1]) return false;
  return opposite(orient_projected(p[e[0]], p[e[1]], p[f[0]], axis), orient_projected(p[e[0]], p[e[1]], p[f[1]], axis)) &&
         opposite(orient_projected(p[f[0]], p[f[1]], p[e[0]], axis), orient_projected(p[f[0]], p[f[1]], p[e[1]], axis));
}

/// How far lines that are not parallel are from each other.
double distance_of_lines(std::span<const Point3> p, const PlanarEdge& e, const PlanarEdge& f, double scale) {
  Vector<3> u = difference(p[e[1]], p[e[0]]), v = difference(p[f[1]], p[f[0]]), w = difference(p[f[0]], p[e[0]]);
  for (Vector<3>* d : {&u, &v, &w})
    for (double& x : *d) x *= scale;
  const Vector<3> n = cross(u, v);
  return std::fabs(dot(n, w)) / std::sqrt(dot(n, n));
}

/// Do all triangles of a facet lie in the plane of the largest?
bool is_planar(std::span<const PlanarTriangle> triangles, std::span<const Point3> p, const TriangleShapes& shapes) {
  const auto size = [&](const PlanarTriangle& t) {
    const Vector<3> n = shapes.normal(t);
    return dot(n, n);
  };
  const auto [a, b, c] = *std::ranges::max_element(triangles, {}, size);
  return std::ranges::all_of(triangles, [&, a = a, b = b, c = c](const PlanarTriangle& t) {
    return std::ranges::all_of(
        t, [&](std::uint32_t v) { return v == a || v == b || v == c || orient3d(p[a], p[b], p[c], p[v]) == Sign::zero; });
  });
}

}  // namespace

PlaneSubdivider::PlaneSubdivider(BuildInput<3>& in, PointLists lists, FacetTriangles& faces,
                                 std::vector<OwnedEdge>& segment_edges, BuildReport<3>& report)
    : in_(in),
      lists_(lists),
      faces_(faces),
      segment_edges_(segment_edges),
      report_(report),
      first_added_(static_cast<std::uint32_t>(in.points.size())) {}

bool PlaneSubdivider::run() {
  bool any = false;
  for (int round = 0; round < most_rounds; ++round, any = true) {
    in_.stop();
    const PlaneWidth width(in_, first_added_);
    const PlaneMeetings met = find_plane_meetings(in_, faces_, segment_edges_, width);
    if (met.empty()) break;
    const EdgeUses uses(faces_, segment_edges_, in_.bulk, in_.stop);
    const PlaneEdges edges(in_, faces_, uses, width);
    if (!areas_ && !met.overlaps.empty()) areas_.emplace(in_, faces_, uses, width);
    find_crossings(met, edges, width);
    if (crossing_.empty() || round + 1 == most_rounds) {
      triangulate(met, edges, width);
      any = true;
      break;
    }
    split_at_crossings(width);
  }
  if (any) mark_bent_facets();
  return any;
}

/// Clusters, the edges inside of them, and what of these crosses.
void PlaneSubdivider::find_crossings(const PlaneMeetings& met, const PlaneEdges& edges, const PlaneWidth& width) {
  clusters_ = DisjointSets(faces_.facets.size());
  touched_.clear();
  inner_.clear();
  crossing_.clear();
  for (const auto& [f, g] : met.overlaps) {
    clusters_.unite(f, g);
    touched_.insert(touched_.end(), {f, g});
  }
  name_planes();
  for (const auto& [t, key] : met.inner) {
    if (edges.is_soft(key, plane_of_) && !crosses_plane(faces_.facet_of[t], key, edges)) continue;
    touched_.push_back(faces_.facet_of[t]);
    inner_.emplace_back(faces_.facet_of[t], key);
    look_across(t, key, edges);
  }
  make_set(touched_);
  make_set(inner_);
  find_inner_crossings(edges, width);
  make_set(crossing_);
}

/// Do two facets meet at this edge from both sides of facet f? They may be one as far as they go, but their edge is one of f. (A
/// diagonal of one facet was not given, and may be another in a copy.)
bool PlaneSubdivider::crosses_plane(std::uint32_t f, std::uint64_t key, const PlaneEdges& edges) const {
  const auto uses = edges.uses(key);
  return uses[0].owner != uses[1].owner && std::ranges::none_of(uses, [&](const EdgeUse& use) {
           return use.is_triangle() && plane_of_[use.owner] == plane_of_[f];
         });
}

/// The edges of triangle t that an edge inside it crosses, or, at a point that was added, ends on.
void PlaneSubdivider::look_across(std::uint32_t t, std::uint64_t key, const PlaneEdges& edges) {
  const std::uint32_t f = faces_.facet_of[t];
  const int axis = faces_.facets[f].axis;
  const auto& p = in_.points;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::uint64_t side = faces_.key_of_edge(t, i);
    const auto [u, v] = edge_of(side);
    const bool crosses = cross_along(p, edge_of(key), {u, v}, axis);
    const bool ends_there = std::ranges::any_of(edge_of(key), [&, u = u, v = v](std::uint32_t w) {
      return w >= first_added_ && w != u && w != v && orient_projected(p[u], p[v], p[w], axis) == Sign::zero;
    });
    if (!crosses && !ends_there) continue;
    if (edges.is_soft(side, plane_of_)) {
      const std::uint32_t g = edges.beyond(t, i, plane_of_);
      clusters_.unite(f, g);
      touched_.push_back(g);
    } else if (crosses) {
      add_crossing(key, side, edges);
    }
  }
}

// Two segments of the input that cross are refused wherever they do, if no facet has edges there. Those that run along outlines
// of facets cross where these overlap, and are cut as they are.
void PlaneSubdivider::add_crossing(std::uint64_t first, std::uint64_t second, const PlaneEdges& edges) {
  const bool of_outlines = edges.is_on_outline(first) && edges.is_on_outline(second);
  if (of_outlines || !edges.is_of_segments(first) || !edges.is_of_segments(second))
    crossing_.emplace_back(std::min(first, second), std::max(first, second));
}

/// The edges inside of each cluster that cross each other, where neither need be an edge of its facets.
void PlaneSubdivider::find_inner_crossings(const PlaneEdges& edges, const PlaneWidth& width) {
  Edges by_cluster;
  for (const auto& [f, key] : inner_) by_cluster.emplace_back(clusters_.find(f), key);
  make_set(by_cluster);
  std::vector<std::uint64_t> inside;
  for (auto begin = by_cluster.begin(), end = begin; begin != by_cluster.end(); begin = end) {
    inside.clear();
    for (; end != by_cluster.end() && end->first == begin->first; ++end) inside.push_back(end->second);
    if (inside.size() > 1) cross_each_other(inside, faces_.facets[begin->first].axis, edges, width);
  }
}

void PlaneSubdivider::cross_each_other(std::span<const std::uint64_t> inside, int axis, const PlaneEdges& edges,
                                       const PlaneWidth& width) {
  std::vector<std::array<std::uint32_t, 3>> corners;
  for (const std::uint64_t key : inside) corners.push_back({edge_of(key)[0], edge_of(key)[1], no_entity});
  const auto& p = in_.points;
  BoxTree<3>(corners, p, width.largest()).self_pairs([&](std::uint32_t i, std::uint32_t j) {
    in_.stop();
    const PlanarEdge e = edge_of(inside[i]), f = edge_of(inside[j]);
    if (!cross_along(p, e, f, axis)) return;
    const double most = width.of(std::array{e[0], e[1], f[0], f[1]});
    const bool meet = most > 0 ? distance_of_lines(p, e, f, in_.scale) <= 2 * most  // each is that near to the plane
                               : orient3d(p[e[0]], p[e[1]], p[f[0]], p[f[1]]) == Sign::zero;
    if (meet) add_crossing(inside[i], inside[j], edges);
  });
}

void PlaneSubdivider::split_at_crossings(const PlaneWidth& width) {
  std::vector<PointOn> on_edges = EdgeCrossings(in_, width, crossing_).add_points(lists_, report_);
  const PointsOnEdges<3> points(in_.points, std::move(on_edges));
  points.split(segment_edges_, report_);
  points.split(faces_.polygon_edges, report_);
  split_triangles(in_, points, {}, faces_, report_);
}

void PlaneSubdivider::triangulate(const PlaneMeetings& met, const PlaneEdges& edges, const PlaneWidth& width) {
  name_planes();
  PlaneClusters made(in_, width, faces_, edges, plane_of_, areas_ ? &*areas_ : nullptr, report_);
  std::vector<std::pair<std::uint32_t, std::uint32_t>> facets;  // by cluster
  Edges inner;
  for (const std::uint32_t f : touched_) facets.emplace_back(clusters_.find(f), f);
  for (const auto& [f, key] : inner_) inner.emplace_back(clusters_.find(f), key);
  make_set(facets);
  make_set(inner);
  note_overlaps(met);
  auto edge = inner.begin();
  std::vector<std::uint32_t> cluster;
  std::vector<std::uint64_t> inside;
  for (auto begin = facets.begin(), end = begin; begin != facets.end(); begin = end) {
    in_.stop();
    cluster.clear();
    inside.clear();
    for (; end != facets.end() && end->first == begin->first; ++end) cluster.push_back(end->second);
    for (; edge != inner.end() && edge->first == begin->first; ++edge) inside.push_back(edge->second);
    if (made.triangulate(cluster, inside)) note_inside(cluster, inside, edges);
  }
  made.write();
}

void PlaneSubdivider::name_planes() {
  plane_of_.clear();
  for (std::uint32_t f = 0; f < faces_.facets.size(); ++f) plane_of_.push_back(clusters_.find(f));
}

void PlaneSubdivider::note_overlaps(const PlaneMeetings& met) {
  std::vector<std::pair<std::int64_t, std::int64_t>> pairs;
  for (const auto& [f, g] : met.overlaps)
    pairs.emplace_back(report_.number(faces_.facets[g].input), report_.number(faces_.facets[f].input));
  make_set(pairs);
  for (const auto& [second, first] : pairs)
    report_.repairs.overlaps.add([&, f = first, g = second] { return std::to_string(g) + " on " + std::to_string(f); },
                                 {second, first});
}

/// Edges that no facet of the cluster has are repairs of their own.
void PlaneSubdivider::note_inside(std::span<const std::uint32_t> cluster, std::span<const std::uint64_t> inside,
                                  const PlaneEdges& edges) {
  for (const std::uint64_t key : inside) {
    const bool own = std::ranges::any_of(
        edges.uses(key), [&](const EdgeUse& use) { return use.is_triangle() && std::ranges::binary_search(cluster, use.owner); });
    if (own) continue;
    const auto in = std::ranges::find_if(cluster, [&](std::uint32_t f) {
      return std::ranges::binary_search(inner_, std::pair{f, key});
    });
    const std::int64_t a = report_.point_number(edge_of(key)[0]), b = report_.point_number(edge_of(key)[1]);
    const std::int64_t f = report_.number(faces_.facets[*in].input);
    report_.repairs.edges_in_facets.add(
        [&] { return std::to_string(a) + " - " + std::to_string(b) + " in " + std::to_string(f); }, {a, b, f});
  }
}

void PlaneSubdivider::mark_bent_facets() {
  const TriangleShapes shapes(in_.points, in_.scale);
  for (TriangulatedFacet& facet : faces_.facets) {
    if (!facet.planar || facet.count < 2) continue;
    in_.stop();
    facet.planar = is_planar(faces_.of(facet), in_.points, shapes);
  }
}

void PlaneSubdivider::refuse_rest() {
  const PlaneMeetings met = find_plane_meetings(in_, faces_, segment_edges_, PlaneWidth(in_, first_added_));
  const auto& p = in_.points;
  const auto input = [&](std::uint32_t f) { return faces_.facets[f].input; };
  for (const auto& [f, g] : met.overlaps)
    report_.attempt([&, f = f, g = g] {
      const std::int64_t first = report_.number(input(f)), second = report_.number(input(g));
      report_.fail(Errc::facets_overlap,
                   "facets " + std::to_string(first) + " and " + std::to_string(second) + " lie in one plane and overlap",
                   SourceItem::facet, input(f), {first, second}, {});
    });
  for (const auto& [t, key] : met.inner) {
    const auto [a, b] = edge_of(key);
    const std::uint32_t f = input(faces_.facet_of[t]);
    report_.attempt([&, a = a, b = b] {
      report_.fail(Errc::entities_intersect,
                   "the edge " + report_.point_words(a) + " - " + report_.point_words(b) + " runs along facet " +
                       std::to_string(report_.number(f)) + ", as near to it as the tolerance, and crosses what is in it",
                   SourceItem::facet, f, {report_.point_number(a), report_.point_number(b), report_.number(f)}, {p[a].x, p[b].x});
    });
  }
}

}  // namespace pgdr::detail
