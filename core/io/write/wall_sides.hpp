// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Which faces of which cells the walls of a mesh are, for formats that name faces so.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "pgdr/output_mesh.hpp"

namespace pgdr::detail {

inline constexpr std::uint32_t no_cell = 0xffffffffu;

/// The face of a cell opposite a corner.
struct CellFace {
  std::uint32_t cell = no_cell;
  std::uint32_t corner = 0;
};

/// What separates cells: subfacets (2D: subsegments).
template <int D>
const auto& walls_of(const OutputMesh<D>& mesh) {
  if constexpr (D == 2)
    return mesh.subsegments;
  else
    return mesh.subfacets;
}

/// Of each wall the faces that it is, that of the smaller cell first; no_cell where there is none. Takes n log n of the walls,
/// and a look at each face whose vertices lie on walls.
template <int D>
std::vector<std::array<CellFace, 2>> sides_of_walls(const OutputMesh<D>& mesh);

/// Numbers of formats that know positive integers alone: labels that are some are their own, the others get the least that is
/// free.
/// @param labels  distinct, ascending
std::vector<int> positive_numbers(const std::vector<double>& labels);
bool is_positive_number(double label);

/// The distinct values, ascending; -0 is not 0.
std::vector<double> distinct_labels(std::vector<double> labels);

}  // namespace pgdr::detail
