// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Sizing fields made of others, of points, or of a background mesh. All copy what they are given, may be called from any
// number of threads at once, and return the same bits for the same point, whoever asks. Sizes are what SizingField takes:
// circumradius bounds in 3D, area bounds in 2D. Growth is a slope of lengths over lengths, in 2D of the square root of the
// area: 0.2 lets sizes grow by a fifth of the distance.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "pgdr/export.hpp"
#include "pgdr/output_mesh.hpp"
#include "pgdr/sizing.hpp"
#include "pgdr/types.hpp"

namespace pgdr PGDR_API {

/// The smallest of the fields at every point; no bound if there are none. A value that is NaN or not positive comes through,
/// so that the refinement can name the point. Constants among them cost no call. Asked by blocks if one of them is.
template <int D>
SizingField<D> smallest(std::vector<SizingField<D>> fields);

/// Sizes given at points, which grow with the distance from them: min over i of sizes[i] + growth |x - points[i]| (in 2D the
/// square of min sqrt(sizes[i]) + growth |x - points[i]|). This is the largest field that no point's size exceeds and whose
/// slope is `growth` at most; exactly the minimum, found by branch and bound in about log n steps where points are few
/// near x. Growth 0: the smallest size everywhere.
/// @throws UsageError bad_option: no points, not one size a point, growth negative or not finite; bad_size: a size that is
///   not positive and finite (ids: the point's number). InputError not_finite: a coordinate.
template <int D>
SizingField<D> sizes_at_points(std::span<const Point<D>> points, std::span<const double> sizes, double growth);

/// Sizes given along straight lines, which grow with the distance from them as those of sizes_at_points() do; a line of two equal
/// ends is a point. Made of points on the lines, so close that it is nowhere larger than the exact minimum, and nowhere less by
/// more than a twentieth of the line's size (2D: of its square root).
/// @throws as sizes_at_points (ids: the line's number), and bad_option: so many points that memory would not hold them
template <int D>
SizingField<D> sizes_along(std::span<const std::array<Point<D>, 2>> lines, std::span<const double> sizes, double growth);

/// Values at the vertices of a mesh from one value a cell: the smallest of its cells'. What is interpolated between them is
/// nowhere above the value of the cell. A vertex in no cell has the largest value of all. Linear time.
/// @throws UsageError bad_option: not one value a cell; bad_size: a value that is not positive and finite (ids: the cell).
///   InputError index_out_of_range (ids: the cell)
template <int D>
std::vector<double> smallest_at_vertices(const OutputMesh<D>& mesh, std::span<const double> of_cells);

/// Sizes given at the vertices of a background mesh, interpolated linearly (barycentric) in the cell that x lies in; outside
/// of the mesh the value at the nearest point of its boundary. Which cell x lies in is decided exactly; on faces that
/// cells share, and where cells overlap, the one with the smallest number counts. Never beyond the values of the vertices
/// that it is interpolated from. Flat cells and the orientation of cells do not matter; markers and constraints are not read.
/// About log n steps, more where long thin cells overlap with their boxes. For values that change too fast: limit_growth.
/// @param mesh    its cells and their vertices
/// @param values  one a vertex; or one a cell, which stand for smallest_at_vertices() of them. Of a mesh with as many cells as
///   vertices they are those of vertices.
/// @throws UsageError bad_option: no cell that is not flat, or not one value a vertex or cell; bad_size: a value that is not
///   positive and finite (ids: the vertex or cell). InputError index_out_of_range (ids: the cell), not_finite.
template <int D>
SizingField<D> sizes_on_mesh(const OutputMesh<D>& mesh, std::span<const double> values);

/// Sizes of the cells of a mesh, each everywhere in its cell, as TetGen's and Triangle's -r take bounds of cells; on faces that
/// cells share, and where they overlap, of the one with the smallest number. No bound outside, nor in cells whose size is not
/// positive.
/// @throws UsageError bad_option: no cell that is not flat, or not one size a cell; bad_size: a NaN (ids: the cell).
///   InputError index_out_of_range (ids: the cell), not_finite.
template <int D>
SizingField<D> sizes_in_cells(const OutputMesh<D>& mesh, std::span<const double> sizes);

/// Values at the vertices of a mesh, lowered where they grow faster than `growth` along an edge: the largest values, none
/// above its old one, that do not. n log n. Values far below their neighbours' thus have the say, as usual.
/// @throws as sizes_on_mesh, and UsageError bad_option: growth negative or not finite
template <int D>
std::vector<double> limit_growth(const OutputMesh<D>& mesh, std::span<const double> values, double growth);

/// Values at the vertices of a labelled mesh by the sizes of its regions: the smallest of the sizes, at the vertex, of all
/// regions that meet there; `otherwise` at vertices of none of them. By `limit_growth` and `sizes_on_mesh` they become sizes
/// that grow gradually from a fine region into its neighbours. A mesh without labels has the label 0. Linear time.
/// @param mesh  a background mesh, e.g. what `refine` makes of the same input without any size
/// @param sizes  of regions that the mesh has
/// @param otherwise  positive and finite
/// @throws UsageError bad_option: `otherwise`, or no cell has a label (but 0); bad_size: a size that is not positive and
///   finite (ids: the vertex). InputError index_out_of_range (ids: the cell). What a size function throws.
template <int D>
std::vector<double> sizes_of_regions(const OutputMesh<D>& mesh, const RegionSizes<D>& sizes, double otherwise);

/// What a size is of. Meshes are bounded by circumradii in 3D and by areas in 2D; other sizes are made these.
enum class SizeUnit : std::uint8_t {
  edge,    ///< a length h: edges are h long on average. 3D: circumradius 0.75 h; 2D: area 0.625 h^2 (measured, docs/remeshing.md)
  radius,  ///< circumradius. 2D: the area of the regular triangle with this one, 3 sqrt(3) / 4 of its square
  area,    ///< 2D
  volume,  ///< 3D: the circumradius of the regular tetrahedron with this volume, so that none has more
};

/// The unit of sizes where nothing else is said.
template <int D>
constexpr SizeUnit usual_size_unit() {
  return D == 2 ? SizeUnit::area : SizeUnit::radius;
}

/// A size in the usual unit. What is not positive, or NaN, stays so. By correctly rounded operations alone.
/// @throws UsageError bad_option: areas in 3D, volumes in 2D
template <int D>
double in_usual_unit(double size, SizeUnit unit);
/// The same of a field, asked by blocks if that is. @throws likewise
template <int D>
SizingField<D> in_usual_unit(SizingField<D> field, SizeUnit unit);
/// How much the length of a usual size (in 2D the root of the area) grows where one in this unit grows by 1: growths of lengths
/// in a unit times this are growths as limit_growth and sizes_at_points take them. Areas and volumes: 1.
template <int D>
double growth_of_unit(SizeUnit unit);

}  // namespace pgdr
