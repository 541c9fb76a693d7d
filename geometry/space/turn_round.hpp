// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The order in which what meets at an edge (in 2D: a point) follows each other round it. Pure functions, any thread.
#pragma once

#include <algorithm>
#include <span>

#include "pgdr/types.hpp"

namespace pgdr::detail {

/// Sorts the walls behind the first one counter-clockwise, from that one on. turn(v, w): the orientation of the edge with the
/// apices v and w. Angles from the first wall on are (0, 180), 180, (180, 360) degrees; inside the first and the last by
/// orientation.
template <class Wall, class Turn>
void sort_round(std::span<Wall> walls, const Turn& turn) {
  if (walls.size() <= 2) return;
  const auto part = [&, first = walls[0].apex](const Wall& w) {
    const Sign s = turn(first, w.apex);
    return s == Sign::positive ? 1 : s == Sign::zero ? 2 : 3;
  };
  std::sort(walls.begin() + 1, walls.end(), [&](const Wall& x, const Wall& y) {
    const int px = part(x), py = part(y);
    return px != py ? px < py : px != 2 && turn(x.apex, y.apex) == Sign::positive;
  });
}

}  // namespace pgdr::detail
