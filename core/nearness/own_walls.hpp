// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The surface that a mesh has, as an input: what it is to fill, and what its reasons name, where that is not the given surface.
#pragma once

#include <vector>

#include "given/match.hpp"
#include "given/named_entities.hpp"
#include "pgdr/poor_reason.hpp"

namespace pgdr::checking {

/// Its points, subsegments, and subfacets, each a facet by itself; seeds are those of the given input that are seeds there.
Plc<3> walls_as_input(const OutputMesh<3>& mesh, const GivenInput<3>& given);

/// How even subfacets are that are one facet, since no subsegment is between them: within so much of a plane, two by two; the
/// tolerance of the given input at least, and at most `most`.
double evenness(const OutputMesh<3>& mesh, double least, double most);

/// Each edge with one subfacet, with three or more, of two markers, or with two subfacets that are not within `even` of one
/// plane, is a subsegment.
void check_edges_of_walls(const OutputMesh<3>& mesh, double even, Findings& findings);

/// Subfacets are one facet if they hang together across edges that are no subsegments.
OwnFacets own_facets(const OutputMesh<3>& mesh);

/// Facets that are named by a place get the number of a subfacet there; those that are not are none.
std::vector<PoorReason> with_subfacets(const std::vector<PoorReason>& reasons, const OutputMesh<3>& mesh);

}  // namespace pgdr::checking
