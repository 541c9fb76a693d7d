// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>

#include "given/findings.hpp"
#include "given/links.hpp"
#include "pgdr/check.hpp"

namespace pgdr::checking {

/// Counts the faces of the first `own` cells that are not locally Delaunay. The others of the mesh are there as their neighbours.
/// @param slack  of each point, as slack_of_vertices() has it
/// @param everywhere  false: beside points with slack alone. A mesh in which the refinement saw no violations has such faces
///   nowhere else, as rounding has moved points off their entities there.
template <int D>
NotDelaunay count_among(const OutputMesh<D>& mesh, std::span<const double> slack, bool everywhere, std::size_t own);

/// CheckOptions::conforming_delaunay, but for faces that are no subsegments, of which check_delaunay() tells.
/// @param slack  of each vertex, as slack_of_vertices() has it
void check_conforming(const OutputMesh<2>& mesh, const Links<2>& links, std::span<const double> slack, Findings& findings);

}  // namespace pgdr::checking
