// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Islands: parts of an input between which nothing is meshed. Walls are of one island if they hang together, touch, or bound one
// volume that is meshed; what lies in such a volume is of its island. So nothing that is meshed sees anything of another island,
// and each can be triangulated, and its boundary be recovered, without the points of the others: parts of an assembly that are a
// hair apart, whose gap nobody wants to be meshed. (In one triangulation the segments on both sides of the gap have to be split
// as finely as the gap is wide.)
#pragma once

#include <cstdint>
#include <vector>

#include "pgdr/domain.hpp"
#include "space/bulk.hpp"
#include "space/stop_check.hpp"

namespace pgdr::detail {

struct Islands {
  std::uint32_t count = 1;
  std::vector<std::uint32_t> of_point;  ///< of each domain point; empty if there is but one
  /// Islands with walls at the volume that the seed is in; none: it is outside of all. One of them encloses it.
  std::vector<std::vector<std::uint32_t>> of_hole, of_region;
};

/// Exact; where it cannot be decided what is meshed, as where walls of one island cross, what is there is of one. What bounds
/// nothing that is meshed, and points in no such volume, are of the first island. In 2D, where a boundary needs no points, there
/// is one. Near-linear; one ray for each surface and seed. @throws CancelledError
template <int D>
Islands islands_of(const Domain<D>& domain, bool voids_by_nesting, const Bulk& bulk, const StopCheck& stop_check);

}  // namespace pgdr::detail
