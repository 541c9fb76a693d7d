// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Maps as 2D inputs: features with polygons, which are what is meshed, and with lines and points, which lie in it; and what the
// segments of an input enclose, and whose it is. Pure functions, any thread.
//
// Of the faces: segments are split first where they meet within the tolerance or cross, as resolve_crossings() does it; what
// comes of them is a planar graph, whose faces are found by walks along its edges, with exact signs; of each bounded face one
// point inside is chosen.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "pgdr/export.hpp"
#include "pgdr/plc.hpp"
#include "pgdr/types.hpp"

namespace pgdr PGDR_API {

/// Points one behind the other. Those that follow each other may be equal, and the first one may be there again at the end of a
/// ring.
struct MapPath {
  std::vector<Point2> points;        ///< finite
  std::vector<std::uint32_t> lines;  ///< of the source, one a point, for messages; empty: unknown
};

/// A polygon by its rings, the outer one first; a line by its one path; or a point, by a path of one.
struct MapPart {
  /// What it may be.
  enum class Kind : std::uint8_t { polygon, line, point };
  Kind kind = Kind::polygon;   ///< what it is
  std::vector<MapPath> paths;  ///< at least one
};

/// A row of a table of geometries.
struct MapFeature {
  double label = 0;            ///< of the cells in its polygons
  double size = 0;             ///< their largest area; <= 0: any
  int marker = 0;              ///< of its edges
  std::string label_name;      ///< what the label is called, if the feature has polygons; empty: nothing
  std::string marker_name;     ///< what the marker is called, if it has edges; empty: nothing
  std::vector<MapPart> parts;  ///< its geometries
};

/// The input that a map is. Equal points are one, in the order in which they come; equal edges are one, with the marker of the
/// first feature that has them; of names of one number the first one counts. Where there are polygons, each bounded face of all
/// edges has a seed: a region with the label and size of the first feature with a polygon that has the face, else a hole. Edges
/// may cross: the input is as given, and resolve_crossings() is for that. n log n.
/// @param features  rows, in the order in which they count
/// @param tolerance  Plc::tolerance
Plc<2> plc_of_map(std::span<const MapFeature> features, std::optional<double> tolerance = std::nullopt);

/// A polygon by its rings: the outer one, then its holes, each without the first corner again at its end.
struct RingPolygon {
  std::vector<std::vector<Point2>> rings;  ///< by corners
  std::uint32_t feature = 0;               ///< what it belongs to
};

/// A point for a face of a planar graph.
struct FaceSeed {
  Point2 point;               ///< inside, off all edges
  std::int64_t feature = -1;  ///< of the first polygon that has the point; -1: none has
};

/// One point in each bounded face that the segments of `plc` make, which has nothing else; faces so narrow that rounding leaves
/// no point in them have none. n log n, but for what lies on a line through each face, and polygons whose boxes lie over each
/// other.
std::vector<FaceSeed> seeds_of_faces(const Plc<2>& plc, std::span<const RingPolygon> polygons);

}  // namespace pgdr
