// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Circumsphere, shortest edge and orientation of several simplices side by side: what an insertion asks of each cell that it
// would make. Bit for bit what circumsphere.hpp computes of each one, on any processor. Pure functions, any thread.
#pragma once

#include <cstddef>
#include <span>

#include "pgdr/types.hpp"

namespace pgdr {

inline constexpr std::size_t shape_lanes = 4;  ///< simplices side by side

/// Corners of `shape_lanes` simplices; every lane must hold a simplex or a copy of one, with distinct corners.
template <int D>
struct alignas(32) SimplexBlock {
  double corner[D + 1][D][shape_lanes];  ///< coordinates, by corner, axis and simplex

  /// Corner i of one simplex.
  void set(std::size_t lane, int i, const Point<D>& p) {
    for (int k = 0; k < D; ++k) corner[i][k][lane] = p[k];
  }
};

/// Where `center_error` is infinite the centre is not to be used: circumsphere() takes more trouble. `det` is that of
/// orient() up to `det_error`, which may be infinite. `power_error`, 6 center_error / radius, bounds what the error of the centre
/// does to |p - centre|^2 - radius^2 over radius^2 near the sphere.
template <int D>
struct alignas(32) ShapeBlock {
  double center[D][shape_lanes];              ///< of the circumsphere, by axis
  double squared_radius[shape_lanes];         ///< of the circumsphere
  double power_error[shape_lanes];            ///< 6 center_error / radius
  double center_error[shape_lanes];           ///< as Circumsphere has it
  double shortest_edge_squared[shape_lanes];  ///< length of the shortest edge
  double det[shape_lanes];                    ///< D! times the measure
  double det_error[shape_lanes];              ///< its error
};

/// @pre out.size() == in.size()
template <int D>
void simplex_shapes(std::span<const SimplexBlock<D>> in, std::span<ShapeBlock<D>> out);

}  // namespace pgdr
