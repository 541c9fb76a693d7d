// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Other numbers for the cells and vertices of a mesh, at random, for tests: what becomes of a mesh must not depend on them.
// Whoever knows some, and not only the mesh, has to rename what it knows.
#pragma once

#include <cstdint>
#include <random>
#include <vector>

#include "mesh/mesh.hpp"
#include "mesh/surroundings.hpp"

namespace pgdr::detail {

/// See above. Cells trade the slots that hold cells, vertices the numbers of vertices that cells have. The order of the vertices
/// of a cell stays. A slot keeps its birth, so that the name of a cell that is dead still is that of none.
template <int D>
class Renumbering {
 public:
  Renumbering(Mesh<D>& mesh, std::mt19937_64& random);  ///< which must outlive it

  CellId operator()(CellId c) const { return cells_[index(c)]; }         ///< the new slot of the cell that is in this one
  VertexId operator()(VertexId v) const { return vertices_[index(v)]; }  ///< the new number. @pre not infinite_vertex
  /// Renames the cell that was born in that slot, if it is alive. Before apply() or after it.
  void rename(CellId& cell, std::uint16_t& birth) const {
    if (mesh_->birth(cell) != birth) return;
    cell = (*this)(cell);
    birth = mesh_->birth(cell);
  }
  /// Gives the cells and vertices of the mesh their new numbers. Once. @pre nobody else uses it; no cell is a ghost, or marked
  void apply();

 private:
  void move_cells();
  void move_vertices();

  Mesh<D>* mesh_;
  std::vector<CellId> cells_, old_cells_;          ///< by old slot; the old slots
  std::vector<VertexId> vertices_, old_vertices_;  ///< likewise
};

extern template class Renumbering<2>;
extern template class Renumbering<3>;

}  // namespace pgdr::detail
