// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The convex hull of an input's points as a part of it, so that bare points can be meshed. Pure functions; any thread. Input that
// a Domain refuses for other reasons (indices, coordinates that are not finite) comes back unchanged.
#pragma once

#include "pgdr/export.hpp"
#include "pgdr/plc.hpp"

namespace pgdr PGDR_API {

/// Adds the edges of the convex hull of all points as segments, with marker 0, but for those that are segments already. They go
/// through all points that they pass within the tolerance.
Plc<2> with_convex_hull(const Plc<2>& plc);

/// Adds the facets of the convex hull of all points, with marker 0, but for those that are facets already: all that lies in one
/// plane, exactly, is one polygon, from corner to corner of the hull. So it depends neither on the order of the points nor on
/// that of anything else, but for the numbers of corners. One whose corners are all within the tolerance of the edge between two
/// of them is a part of that edge, and left out. Points on the hull are left to the Domain, and so are facets of planes that are
/// one within the tolerance.
/// @throws InputError no_volume: all points lie in one plane
Plc<3> with_convex_hull(const Plc<3>& plc);

}  // namespace pgdr
