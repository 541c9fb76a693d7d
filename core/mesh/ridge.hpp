// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The walk round a ridge (a vertex in 2D, an edge in 3D), from cell to cell. (numbers/corners.hpp has the numbers of edges and
// corners.)
#pragma once

#include "mesh/mesh.hpp"
#include "numbers/corners.hpp"

namespace pgdr {

/// Steps from cell to cell round a ridge. `exit` and `entry` are the numbers of the two vertices of the cell that are not on the
/// ridge; the next cell lies across the face opposite `exit`.
template <int D>
struct RidgeWalk {
  CellId cell;  ///< where the walk is
  int entry;    ///< the vertex across which it came in
  int exit;     ///< the vertex across which it goes on

  Link link(const Mesh<D>& mesh) const { return mesh.cell(cell).links[exit]; }  ///< where a step leads
  /// @pre link() leads somewhere.
  void step(const Mesh<D>& mesh) {
    const auto& k = mesh.cell(cell);
    const VertexId pivot = k.vertices[entry];
    const Link next = k.links[exit];
    cell = next.cell();
    entry = next.face();
    const auto& n = mesh.cell(cell);
    exit = 0;
    while (n.vertices[exit] != pivot) ++exit;
  }
};

/// What a visitor of the cells round an edge wants next.
enum class RoundEdge {
  go_on,      ///< the next cell in this direction
  turn_back,  ///< nothing more in this direction: the other one, from the first cell
  stop,       ///< no more cells
};

/// Calls f(walk) at the cells round edge `edge` of c, beginning with c: in one direction until the walk is back
/// at c, or at a face with nothing beyond; then in the other one, c again first. Reads a cell only after f has said `go_on` at
/// the one before.
template <class F>
void for_cells_round(const Mesh<3>& mesh, CellId c, int edge, F f) {
  const auto others = corners_without(edge_ends[edge][0], edge_ends[edge][1]);
  for (const int way : {0, 1}) {
    RidgeWalk<3> walk{c, others[1 - way], others[way]};
    while (true) {
      const RoundEdge next = f(walk);
      if (next == RoundEdge::stop) return;
      if (next == RoundEdge::turn_back || !walk.link(mesh)) break;
      walk.step(mesh);
      if (walk.cell == c) return;
    }
  }
}

}  // namespace pgdr
