// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// From the mesh under refinement to the finished one. The canonical numbering is a function of the mesh alone: input points
// in the order of the input, Steiner points along a Hilbert curve (ties by coordinates), cells by their sorted vertex numbers.
#pragma once

#include <functional>
#include <span>
#include <stop_token>
#include <vector>

#include "mesh/mesh.hpp"
#include "pgdr/output_mesh.hpp"

namespace pgdr {

/// The finished mesh, and where its vertices and cells come from.
template <int D>
struct Compacted {
  OutputMesh<D> mesh;                        ///< the mesh
  std::vector<std::uint32_t> vertex_number;  ///< by index(VertexId); 0xffffffff where no cell has the vertex
  std::vector<std::uint32_t> first_cell;     ///< the first of the cells with vertex v as their smallest, and so on
  /// Of the cell of the mesh that was compacted, by its vertices there. @pre the numbering is the usual one
  std::uint32_t cell_number(const std::array<VertexId, D + 1>& vertices) const;
};

/// What is added to numbered points from the records of their vertices (point_data.hpp).
template <int D>
using FillPoints = std::function<void(const Mesh<D>&, Compacted<D>&)>;

/// The finished mesh, made in the place of the one that was refined, of which nothing is left to use. `region_attributes`: the
/// attribute of each region number; empty: do not label. `parallel`: on the threads of the caller's task arena; the result is
/// the same. `stop`: once it is requested the result is nothing to use, and comes soon. `fill` may be empty. `hurry`: once it is
/// requested what is left is numbered as it comes, and cell_number() is not to be asked.
template <int D>
Compacted<D> compact(Mesh<D>&& mesh, const Domain<D>& domain, std::span<const double> region_attributes, bool parallel,
                     std::stop_token stop = {}, const FillPoints<D>& fill = {}, std::stop_token hurry = {});

/// The same of a run that was stopped, when the mesh is chance anyway: Steiner points and cells are numbered as their slots
/// come, in a fifth of the time.
template <int D>
Compacted<D> compact_by_slots(const Mesh<D>& mesh, const Domain<D>& domain, std::span<const double> region_attributes,
                             bool parallel, const FillPoints<D>& fill = {});

}  // namespace pgdr
