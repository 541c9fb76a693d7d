// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The input that labelled cells stand for: faces that bound them and are not given yet, a seed for each label, and a point
// in each void that they enclose. What is between the cells of one label may go. Deterministic; n log n, and linear in
// the cells for each void. Any thread.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "pgdr/plc.hpp"
#include "pgdr/types.hpp"
#include "space/disjoint_sets.hpp"

namespace pgdr::detail {

template <int D>
struct LabelledCell {
  std::array<std::uint32_t, D + 1> corners;
  double label = 0;
};

/// A void that cells enclose, by a point in it.
template <int D>
struct CellVoid {
  Point<D> point;
  double width = 0;  ///< of the strip between two parallel planes (lines) that has the void's faces
};

template <int D>
struct CellSurface {
  std::vector<std::array<std::uint32_t, D>> faces;  ///< of one cell, or between labels, and no wall; sorted
  /// One point in each part of the cells of one label, not 0, that walls and `faces` enclose: the centroid of its
  /// largest cell. None where no cell has its rounded centroid inside.
  std::vector<RegionSeed<D>> seeds;
  std::vector<CellVoid<D>> voids;
};

/// A face of one cell alone.
template <int D>
struct HullFace {
  std::array<std::uint32_t, D> corners;
  std::uint32_t cell;
};

/// The cells beyond the faces of each cell; no_entity: none, or several.
template <int D>
using CellLinks = std::vector<std::array<std::uint32_t, D + 1>>;

/// The parts of the hull, each closed and without touching itself but at lower ridges: at a ridge (2D: a point) of more than two
/// of its faces those are neighbours between which there is no cell. Named by the least face of each.
template <int D>
std::vector<std::uint32_t> parts_of_hull(const std::vector<Point<D>>& points, const std::vector<LabelledCell<D>>& cells,
                                         const CellLinks<D>& links, const std::vector<HullFace<D>>& hull);

/// The voids: the parts of the hull that have the cells outside. The point lies strictly beyond one of the void's large faces,
/// half way to what is opposite where that is free, and in no cell; exact. Where there is no such point, as in voids that
/// rounding alone has opened, there is none.
/// @param parts of each face
template <int D>
std::vector<CellVoid<D>> voids_of(const std::vector<Point<D>>& points, const std::vector<LabelledCell<D>>& cells,
                                  const std::vector<HullFace<D>>& hull, const std::vector<std::uint32_t>& parts);

/// @param walls the given facets (segments), each with its corners in increasing order; in any order
template <int D>
CellSurface<D> surface_of(const std::vector<Point<D>>& points, const std::vector<LabelledCell<D>>& cells,
                          const std::vector<std::array<std::uint32_t, D>>& walls);

/// Makes the seeds and the points in voids those of an input that has no others.
template <int D>
void give_seeds(const CellSurface<D>& surface, Plc<D>& plc) {
  plc.regions = surface.seeds;
  plc.source.cell_regions = static_cast<std::uint32_t>(surface.seeds.size());
  for (const CellVoid<D>& v : surface.voids) {
    plc.holes.push_back(v.point);
    plc.source.void_widths.push_back(v.width);
  }
}

}  // namespace pgdr::detail
