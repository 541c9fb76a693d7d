// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The last stages: bounds of shape and size with their reasons, and the local Delaunay property.
#pragma once

#include <span>

#include "check/reasons.hpp"
#include "given/regions.hpp"

namespace pgdr::checking {

/// Every cell is within its bounds, or a reason holds. @param input null if there is none.
template <int D>
void check_bounds(const OutputMesh<D>& mesh, const CheckOptions<D>& options, const Links<D>& links, const Components& components,
                  const InputVolumes<D>* input, Reasons<D>& reasons, Findings& findings);

/// No vertex opposite an unconstrained face lies inside the circumsphere of the cell on its other side.
/// @param slack of each vertex: how far it may be off its entity by rounding.
/// @param refused of each vertex: it lies on an entity whose split was refused; may be empty.
/// @param left CheckOptions::not_delaunay_left
template <int D>
void check_delaunay(const OutputMesh<D>& mesh, const Links<D>& links, std::span<const double> slack,
                    std::span<const std::uint8_t> refused, std::uint64_t left, Findings& findings);

/// The largest absolute value of a coordinate.
template <int D>
double largest_coordinate(const OutputMesh<D>& mesh);

/// How far rounding may have moved each vertex off what it lies on: any vertex of a constraint that is not axis-aligned by so
/// many ulps of the largest coordinate of the mesh, also a point of the input, which may be one of a facet that is planar within
/// rounding.
template <int D>
std::vector<double> slack_of_vertices(const OutputMesh<D>& mesh, int ulps);

}  // namespace pgdr::checking
