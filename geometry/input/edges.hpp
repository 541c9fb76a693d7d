// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Edges between points of an input.
#pragma once

#include <algorithm>
#include <cstdint>
#include <utility>

#include "space/planar_cdt.hpp"

namespace pgdr::detail {

/// An edge as one number, whichever end is a: the smaller index is in the upper half.
inline std::uint64_t edge_key(std::uint32_t a, std::uint32_t b) {
  return static_cast<std::uint64_t>(std::min(a, b)) << 32 | std::max(a, b);
}
/// The ends of the edge with this key, the smaller index first.
inline PlanarEdge edge_of(std::uint64_t key) { return {static_cast<std::uint32_t>(key >> 32), static_cast<std::uint32_t>(key)}; }

/// An edge of an input facet or segment.
struct OwnedEdge {
  PlanarEdge edge;
  std::uint32_t owner;
};

/// The key of an edge, or the number of a triangle, and a point inside it.
using PointOn = std::pair<std::uint64_t, std::uint32_t>;

}  // namespace pgdr::detail
