// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The input as the caller has it: a planar straight line graph (D = 2) or a piecewise linear complex (D = 3). A plain
// value: fill it from memory, or by `read_plc`. Nothing is checked here; `Domain<D>` (domain.hpp) checks and prepares.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "pgdr/types.hpp"

namespace pgdr {

/// A point that stands for the volume (area) around it, up to the facets (segments): a hole, or a region.
template <int D>
struct RegionSeed {
  Point<D> point;
  double attribute = 0;  ///< label of the region's cells in the output
  double size = 0;       ///< largest volume (3D) or area (2D) of the region's cells; <= 0: no bound
};

/// Where things stood in the file, for messages. Empty vectors: unknown.
struct PlcSource {
  std::string file;
  std::vector<std::uint32_t> point_lines, segment_lines, facet_lines, hole_lines, region_lines;
};

template <int D>
struct Plc {
  struct Segment {
    std::array<std::uint32_t, 2> points;
    int marker = 0;
  };
  /// A planar facet (3D only): one outer polygon, then any of: polygons of holes or of inner constraints, two-point
  /// polygons (inner segments), one-point polygons (inner points). What a hole seed reaches without crossing a polygon
  /// is not part of the facet. As in TetGen's .poly.
  struct Facet {
    std::vector<std::vector<std::uint32_t>> polygons;
    std::vector<Point<D>> holes;  ///< seeds, in space, projected as the facet is
    int marker = 0;
  };

  std::vector<Point<D>> points;
  std::vector<int> point_markers;  ///< empty, or one a point
  std::vector<Segment> segments;
  std::vector<Facet> facets;
  std::vector<Point<D>> holes;
  std::vector<RegionSeed<D>> regions;

  std::uint32_t first_index = 0;  ///< the number the source gives its first point (0 or 1), for messages
  PlcSource source;
};

}  // namespace pgdr
