// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The caller's point selector at work: what it is told, what it may ask, and what becomes of the point that it returns.
#pragma once

#include <optional>

#include "refine/workspace.hpp"

namespace pgdr {

/// Where the selector puts the point of a cell over the radius-edge bound; nothing if the claim is too small to tell. `center`:
/// the cell's circumcentre. Uses the cavity, which must be empty.
/// @throws UsageError bad_option for a point outside the disk, if the caller wants that to be an error; what the selector throws
template <int D>
std::optional<Point<D>> selected_point(Workspace<D>& w, CellId c, const Point<D>& center);

}  // namespace pgdr
