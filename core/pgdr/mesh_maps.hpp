// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// What of a finished mesh is what of its input, which cells lie beside each other, and the boundary as an input again: computed
// when asked for, on the calling thread. Pure functions, any thread.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "pgdr/domain.hpp"
#include "pgdr/export.hpp"
#include "pgdr/output_mesh.hpp"
#include "pgdr/plc.hpp"
#include "pgdr/types.hpp"

namespace pgdr PGDR_API {

/// Lists of numbers, one after the other: compressed rows.
struct NumberLists {
  std::vector<std::uint32_t> begin{0};  ///< where each list begins in `numbers`, and where the last one ends
  std::vector<std::uint32_t> numbers;   ///< of all lists, each ascending

  std::size_t size() const { return begin.size() - 1; }  ///< how many lists there are
  /// List i, i < size(). A view: the lists must outlive it.
  std::span<const std::uint32_t> operator[](std::size_t i) const& {
    return std::span(numbers).subspan(begin[i], begin[i + 1] - begin[i]);
  }
  std::span<const std::uint32_t> operator[](std::size_t i) const&& = delete;
};

inline constexpr std::uint32_t dropped_point = 0xffffffffu;  ///< instead of a vertex: the mesh is without it

/// The vertices that nothing of the mesh has, no cell, subsegment or subfacet, ascending: points of the input outside of what is
/// meshed.
template <int D>
std::vector<std::uint32_t> unused_points(const OutputMesh<D>& mesh);

/// Takes out the vertices `unused`, ascending, as unused_points() gives them. All else keeps its order.
template <int D>
void drop_points(OutputMesh<D>& mesh, std::span<const std::uint32_t> unused);

/// Which vertices, subsegments and subfacets the points, segments and facets of an input have become, and back. Everything counts
/// from 0: what is of the input in the vectors of the Plc, what is of the mesh in those of the OutputMesh.
///
/// Inputs overlap, and repairs join what lies together, so that nothing here is one to one. Points that are one vertex share it.
/// Where segments overlap, or repeat each other, their common subsegments belong to all of them. Facets in one plane with equal
/// markers and a common edge are one facet of the mesh, without a trace of that edge: each of its subfacets belongs to all of
/// them; so does what facets have in common that overlap. What repairs drop, as segments of no length and facets of no area, has
/// empty lists.
template <int D>
struct InputMap {
  /// The vertex of each point of the input. One in a hole, or outside, is in no cell; dropped_point if such points were dropped.
  std::vector<std::uint32_t> vertex_of_point;
  NumberLists points_of_vertex;        ///< of the first OutputMesh::input_points vertices; empty: a crossing of the input's edges
  NumberLists subsegments_of_segment;  ///< those that make up each of Plc::segments
  NumberLists segments_of_subsegment;  ///< empty in 3D for those on edges of facets alone
  NumberLists subfacets_of_facet;      ///< 3D: those that make up each of Plc::facets
  NumberLists facets_of_subfacet;      ///< 3D
  NumberLists subsegments_of_facet;    ///< 3D: of facets of one polygon of two corners, which are segments; else empty
};

/// The map of an input and its mesh, in linear time. Subsegments and subfacets inside holes and outside are gone with the cells
/// there.
/// @param domain  the input as it was meshed
/// @param mesh  as `refine` made it of this Domain; its lists of subsegments and subfacets may be in any order
/// @throws UsageError bad_option: a mesh whose input points are not the Domain's, in their order, but for some that were dropped,
///   or with subsegments or subfacets whose `entity` is not of the Domain, as those of a mesh that was read from a file
template <int D>
InputMap<D> input_map(const Domain<D>& domain, const OutputMesh<D>& mesh);

/// InputMap::vertex_of_point alone. @throws as input_map for points
template <int D>
std::vector<std::uint32_t> vertices_of_points(const Domain<D>& domain, const OutputMesh<D>& mesh);

inline constexpr std::uint32_t no_cell_beyond = 0xffffffffu;  ///< a neighbour: there is none

/// The neighbours of each cell, in linear time: `[c][i]` is the cell beyond the face (2D: edge) opposite vertex i of cell c, also
/// where that face is a subfacet (subsegment); no_cell_beyond on the boundary of the mesh.
/// @throws InputError index_out_of_range: a vertex that does not exist; UsageError bad_option: more than two cells with one face
template <int D>
std::vector<std::array<std::uint32_t, D + 1>> neighbors_of_cells(const OutputMesh<D>& mesh);

/// The boundary of a mesh as an input, which encloses what the mesh fills: its subsegments and subfacets with their markers; the
/// faces of cells that have no other cell beyond, or one of another label, and are none of these, with marker 0; a region seed in
/// each part that these enclose with a label other than 0; a hole in each void. Points that cells alone have are left out, but
/// for the first OutputMesh::input_points; the others keep their order, markers and attributes. The tolerance is the default, and
/// bounds on the sizes of regions are not known to a mesh. n log n, and linear in the cells for each void.
/// @throws InputError index_out_of_range: a vertex that does not exist, or labels, markers or attributes that are not one each;
///   UsageError bad_option: no cells
template <int D>
Plc<D> boundary_of_mesh(const OutputMesh<D>& mesh);

}  // namespace pgdr
