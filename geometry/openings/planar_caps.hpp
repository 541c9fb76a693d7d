// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Which openings lie in a plane, and what closes them (pgdr/openings.hpp has the rule).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "openings/open_loops.hpp"
#include "pgdr/domain.hpp"
#include "space/stop_check.hpp"

namespace pgdr::detail {

/// What closes an opening.
struct PlanarCap {
  std::vector<std::uint32_t> loops;  ///< the one around it, then those that are holes of it, ascending
  bool turned = false;               ///< it runs against the first of these
  std::vector<Point3> seeds;         ///< a point in each hole
  double area = 0;                   ///< rounded
};

/// All of them, by their first loops, ascending.
std::vector<PlanarCap> planar_caps(const Domain<3>& domain, std::span<const OpenLoop> loops, const StopCheck& stop);

}  // namespace pgdr::detail
