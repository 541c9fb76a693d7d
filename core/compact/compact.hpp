// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Compaction: makes the finished mesh of the mesh under refinement. The canonical numbering is a function of the mesh alone:
// input points in the order of the input, Steiner points along a Hilbert curve (ties by coordinates), cells by their sorted
// vertex numbers.
#pragma once

#include <functional>
#include <span>
#include <stop_token>
#include <vector>

#include "mesh/mesh.hpp"
#include "pgdr/output_mesh.hpp"
#include "space/pieces.hpp"

namespace pgdr {

/// The finished mesh, and where its vertices and cells come from.
template <int D>
struct Compacted {
  OutputMesh<D> mesh;                        ///< the mesh
  std::vector<std::uint32_t> vertex_number;  ///< by index(VertexId); 0xffffffff where no cell has the vertex
  std::vector<std::uint32_t> first_cell;     ///< the first of the cells with vertex v as their smallest, and so on
  /// The number of a cell, by its vertices in the mesh that was compacted. @pre the numbering is the canonical one
  std::uint32_t cell_number(const std::array<VertexId, D + 1>& vertices) const;
};

/// A function that adds data to the numbered points from the records of their vertices (point_data.hpp).
template <int D>
using FillPoints = std::function<void(const Mesh<D>&, Compacted<D>&)>;

/// Makes the finished mesh in the memory of the refined one, which cannot be used after that.
/// @param region_attributes  the attribute of each region number; empty: cells get no labels
/// @param pieces  the threads; the result does not depend on them
/// @param stop  once it is requested the call ends soon, and its result is of no use
/// @param fill  may be empty
/// @param hurry  once it is requested the rest is numbered by slots, and cell_number() may not be called
template <int D>
Compacted<D> compact(Mesh<D>&& mesh, const Domain<D>& domain, std::span<const double> region_attributes,
                     const detail::Pieces& pieces, std::stop_token stop = {}, const FillPoints<D>& fill = {},
                     std::stop_token hurry = {});

/// Makes the finished mesh of a run that was stopped, when the mesh depends on chance anyway: Steiner points and cells are
/// numbered by their slots, in a fifth of the time.
template <int D>
Compacted<D> compact_by_slots(const Mesh<D>& mesh, const Domain<D>& domain, std::span<const double> region_attributes,
                              const detail::Pieces& pieces, const FillPoints<D>& fill = {});

}  // namespace pgdr
