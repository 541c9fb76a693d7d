// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "pgdr/kept_edges.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <numeric>

namespace pgdr {
namespace {

/// The same number for points with the same coordinates.
std::vector<std::uint32_t> places_of(const std::vector<Point3>& points) {
  std::vector<std::uint32_t> order(points.size()), place(points.size());
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return lex_less<3>(points[a], points[b]) || (points[a] == points[b] && a < b);
  });
  for (std::size_t i = 0; i < order.size(); ++i)
    place[order[i]] = i > 0 && points[order[i]] == points[order[i - 1]] ? place[order[i - 1]] : order[i];
  return place;
}

}  // namespace

Plc<3> with_kept_edges(Plc<3> plc, const std::vector<int>& markers) {
  const auto exists = [&](std::uint32_t p) { return p < plc.points.size(); };
  using Edge = std::array<std::uint32_t, 2>;
  const std::vector<std::uint32_t> place = places_of(plc.points);
  const auto edge = [&](std::uint32_t a, std::uint32_t b) {
    return Edge{std::min(place[a], place[b]), std::max(place[a], place[b])};
  };
  std::vector<Edge> known, edges;
  for (const auto& s : plc.segments) {
    if (!exists(s.points[0]) || !exists(s.points[1])) return plc;
    known.push_back(edge(s.points[0], s.points[1]));
  }
  for (const auto& facet : plc.facets) {
    const bool is_kept = markers.empty() || std::find(markers.begin(), markers.end(), facet.marker) != markers.end();
    for (const auto& polygon : facet.polygons) {
      if (!std::all_of(polygon.begin(), polygon.end(), exists)) return plc;
      // A facet that is a segment is one already; so is an inner one, but it has no marker that could be lost.
      const bool is_segment = facet.polygons.size() == 1 && polygon.size() == 2;
      for (std::size_t i = 0; is_kept && polygon.size() > 1 && i < polygon.size(); ++i)
        (is_segment ? known : edges).push_back(edge(polygon[i], polygon[(i + 1) % polygon.size()]));
    }
  }
  std::sort(known.begin(), known.end());
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  for (const Edge& e : edges)
    if (e[0] != e[1] && !std::binary_search(known.begin(), known.end(), e)) plc.segments.push_back({e, 0});
  if (!plc.source.segment_lines.empty()) plc.source.segment_lines.resize(plc.segments.size(), 0);
  return plc;
}

}  // namespace pgdr
