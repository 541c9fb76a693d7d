// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// A facet that is planar only within a tolerance (Plc::precision, a bent polygon) is triangulated anew, within that tolerance of
// its triangles. Where other facets are as near, at edges as short as the tolerance, the new surface may pass on the wrong side of
// a point, and carving takes cells that belong to the domain, or leaves others. Nothing else takes a part of a segment out of the
// mesh: along a segment the same facets and volumes meet.
#pragma once

#include "pgdr/domain.hpp"
#include "pgdr/mesh.hpp"

namespace pgdr {

/// After carving. Looks at nothing where all facets are planar but for rounding. Any thread; nobody changes the mesh meanwhile.
/// @throws InputError boundary_not_recovered: the least segment that is in the mesh in part; its ends in `ids` and `points`
void require_unfolded(const Mesh<3>& mesh, const Domain<3>& domain);

}  // namespace pgdr
