// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Boxes parallel to the axes. Values, any thread.
#pragma once

#include <algorithm>
#include <limits>
#include <span>

#include "pgdr/types.hpp"

namespace pgdr::detail {

/// A closed box. `low` above `high`: empty, meets nothing.
template <int D>
struct Box {
  Point<D> low;   ///< smallest coordinates
  Point<D> high;  ///< largest coordinates

  static Box empty() {
    Box b;
    b.low.x.fill(std::numeric_limits<double>::infinity());
    b.high.x.fill(-std::numeric_limits<double>::infinity());
    return b;
  }
  static Box around(const Point<D>& p) { return {p, p}; }
  /// The box around points; that of the origin if there are none. @pre coordinates are finite
  static Box of(std::span<const Point<D>> points) {
    if (points.empty()) return {};
    Box b = around(points[0]);
    for (const Point<D>& p : points) b.add(p);
    return b;
  }

  void add(const Point<D>& p) {
    for (int i = 0; i < D; ++i) {
      low[i] = std::min(low[i], p[i]);
      high[i] = std::max(high[i], p[i]);
    }
  }
  void add(const Box& b) {
    for (int i = 0; i < D; ++i) {
      low[i] = std::min(low[i], b.low[i]);
      high[i] = std::max(high[i], b.high[i]);
    }
  }
  /// Larger by `width` on all sides.
  Box widened(double width) const {
    Box b = *this;
    for (int i = 0; i < D; ++i) {
      b.low[i] -= width;
      b.high[i] += width;
    }
    return b;
  }

  bool meets(const Box& o) const {
    for (int i = 0; i < D; ++i)
      if (!(low[i] <= o.high[i] && o.low[i] <= high[i])) return false;
    return true;
  }
  /// Length of the longest side, rounded.
  double longest_side() const {
    double side = 0;
    for (int i = 0; i < D; ++i) side = std::max(side, high[i] - low[i]);
    return side;
  }
  /// At most squared_distance(p, q) for any q in the box, also as rounded: each step is monotonous.
  double squared_distance_to(const Point<D>& p) const {
    double s = 0;
    for (int i = 0; i < D; ++i) {
      const double d = p[i] < low[i] ? low[i] - p[i] : p[i] > high[i] ? p[i] - high[i] : 0;
      s += d * d;
    }
    return s;
  }
};

}  // namespace pgdr::detail
