// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// What may be done to a planar straight line graph before it is meshed, if the caller asks for it. Pure functions; any
// thread. Input that a Domain refuses for other reasons (indices, coordinates that are not finite) comes back unchanged.
#pragma once

#include <vector>

#include "pgdr/error.hpp"
#include "pgdr/export.hpp"
#include "pgdr/plc.hpp"

namespace pgdr PGDR_API {

/// Splits segments where they cross, at new points (behind those of the input), each the exact intersection rounded once:
/// pieces may leave the line of their segment by an ulp. What that makes cross is split in turn, at points that are there
/// already where the rounded intersection is one of them, until nothing crosses. Segments are split before at the points that
/// they miss by no more than rounding, 4 ulps of the largest coordinate, as where roads meet in a file of rounded coordinates;
/// those that touch or overlap exactly, and nothing else, are left to Domain. The pieces keep the marker, and take the segment's
/// place in the list; attributes of the new points are interpolated along one of the segments.
/// @param plc the input.
/// @param repairs gets one entry entities_intersect, if anything crosses: `ids` are pairs of segments, in the numbering of
///   the input, `points` the new points; one point_on_segment for what is split at points that are there (the point, both
///   ends); and one degenerate_segment for segments of no length, which are dropped where anything is split (the segment, both
///   ends).
/// @throws InputError entities_intersect if there is no end of it, which no input is known to cause.
Plc<2> resolve_crossings(const Plc<2>& plc, std::vector<Diagnostic>& repairs);

/// Adds the edges of the convex hull of all points as segments, with marker 0, but for those that are segments already.
Plc<2> with_convex_hull(const Plc<2>& plc);

}  // namespace pgdr
