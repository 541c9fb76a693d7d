// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// How the surface of an input hangs together, before and after what lies within the tolerance was joined (which changes it on
// purpose). Near-linear. Pure functions, any thread.
#pragma once

#include <cstdint>
#include <optional>

#include "pgdr/domain.hpp"
#include "pgdr/export.hpp"
#include "pgdr/plc.hpp"

namespace pgdr PGDR_API {

/// Of the union of all facets.
struct SurfaceCounts {
  std::uint64_t components = 0;  ///< pieces that have no point in common
  std::uint64_t open_loops = 0;  ///< pieces of their boundary: edges of one facet each that hang together
  /// Tunnels through it: of a torus 1. None where an edge has more than two facets, or facets touch at a point alone, so that it
  /// is no surface; or where it has one side only.
  std::optional<std::uint64_t> handles;
  bool operator==(const SurfaceCounts&) const = default;  ///< all counts equal
};

/// Of the facets as given: points are one where their coordinates are equal.
SurfaceCounts surface_counts(const Plc<3>& plc);
/// Of the facets as they are meshed.
SurfaceCounts surface_counts(const Domain<3>& domain);

}  // namespace pgdr
