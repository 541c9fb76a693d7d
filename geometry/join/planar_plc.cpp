// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "pgdr/planar_plc.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "input/edges.hpp"
#include "input/usable_plc.hpp"
#include "input/words.hpp"
#include "join/crossing_resolver.hpp"

namespace pgdr {
namespace {

using detail::CrossingResolver;

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

}  // namespace

Plc<2> resolve_crossings(const Plc<2>& plc, std::vector<Diagnostic>& repairs) {
  if (!detail::is_usable(plc)) return plc;
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

}  // namespace pgdr
