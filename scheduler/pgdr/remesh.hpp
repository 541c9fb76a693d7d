// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// A mesh in the place of another one: finer, coarser, better, of the same regions, with its markers and names.
#pragma once

#include "pgdr/export.hpp"
#include "pgdr/output_mesh.hpp"
#include "pgdr/refine.hpp"
#include "pgdr/remesh_input.hpp"

namespace pgdr PGDR_API {

/// Meshes what a mesh fills: `refine` of remesh_input(mesh, how). Point attributes come along by linear interpolation; other
/// fields by transfer_fields (transfer.hpp). Reasons name facets of boundary_with_vertices(mesh, how.required).plc, which `check`
/// takes as the input, with CheckOptions::required_points.
///
/// @code
/// const OutputMesh<3> old = read_mesh<3>("part.msh");
/// RefineOptions<3> options;
/// options.size = in_usual_unit<3>(sizes_on_mesh<3>(old, edge_lengths), SizeUnit::edge);  // one number a vertex, or a cell
/// const OutputMesh<3> mesh = remesh(old, options).mesh;
/// const std::vector<double> heat = CellTransfer<3>(old, mesh).means(old_heat);
/// @endcode
/// @throws as remesh_input and refine
template <int D>
RefineResult<D> remesh(const OutputMesh<D>& mesh, const RefineOptions<D>& options, const RemeshInputOptions& how = {});

}  // namespace pgdr
