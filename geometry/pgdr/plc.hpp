// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The input as the caller has it: a planar straight line graph (D = 2) or a piecewise linear complex (D = 3). A plain
// value: fill it from memory, or by `read_plc`. Nothing is checked here; `Domain<D>` (domain.hpp) checks and prepares.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "pgdr/export.hpp"
#include "pgdr/names.hpp"
#include "pgdr/types.hpp"

namespace pgdr PGDR_API {

/// A point that stands for the volume (area) around it, up to the facets (segments): a hole, or a region.
template <int D>
struct RegionSeed {
  Point<D> point;        ///< strictly inside
  double attribute = 0;  ///< label of the region's cells in the output
  double size = 0;       ///< largest volume (3D) or area (2D) of the region's cells; <= 0: no bound
};

/// What a PlcSource has lines of.
enum class SourceItem { point, segment, facet, hole, region };

/// Where things stood in the file, for messages. Empty vectors: unknown.
struct PlcSource {
  /// Of an input joined of several (joined_plc.hpp), whose lines count on from file to file: one of these.
  struct Part {
    std::string file;              ///< as it was opened
    std::uint32_t first_line = 0;  ///< for its things of unknown line; those of line n have first_line + n
  };
  /// Where one thing stood.
  struct Place {
    std::string file;        ///< as it was opened
    std::uint32_t line = 0;  ///< counted from 1; 0: unknown
  };
  /// Of item i.
  Place place(SourceItem item, std::size_t i) const;

  std::string file;                          ///< as it was opened; of several the first, and how many more
  std::vector<std::uint32_t> point_lines;    ///< line of each point, counted from 1
  std::vector<std::uint32_t> segment_lines;  ///< of each segment
  std::vector<std::uint32_t> facet_lines;    ///< of each facet
  std::vector<std::uint32_t> hole_lines;     ///< of each hole
  std::vector<std::uint32_t> region_lines;   ///< of each region

  /// Of a file that has cells, and no seeds of its own: how thick the voids between its cells are that the first holes were made
  /// for (infinite: one of them was not), and how many of the first regions were made for labelled cells. What is wrong with such
  /// a seed is said of the cells.
  std::vector<double> void_widths;
  std::uint32_t cell_regions = 0;  ///< so many of the first regions

  std::vector<Part> parts;  ///< empty: the input is not joined
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

  std::vector<Point<D>> points;          ///< exact duplicates become one vertex; others within `tolerance`, too
  std::vector<int> point_markers;        ///< empty, or one a point
  std::vector<double> point_attributes;  ///< of the first point, of the second, ...: equally many each, or none at all
  std::vector<Segment> segments;         ///< 2D: the boundary and inner constraints; 3D: those that no facet has
  std::vector<Facet> facets;             ///< 3D: the boundary and inner constraints; 2D: must be empty
  std::vector<Point<D>> holes;           ///< a point in each volume (area) that is to stay empty
  std::vector<RegionSeed<D>> regions;    ///< labels and bounds of volumes (areas)

  /// 3D: the body that each facet belongs to, counted from 0: a file, or a solid of an .stl. Empty: bodies are what hangs
  /// together by edges that facets share.
  std::vector<std::uint32_t> facet_bodies;
  std::vector<std::string> body_names;  ///< of each body; empty where `facet_bodies` is
  Names names;                          ///< of markers and labels, which the mesh hands on

  /// What lies within this distance meets (domain.hpp): an absolute length, in the units of the coordinates. None: the rounding
  /// of the coordinates, `rounding_tolerance`. 0: everything is exactly as given.
  std::optional<double> tolerance;
  /// A `tolerance` above a thousandth of the diagonal of all points is meant, and no slip of units; else a Domain refuses it.
  bool is_coarse = false;
  /// The coordinates were stored in single precision: rounding moves them by the ulps of floats.
  bool are_floats = false;

  std::uint32_t first_index = 0;  ///< the number the source gives its first point (0 or 1), for messages
  PlcSource source;               ///< for messages
};

/// What rounding may have done to these coordinates: 8 ulps of a double at the largest one; where they are floats, 2 ulps of a
/// float there, if that is no more than a millionth of the diagonal of all points. The default of Plc::tolerance. (Each turn or
/// shift of a point is a sum of up to four rounded terms, 2 to 3 ulps a coordinate; a rounding to floats is half an ulp of
/// these.) 0 of no points, or where coordinates are not finite.
template <int D>
double rounding_tolerance(const Plc<D>& plc);

/// The tolerance that a Domain of this input is made with: its own, or else the default.
template <int D>
double tolerance_of(const Plc<D>& plc) {
  return plc.tolerance ? *plc.tolerance : rounding_tolerance(plc);
}

/// The holes of an input where what lies within this distance meets: all but those made for voids between cells that are no
/// thicker, since nothing is left of these.
template <int D>
std::vector<Point<D>> holes_within(const Plc<D>& plc, double tolerance) {
  std::vector<Point<D>> holes;
  for (std::size_t i = 0; i < plc.holes.size(); ++i)
    if (i >= plc.source.void_widths.size() || plc.source.void_widths[i] > tolerance) holes.push_back(plc.holes[i]);
  return holes;
}

}  // namespace pgdr
