// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The loops in which a surface ends.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "pgdr/domain.hpp"
#include "space/bulk.hpp"
#include "space/stop_check.hpp"

namespace pgdr::detail {

/// An edge that one triangle of the Domain alone has.
struct OpenEdge {
  std::array<std::uint32_t, 2> ends;  ///< in the direction in which its facet of the input runs along it
  std::uint32_t apex;                 ///< the third corner of its triangle
  std::uint32_t facet;                ///< index in Plc::facets
};

/// A closed chain of open edges through distinct points: a block of the graph of open edges.
struct OpenLoop {
  /// Points of the Domain, from the least one on (by coordinates); against the direction of the facets along it if these all have
  /// one, so that a facet which goes round it like that goes on in theirs. Else to the lesser neighbour first.
  std::vector<std::uint32_t> points;
  std::vector<OpenEdge> edges;  ///< of point k and the next
  bool is_oriented = true;      ///< facets run along it in one direction
};

/// All of them, ordered by the coordinates of their points.
std::vector<OpenLoop> open_loops(const Domain<3>& domain, const Bulk& bulk, const StopCheck& stop);

}  // namespace pgdr::detail
