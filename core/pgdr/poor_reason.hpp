// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Why a cell is over a bound: what a refinement gives, and the checker verifies. A plain value.
#pragma once

#include <array>
#include <cstdint>

#include "pgdr/export.hpp"
#include "pgdr/types.hpp"

namespace pgdr PGDR_API {

/// What a reason names: a segment or a facet of the input as given.
struct GivenEntity {
  EntityKind kind = EntityKind::volume;  ///< segment or facet; volume: nothing is named
  std::uint32_t facet = no_entity;       ///< of a facet: its index in Plc::facets; of several that are one facet any of these
  /// Of a segment: its ends, where the mesh has them, in 2D with 0 behind; of a facet without number: a place (facet_places.hpp).
  std::array<std::array<double, 3>, 2> ends{};
  friend bool operator==(const GivenEntity&, const GivenEntity&) = default;  ///< the same name
};

/// Why a cell stayed over a bound; one entry of the report's `bounds.reasons`.
struct PoorReason {
  /// small_angle: of the input, between the two entities. rounding: an edge is as short as the rounding
  /// of coordinates. beyond_theory: the bound
  /// asked for is below the smallest proved one. kept_boundary: the first entity is a segment (2D) or a facet without points of
  /// its own, which hides the circumcentre or is encroached upon by it, or is near it (RefineOptions::keep_boundary).
  /// input_dihedral: an edge of the cell is on a segment at which the input, in the cell's region, has a wedge below the target
  /// of dihedral angles; the first entity is the segment. not_found, budget: no excuse, but what is known of it: nothing
  /// better was found, nor a reason in the input, or the optimiser's budget was spent.
  enum class Code { small_angle, rounding, beyond_theory, kept_boundary, input_dihedral, not_found, budget };
  std::uint32_t cell = 0;               ///< index into OutputMesh::cells
  Code code = Code::small_angle;        ///< what kind of reason
  std::array<GivenEntity, 2> entities;  ///< that meet at the angle
  double angle = 0;                     ///< degrees
};

}  // namespace pgdr
