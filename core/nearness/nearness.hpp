// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The certificate of another surface: is what the mesh has for a surface within a distance of the given one, both ways, and does
// it hang together and enclose volumes as that does? docs/surface.md says what of it is proved. It knows the mesh and the input
// as given, and nothing of how a surface is made.
#pragma once

#include <cstdint>
#include <span>

#include "given/match.hpp"
#include "given/regions.hpp"
#include "nearness/given_surface.hpp"

namespace pgdr::checking {

struct NearTask {
  const OutputMesh<3>& mesh;
  const GivenInput<3>& input;
  const GivenSurface& given;
  double distance;       ///< E
  double feature_angle;  ///< degrees
  Findings& findings;
  const std::vector<std::uint8_t>* required = nullptr;  ///< GivenTask::required
  /// How far the mesh may be from what was given: E, and rounding.
  double limit() const { return distance + input.rounding(); }
};

/// Subfacets and given facets, both ways, marker by marker.
void check_near_facets(const NearTask& task);

/// Segments, borders of markers and of the surface, edges of three or more facets, both ways and kind by kind; creases one way.
void check_near_curves(const NearTask& task);

/// Components, open loops, handles, and Euler's characteristic.
void check_same_topology(const NearTask& task);

/// Points of the input that are to be vertices.
/// @param sorted the vertices by their coordinates
void check_explicit_points(const NearTask& task, std::span<const std::uint32_t> sorted);

/// Which given volume is in each of those of the mesh, whether it is to be meshed, seeds, and what both measure.
/// @param volumes those of the mesh's own walls, to which its components were compared
void check_near_volumes(const NearTask& task, const InputVolumes<3>& volumes, const Components& components);

}  // namespace pgdr::checking
