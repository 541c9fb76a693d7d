// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "arrange/grid.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "space/point_places.hpp"

namespace pgdr::detail {

Grid::Grid(const Plc<3>& plc) : width_(0x1p-22 / scale_of<3>(plc.points).first) {}

// A power of two: division and product are exact.
Point3 Grid::nearest(const Point3& p) const {
  Point3 out;
  for (int i = 0; i < 3; ++i) out[i] = std::round(p[i] / width_) * width_ + 0.0;
  return out;
}

bool Grid::snap(Plc<3>& plc, std::span<const Point3> places) {
  std::vector<Point3> snapped;
  for (const Point3& p : places) snapped.push_back(nearest(p));
  std::ranges::sort(snapped, lex_less<3>);
  bool any = false;
  for (Point3& p : plc.points) {
    const Point3 q = nearest(p);
    if (p == q || !std::ranges::binary_search(snapped, q, lex_less<3>)) continue;
    farthest_ = std::max(farthest_, std::sqrt(squared_distance(p, q)));
    p = q;
    any = true;
  }
  return any;
}

}  // namespace pgdr::detail
