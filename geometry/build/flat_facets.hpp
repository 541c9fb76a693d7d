// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Continues the fourth step of a Domain (3D): a facet all of whose points lie on one line is dropped. If the edges of others
// cover it, it adds nothing to the union of all facets and segments; edges have no points inside by now, so that a walk from one
// end along the line sees it. If not, it adds a piece of that line, which bounds nothing: its edges, split at its own points, run
// through each place of the line as often there as back, so that no surface is open without them. CAD programs write such where
// a corner lies on an axis of revolution. It is told apart in the report.
#pragma once

#include <span>

#include "join/build_input.hpp"
#include "join/build_report.hpp"
#include "join/edge_uses.hpp"
#include "join/facet_triangulator.hpp"
#include "join/near_contacts.hpp"

namespace pgdr::detail {

/// Reports the flat facets, which no step has taken up. `near`: null unless edges go through points that are near to them.
void report_flat_facets(const BuildInput<3>& in, std::span<const FlatFacet> flat, const EdgeUses& uses, const NearContacts* near,
                        BuildReport<3>& report);

}  // namespace pgdr::detail
