// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>

namespace pgdr::detail {

/// How far from the midpoint of the shortest edge, of this length, an off-centre lies if the circumcentre is no nearer: as
/// pgdr/selectors.hpp has it. `bound`: on radius over shortest edge.
inline double off_center_distance(double factor, double shortest_edge, double bound) {
  return factor * shortest_edge * (bound + std::sqrt(std::max(bound * bound - 0.25, 0.0)));
}

}  // namespace pgdr::detail
