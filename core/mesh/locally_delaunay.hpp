// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The local Delaunay test. A face that fails it is a violation, which flips and gift wrapping repair.
#pragma once

#include "mesh/mesh.hpp"

namespace pgdr {

/// Is the face unconstrained, and the vertex beyond it strictly inside the (unperturbed) circumsphere of c? Any thread that may
/// read the cell and the one beyond the face.
template <int D>
bool violates(const Mesh<D>& mesh, CellId c, int face) {
  const Link link = mesh.cell(c).links[face];
  if (!link || mesh.constrained(c, face)) return false;
  const VertexId apex = mesh.cell(link.cell()).vertices[link.face()];
  const Point<D>& p = mesh.point(apex);
  // The cached sphere says no nearly always; what it leaves may be a tie, which is no violation.
  return mesh.conflicts(c, p) && in_sphere<D>(mesh.simplex(c), p) == Sign::positive;
}

}  // namespace pgdr
