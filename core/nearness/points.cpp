// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "nearness/nearness.hpp"

namespace pgdr::checking {
namespace {

int marker_of(const std::vector<int>& markers, std::uint32_t point) { return point < markers.size() ? markers[point] : 0; }

}  // namespace

/// Where a point and others are joined, that any of them is a vertex will do.
void check_explicit_points(const NearTask& task, std::span<const std::uint32_t> sorted) {
  const GivenInput<3>& input = task.input;
  const Plc<3>& plc = input.plc();
  std::vector<std::uint8_t> is_explicit(plc.points.size(), 1);
  for (const auto& facet : plc.facets)
    for (const auto& polygon : facet.polygons)
      for (const std::uint32_t p : polygon) is_explicit[p] = 0;
  for (std::size_t p = 0; p < plc.point_markers.size() && p < plc.points.size(); ++p)
    if (plc.point_markers[p] != 0) is_explicit[p] = 1;
  for (const auto& segment : plc.segments)
    for (const std::uint32_t p : segment.points) is_explicit[p] = 1;
  if (task.required) is_explicit = *task.required;
  std::vector<std::uint8_t> in_cell(task.mesh.points.size(), 0);
  for (const auto& cell : task.mesh.cells)
    for (const std::uint32_t v : cell) in_cell[v] = 1;
  const double reach = 2 * input.tolerance();
  for (std::uint32_t p = 0; p < plc.points.size(); ++p) {
    if (!is_explicit[p]) continue;
    const Point3& x = plc.points[p];
    auto at = std::ranges::lower_bound(sorted, x[0] - reach, {}, [&](std::uint32_t v) { return task.mesh.points[v][0]; });
    bool found = false, marked = false;
    for (; at != sorted.end() && task.mesh.points[*at][0] <= x[0] + reach; ++at) {
      if (!in_cell[*at] || squared_distance(task.mesh.points[*at], x) > reach * reach) continue;
      found = true;
      marked = marked || marker_of(task.mesh.point_markers, *at) == marker_of(plc.point_markers, p);
    }
    if (found && !marked && marker_of(plc.point_markers, p) != 0 && !task.mesh.point_markers.empty())
      task.findings.add(Kind::wrong_marker, {p}, [&] {
        return "Input point " + std::to_string(p) + " " + words(x) + " has marker " +
               std::to_string(marker_of(plc.point_markers, p)) + ", and no vertex there has it.";
      });
    if (found || !task.given.wants_place(x)) continue;
    task.findings.add(Kind::missing_input_point, {p}, [&] {
      return "Input point " + std::to_string(p) + " " + words(x) +
             ", which has a marker, or is of a segment or of no facet, is no vertex of the mesh.";
    });
  }
}

}  // namespace pgdr::checking
