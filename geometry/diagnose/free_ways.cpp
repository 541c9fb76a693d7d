// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "diagnose/free_ways.hpp"

#include <algorithm>
#include <array>

#include "numbers/vectors.hpp"

namespace pgdr::detail {
namespace {

/// Of the determinants of differences, in doubles: a wrong one costs a place of an estimate.
Sign side(const Point2& a, const Point2& b, const Point2& c) {
  const auto u = difference(b, a), v = difference(c, a);
  return sign_of(u[0] * v[1] - u[1] * v[0]);
}
Sign side(const Point3& a, const Point3& b, const Point3& c, const Point3& d) {
  return sign_of(dot(cross(difference(b, a), difference(c, a)), difference(d, a)));
}

}  // namespace

template <int D>
bool FreeWays<D>::is_free(const Point<D>& a, const Point<D>& b) const {
  auto way = Box<D>::around(a);
  way.add(b);
  bool free = true;
  field_.tree().meeting(way, [&](std::uint32_t i) {
    const auto& piece = field_.pieces().pieces()[i];
    if (free && piece.count == D) free = !crosses(a, b, piece);
  });
  return free;
}

template <int D>
bool FreeWays<D>::crosses(const Point<D>& a, const Point<D>& b, const typename NearPieces<D>::Piece& piece) const {
  const auto p = field_.pieces().points();
  const Point<D>&q = p[piece.corners[0]], &r = p[piece.corners[1]];
  if constexpr (D == 2) {
    return side(q, r, a) != side(q, r, b) && side(a, b, q) != side(a, b, r);
  } else {
    const Point3& t = p[piece.corners[2]];
    if (side(q, r, t, a) == side(q, r, t, b)) return false;
    const std::array<Sign, 3> sides{side(a, b, q, r), side(a, b, r, t), side(a, b, t, q)};
    const auto has = [&](Sign s) { return std::ranges::find(sides, s) != sides.end(); };
    return !(has(Sign::positive) && has(Sign::negative));
  }
}

template <int D>
bool FreeWays<D>::is_inside(const Point<D>& x) const {
  for (int axis = 0; axis < D; ++axis) {
    Point<D> low = x, high = x;
    const double beyond = all_.high[axis] - all_.low[axis];
    low[axis] = all_.low[axis] - beyond;
    high[axis] = all_.high[axis] + beyond;
    if (is_free(x, low) || is_free(x, high)) return false;
  }
  return true;
}

template <int D>
double FreeWays<D>::part_inside(const Box<D>& box) const {
  constexpr int places = 1 << D;
  int inside = 0;
  for (int k = 0; k < places; ++k) {
    Point<D> x;
    for (int i = 0; i < D; ++i) x[i] = box.low[i] + ((k >> i & 1) != 0 ? 0.75 : 0.25) * (box.high[i] - box.low[i]);
    inside += is_inside(x) ? 1 : 0;
  }
  return static_cast<double>(inside) / places;
}

template class FreeWays<2>;
template class FreeWays<3>;

}  // namespace pgdr::detail
