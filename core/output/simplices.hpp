// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "pgdr/output_mesh.hpp"
#include "pgdr/types.hpp"

namespace pgdr {

/// The constraints of dimension D - 1 of a finished mesh: its subsegments in 2D, its subfacets in 3D.
template <int D>
const auto& walls(const OutputMesh<D>& mesh) {
  if constexpr (D == 2)
    return mesh.subsegments;
  else
    return mesh.subfacets;
}

/// The corners of a cell of these points.
template <int D>
Simplex<D> corners_of(std::span<const Point<D>> points, const std::array<std::uint32_t, D + 1>& cell) {
  Simplex<D> s;
  for (std::size_t i = 0; i <= D; ++i) s[i] = points[cell[i]];
  return s;
}
template <int D>
Simplex<D> corners_of(const OutputMesh<D>& mesh, std::size_t cell) {
  return corners_of<D>(mesh.points, mesh.cells[cell]);
}

/// Calls f(vertices) for all cells and constraints.
template <class Mesh, class F>
void each_simplex(Mesh& mesh, const F& f) {
  for (auto& c : mesh.cells) f(c);
  for (auto& c : mesh.subfacets) f(c.vertices);
  for (auto& c : mesh.subsegments) f(c.vertices);
}

}  // namespace pgdr
