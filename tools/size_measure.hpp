// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Bounds on the sizes of cells as what an estimate asks for.
#pragma once

#include <algorithm>
#include <functional>
#include <limits>

#include "pgdr/sizing.hpp"
#include "pgdr/types.hpp"

namespace pgdr::tool {

/// Of the largest tetrahedron, a regular one, in a sphere of radius 1: 8 sqrt 3 / 27.
inline constexpr double largest_in_sphere = 0.5132002392796674;

/// The largest volume (area) of a cell within a bound on its circumradius (2D: on its area).
template <int D>
double measure_of_size(double size) {
  if (!(size > 0)) return std::numeric_limits<double>::infinity();  // the run will say that it cannot be used
  return D == 3 ? largest_in_sphere * size * size * size : size;
}

/// EstimateOptions::measure of these sizes, which it has copies of; empty where they bound nothing.
template <int D>
std::function<double(const Point<D>&, double)> measure_of_sizes(const SizingField<D>& size, const RegionSizes<D>& region_sizes,
                                                                double max_volume) {
  if (!size.bounded() && region_sizes.empty() && max_volume == std::numeric_limits<double>::infinity()) return {};
  return [=](const Point<D>& x, double label) {
    double measure = std::min(measure_of_size<D>(size.at(x)), max_volume);
    for (const RegionSize<D>& region : region_sizes)
      if (region.label == label) measure = std::min(measure, measure_of_size<D>(region.size.at(x)));
    return measure;
  };
}

}  // namespace pgdr::tool
