// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The claim of a visit that inserts points into a triangulation without constraints: ranges of vertices. The claims of concurrent
// visits are disjoint. A visit owns the cells that have at most one vertex outside its claim; a ghost, and a triangle, none but
// the vertex at infinity. It deletes cells that it owns, makes cells that it owns (the vertex that it inserts is in its claim),
// and reads these and the cells that share a face with one. That is safe:
//
// In space such a face has at most one vertex outside, so that the cell beyond has at most two: too many vertices are claimed for
// another visit to own it. It may lie next to cells of another visit too. Both read its vertices and its sphere, which nobody
// writes, and each writes the links across faces of its own.
// In the plane the triangle beyond has two vertices of the claim, as in visit_area.hpp. A ghost beyond another ghost has one, and
// may lie between two visits, as above.
// What a ghost asks when a point is in line with its hull face is the cell behind this face. It has the same vertices but one,
// and what is said of the ghost holds of it.
#pragma once

#include <array>
#include <cstdint>

#include "mesh/mesh.hpp"

namespace pgdr {

/// The claim of one visit: those ranges of 2^shift vertices whose entry in a table is the number of the visit. Nobody writes the
/// table while visits run.
template <int D>
struct VertexClaim {
  const std::uint32_t* visit_of;  ///< of each range, the number of the visit that claims it
  int shift;                      ///< of the vertices' numbers
  std::uint32_t visit;            ///< the number of this one

  /// Is the vertex claimed? The one at infinity is not.
  bool has(VertexId v) const { return v != infinite_vertex && visit_of[index(v) >> shift] == visit; }
  /// Does the visit own a cell of these vertices?
  bool owns(const std::array<VertexId, D + 1>& vertices) const {
    int outside = 0;
    for (const VertexId v : vertices) outside += has(v) ? 0 : 1;
    if constexpr (D == 3) return outside <= 1;
    return outside == 0 || (outside == 1 && has_infinite(vertices));
  }
  /// Is it a cell that the visit owns, or could it share a face with one? Debug builds assert this of what is read.
  bool may_read(const std::array<VertexId, D + 1>& vertices) const {
    int outside = 0;
    for (const VertexId v : vertices) {
      if (v == no_vertex) return false;
      outside += has(v) ? 0 : 1;
    }
    return outside <= 2 - (D == 2 && !has_infinite(vertices) ? 1 : 0);
  }

 private:
  static bool has_infinite(const std::array<VertexId, D + 1>& vertices) {
    for (const VertexId v : vertices)
      if (v == infinite_vertex) return true;
    return false;
  }
};

}  // namespace pgdr
