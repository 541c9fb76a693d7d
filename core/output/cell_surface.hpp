// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The input that labelled cells stand for: faces that bound them and are not given yet, a seed for each label, and a hole
// in each void that they enclose. What is between the cells of one label may go. Deterministic; n log n, and linear in
// the cells for each void. Any thread.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "pgdr/plc.hpp"
#include "space/disjoint_sets.hpp"

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
  std::vector<Point<D>> holes;
};

/// A face of one cell alone.
template <int D>
struct HullFace {
  std::array<std::uint32_t, D> corners;
  std::uint32_t cell;
};

/// A point in each void: beside the largest face of each closed part of the hull that has the cells outside. The point
/// lies strictly beyond its face and in no cell; exact. A void that has a double ridge (two in 2D: points) in common with
/// another part of the hull may be missed if that opens it.
/// @param hull all of them, in any order
template <int D>
std::vector<Point<D>> points_in_voids(const std::vector<Point<D>>& points, const std::vector<LabelledCell<D>>& cells,
                                      const std::vector<HullFace<D>>& hull);

/// @param walls the given facets (segments), each with its corners in increasing order; in any order
template <int D>
CellSurface<D> surface_of(const std::vector<Point<D>>& points, const std::vector<LabelledCell<D>>& cells,
                          const std::vector<std::array<std::uint32_t, D>>& walls);

}  // namespace pgdr::detail
