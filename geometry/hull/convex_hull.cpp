// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "pgdr/convex_hull.hpp"

#include <algorithm>
#include <array>
#include <set>
#include <utility>

#include "hull/space_hull.hpp"
#include "input/edges.hpp"
#include "input/usable_plc.hpp"
#include "join/near_tests.hpp"
#include "join/passing_points.hpp"
#include "pgdr/error.hpp"
#include "pgdr/predicates.hpp"
#include "space/box_tree.hpp"
#include "space/point_places.hpp"

namespace pgdr {
namespace {

/// The corners of the convex hull of the points, counterclockwise (Andrew 1979). `first`: of each point the first at its place.
std::vector<std::uint32_t> corners_of_hull(const std::vector<Point2>& p, const std::vector<std::uint32_t>& first) {
  std::vector<std::uint32_t> order, corners;
  for (std::uint32_t i = 0; i < p.size(); ++i)
    if (first[i] == i) order.push_back(i);
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) { return lex_less(p[a], p[b]); });
  for (int half = 0; half < 2; ++half) {
    std::vector<std::uint32_t> chain;
    for (const std::uint32_t v : order) {
      while (chain.size() >= 2 && orient2d(p[chain.end()[-2]], p[chain.back()], p[v]) != Sign::positive) chain.pop_back();
      chain.push_back(v);
    }
    if (!chain.empty()) corners.insert(corners.end(), chain.begin(), chain.end() - 1);
    std::reverse(order.begin(), order.end());
  }
  return corners;
}

/// The edges of the hull with these corners, through all points that they pass within the tolerance.
std::vector<std::uint64_t> edges_of_hull(const std::vector<Point2>& points, const std::vector<std::uint32_t>& corners,
                                         const std::vector<std::uint32_t>& first, double tolerance) {
  const double scale = detail::scale_of<2>(points).first;
  std::vector<Point2> p(points);
  for (Point2& x : p)
    for (double& c : x.x) c *= scale;
  std::vector<detail::PlanarEdge> edges;
  std::vector<detail::Box<2>> boxes;
  for (std::size_t k = 0; k < corners.size(); ++k) {
    edges.push_back({corners[k], corners[(k + 1) % corners.size()]});
    auto box = detail::Box<2>::around(p[edges.back()[0]]);
    box.add(p[edges.back()[1]]);
    boxes.push_back(box.widened(tolerance * scale));
  }
  std::vector<std::vector<std::uint32_t>> inside(edges.size());
  const detail::BoxTree<2> tree(boxes);
  for (std::uint32_t v = 0; v < p.size(); ++v)
    if (first[v] == v)
      tree.at(p[v], [&](std::uint32_t k) {
        if (v != edges[k][0] && v != edges[k][1] &&
            detail::passes_within(p[edges[k][0]], p[edges[k][1]], p[v], tolerance * scale))
          inside[k].push_back(v);
      });
  std::vector<std::uint64_t> keys;
  for (std::size_t k = 0; k < edges.size(); ++k) {
    const auto chain = detail::chain_along(p, edges[k], std::move(inside[k]));
    for (std::size_t i = 1; i < chain.size(); ++i) keys.push_back(detail::edge_key(chain[i - 1], chain[i]));
  }
  return keys;
}

std::vector<std::uint32_t> without_repeats(const std::vector<std::uint32_t>& first) {
  std::vector<std::uint32_t> distinct;
  for (std::uint32_t i = 0; i < first.size(); ++i)
    if (first[i] == i) distinct.push_back(i);
  return distinct;
}

/// The corners of facets of one polygon, each at the first point of its place, sorted.
std::set<std::vector<std::uint32_t>> polygons_of(const Plc<3>& plc, const std::vector<std::uint32_t>& first) {
  std::set<std::vector<std::uint32_t>> known;
  for (const auto& facet : plc.facets) {
    if (facet.polygons.size() != 1) continue;
    std::vector<std::uint32_t> corners;
    for (const std::uint32_t v : facet.polygons[0]) corners.push_back(first[v]);
    std::ranges::sort(corners);
    known.insert(std::move(corners));
  }
  return known;
}

/// Are all corners within the tolerance of the edge between two of them, so that they are on it? Rounding makes such polygons of
/// points along an edge.
bool is_edge_within(const std::vector<Point3>& p, const std::vector<std::uint32_t>& corners, double tolerance) {
  std::array<std::uint32_t, 2> ends{corners[0], corners[1]};
  for (const std::uint32_t a : corners)
    for (const std::uint32_t b : corners)
      if (squared_distance(p[ends[0]], p[ends[1]]) < squared_distance(p[a], p[b])) ends = {a, b};
  return tolerance > 0 && std::ranges::all_of(corners, [&](std::uint32_t v) {
           return v == ends[0] || v == ends[1] || detail::part_of_edge_near<3>(p[v], p[ends[0]], p[ends[1]], tolerance);
         });
}

}  // namespace

Plc<2> with_convex_hull(const Plc<2>& plc) {
  if (!detail::is_usable(plc)) return plc;
  const auto first = detail::first_at_places<2>(plc.points);
  std::set<std::uint64_t> known;
  for (const auto& s : plc.segments) known.insert(detail::edge_key(first[s.points[0]], first[s.points[1]]));
  Plc<2> out = plc;
  for (const std::uint64_t key : edges_of_hull(plc.points, corners_of_hull(plc.points, first), first, tolerance_of(plc)))
    if (const auto [a, b] = detail::edge_of(key); known.insert(key).second) out.segments.push_back({{a, b}, 0});
  if (!out.source.segment_lines.empty()) out.source.segment_lines.resize(out.segments.size(), 0);
  return out;
}

Plc<3> with_convex_hull(const Plc<3>& plc) {
  if (!detail::is_usable(plc)) return plc;
  const auto first = detail::first_at_places<3>(plc.points);
  const auto facets = detail::facets_of_hull(plc.points, without_repeats(first));
  if (facets.empty())
    throw InputError(
        {Errc::no_volume, "all points lie in one plane: their convex hull has no volume", plc.source.file, 0, {}, {}});
  const std::set<std::vector<std::uint32_t>> known = polygons_of(plc, first);
  const double tolerance = tolerance_of(plc);
  Plc<3> out = plc;
  for (const std::vector<std::uint32_t>& corners : facets) {
    std::vector<std::uint32_t> sorted = corners;
    std::ranges::sort(sorted);
    if (known.contains(sorted) || is_edge_within(plc.points, corners, tolerance)) continue;
    auto& facet = out.facets.emplace_back();
    facet.polygons.push_back(corners);
  }
  if (!out.source.facet_lines.empty()) out.source.facet_lines.resize(out.facets.size(), 0);
  if (!out.facet_bodies.empty()) {
    out.facet_bodies.resize(out.facets.size(), static_cast<std::uint32_t>(out.body_names.size()));
    out.body_names.push_back("convex_hull");
  }
  return out;
}

}  // namespace pgdr
