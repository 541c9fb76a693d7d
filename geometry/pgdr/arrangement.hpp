// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Surfaces and lines of space that cross (facets through facets, segments through facets and through each other), made free of
// crossings: the exact arrangement of their triangles, each new point rounded once, in rounds, until nothing meets but in common
// points and edges. What comes out is judged by the same exact search as any input (diagnosis.hpp). Pure functions, any thread;
// long loops run on the threads of the caller's tbb::task_arena, and what comes out is the same for any number of them.
#pragma once

#include <array>
#include <cstdint>
#include <stop_token>
#include <vector>

#include "pgdr/error.hpp"
#include "pgdr/export.hpp"
#include "pgdr/plc.hpp"

namespace pgdr PGDR_API {

/// Whose marker a piece has that several facets cover.
enum class SharedMarker : std::uint8_t {
  smallest,  ///< the facet of smallest area, as where facets overlap in a plane; ties: the first
  first,     ///< the facet of smallest index
  last,      ///< of largest index
};

/// A facet of the input that covers a piece. Of facets that go on in each other in one plane, with equal markers and oriented
/// alike, a piece may lie in several, and names the one that has its middle.
struct PieceOrigin {
  std::uint32_t facet;                                   ///< index in Plc::facets
  bool reversed = false;                                 ///< the piece's corners run against those of the facet's first polygon
  auto operator<=>(const PieceOrigin&) const = default;  ///< by facet
};

/// A surface cut along all its meetings: triangles any two of which have a corner, an edge, or nothing in common.
struct Arrangement {
  /// Those of the input first (all of them, by their indices, where they were joined), then new ones.
  std::vector<Point<3>> points;
  std::vector<double> point_attributes;  ///< of each point, as of those of the input; of new ones interpolated, as below
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< the pieces; none twice, none degenerate
  std::vector<std::uint32_t> origins_begin;             ///< of each piece, among `origins`; one more than pieces
  /// All facets that cover the piece, with multiplicity, the one whose marker it has first.
  std::vector<PieceOrigin> origins;
  /// Plc::segments, cut where they go through facets or each other, and edges drawn inside of facets that were cut.
  std::vector<Plc<3>::Segment> segments;
  std::vector<std::uint32_t> segment_lines;  ///< PlcSource::segment_lines of these
  /// With which nothing crosses: that of the input, or, where it is the rounding of floats and rounds do not end, that of
  /// doubles.
  double tolerance = 0;
};

/// How crossings are resolved.
struct ArrangementOptions {
  SharedMarker markers = SharedMarker::smallest;  ///< of pieces that several facets cover
  std::stop_token stop = {};                      ///< ends it, from any thread, by a CancelledError
};

/// The surface of the input, free of crossings.
///
/// What lies within the tolerance meets, and facets that overlap in a plane are subdivided, as a Domain has it (domain.hpp). What
/// crosses then is cut: all triangles along the edges and points that they have in common with others, exactly, in rationals; and
/// every new point is rounded to the nearest doubles. Points of the input never move, but by the tolerance. What rounding makes
/// meet again is cut in the next round. A piece after k rounds is within k * sqrt(3)/2 ulps of the largest coordinate, and the
/// tolerance, of its facets. Where rounds do not end, the points of what still meets go to a grid of 2^-23 of the largest
/// coordinate, which is said among the repairs. Some 10 microseconds a triangle, and 30 more one that is cut.
/// @param plc the input.
/// @param repairs gets an entry entities_intersect if anything crossed: `ids` are pairs of facets of the input, `points` the new
///   points; and one near_points if points went to a grid: their numbers.
/// @param options whose marker a piece has; what ends it.
/// @throws InputError what Domain refuses for other reasons than crossings; entities_intersect with the pairs left, if there
///   is no end; CancelledError
Arrangement arrange(const Plc<3>& plc, std::vector<Diagnostic>& repairs, const ArrangementOptions& options = {});

/// The same as an input: with pieces, a triangle each, in the place of the facets that anything crosses, and of segments, in the
/// places of these, with their markers, bodies and the lines of their source. All else comes back as it is; so does an input in
/// which nothing crosses, and one that a Domain refuses for other reasons. Attributes of new points are interpolated along an
/// edge, or in a triangle.
/// @param plc the input.
/// @param repairs as above.
/// @param options as above.
/// @throws InputError as above, but for the first; CancelledError
Plc<3> resolve_crossings(const Plc<3>& plc, std::vector<Diagnostic>& repairs, const ArrangementOptions& options = {});

}  // namespace pgdr
