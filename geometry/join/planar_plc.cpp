// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "pgdr/planar_plc.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "input/edges.hpp"
#include "input/words.hpp"
#include "join/crossing_resolver.hpp"
#include "join/passing_points.hpp"
#include "numbers/finite.hpp"
#include "pgdr/predicates.hpp"
#include "space/box_tree.hpp"
#include "space/point_places.hpp"

namespace pgdr {
namespace {

using detail::CrossingResolver;

bool is_usable(const Plc<2>& plc) {
  if (!std::ranges::all_of(plc.points, detail::is_finite<2>)) return false;
  for (const auto& s : plc.segments)
    for (const std::uint32_t v : s.points)
      if (v >= plc.points.size()) return false;
  return true;
}

/// The first of the points at each place.
std::vector<std::uint32_t> first_at_place(const std::vector<Point2>& points) {
  std::map<std::array<double, 2>, std::uint32_t> seen;
  std::vector<std::uint32_t> first(points.size());
  for (std::uint32_t i = 0; i < points.size(); ++i) first[i] = seen.try_emplace(points[i].x, i).first->second;
  return first;
}

void report(const CrossingResolver& resolved, const Plc<2>& plc, std::vector<Diagnostic>& repairs) {
  detail::RepairList list;
  const auto number = [&](std::uint32_t s) { return std::int64_t{s} + plc.first_index; };
  for (const auto& [s, t] : resolved.pairs()) {
    const std::int64_t first = number(s), second = number(t);
    list.add([&] { return std::to_string(first) + " x " + std::to_string(second); }, {first, second});
  }
  for (std::size_t i = plc.points.size(); i < resolved.points().size(); ++i)
    list.diagnostic.points.push_back(detail::in_space(resolved.points()[i]));
  detail::RepairList touching;
  for (const auto& [edge, v] : resolved.touching()) {
    const std::int64_t point = number(v), from = number(detail::edge_of(edge)[0]), to = number(detail::edge_of(edge)[1]);
    const auto words = [&] { return std::to_string(point) + " in " + std::to_string(from) + "-" + std::to_string(to); };
    touching.add(words, {point, from, to});
  }
  detail::RepairList dropped;
  for (const detail::OwnedEdge& e : resolved.edges()) {
    if (e.edge[0] != e.edge[1]) continue;
    const std::int64_t segment = number(e.owner), a = number(plc.segments[e.owner].points[0]),
                       b = number(plc.segments[e.owner].points[1]);
    dropped.add([&] { return std::to_string(segment); }, {segment, a, b});
  }
  dropped.report(Errc::degenerate_segment, "segments of no length, dropped", plc.source.file, repairs);
  touching.report(Errc::point_on_segment, "points inside a segment, which is split there", plc.source.file, repairs);
  list.report(Errc::entities_intersect, "segments that cross, now split there", plc.source.file, repairs);
}

/// Those of the new points: linear along the edge that they were made on.
void append_attributes(const CrossingResolver& resolved, Plc<2>& plc, std::size_t old_points) {
  const std::size_t columns = old_points == 0 ? 0 : plc.point_attributes.size() / old_points;
  if (columns * old_points != plc.point_attributes.size()) return;  // Domain refuses it
  const auto& p = resolved.points();
  for (std::size_t i = 0; i < resolved.origins().size(); ++i) {
    const auto [a, b] = resolved.origins()[i];
    const int axis = std::fabs(p[b][0] - p[a][0]) >= std::fabs(p[b][1] - p[a][1]) ? 0 : 1;
    const double t = std::clamp((p[old_points + i][axis] - p[a][axis]) / (p[b][axis] - p[a][axis]), 0.0, 1.0);
    for (std::size_t k = 0; k < columns; ++k) {
      const double from = plc.point_attributes[a * columns + k], to = plc.point_attributes[b * columns + k];
      plc.point_attributes.push_back((1 - t) * from + t * to);
    }
  }
}

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

}  // namespace

Plc<2> resolve_crossings(const Plc<2>& plc, std::vector<Diagnostic>& repairs) {
  if (!is_usable(plc)) return plc;
  detail::CrossingResolver resolver(plc);
  int rounds = 0;
  while (resolver.split_once()) ++rounds;
  if (rounds <= 1 && resolver.pairs().empty()) return plc;
  report(resolver, plc, repairs);
  Plc<2> out = plc;
  out.points = resolver.points();
  if (!out.point_markers.empty()) out.point_markers.resize(out.points.size(), 0);
  append_attributes(resolver, out, plc.points.size());
  out.segments.clear();
  out.source.segment_lines.clear();
  for (const detail::OwnedEdge& e : resolver.edges()) {
    if (e.edge[0] == e.edge[1]) continue;  // it has no length, and is dropped
    out.segments.push_back({e.edge, plc.segments[e.owner].marker});
    if (e.owner < plc.source.segment_lines.size()) out.source.segment_lines.push_back(plc.source.segment_lines[e.owner]);
  }
  return out;
}

Plc<2> with_convex_hull(const Plc<2>& plc) {
  if (!is_usable(plc)) return plc;
  const auto first = first_at_place(plc.points);
  std::set<std::uint64_t> known;
  for (const auto& s : plc.segments) known.insert(detail::edge_key(first[s.points[0]], first[s.points[1]]));
  Plc<2> out = plc;
  for (const std::uint64_t key : edges_of_hull(plc.points, corners_of_hull(plc.points, first), first, tolerance_of(plc)))
    if (const auto [a, b] = detail::edge_of(key); known.insert(key).second) out.segments.push_back({{a, b}, 0});
  if (!out.source.segment_lines.empty()) out.source.segment_lines.resize(out.segments.size(), 0);
  return out;
}

}  // namespace pgdr
