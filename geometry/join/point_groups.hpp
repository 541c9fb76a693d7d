// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Points that the tolerance makes one: the connected components of "within T", on the coordinates as given, so that neither the
// order of the points nor what is joined already decides. A group that is wider than 2 T is ambiguous.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "pgdr/types.hpp"
#include "space/stop_check.hpp"

namespace pgdr::detail {

/// A group of points that are farther apart than twice the tolerance, and which two are.
struct AmbiguousGroup {
  std::uint32_t first, second;  ///< two of its points
  double distance;              ///< between them
  std::size_t size;             ///< points in the group
};

struct PointGroups {
  std::vector<std::uint32_t> group_of;    ///< of each point the smallest number in its group, which may be its own
  std::vector<std::uint32_t> place_of;    ///< by that number: the point at whose place the group is, lexicographically the least
  std::vector<AmbiguousGroup> ambiguous;  ///< whose points are left apart
};

/// Groups distinct points, whose coordinates are of the size of 1. Near-linear. @param tolerance  > 0
template <int D>
PointGroups group_points(std::span<const Point<D>> points, double tolerance, const StopCheck& stop);

}  // namespace pgdr::detail
