// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Openings of a surface, as the ends of a pipe that is a wall without thickness, and facets that close them. A pure function; any
// thread; long loops run on the threads of the caller's tbb::task_arena, and what comes out is the same for any number of them.
#pragma once

#include <stop_token>
#include <vector>

#include "pgdr/error.hpp"
#include "pgdr/export.hpp"
#include "pgdr/plc.hpp"

namespace pgdr PGDR_API {

/// The input with a facet more for each opening that lies in a plane.
///
/// An opening is bounded by loops: closed chains of edges of one facet each, through distinct points, that have at most one point
/// in common with other such chains. Edges, and what is one point, are those of the input's Domain (domain.hpp). A loop is closed
/// if its points lie in one plane, exactly or within the tolerance, and its edges do not cross as seen along an axis; and not if
/// the facet that closes it would cover facets of the same plane that have the loop as their rim: a flat sheet stays open.
///
/// Loops of one plane that lie in others are told by the directions in which their facets run along them: what is closed is
/// where they wind around, as often to one side as to the other makes none. So between the inner and the outer wall of a pipe a
/// ring is closed, and where one pipe lies in another the ring and the disc. Where facets run along a loop in both directions
/// each loop changes closed and open. The facet of an opening has the loop around it as first polygon, then those in it, which
/// are holes of it; it goes on in the direction of the facets around it, or is counter-clockwise as seen along the axis.
///
/// New facets stand behind those of the input, in the order of their least points (compared by coordinates, then the next ones).
/// Each has a marker of its own: the least positive number that nothing has; with the name closed_opening_1, closed_opening_2,
/// ..., as far as no marker has it. Of bodies (Plc::facet_bodies) it belongs to the first one of the facets around it. A point
/// that the Domain has added on a loop becomes one of the input. Some microseconds a facet of the input.
/// @param plc the input. One that a Domain refuses comes back as it is, as one without such openings does.
/// @param repairs gets an entry open_boundary for each opening: `ids` are the points of its loops, `points` where these are.
/// @param stop ends it, from any thread, by a CancelledError.
/// @throws CancelledError
Plc<3> close_planar_openings(const Plc<3>& plc, std::vector<Diagnostic>& repairs, const std::stop_token& stop = {});

}  // namespace pgdr
