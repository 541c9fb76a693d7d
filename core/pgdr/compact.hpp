// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// From the mesh under refinement to the finished one. The canonical numbering is a function of the mesh alone: input points
// in the order of the input, Steiner points along a Hilbert curve (ties by coordinates), cells by their sorted vertex numbers.
#pragma once

#include <span>
#include <stop_token>
#include <vector>

#include "pgdr/mesh.hpp"
#include "pgdr/output_mesh.hpp"

namespace pgdr {

/// How Steiner points and cells are numbered.
enum class Numbering : std::uint8_t {
  canonical,  ///< as said above
  hasty,      ///< as their slots come, in a fifth of the time: of a run that was stopped, when the mesh is chance anyway
};

/// The finished mesh, and where its vertices and cells come from.
template <int D>
struct Compacted {
  OutputMesh<D> mesh;                        ///< the mesh
  std::vector<std::uint32_t> vertex_number;  ///< by index(VertexId); 0xffffffff where no cell has the vertex
  std::vector<std::uint32_t> first_cell;     ///< the first of the cells with vertex v as their smallest, and so on
  /// Of a cell that is alive in the mesh that was compacted. @pre the numbering is canonical
  std::uint32_t cell_number(const Mesh<D>& mesh, CellId c) const;
};

/// The finished mesh, but for the data of its points (point_data.hpp). `region_attributes`: the attribute of each region
/// number; empty: do not label. `parallel`: on the threads of the caller's task arena; the result is the same. `stop`: once
/// it is requested the result is nothing to use, and comes soon.
template <int D>
Compacted<D> compact(const Mesh<D>& mesh, const Domain<D>& domain, std::span<const double> region_attributes, bool parallel,
                     std::stop_token stop = {}, Numbering numbering = Numbering::canonical);

}  // namespace pgdr
