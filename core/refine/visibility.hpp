// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The wall that hides an element's point from the element: the constrained face that a straight walk through the cells meets
// first. It is split in place of the element, as a cavity cannot be star-shaped about a point behind it.
#pragma once

#include <optional>

#include "refine/workspace.hpp"

namespace pgdr {

/// The wall before x, as seen from cell c, in the part of space that the visit has claimed. The walk adds to the trace.
template <int D>
std::optional<Entry<D>> wall_in_claim(Workspace<D>& w, CellId c, const Point<D>& x);

/// The wall beyond which the collected point x of cell c lies; none where the cavity is star-shaped for sure.
template <int D>
std::optional<Entry<D>> wall_that_hides(Workspace<D>& w, CellId c, const Point<D>& x);

/// 3D: the wall that hides the point of an element so flat that its point lies many times the element's longest edge away. Where
/// facets are nearly coplanar such a point is in conflict with other flat elements, often thousands. They are not collected to
/// find an entity that the point encroaches upon: mostly there is none, and the wall is split in the end.
template <int D>
std::optional<Entry<D>> wall_before_distant_point(Workspace<D>& w, CellId c, const Point<D>& x);

}  // namespace pgdr
