// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// What makes every edge of a facet one of the mesh (RefineOptions::keep_boundary). A pure function; any thread.
#pragma once

#include <vector>

#include "pgdr/export.hpp"
#include "pgdr/plc.hpp"

namespace pgdr PGDR_API {

/// Adds the edges of the polygons of facets as segments with marker 0 behind those of the input, each once, but for those that
/// are segments already: so those between coplanar facets are segments of a Domain, too. Nothing else changes, and neither does
/// what is given. `refine` of a Plc does it by itself.
/// @param plc     the input
/// @param markers of the facets whose edges are kept; empty: all.
/// @returns the input as it is where indices do not exist, which a Domain refuses
Plc<3> with_kept_edges(Plc<3> plc, const std::vector<int>& markers);

}  // namespace pgdr
