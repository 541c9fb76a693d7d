// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "check/not_delaunay.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "check/bounds.hpp"
#include "numbers/exact_tests.hpp"
#include "pgdr/circumsphere.hpp"
#include "pgdr/predicates.hpp"

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

namespace {

/// Does rounding explain that x is inside the diametral circle of ab: can (a - x).(b - x) be 0 or more if each point moves by as
/// much as it may be off?
bool rounding_opens(const Point2& a, const Point2& b, const Point2& x, double off_a, double off_b, double off_x) {
  const double to_a = off_a + off_x, to_b = off_b + off_x;
  if (to_a + to_b == 0) return false;
  const double far_a = std::sqrt(squared_distance(a, x)), far_b = std::sqrt(squared_distance(b, x));
  const double product = (a[0] - x[0]) * (b[0] - x[0]) + (a[1] - x[1]) * (b[1] - x[1]);
  // Each of the two differences moves by its length at most, and what is computed is off by a few ulps of what is compared.
  return product + far_a * to_b + far_b * to_a + to_a * to_b >= -8 * rounding::ulp * far_a * far_b;
}

void check_boundary_edge(const OutputMesh<2>& mesh, std::uint32_t face, std::span<const double> slack, Findings& findings) {
  const auto [a, b] = face_vertices(mesh, face);
  const std::uint32_t cell = face / 3, x = mesh.cells[cell][face % 3];
  const Point2 &p = mesh.points[a], &q = mesh.points[b], &apex = mesh.points[x];
  if (!in_diametral_ball(p, q, apex)) return;
  if (rounding_opens(p, q, apex, slack[a], slack[b], slack[x])) {
    ++findings.report().not_delaunay_rounding;
    return;
  }
  findings.add(Kind::not_delaunay, {cell, x}, [&] {
    return "The " + vertex_words(mesh, x) + " lies inside the diametral circle of an edge of the boundary, of " +
           cell_words(mesh, cell) + ", whose circumcentre is beyond that.";
  });
}

void check_across(const OutputMesh<2>& mesh, std::uint32_t face, std::uint32_t back, std::span<const double> slack,
                  Findings& findings) {
  const std::uint32_t cell = face / 3, other = back / 3, apex = mesh.cells[other][back % 3];
  const Simplex<2> s = corners_of(mesh, cell);
  if (in_sphere<2>(s, mesh.points[apex]) != Sign::positive) return;
  const auto& v = mesh.cells[cell];
  if (rounding_cancels<2>(s, mesh.points[apex], {slack[v[0]], slack[v[1]], slack[v[2]], slack[apex]})) {
    ++findings.report().not_delaunay_rounding;
    return;
  }
  findings.add(Kind::not_delaunay, {cell, other}, [&] {
    return "The " + vertex_words(mesh, apex) + " of cell " + std::to_string(other) +
           ", across a subsegment, lies inside the circumcircle of " + cell_words(mesh, cell) + ".";
  });
}

}  // namespace

void check_conforming(const OutputMesh<2>& mesh, const Links<2>& links, std::span<const double> slack, Findings& findings) {
  for (std::uint32_t face = 0; face < links.neighbour.size(); ++face) {
    findings.heed_stop();
    const std::uint32_t back = links.neighbour[face];
    if (!links.positive(face / 3)) continue;
    if (back == none)
      check_boundary_edge(mesh, face, slack, findings);
    else if (links.is_wall(face) && face < back && links.positive(back / 3))
      check_across(mesh, face, back, slack, findings);
  }
}

template NotDelaunay count_among(const OutputMesh<2>&, std::span<const double>, bool, std::size_t);
template NotDelaunay count_among(const OutputMesh<3>&, std::span<const double>, bool, std::size_t);

}  // namespace checking

template <int D>
NotDelaunay count_not_delaunay(const OutputMesh<D>& mesh, bool everywhere) {
  const std::vector<double> slack = checking::slack_of_vertices(mesh, CheckOptions<D>{}.conformity_ulps);
  return checking::count_among<D>(mesh, slack, everywhere, mesh.cells.size());
}

template <int D>
std::vector<NotDelaunayCell> cells_not_delaunay(const OutputMesh<D>& mesh) {
  using namespace checking;
  CheckReport report;
  Findings findings(report, 0, {});
  const Links<D> links = link_cells(mesh, findings);
  std::vector<NotDelaunayCell> found;
  for (std::uint32_t cell = 0; cell < mesh.cells.size(); ++cell) {
    if (!links.positive(cell)) continue;
    for (std::uint32_t face = (D + 1) * cell; face < (D + 1) * (cell + 1); ++face) {
      const std::uint32_t back = links.neighbour[face];
      if (back == none || links.is_wall(face) || !links.positive(back / (D + 1))) continue;
      const std::uint32_t apex = mesh.cells[back / (D + 1)][back % (D + 1)];
      if (in_sphere<D>(corners_of(mesh, cell), mesh.points[apex]) != Sign::positive) continue;
      found.push_back({cell, apex});
      break;
    }
  }
  return found;
}

template PGDR_API std::vector<NotDelaunayCell> cells_not_delaunay(const OutputMesh<2>&);
template PGDR_API std::vector<NotDelaunayCell> cells_not_delaunay(const OutputMesh<3>&);
template PGDR_API NotDelaunay count_not_delaunay(const OutputMesh<2>&, bool);
template PGDR_API NotDelaunay count_not_delaunay(const OutputMesh<3>&, bool);

}  // namespace pgdr
