// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "check/not_delaunay.hpp"

#include <algorithm>
#include <cstdint>
#include <vector>

#include "check/bounds.hpp"

namespace pgdr {
namespace checking {
namespace {

/// Of the cells [first, last) those with a point that has slack, those that share a face with one, and few more. The points are
/// in `beside` that are of a cell with such a point.
template <int D>
void take_cells(const OutputMesh<D>& mesh, const std::vector<std::uint8_t>& beside, std::size_t first, std::size_t last,
                OutputMesh<D>& part) {
  for (std::size_t c = first; c < last; ++c) {
    const auto& cell = mesh.cells[c];
    if (std::ranges::count_if(cell, [&](std::uint32_t v) { return beside[v] != 0; }) >= D) part.cells.push_back(cell);
  }
}

template <int D>
NotDelaunay count_all(const OutputMesh<D>& mesh, std::span<const double> slack, std::size_t own) {
  CheckReport report;
  Findings findings(report, 0, {});
  Links<D> links = link_cells(mesh, findings);
  links.neighbour.resize((D + 1) * own);  // a face is looked at from the first of its cells
  check_delaunay<D>(mesh, links, slack, {}, 0, findings);
  return {report.not_delaunay_rounding, report.count(Kind::not_delaunay)};
}

}  // namespace

template <int D>
NotDelaunay count_among(const OutputMesh<D>& mesh, std::span<const double> slack, bool everywhere, std::size_t own) {
  if (everywhere) return count_all(mesh, slack, own);
  std::vector<std::uint8_t> beside(mesh.points.size());
  for (const auto& cell : mesh.cells)
    if (std::ranges::any_of(cell, [&](std::uint32_t v) { return slack[v] > 0; }))
      for (const std::uint32_t v : cell) beside[v] = 1;
  OutputMesh<D> part;
  take_cells(mesh, beside, 0, own, part);
  const std::size_t own_in_part = part.cells.size();
  if (own_in_part == 0) return {};
  take_cells(mesh, beside, own, mesh.cells.size(), part);
  part.points = mesh.points;
  part.input_points = mesh.input_points;
  part.subfacets = mesh.subfacets;
  part.subsegments = mesh.subsegments;
  return count_all(part, slack, own_in_part);
}

template NotDelaunay count_among(const OutputMesh<2>&, std::span<const double>, bool, std::size_t);
template NotDelaunay count_among(const OutputMesh<3>&, std::span<const double>, bool, std::size_t);

}  // namespace checking

template <int D>
NotDelaunay count_not_delaunay(const OutputMesh<D>& mesh, bool everywhere) {
  const std::vector<double> slack = checking::slack_of_vertices(mesh, CheckOptions<D>{}.conformity_ulps);
  return checking::count_among<D>(mesh, slack, everywhere, mesh.cells.size());
}

template PGDR_API NotDelaunay count_not_delaunay(const OutputMesh<2>&, bool);
template PGDR_API NotDelaunay count_not_delaunay(const OutputMesh<3>&, bool);

}  // namespace pgdr
