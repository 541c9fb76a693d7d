// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "check/not_delaunay.hpp"

#include "check/bounds.hpp"

namespace pgdr {
namespace checking {

template <int D>
std::vector<std::uint8_t> points_beside(const OutputMesh<D>& mesh, const std::vector<std::uint8_t>& slanted) {
  std::vector<std::uint8_t> beside(mesh.points.size());
  for (const auto& cell : mesh.cells)
    if (std::any_of(cell.begin(), cell.end(), [&](std::uint32_t v) { return slanted[v] != 0; }))
      for (const std::uint32_t v : cell) beside[v] = 1;
  return beside;
}

template <int D>
NotDelaunay count_among(const OutputMesh<D>& mesh, std::span<const double> slack) {
  CheckReport report;
  Findings findings(report, 0, {});
  check_delaunay<D>(mesh, link_cells(mesh, findings), slack, {}, findings);
  return {report.not_delaunay_rounding, report.count(Kind::not_delaunay)};
}

template std::vector<std::uint8_t> points_beside(const OutputMesh<2>&, const std::vector<std::uint8_t>&);
template std::vector<std::uint8_t> points_beside(const OutputMesh<3>&, const std::vector<std::uint8_t>&);
template NotDelaunay count_among(const OutputMesh<2>&, std::span<const double>);
template NotDelaunay count_among(const OutputMesh<3>&, std::span<const double>);

}  // namespace checking

template <int D>
NotDelaunay count_not_delaunay(const OutputMesh<D>& mesh, bool everywhere) {
  const std::vector<double> slack = checking::slack_of_vertices(mesh, CheckOptions<D>{}.conformity_ulps);
  if (everywhere) return checking::count_among<D>(mesh, slack);
  std::vector<std::uint8_t> slanted(slack.size());
  std::transform(slack.begin(), slack.end(), slanted.begin(), [](double s) { return s > 0; });
  const std::vector<std::uint8_t> beside = checking::points_beside(mesh, slanted);
  OutputMesh<D> part;
  std::copy_if(mesh.cells.begin(), mesh.cells.end(), std::back_inserter(part.cells),
               [&](const auto& cell) { return checking::is_beside(cell, beside); });
  if (part.cells.empty()) return {};
  part.points = mesh.points;
  part.input_points = mesh.input_points;
  part.subfacets = mesh.subfacets;
  part.subsegments = mesh.subsegments;
  return checking::count_among<D>(part, slack);
}

template PGDR_API NotDelaunay count_not_delaunay(const OutputMesh<2>&, bool);
template PGDR_API NotDelaunay count_not_delaunay(const OutputMesh<3>&, bool);

}  // namespace pgdr
