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

/// Splits segments where they cross, at new points (behind those of the input), each the exact intersection rounded once; where a
/// point is within twice the tolerance of that, or within what rounding makes of it (4 ulps of the largest coordinate), it is
/// taken in place of a new one. Before, segments are split at the points that they pass within the tolerance, and points within
/// it of each other are one, as a Domain has it: so nothing is a crossing that merely meets. Pieces leave the line of their
/// segment thereby; what they cross or pass now is split in turn, until nothing crosses. An input in which nothing crosses comes
/// back as it is: what merely meets is left to the Domain. The pieces keep the marker, and take the segment's place in the list;
/// attributes of the new points are interpolated along one of the segments. Which pieces come of it depends neither on the order
/// of the points nor on that of the segments.
/// @param plc the input.
/// @param repairs gets one entry entities_intersect, if anything crosses: `ids` are pairs of segments, in the numbering of
///   the input, `points` the new points; one point_on_segment for what is split at points that are there (the point, both
///   ends); and one degenerate_segment for segments of no length, which are dropped where anything is split (the segment, both
///   ends).
Plc<2> resolve_crossings(const Plc<2>& plc, std::vector<Diagnostic>& repairs);

}  // namespace pgdr
