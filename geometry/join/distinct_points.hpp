// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The first step of a Domain: numbers that are finite, indices that exist, and the distinct points. Exact duplicates are one
// point, and so are the groups of points within the tolerance (point_groups.hpp).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "join/build_report.hpp"
#include "pgdr/plc.hpp"
#include "space/stop_check.hpp"

namespace pgdr::detail {

/// The members of a Domain that speak of points and of seeds; -0 is 0.
template <int D>
struct DistinctPoints {
  std::vector<Point<D>> points;
  std::vector<std::uint32_t> point_of_input, input_of_point;
  std::vector<int> markers;
  std::vector<double> attributes;
  std::vector<Point<D>> holes;
  std::vector<RegionSeed<D>> regions;
  double largest_move = 0;  ///< of a point to its group's place
};

/// @throws InputError not_finite
template <int D>
void check_finite(const Plc<D>& plc, const BuildReport<D>& report);
/// @throws InputError index_out_of_range; ResourceError if there are too many points for ids
template <int D>
void check_indices(const Plc<D>& plc, const BuildReport<D>& report);
/// @throws UsageError bad_option; InputError ambiguous for a tolerance that was given
template <int D>
DistinctPoints<D> merge_points(const Plc<D>& plc, double tolerance, const StopCheck& stop, BuildReport<D>& report);
/// Exact. @throws InputError no_volume unless some D + 1 points span the space
template <int D>
void check_spans_space(std::span<const Point<D>> points, const BuildReport<D>& report);

}  // namespace pgdr::detail
