// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Inputs from, and meshes as, the flat arrays that other programs hold: coordinates one point after the other (D each), simplices
// one after the other (indices from 0). Views cost nothing and live as long as what they look at; the vectors of an OutputMesh
// may as well be moved out. Pure functions, any thread.
#pragma once

#include <cstdint>
#include <span>
#include <variant>

#include "pgdr/export.hpp"
#include "pgdr/output_mesh.hpp"
#include "pgdr/plc.hpp"
#include "pgdr/types.hpp"

namespace pgdr PGDR_API {

static_assert(sizeof(Point<2>) == 2 * sizeof(double) && sizeof(Point<3>) == 3 * sizeof(double));
static_assert(sizeof(std::array<std::uint32_t, 3>) == 12 && sizeof(std::array<std::uint32_t, 4>) == 16);

/// The coordinates of points: D each, points.size() * D in all. A view.
template <int D>
std::span<const double> flat(std::span<const Point<D>> points) {
  return {points.empty() ? nullptr : points.front().x.data(), points.size() * D};
}
/// Coordinates of the points of a mesh: points.size() * D. A view: of a mesh that ends with the statement there is none.
template <int D>
std::span<const double> flat_points(const OutputMesh<D>& mesh) {
  return flat<D>(std::span<const Point<D>>(mesh.points));
}
template <int D>
std::span<const double> flat_points(const OutputMesh<D>&& mesh) = delete;
/// Vertices of the cells of a mesh, D + 1 each: cells.size() * (D + 1). A view: the mesh must outlive it.
template <int D>
std::span<const std::uint32_t> flat_cells(const OutputMesh<D>& mesh) {
  return {mesh.cells.empty() ? nullptr : mesh.cells.front().data(), mesh.cells.size() * (D + 1)};
}
template <int D>
std::span<const std::uint32_t> flat_cells(const OutputMesh<D>&& mesh) = delete;

/// Coordinates in an array of doubles or floats: a view, which a std::vector, std::array, std::span or array of them turns into.
using CoordinateArray = std::variant<std::span<const double>, std::span<const float>>;
/// Indices in an array of integers of 32 or 64 bits: a view, likewise.
using IndexArray = std::variant<std::span<const std::uint32_t>, std::span<const std::int32_t>, std::span<const std::int64_t>,
                                std::span<const std::uint64_t>>;

/// An input from flat arrays. One copy, linear time; what is wrong with the geometry is found by Domain or `refine`.
/// @param coordinates  D a point; if they are floats, so much rounding is expected of them
/// @param simplices    D indices each: segments in 2D, triangles in 3D
/// @param markers      one a simplex, or empty: 0
/// @throws UsageError bad_option: an array of another length; InputError index_out_of_range (ids: simplex, index), also below 0
template <int D>
Plc<D> plc_from_arrays(CoordinateArray coordinates, IndexArray simplices, std::span<const int> markers = {});

/// A mesh from flat arrays, without constraints or labels: a background mesh, or one to check. One copy, linear time.
/// @param coordinates  D a point
/// @param cells        D + 1 indices each
/// @throws as plc_from_arrays
template <int D>
OutputMesh<D> mesh_from_arrays(CoordinateArray coordinates, IndexArray cells);

}  // namespace pgdr
