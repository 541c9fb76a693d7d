// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "pgdr/selectors.hpp"

namespace pgdr::detail {

/// How far from the midpoint of the shortest edge, of this length, an off-centre lies if the circumcentre is no nearer: as
/// pgdr/selectors.hpp has it. `bound`: on radius over shortest edge.
inline double off_center_distance(double factor, double shortest_edge, double bound) {
  return factor * shortest_edge * (bound + std::sqrt(std::max(bound * bound - 0.25, 0.0)));
}

/// The off-centre of a cell with this circumcentre, by the default factor; none if the circumcentre is no farther from the
/// shortest edge. The same for every order of the corners.
template <int D>
std::optional<Point<D>> off_center_before(Simplex<D> s, const Point<D>& center, double bound) {
  std::sort(s.begin(), s.end(), lex_less<D>);
  std::array<int, 2> shortest{0, 1};
  for (int i = 0; i <= D; ++i)
    for (int j = i + 1; j <= D; ++j)
      if (squared_distance(s[i], s[j]) < squared_distance(s[shortest[0]], s[shortest[1]])) shortest = {i, j};
  const Point<D>&p = s[shortest[0]], &q = s[shortest[1]];
  Point<D> x{};
  for (int k = 0; k < D; ++k) x[k] = p[k] + (q[k] - p[k]) / 2;
  const double far = off_center_distance(default_off_center_factor<D>(), std::sqrt(squared_distance(p, q)), bound);
  const double to_center = std::sqrt(squared_distance(x, center));
  if (!(far < to_center)) return std::nullopt;
  for (int k = 0; k < D; ++k) x[k] += far / to_center * (center[k] - x[k]);
  return x;
}

}  // namespace pgdr::detail
