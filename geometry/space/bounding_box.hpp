// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The box, parallel to the axes, around points. Any thread.
#pragma once

#include <algorithm>
#include <span>

#include "pgdr/types.hpp"

namespace pgdr {

/// Closed; the smallest and the largest coordinate of each axis.
template <int D>
struct BoundingBox {
  Point<D> low;   ///< smallest coordinates
  Point<D> high;  ///< largest coordinates

  /// Length of the longest side, rounded.
  double longest_side() const {
    double side = 0;
    for (int i = 0; i < D; ++i) side = std::max(side, high[i] - low[i]);
    return side;
  }
};

/// Of no points: that of the origin. @pre coordinates are finite
template <int D>
BoundingBox<D> bounding_box(std::span<const Point<D>> points) {
  if (points.empty()) return {};
  BoundingBox<D> box{points[0], points[0]};
  for (const Point<D>& p : points)
    for (int i = 0; i < D; ++i) {
      box.low[i] = std::min(box.low[i], p[i]);
      box.high[i] = std::max(box.high[i], p[i]);
    }
  return box;
}

}  // namespace pgdr
