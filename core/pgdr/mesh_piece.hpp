// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Pieces of a finished mesh: what each process of a distributed run keeps, and what each file of a .pvtu holds. A piece has
// successive rows of the arrays of the whole mesh, whose numbers have 64 bits. Plain values; any number of threads may read them.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "pgdr/export.hpp"
#include "pgdr/output_mesh.hpp"

namespace pgdr PGDR_API {

/// Some rows of a mesh. The rows of all its pieces, in their order, are those of the mesh, each once.
template <int D>
struct MeshPiece {
  using Number = std::uint64_t;  ///< of a point, cell, ... in the whole mesh

  /// What the whole mesh has.
  struct Totals {
    Number points = 0;                                               ///< how many it has
    Number input_points = 0;                                         ///< how many of these, the first, are of the input
    Number cells = 0;                                                ///< how many it has
    Number subfacets = 0;                                            ///< 3D: how many it has
    Number subsegments = 0;                                          ///< how many it has
    Number attributes_per_point = 0;                                 ///< how many attributes each point has
    bool point_markers = false;                                      ///< has each point a marker?
    bool regions = false;                                            ///< has each cell a label?
    bool leaves = false;                                             ///< has each cell its leaf of the tree?
    friend bool operator==(const Totals&, const Totals&) = default;  ///< the same numbers
  };

  /// The rows of cells, subfacets and subsegments, which index into `mesh.points`. These are the points of its cells, subfacets
  /// and subsegments, and its own rows of points; `mesh.input_points` of them, the first, are input points. `mesh.names` are
  /// those of the whole mesh.
  OutputMesh<D> mesh;
  std::vector<Number> point_numbers;  ///< of mesh.points in the whole mesh, ascending
  Number first_point = 0;             ///< in the whole mesh: the first of the points that are its own rows
  Number own_points = 0;              ///< how many points are its own rows; all of them are in mesh.points
  Number first_cell = 0;              ///< in the whole mesh: the row of the first cell
  Number first_subfacet = 0;          ///< and of the first subfacet
  Number first_subsegment = 0;        ///< and of the first subsegment
  Totals total;                       ///< the same in all pieces
};

/// Which other processes have each point of a piece, in compressed rows.
struct SharingRanks {
  std::vector<std::uint64_t> begin{0};  ///< where the ranks of each point begin in `ranks`, and where those of the last one end
  std::vector<int> ranks;               ///< of all points of the piece, of each ascending, without the rank itself
};

/// The row with which part `part` of so many parts of `rows` begins: floor(rows * part / parts).
/// @pre parts is from 1 to 2^32 - 1, part is not more
constexpr std::uint64_t first_row_of_part(std::uint64_t rows, std::uint64_t part, std::uint64_t parts) {
  return rows / parts * part + rows % parts * part / parts;
}

/// Piece k of `count` as equal as can be: rows [n k / count, n (k + 1) / count) of the n cells, and likewise of the points,
/// subfacets and subsegments. Takes time and memory in proportion to the piece, and a bit a point of the mesh.
/// @throws UsageError bad_option if count is not from 1 to 2^32 - 1, or k is not below it
template <int D>
MeshPiece<D> piece_of(const OutputMesh<D>& mesh, std::uint64_t k, std::uint64_t count);

/// The mesh of all its pieces, in any order.
/// @throws InputError syntax if they are not the pieces of one mesh, each once (rows are missing or there twice, or a point is
///   not the same in all), with the number of the row in the mesh; ResourceError ids_exhausted if an OutputMesh cannot index so
///   much
template <int D>
OutputMesh<D> join_pieces(std::span<const MeshPiece<D>> pieces);

}  // namespace pgdr
