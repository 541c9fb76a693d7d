// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// How reasons name the facets of another surface than the given one. A pure function, any thread.
#pragma once

#include <vector>

#include "pgdr/export.hpp"
#include "pgdr/plc.hpp"
#include "pgdr/poor_reason.hpp"

namespace pgdr PGDR_API {

/// Facets of another surface have no numbers that an input knows: each is named by a place on it instead, the centre of its
/// largest triangle (GivenEntity), by which `check` with a surface tolerance finds it.
/// @param plc  that surface, as it was meshed: 3D
/// @param reasons  of its mesh: facets by their numbers, which become places
void name_facets_by_places(const Plc<3>& plc, std::vector<PoorReason>& reasons);

}  // namespace pgdr
