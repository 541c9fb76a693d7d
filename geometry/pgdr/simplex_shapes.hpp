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

inline constexpr std::size_t shape_lanes = 4;

/// Corners of `shape_lanes` simplices; every lane must hold a simplex or a copy of one, with distinct corners.
template <int D>
struct alignas(32) SimplexBlock {
  double corner[D + 1][D][shape_lanes];

  void set(std::size_t lane, int i, const Point<D>& p) {
    for (int k = 0; k < D; ++k) corner[i][k][lane] = p[k];
  }
};

/// Where `center_error` is infinite the centre is not to be used: circumsphere() takes more trouble. `det` is that of
/// orient() up to `det_error`, which may be infinite; `radius` is the root of `squared_radius`.
template <int D>
struct alignas(32) ShapeBlock {
  double center[D][shape_lanes];
  double squared_radius[shape_lanes], radius[shape_lanes], center_error[shape_lanes];
  double shortest_edge_squared[shape_lanes];
  double det[shape_lanes], det_error[shape_lanes];
};

/// @pre out.size() == in.size()
template <int D>
void simplex_shapes(std::span<const SimplexBlock<D>> in, std::span<ShapeBlock<D>> out);

}  // namespace pgdr
