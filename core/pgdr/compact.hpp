// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// From the mesh under refinement to the finished one. The numbering is a function of the mesh alone: input points in the
// order of the input, Steiner points along a Hilbert curve (ties by coordinates), cells by their sorted vertex numbers.
#pragma once

#include <span>
#include <stop_token>
#include <vector>

#include "pgdr/mesh.hpp"
#include "pgdr/output_mesh.hpp"

namespace pgdr {

template <int D>
struct Compacted {
  OutputMesh<D> mesh;
  std::vector<std::uint32_t> vertex_number;  ///< by index(VertexId); 0xffffffff where no cell has the vertex
  std::vector<std::uint32_t> first_cell;     ///< the first of the cells with vertex v as their smallest, and so on
  /// Of the cell of the mesh that was compacted, by its vertices there.
  std::uint32_t cell_number(const std::array<VertexId, D + 1>& vertices) const;
};

/// The finished mesh, made in the place of the one that was refined, of which nothing is left to use. `region_attributes`: the
/// attribute of each region number; empty: do not label. `parallel`: on the threads of the caller's task arena; the result is
/// the same. `stop`: once it is requested the result is nothing to use, and comes soon.
template <int D>
Compacted<D> compact(Mesh<D>&& mesh, const Domain<D>& domain, std::span<const double> region_attributes, bool parallel,
                     std::stop_token stop = {});

}  // namespace pgdr
