// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The input that labelled cells stand for: faces that bound them and are not given yet, and a seed for each label. What
// is between the cells of one label may go. Deterministic; n log n. Any thread.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "pgdr/plc.hpp"

namespace pgdr::detail {

template <int D>
struct LabelledCell {
  std::array<std::uint32_t, D + 1> corners;
  double label = 0;
};

template <int D>
struct CellSurface {
  std::vector<std::array<std::uint32_t, D>> faces;  ///< of one cell, or between labels, and no wall; sorted
  /// One point in each part of the cells of one label, not 0, that walls and `faces` enclose: the centroid of its
  /// largest cell. None where no cell has its rounded centroid inside.
  std::vector<RegionSeed<D>> seeds;
};

/// @param walls the given facets (segments), each with its corners in increasing order; in any order
template <int D>
CellSurface<D> surface_of(const std::vector<Point<D>>& points, const std::vector<LabelledCell<D>>& cells,
                          const std::vector<std::array<std::uint32_t, D>>& walls);

}  // namespace pgdr::detail
