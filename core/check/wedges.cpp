// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "check/wedges.hpp"

#include "numbers/angle_bounds.hpp"
#include "pgdr/predicates.hpp"

namespace pgdr::checking {
namespace {

/// From the cell, round the edge between two of its corners, across the face opposite corner `exit`: the vertex of the first wall
/// that is not on the edge. None where there is no wall, or a cell that is not positive.
std::uint32_t wall_round_edge(const OutputMesh<3>& mesh, const Links<3>& links, std::uint32_t cell, int exit, int kept) {
  for (std::uint32_t at = cell, steps = 0; steps < mesh.cells.size() && links.positive(at); ++steps) {
    const std::uint32_t face = 4 * at + static_cast<std::uint32_t>(exit);
    const std::uint32_t pivot = mesh.cells[at][kept];  // the vertex of the face that is not on the edge
    if (links.is_wall(face)) return pivot;
    const std::uint32_t back = links.neighbour[face];
    if (back == none) break;
    at = back / 4;
    exit = corner_of(mesh.cells[at], pivot);  // stays behind, as the walk turns about the edge
    kept = static_cast<int>(back % 4);
    if (at == cell || exit == 4) break;
  }
  return none;
}

}  // namespace

// The dihedral angles of cells from wall to wall, all positive and each of less than 180 degrees, add up to the wedge, which is
// at most 360 degrees. The walls' half-planes make it or what it lacks of 360 degrees; the orientation tells which.
std::optional<Wedge> wedge_below(const OutputMesh<3>& mesh, const Links<3>& links, std::uint32_t cell, int edge,
                                 double largest_cosine) {
  const auto [i, j] = edge_ends[edge];
  const auto [k, l] = corners_without(i, j);
  const std::uint32_t first = wall_round_edge(mesh, links, cell, l, k), last = wall_round_edge(mesh, links, cell, k, l);
  if (first == none || last == none || first == last) return {};
  const auto& v = mesh.cells[cell];
  const auto point = [&](std::uint32_t u) -> const Point3& { return mesh.points[u]; };
  const Sign way = orient3d(point(v[i]), point(v[j]), point(v[k]), point(v[l]));
  const Wedge wedge{point(v[i]), point(v[j]), point(first), point(last)};
  if (orient3d(wedge[0], wedge[1], wedge[2], wedge[3]) != way) return {};
  if (!detail::dihedral_below(wedge[0], wedge[1], wedge[2], wedge[3], largest_cosine)) return {};
  return wedge;
}

}  // namespace pgdr::checking
