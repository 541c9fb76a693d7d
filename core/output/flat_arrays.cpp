// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "pgdr/flat_arrays.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include "pgdr/error.hpp"

namespace pgdr {
namespace {

[[noreturn]] void bad_length(const std::string& what) { throw UsageError({Errc::bad_option, what, {}, 0, {}, {}}); }

template <int D>
std::vector<Point<D>> points_of(const CoordinateArray& coordinates) {
  return std::visit(
      [](const auto& numbers) {
        if (numbers.size() % D != 0)
          bad_length(std::to_string(numbers.size()) + " coordinates, which is no multiple of " + std::to_string(D));
        std::vector<Point<D>> points(numbers.size() / D);
        for (std::size_t i = 0; i < points.size(); ++i) std::copy_n(numbers.begin() + i * D, D, points[i].x.begin());
        return points;
      },
      coordinates);
}

template <class Index>
[[noreturn]] void bad_index(std::size_t simplex, Index index, std::size_t points) {
  throw InputError({Errc::index_out_of_range,
                    "simplex " + std::to_string(simplex) + " has index " + std::to_string(index) + ", there are " +
                        std::to_string(points) + " points",
                    {},
                    0,
                    {static_cast<std::int64_t>(simplex), static_cast<std::int64_t>(index)},
                    {}});
}

/// N indices each, all of them below `points`.
template <std::size_t N>
std::vector<std::array<std::uint32_t, N>> simplices_of(const IndexArray& array, std::size_t points) {
  return std::visit(
      [points](const auto& indices) {
        if (indices.size() % N != 0)
          bad_length(std::to_string(indices.size()) + " indices, which is no multiple of " + std::to_string(N));
        std::vector<std::array<std::uint32_t, N>> simplices(indices.size() / N);
        for (std::size_t i = 0; i < indices.size(); ++i) {
          const auto index = indices[i];  // once: the caller's other threads may be writing to the array
          if (!std::in_range<std::uint32_t>(index) || static_cast<std::uint32_t>(index) >= points)
            bad_index(i / N, index, points);
          simplices[i / N][i % N] = static_cast<std::uint32_t>(index);
        }
        return simplices;
      },
      array);
}

}  // namespace

template <int D>
Plc<D> plc_from_arrays(CoordinateArray coordinates, IndexArray simplices, std::span<const int> markers) {
  Plc<D> plc;
  plc.points = points_of<D>(coordinates);
  plc.are_floats = std::holds_alternative<std::span<const float>>(coordinates);
  const auto faces = simplices_of<D>(simplices, plc.points.size());
  if (!markers.empty() && markers.size() != faces.size())
    bad_length(std::to_string(markers.size()) + " markers for " + std::to_string(faces.size()) + " simplices");
  for (std::size_t i = 0; i < faces.size(); ++i) {
    const int marker = markers.empty() ? 0 : markers[i];
    if constexpr (D == 2) {
      plc.segments.push_back({faces[i], marker});
    } else {
      plc.facets.push_back({{{faces[i].begin(), faces[i].end()}}, {}, marker});
    }
  }
  return plc;
}

template <int D>
OutputMesh<D> mesh_from_arrays(CoordinateArray coordinates, IndexArray cells) {
  OutputMesh<D> mesh;
  mesh.points = points_of<D>(coordinates);
  mesh.cells = simplices_of<D + 1>(cells, mesh.points.size());
  return mesh;
}

template PGDR_API Plc<2> plc_from_arrays<2>(CoordinateArray, IndexArray, std::span<const int>);
template PGDR_API Plc<3> plc_from_arrays<3>(CoordinateArray, IndexArray, std::span<const int>);
template PGDR_API OutputMesh<2> mesh_from_arrays<2>(CoordinateArray, IndexArray);
template PGDR_API OutputMesh<3> mesh_from_arrays<3>(CoordinateArray, IndexArray);

}  // namespace pgdr
