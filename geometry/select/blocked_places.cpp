// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "select/blocked_places.hpp"

#include "numbers/finite.hpp"
#include "pgdr/circumsphere.hpp"
#include "pgdr/predicates.hpp"
#include "select/off_center.hpp"

namespace pgdr::detail {
namespace {

/// Is there a point of the triangle on the segment from p to x, with p off its plane? Exact.
bool is_between(const std::array<Point3, 3>& t, const Point3& p, const Point3& x) {
  const Sign side = orient3d(t[0], t[1], t[2], p);
  if (side == Sign::zero || orient3d(t[0], t[1], t[2], x) == side) return false;
  bool left = false, right = false;  // of the line from p to x there is an edge
  for (std::size_t i = 0; i < 3; ++i) {
    const Sign turn = orient3d(p, x, t[i], t[(i + 1) % 3]);
    left = left || turn == Sign::positive;
    right = right || turn == Sign::negative;
  }
  return !(left && right);
}

template <class Blocks>
unsigned sum_of(const std::array<Point3, 2>& places, const Blocks& blocks) {
  unsigned sum = 0;
  for (unsigned i = 0; i < 2; ++i)
    if (is_finite(places[i]) && blocks(places[i])) sum |= 1u << i;
  return sum;
}

}  // namespace

PlacesForCell::PlacesForCell(const Simplex<3>& cell, double radius_edge_bound) : from(centroid<3>(cell)) {
  const Point3 center = circumsphere<3>(cell).center;
  places = {center, off_center_before<3>(cell, center, radius_edge_bound).value_or(center)};
}

unsigned PlacesForCell::blocked_by_triangle(const std::array<Point3, 3>& corners) const {
  const Ball<3> ball = equatorial_ball(corners[0], corners[1], corners[2]);
  return sum_of(places, [&](const Point3& x) { return in_equatorial_ball(ball, x) || is_between(corners, from, x); });
}

unsigned PlacesForCell::blocked_by_segment(const std::array<Point3, 2>& ends) const {
  return sum_of(places, [&](const Point3& x) { return in_diametral_ball<3>(ends[0], ends[1], x); });
}

}  // namespace pgdr::detail
