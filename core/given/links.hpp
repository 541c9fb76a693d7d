// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// What lies beside what in a finished mesh: the checker's own neighbour table, rebuilt from the cells alone, and the
// first stages that need nothing else. A *wall* is a constraint of dimension D - 1: a subsegment in 2D, a subfacet in
// 3D. Face f = (D + 1) * cell + i is the face of the cell opposite its i-th vertex.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "given/findings.hpp"
#include "numbers/corners.hpp"
#include "output/simplices.hpp"

namespace pgdr::checking {

template <int D>
struct Links {
  static constexpr std::uint32_t corners = D + 1;
  std::vector<std::uint32_t> neighbour;  ///< of each face: the same face as its other cell has it; none on the hull
  std::vector<std::uint8_t> bits;        ///< of each cell: bit i: face i is a wall; bit 7: orientation is positive
  /// Of each wall: the face of the cell on its positive side (where orient(wall, x) > 0), and on its negative side.
  std::vector<std::array<std::uint32_t, 2>> wall_sides;

  bool positive(std::uint32_t cell) const { return bits[cell] & 0x80; }
  bool is_wall(std::uint32_t face) const { return bits[face / corners] >> (face % corners) & 1; }
};

/// The vertices of a face, ordered so that orient(face, opposite vertex) is that of the cell.
template <int D>
std::array<std::uint32_t, D> face_vertices(const OutputMesh<D>& mesh, std::uint32_t face) {
  const auto& cell = mesh.cells[face / (D + 1)];
  const int opposite = static_cast<int>(face % (D + 1));
  auto v = face_without(cell, opposite);
  if ((D - opposite) % 2) std::swap(v[0], v[1]);
  return v;
}

/// Indices, finite coordinates, sizes of the label arrays. Later stages may run only if it returns true.
template <int D>
bool check_indices(const OutputMesh<D>& mesh, Findings& findings);

/// All vertices, sorted by coordinates; equal ones are findings.
template <int D>
std::vector<std::uint32_t> sort_points(const OutputMesh<D>& mesh, Findings& findings);

/// Orientation of every cell, each face shared by at most two cells from opposite sides, hull faces and walls the same.
template <int D>
Links<D> link_cells(const OutputMesh<D>& mesh, Findings& findings);

/// The cells round each vertex cover every direction once (inside) or at most once (on the hull).
/// @pre no findings so far: all cells positive, all faces matched.
template <int D>
void check_stars(const OutputMesh<D>& mesh, const Links<D>& links, Findings& findings);

/// 3D: every subsegment is an edge of a cell (in 2D `link_cells` has decided that).
template <int D>
void check_subsegments_used(const OutputMesh<D>& mesh, Findings& findings);

}  // namespace pgdr::checking
