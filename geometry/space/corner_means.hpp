// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Midpoints of edges, centroids of faces, the centroid.
#pragma once

#include <algorithm>
#include <bit>
#include <vector>

#include "pgdr/types.hpp"

namespace pgdr::detail {

/// The mean of the corners whose bits are set.
template <int D>
Point<D> mean_of_corners(const Simplex<D>& s, unsigned corners) {
  Point<D> x{};
  for (int i = 0; i <= D; ++i)
    for (int k = 0; k < D; ++k) x[k] += corners >> i & 1 ? s[i][k] / std::popcount(corners) : 0;
  return x;
}

}  // namespace pgdr::detail
