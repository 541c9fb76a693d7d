// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// A mesh as the input of another one. `remesh` (remesh.hpp) does all of it; here are its steps, for those who want to do
// something between them. Pure functions, any thread.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <stop_token>
#include <vector>

#include "pgdr/export.hpp"
#include "pgdr/mesh_maps.hpp"
#include "pgdr/output_mesh.hpp"
#include "pgdr/plc.hpp"
#include "pgdr/poor_reason.hpp"
#include "pgdr/whole_facets.hpp"

namespace pgdr PGDR_API {

/// boundary_of_mesh, and what its points are in the mesh.
template <int D>
struct MeshBoundary {
  Plc<D> plc;                                  ///< as boundary_of_mesh gives it, with the required vertices
  std::vector<std::uint32_t> vertex_of_point;  ///< of each point of plc, ascending
};

/// @param mesh      whole, as boundary_of_mesh takes it
/// @param required  of each vertex: it is a point of the input, wherever it is; empty: none has to be one
/// @throws as boundary_of_mesh, and UsageError bad_option: not one a vertex
template <int D>
MeshBoundary<D> boundary_with_vertices(const OutputMesh<D>& mesh, std::span<const std::uint8_t> required = {});

/// How a mesh becomes an input.
struct RemeshInputOptions {
  std::vector<std::uint8_t> required;  ///< of each vertex: it is one of the new mesh, too; empty: none has to be
  std::optional<double> tolerance;     ///< Plc::tolerance: the T within which parts are of one plane or line
  bool is_coarse = false;              ///< Plc::is_coarse
  bool keep_boundary = false;          ///< every edge and face of it stays as it is, for RefineOptions::keep_boundary
  /// All vertices are points of the input, and nothing is joined to whole facets: to refine the mesh, as TetGen's and Triangle's
  /// -r do. The cells are not kept as such: those of a finer mesh are of the constrained Delaunay triangulation of its vertices.
  bool keep_vertices = false;
  std::stop_token stop = {};  ///< ends it, from any thread, by a CancelledError
};

/// What is meshed in the place of a mesh: its boundary, the faces between its labels, its subfacets and subsegments, as whole
/// facets and segments (with_whole_facets); a region seed in each part of a label other than 0 that these enclose, a hole in each
/// void. Of the vertices inside of planes, of lines and of cells the required ones stay alone. The marker of a vertex that a
/// subfacet or subsegment at it has, too, is not its own, and is not handed on, unless it is required. Attributes are left to
/// transfer_attributes.
/// @returns  the input; point_of_input and facet_of_input speak of boundary_with_vertices(mesh, required).plc, which is what
/// `check`
///   takes, with CheckOptions::required_points
/// @throws as boundary_with_vertices and with_whole_facets
template <int D>
WholeFacets<D> remesh_input(const OutputMesh<D>& mesh, const RemeshInputOptions& options = {});

/// Reasons that name facets of such an input name those of the boundary instead.
/// @param facet_of_input  WholeFacets::facet_of_input
/// @param reasons  changed
void name_given_facets(std::span<const std::uint32_t> facet_of_input, std::vector<PoorReason>& reasons);

/// Takes out segments without a marker at edges of facets, which are there anyway or lie inside of a plane: where another surface
/// is meshed they are not kept, and `check` with CheckOptions::surface_tolerance must not ask for them.
void drop_plain_segments(Plc<3>& plc);

/// Of each point of a boundary whether its vertex is required, as CheckOptions::required_points has it.
template <int D>
std::vector<std::uint8_t> required_points(const MeshBoundary<D>& boundary, std::span<const std::uint8_t> required);

}  // namespace pgdr
