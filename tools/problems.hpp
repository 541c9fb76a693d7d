// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// What a diagnosis finds, as geometry: facets that cross and the segments in which they do, loops of openings, gaps, and so on.
// Prints nothing.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "pgdr/diagnosis.hpp"
#include "pgdr/plc.hpp"

namespace pgdr::tool {

/// Points, lines and polygons.
struct Problems {
  enum class Role {
    culprit,  ///< an entity of the input; each once for every kind of finding
    where,    ///< a place of the finding: of two facets that cross, the segment in which they do
  };
  struct Cell {
    Finding finding;
    Role role;
    /// Of a culprit: its number, and, of a segment or an edge, whose number is that of its first point, the other; of a place
    /// those of the first two that meet there. As the input counts; -1: none.
    std::array<std::int64_t, 2> ids{-1, -1};
    double measure = 0;  ///< of the finding (diagnosis.hpp)
    std::vector<std::uint32_t> points{};
  };

  std::vector<std::array<double, 3>> points;  ///< distinct
  std::vector<Cell> vertices, lines, polygons;

  std::size_t size() const { return vertices.size() + lines.size() + polygons.size(); }
};

/// All errors and open boundaries of an input, up to ten thousand of each other kind of finding, and of small angles those listed
/// in `diagnosis`.
template <int D>
Problems problems_in_full(const Plc<D>& plc, const Diagnosis<D>& diagnosis);
/// Adds the places of an error that no diagnosis finds.
void add_problem(Problems& problems, const Diagnostic& error);

/// @throws UsageError unknown_format
void require_problems_writable(const std::string& file);
/// As .vtp, .vtu, .vtk (legacy) or .obj. The cells, in the order vertices, lines, polygons, have `finding`, `role`, `id`,
/// `other_id` and `measure`; the field data `findings` has the words of the numbers of findings. An .obj has groups of these
/// words.
/// @throws FileError cannot_write
void write_problems(const Problems& problems, const std::string& file);

}  // namespace pgdr::tool
