// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Where a mesh in which the refinement saw no violations may have faces that are not locally Delaunay: beside points that
// rounding has moved off their entities.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "pgdr/check.hpp"

namespace pgdr::checking {

/// Of each point: is it one of a cell with a slanted point?
template <int D>
std::vector<std::uint8_t> points_beside(const OutputMesh<D>& mesh, const std::vector<std::uint8_t>& slanted);

/// Is the cell to be looked at? Those with a slanted point are, those that share a face with one, and few more.
template <std::size_t N>
bool is_beside(const std::array<std::uint32_t, N>& cell, const std::vector<std::uint8_t>& beside) {
  return std::count_if(cell.begin(), cell.end(), [&](std::uint32_t v) { return beside[v] != 0; }) + 1 >=
         static_cast<std::ptrdiff_t>(N);
}

/// Counts among the cells of this mesh. @param slack  of each point, as slack_of_vertices() has it
template <int D>
NotDelaunay count_among(const OutputMesh<D>& mesh, std::span<const double> slack);

}  // namespace pgdr::checking
