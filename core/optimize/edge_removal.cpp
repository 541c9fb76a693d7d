// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "optimize/edge_removal.hpp"

#include <algorithm>
#include <cassert>

#include "pgdr/predicates.hpp"

namespace pgdr {

// The part of the polygon between vertices i and j, and the chord between them, is filled at best by the best triangle (i, k, j)
// on the chord with the best of the two parts beside it. So each triangle is looked at once, as one on its longest chord.
double EdgeRemoval::find(std::span<const Point3> ring, const Point3& a, const Point3& b, int region, const CellQuality& quality,
                         double enough) {
  const std::size_t n = ring.size();
  assert(n >= 3 && n <= longest_ring);
  triangles_.clear();
  // The quality of the cell, if it is above `bar` and the cell is positive; else a number that is at most `bar`.
  const auto measure = [&](const Point3& p, const Point3& q, const Point3& r, const Point3& top, double bar) {
    const Simplex<3> cell{{p, q, r, top}};
    const double of_cell = quality.of(cell, region, bar);
    return of_cell > bar && orient<3>(cell) != Sign::positive ? bar : of_cell;
  };
  for (std::size_t i = 0; i + 1 < n; ++i) best_[i][i + 1] = 1;
  for (std::size_t length = 2; length < n; ++length)
    for (std::size_t i = 0; i + length < n; ++i) {
      const std::size_t j = i + length;
      double best = enough;
      for (std::size_t k = i + 1; k < j && best < 1; ++k) {
        const double parts = std::min(best_[i][k], best_[k][j]);
        if (!(parts > best)) continue;
        const double above = measure(ring[i], ring[k], ring[j], b, best);
        if (!(above > best)) continue;
        const double below = measure(ring[j], ring[k], ring[i], a, best);
        if (!(below > best)) continue;
        best = std::min({parts, above, below});
        apex_[i][j] = static_cast<std::uint8_t>(k);
      }
      best_[i][j] = best;
    }
  const double found = best_[0][n - 1];
  if (found > enough) list(0, n - 1);
  return found;
}

void EdgeRemoval::list(std::size_t i, std::size_t j) {
  if (j - i < 2) return;
  const std::size_t k = apex_[i][j];
  triangles_.push_back({static_cast<std::uint8_t>(i), static_cast<std::uint8_t>(k), static_cast<std::uint8_t>(j)});
  list(i, k);
  list(k, j);
}

}  // namespace pgdr
