// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The volume (area) of a simplex by its corners, in doubles, and how far that may be off. Pure functions, any thread.
#pragma once

#include <array>
#include <cmath>
#include <utility>

#include "numbers/rounding.hpp"
#include "pgdr/types.hpp"

namespace pgdr::detail {

/// The determinant of the corners less x, which has the sign that x has to them (orient3d, orient2d) and is 6 (2) times the
/// volume (area); and its error.
template <int D>
std::pair<double, double> signed_measure(const std::array<Point<D>, D>& s, const Point<D>& x) {
  std::array<Point<D>, D> a;
  for (int i = 0; i < D; ++i)
    for (int j = 0; j < D; ++j) a[i][j] = s[i][j] - x[j];
  if constexpr (D == 2) {
    const double l = a[0][0] * a[1][1], r = a[0][1] * a[1][0];
    return {l - r, rounding::of_determinant * (std::abs(l) + std::abs(r))};
  } else {
    double value = 0, size = 0;
    for (int j = 0; j < 3; ++j) {
      const int k = (j + 1) % 3, m = (j + 2) % 3;
      const double l = a[1][k] * a[2][m], r = a[1][m] * a[2][k];
      value -= a[0][j] * (l - r);
      size += std::abs(a[0][j]) * (std::abs(l) + std::abs(r));
    }
    return {value, rounding::of_determinant * size};
  }
}

}  // namespace pgdr::detail
