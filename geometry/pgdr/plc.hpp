// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The input as the caller has it: a planar straight line graph (D = 2) or a piecewise linear complex (D = 3). A plain
// value: fill it from memory, or by `read_plc`. Nothing is checked here; `Domain<D>` (domain.hpp) checks and prepares.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "pgdr/export.hpp"
#include "pgdr/types.hpp"

namespace pgdr PGDR_API {

/// A point that stands for the volume (area) around it, up to the facets (segments): a hole, or a region.
template <int D>
struct RegionSeed {
  Point<D> point;        ///< strictly inside
  double attribute = 0;  ///< label of the region's cells in the output
  double size = 0;       ///< largest volume (3D) or area (2D) of the region's cells; <= 0: no bound
};

/// Where things stood in the file, for messages. Empty vectors: unknown.
struct PlcSource {
  std::string file;                          ///< as it was opened
  std::vector<std::uint32_t> point_lines;    ///< line of each point, counted from 1
  std::vector<std::uint32_t> segment_lines;  ///< of each segment
  std::vector<std::uint32_t> facet_lines;    ///< of each facet
  std::vector<std::uint32_t> hole_lines;     ///< of each hole
  std::vector<std::uint32_t> region_lines;   ///< of each region
};

/// The input. Coordinates are in the user's units; all indices count from 0, whatever `first_index` is. From flat arrays:
/// flat_arrays.hpp.
template <int D>
struct Plc {
  /// A straight edge that must be a union of edges of the mesh.
  struct Segment {
    std::array<std::uint32_t, 2> points;  ///< its ends, indices into Plc::points
    int marker = 0;                       ///< handed on to its subsegments
  };
  /// A planar facet (3D only): one outer polygon, then any of: polygons of holes or of inner constraints, two-point
  /// polygons (inner segments), one-point polygons (inner points). What a hole seed reaches without crossing a polygon
  /// is not part of the facet. As in TetGen's .poly. A facet of one two-point polygon alone is a segment with its marker.
  struct Facet {
    std::vector<std::vector<std::uint32_t>> polygons;  ///< closed, without repeating the first point; into Plc::points
    std::vector<Point<D>> holes;                       ///< seeds, in space, projected as the facet is
    int marker = 0;                                    ///< handed on to its subfacets
  };

  std::vector<Point<D>> points;          ///< exact duplicates become one vertex; others, too, if merge_within says so
  std::vector<int> point_markers;        ///< empty, or one a point
  std::vector<double> point_attributes;  ///< of the first point, of the second, ...: equally many each, or none at all
  std::vector<Segment> segments;         ///< 2D: the boundary and inner constraints; 3D: those that no facet has
  std::vector<Facet> facets;             ///< 3D: the boundary and inner constraints; 2D: must be empty
  std::vector<Point<D>> holes;           ///< a point in each volume (area) that is to stay empty
  std::vector<RegionSeed<D>> regions;    ///< labels and bounds of volumes (areas)

  /// 3D: facets that meet at an edge, with all their points within `precision` times the largest of their coordinates
  /// of one plane, count as coplanar. For the rounding of coordinates that were turned or shifted: 16 ulps.
  double precision = 0x1p-48;
  /// `precision` is what the numbers of the file allow (written_precision), and nobody's wish: where facets fold over within it,
  /// `refine` of a Plc takes less, in the end the default (with_less_precision, which goes from there to 0, should it come to
  /// that).
  bool precision_of_file = false;
  /// Points within this times the largest coordinate of all are one: each goes to the nearest kept one before it. 0, as it is
  /// unless asked for (or the file is of floats, set_merge_of_file): exact duplicates alone. Edges, segments and facets of which
  /// nothing is left go; 0.01 at most. In 3D edges, segments and facets then go through points within that distance of them, and
  /// facets along edges that run as near to them.
  double merge_within = 0;

  std::uint32_t first_index = 0;  ///< the number the source gives its first point (0 or 1), for messages
  PlcSource source;               ///< for messages
};

/// A copy for which Plc::precision_of_file does not hold.
template <int D>
Plc<D> with_default_precision(Plc<D> plc) {
  plc.precision = Plc<D>{}.precision;
  plc.precision_of_file = false;
  return plc;
}

}  // namespace pgdr
