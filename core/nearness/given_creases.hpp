// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Where the given surface has creases: edges at which its shape turns, and not the noise of needles.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "nearness/given_surface.hpp"
#include "nearness/surface_edges.hpp"

namespace pgdr::checking {

using CreaseEdge = std::array<std::uint32_t, 2>;

/// Edges of two triangles of one marker, whose normals differ by more than the angle, both higher above it than a fourth of the
/// distance; and so do the normals of the first triangles on either side that are as high above all of their edges, reached
/// across longest edges. Of edges that hang together in a box no longer than 30 times the distance only those that hang on `kept`
/// ones. Which way normals differ is decided with about 100 bits: an edge for which that is not enough is none.
/// @param edges of the triangles that are to be meshed. @param kept_points sorted: points of edges that are kept anyhow
std::vector<CreaseEdge> given_creases(const GivenSurface& surface, const SurfaceEdges& edges,
                                      const std::vector<std::uint32_t>& kept_points, double distance, double degrees);

}  // namespace pgdr::checking
