// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Where everything of a .vtu file lies, which follows from the totals of its mesh alone, and what puts the rows that somebody has
// of it. So it can be written from its beginning to its end by one who has all rows, or by several at once, each its own rows.
//
// VTK's XML file of an unstructured grid, all arrays appended as raw bytes, so that writing is copying and doubles keep
// their bits. Cells come first, then subfacets (3D), then subsegments; "region" and "leaf" (-1 elsewhere) mean something for
// the cells and "marker" for the others. Field data "dimension" and "input_points" let our reader restore the mesh; of each name
// there is an array of that name with what it stands for: pairs of a label or marker, and the dimension of what has it, as meshio
// has it of gmsh's files. The file of a piece has the numbers of its points and cells in the whole mesh, too, and field data
// "piece". Of sides that correspond field data "periodic_sides" has pairs of markers, "periodic_motions" a motion of each.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "output/mid_sides.hpp"
#include "paths/file_output.hpp"
#include "pgdr/mesh_fields.hpp"
#include "pgdr/mesh_piece.hpp"
#include "pgdr/periodic.hpp"

namespace pgdr::detail {

/// What of a file somebody has.
template <int D>
struct VtuPart {
  using Number = std::uint64_t;

  const OutputMesh<D>* mesh;
  typename MeshPiece<D>::Totals total;                 ///< of the file
  const std::vector<Number>* point_numbers = nullptr;  ///< of mesh->points in the file; null: they are all points, in their order
  Number first_point = 0, own_points = 0;              ///< the rows of points, by their numbers in the file
  Number first_cell = 0, first_subfacet = 0, first_subsegment = 0;
  const MeshPiece<D>* piece = nullptr;                   ///< of a whole mesh whose numbers the file has, too
  std::vector<std::uint32_t> periodic_of = {};           ///< of all points; empty: nothing is periodic
  const std::vector<PeriodicPairs>* periodic = nullptr;  ///< of a whole mesh: the sides of that
  const MeshFields* fields = nullptr;                    ///< of a whole mesh: further arrays
  const MidSides<D>* middles = nullptr;                  ///< of a whole mesh of second order, which has these nodes

  /// @param pairs outlive this
  void set_periodic(const std::vector<PeriodicPairs>& pairs) {
    if (pairs.empty()) return;
    periodic = &pairs;
    periodic_of = pgdr::periodic_of(pairs, mesh->points.size());
  }

  static VtuPart whole(const OutputMesh<D>& mesh);          ///< all rows of the file of a mesh
  static VtuPart rows_of(const MeshPiece<D>& piece);        ///< its rows of the file of the whole mesh
  static VtuPart file_of_piece(const MeshPiece<D>& piece);  ///< all rows of a file of the piece alone
};

/// An array of the file: how it is announced, how large it is, where it lies.
struct VtuArray {
  /// Successive rows of it.
  struct Rows {
    std::uint64_t at;  ///< in the array, in bytes
    std::size_t count;
    PutBlock put;
  };
  std::string_view section, type;
  std::string name;
  std::string shape;  ///< further attributes of the announcement, or empty
  std::uint64_t bytes = 0;
  std::uint64_t offset = 0;  ///< of its size, which its rows follow, in the appended data
  std::vector<Rows> rows;    ///< those of the part
  std::string content;       ///< instead of rows: what everybody knows
};

/// The arrays as they are announced, with the rows of a part, which must outlive them. They lie in the file in the opposite
/// order.
template <int D>
std::vector<VtuArray> arrays_of(const VtuPart<D>& part);

/// What comes before the appended data.
template <int D>
std::string vtu_head(const typename MeshPiece<D>::Totals& total, const std::vector<VtuArray>& arrays);
inline constexpr std::string_view vtu_tail = "\n</AppendedData>\n</VTKFile>\n";

}  // namespace pgdr::detail
