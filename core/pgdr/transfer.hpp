// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// What lived on a mesh, on another one: at points by linear interpolation, on cells so that integrals stay what they were. Where
// a point is, and what cells have in common, is found once for as many arrays as there are. Immutable once made; any number of
// threads may ask. They are made on the threads of the caller's tbb::task_arena, the same for any number of them.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "pgdr/export.hpp"
#include "pgdr/mesh_fields.hpp"
#include "pgdr/output_mesh.hpp"

namespace pgdr PGDR_API {

/// Values at points from those at the vertices of a mesh: linear (barycentric) in the cell that a point lies in, the one with the
/// smallest number if there are several; outside of the mesh those of the nearest point of its boundary. So values of a linear
/// function come out as they are, but for rounding, and no value is beyond those that it lies between. Some 2 microseconds a
/// point.
template <int D>
class PointTransfer {
 public:
  /// @throws UsageError bad_option: no cell that is not flat; InputError index_out_of_range, not_finite
  PointTransfer(const OutputMesh<D>& from, std::span<const Point<D>> to);

  /// @param values  `width` for each vertex of the mesh, row by row
  /// @param width  numbers of a row
  /// @returns  as many for each of the points
  /// @throws UsageError bad_option: another number of values
  std::vector<double> operator()(std::span<const double> values, std::size_t width = 1) const;
  /// Those of the corner that has the largest weight, in the place of a mean; of equal weights the first. @throws likewise
  std::vector<double> of_nearest_corners(std::span<const double> values, std::size_t width = 1) const;

 private:
  std::size_t vertices_;
  std::vector<std::array<std::uint32_t, D + 1>> corners_;
  std::vector<std::array<double, D + 1>> weights_;
};

/// Values of cells from those of the cells of another mesh of the same volumes, by what they have in common. Each old cell's
/// amount, its value times its measure, goes to the new cells in the shares in which they have it, so that the sum of all amounts
/// stays, label by label. Cells take from cells of their label alone, if both meshes have the same labels; else labels do not
/// count.
///
/// Common parts are convex, cut out plane by plane (D. Powell, T. Abel: An exact general remeshing scheme applied to physically
/// conservative voxelization, J. Comput. Phys. 297, 2015, sections 2 and 3), and measured to rounding. Where the boundaries of
/// the meshes differ, what of a new cell is in no old one counts as part of the old cell that it has most of, else of the
/// nearest; an old cell that no new one has anything of gives what it has to the nearest one. Amounts stay even so; a constant
/// does then up to the part that boundaries differ by.
template <int D>
class CellTransfer {
 public:
  /// @throws UsageError bad_option: a mesh without a cell that is not flat; InputError index_out_of_range, not_finite
  CellTransfer(const OutputMesh<D>& from, const OutputMesh<D>& to);

  /// Amounts over measures: what is a density, per volume (area), is conserved.
  /// @param values  `width` for each old cell, row by row
  /// @param width  numbers of a row
  /// @returns  as many for each new cell; 0 for a cell without a measure
  /// @throws UsageError bad_option: another number of values
  std::vector<double> means(std::span<const double> values, std::size_t width = 1) const;

  /// The value that has the largest share of each new cell; of equal shares the smallest value. For labels.
  /// @throws likewise
  std::vector<double> largest_share(std::span<const double> values) const;

 private:
  struct Part {
    std::uint32_t to, from;
    double measure;  ///< of what they have in common
  };
  void complete(const OutputMesh<D>& from, const OutputMesh<D>& to, std::span<const std::uint32_t> old_labels,
                std::span<const std::uint32_t> new_labels);

  std::size_t new_cells_ = 0;
  std::vector<Part> parts_;                ///< by new cells, then old ones
  std::vector<double> measures_, shared_;  ///< of each old cell, and of its parts together
  std::vector<double> new_measures_;
};

/// Gives the points of a mesh the attributes (OutputMesh::point_attributes) of another one, as PointTransfer has them; none if
/// that has none.
template <int D>
void transfer_attributes(const OutputMesh<D>& from, OutputMesh<D>& to);

/// All fields of a mesh on another one, those of points and means of cells as above; whole numbers of cells, if they are one
/// each, by the largest share; those of points, which mean nothing between, as those of the nearest corner of the cell.
template <int D>
MeshFields transfer_fields(const OutputMesh<D>& from, const MeshFields& fields, const OutputMesh<D>& to);

}  // namespace pgdr
