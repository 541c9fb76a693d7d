// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pgdr/output_mesh.hpp"

namespace pgdr {

/// The constraints of dimension D - 1 of a finished mesh: its subsegments in 2D, its subfacets in 3D.
template <int D>
const auto& walls(const OutputMesh<D>& mesh) {
  if constexpr (D == 2)
    return mesh.subsegments;
  else
    return mesh.subfacets;
}

/// Calls f(vertices) for all cells and constraints.
template <class Mesh, class F>
void each_simplex(Mesh& mesh, const F& f) {
  for (auto& c : mesh.cells) f(c);
  for (auto& c : mesh.subfacets) f(c.vertices);
  for (auto& c : mesh.subsegments) f(c.vertices);
}

}  // namespace pgdr
