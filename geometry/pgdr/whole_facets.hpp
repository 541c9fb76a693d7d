// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// An input by as few points as its planes and lines need: of what a mesh has on its boundary, the facets and segments that it was
// made of. A plain function from Plc to Plc: call it, then `refine`.
#pragma once

#include <cstdint>
#include <span>
#include <stop_token>
#include <vector>

#include "pgdr/export.hpp"
#include "pgdr/plc.hpp"

namespace pgdr PGDR_API {

/// The input, and what its facets are in the given one.
template <int D>
struct WholeFacets {
  Plc<D> plc;                                 ///< seeds, names and the tolerance as given
  std::vector<std::uint32_t> point_of_input;  ///< of each given point, its number here; no_entity: it is gone
  std::vector<std::uint32_t> facet_of_input;  ///< 3D: of each facet here, a given one that is part of it
};

/// The same union of points, up to the tolerance T (tolerance_of), with whole facets and segments. Facets that are one facet of a
/// Domain (domain.hpp: in one plane, within T, with equal markers and a common edge that only they have) are one polygon with
/// holes. A segment without a marker at an edge of facets is given anyway, and so is one itself only where it runs inside of a
/// plane. Edges that lie one behind the other within T of one line are one, where they have the same marker and bound the same
/// facets; fine arcs, whose points are within T of their neighbours' line each but not all together, lose what is exactly
/// straight. Points that are then of nothing are left out.
///
/// Facets here are within T of a plane that all given points of theirs are within T of, and so within 2 T of the given ones;
/// lines within T of theirs. A facet whose outline comes too near to itself for a polygon stays as it is given, triangle by
/// triangle. What the Domain repairs is repaired. Linear time but for sorting; twice that of a Domain.
/// @param plc  the input; as a Domain takes it
/// @param required  of each point: it stays, as a point of what it is in; empty: none has to
/// @param stop  ends it, from any thread, by a CancelledError
/// @throws UsageError bad_option: not one a point; what Domain throws
template <int D>
WholeFacets<D> with_whole_facets(const Plc<D>& plc, std::span<const std::uint8_t> required = {}, std::stop_token stop = {});

}  // namespace pgdr
