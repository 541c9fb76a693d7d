// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// A facet that is planar only within a tolerance (Plc::tolerance, a bent polygon) is triangulated anew, within that tolerance of
// its triangles. Where other facets are as near, at edges or walls as short as the tolerance, the new surface may pass on the
// wrong side of a point, or have a triangle in common with another one, and carving takes cells that belong to the domain, or
// leaves others. Nothing of the mesh alone tells all of that (one that is inside out has all its triangles), so the checker is
// asked.
#pragma once

#include <span>
#include <stop_token>

#include "mesh/mesh.hpp"
#include "pgdr/domain.hpp"
#include "pgdr/region_mode.hpp"
#include "space/pieces.hpp"

namespace pgdr {

/// Is any facet bent by more than rounding? Or by less, with a segment as short as that, or another facet there at an angle as
/// small? Any thread.
bool may_fold(const Domain<3>& domain, const detail::Pieces& pieces = detail::OneByOne());

/// Checks that the mesh is one of the domain, after carving and before the refinement, which keeps what is right so. Looks at
/// nothing unless may_fold(domain); else takes some 5 microseconds a cell. `region_attributes`: of each region number, empty
/// without labels. Any thread; nobody changes the mesh meanwhile.
/// @throws InputError boundary_not_recovered: the least segment that is in the mesh in part, its ends in `ids` and `points`; or,
///   if the checker finds the mesh not to be one of the domain, the facet that is off its plane by most, with its points;
///   CancelledError, some hundredths of a second after `stop` is requested
void require_unfolded(const Mesh<3>& mesh, const Domain<3>& domain, RegionMode regions, std::span<const double> region_attributes,
                      const detail::Pieces& pieces = detail::OneByOne(), const std::stop_token& stop = {});

}  // namespace pgdr
