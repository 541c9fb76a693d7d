// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Point location by a visibility walk.
#pragma once

#include <cstdint>

#include "mesh/mesh.hpp"
#include "pgdr/error.hpp"

namespace pgdr::detail {

template <int D>
int corner_at_infinity(const CellRecord<D>& k) {
  for (int i = 0; i <= D; ++i)
    if (k.vertices[i] == infinite_vertex) return i;
  return -1;
}

/// The cell that contains p (closed), or the ghost beyond whose hull face p lies, by a walk from `hint` over cells that
/// `may_enter` says yes of; no_cell where it would leave these. @pre the hint is one of them
///
/// In a Delaunay triangulation, perturbed or not, a visibility walk cannot cycle (Edelsbrunner 1990), whichever of the
/// faces that hide p it crosses. In another one it ends if that is left to chance (Devillers, Pion, Teillaud 2002).
template <int D, class MayEnter>
CellId walk_to(const Mesh<D>& mesh, const Point<D>& p, CellId hint, const MayEnter& may_enter) {
  constexpr unsigned in_turn = 10000;  // steps before chance takes over
  CellId c = hint;
  if (const int i = corner_at_infinity<D>(mesh.cell(c)); i >= 0) {
    c = mesh.cell(c).links[i].cell();
    if (!may_enter(c)) return no_cell;
  }
  int from = -1;
  std::uint32_t random = 1;
  for (unsigned step = 0;; ++step) {
    random = random * 1664525 + 1013904223;
    const unsigned turn = step < in_turn ? step : random >> 16;
    const CellRecord<D>& k = mesh.cell(c);
    const Simplex<D> corners = mesh.simplex(c);
    int exit = -1;
    for (int j = 0; j <= D && exit < 0; ++j) {
      const int i = static_cast<int>((j + turn) % (D + 1));
      if (i == from) continue;
      Simplex<D> s = corners;
      s[i] = p;
      if (orient<D>(s) == Sign::negative) exit = i;
    }
    if (exit < 0) return c;
    from = k.links[exit].face();
    c = k.links[exit].cell();
    if (!may_enter(c)) return no_cell;
    if (corner_at_infinity<D>(mesh.cell(c)) >= 0) return c;
  }
}

/// The vertex of the cell at p, or no_vertex.
template <int D>
VertexId vertex_at(const Mesh<D>& mesh, CellId c, const Point<D>& p) {
  for (const VertexId v : mesh.cell(c).vertices)
    if (v != infinite_vertex && mesh.point(v) == p) return v;
  return no_vertex;
}

/// Points of an input are distinct once it is read. @throws ResourceError internal
template <int D>
void require_no_vertex_at(const Mesh<D>& mesh, CellId c, const Point<D>& p) {
  if (vertex_at(mesh, c, p) != no_vertex) throw ResourceError({Errc::internal, "two input points coincide", {}, 0, {}, {}});
}

}  // namespace pgdr::detail
