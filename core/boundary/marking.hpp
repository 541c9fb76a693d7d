// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The constraints of cells, once nothing is missing: each cell looks for its own faces and edges among all that are wanted, so
// that no two threads write to one cell. Private to this room.
#pragma once

#include "boundary/state.hpp"

namespace pgdr::detail {

/// Marks the subfacets and subsegments in all cells that have them. Side records come from `pools`.
void mark_constraints(Mesh<3>& mesh, Mesh<3>::Pools& pools, const WantedFaces& faces, const WantedEdges& edges, const Bulk& bulk);

}  // namespace pgdr::detail
