// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "volumes/first_hits.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "numbers/exact_tests.hpp"
#include "numbers/rounding.hpp"
#include "numbers/signed_measure.hpp"
#include "numbers/vectors.hpp"
#include "pgdr/predicates.hpp"
#include "space/chance.hpp"

namespace pgdr::detail {
namespace {

template <int D>
std::vector<Box<D>> boxes_of(std::span<const Point<D>> points, std::span<const Wall<D>> walls, const Bulk& bulk) {
  std::vector<Box<D>> boxes(walls.size());
  bulk.each(walls.size(), [&](std::size_t i) {
    boxes[i] = Box<D>::empty();
    for (const std::uint32_t v : walls[i]) boxes[i].add(points[v]);
  });
  return boxes;
}

}  // namespace

template <int D>
FirstHits<D>::FirstHits(std::span<const Point<D>> points, std::vector<Wall<D>> walls, const Bulk& bulk)
    : points_(points),
      walls_(std::move(walls)),
      boxes_(boxes_of<D>(points_, walls_, bulk)),
      tree_(boxes_, bulk),
      reach_(4 * Box<D>::of(points_).longest_side()) {}

template <int D>
std::array<Point<D>, D> FirstHits<D>::corners(std::uint32_t wall) const {
  std::array<Point<D>, D> s;
  for (std::size_t k = 0; k < D; ++k) s[k] = points_[walls_[wall][k]];
  return s;
}

template <int D>
Sign FirstHits<D>::side(std::uint32_t wall, const Point<D>& x) const {
  const auto s = corners(wall);
  if constexpr (D == 2)
    return orient2d(s[0], s[1], x);
  else
    return orient3d(s[0], s[1], s[2], x);
}

template <int D>
auto FirstHits<D>::ray(const Point<D>& from, int attempt) const -> Ray {
  Chance chance;
  Vector<D> way{};
  for (int k = 0; k <= attempt + 1; ++k)  // the first numbers are next to nothing
    for (double& w : way) w = 2 * chance() - 1;
  double longest = 0;
  for (const double w : way) longest = std::max(longest, std::fabs(w));
  Ray ray{from, from};
  for (int i = 0; i < D; ++i) ray.to[i] += reach_ * way[static_cast<std::size_t>(i)] / longest;
  return ray;
}

/// Of a ray in the plane (2D: line) of a wall: does a line (point) of it separate the two? An edge of one of two convex figures
/// is along one that does, if there is any.
template <int D>
bool FirstHits<D>::is_apart_in_plane(const Ray& ray, std::uint32_t wall) const {
  const auto s = corners(wall);
  if constexpr (D == 2) {
    for (int i = 0; i < D; ++i) {
      const double low = std::min(ray.from[i], ray.to[i]), high = std::max(ray.from[i], ray.to[i]);
      if (high < std::min(s[0][i], s[1][i]) || low > std::max(s[0][i], s[1][i])) return true;
    }
    return false;
  } else {
    const auto n = cross(difference(s[1], s[0]), difference(s[2], s[0]));
    int axis = 0;
    for (int i = 1; i < D; ++i)
      if (std::fabs(n[static_cast<std::size_t>(i)]) > std::fabs(n[static_cast<std::size_t>(axis)])) axis = i;
    const Sign inside = orient_projected(s[0], s[1], s[2], axis);
    if (inside == Sign::zero) return false;
    bool all_positive = true, all_negative = true;
    for (std::size_t i = 0; i < 3; ++i) {
      const Point<D>&a = s[i], &b = s[(i + 1) % 3];
      if (orient_projected(a, b, ray.from, axis) == -inside && orient_projected(a, b, ray.to, axis) == -inside) return true;
      const Sign side = orient_projected(ray.from, ray.to, a, axis);
      all_positive = all_positive && side == Sign::positive;
      all_negative = all_negative && side == Sign::negative;
    }
    return all_positive || all_negative;
  }
}

// Seen along the ray, a wall surrounds it if its rims turn round it the same way.
template <int D>
auto FirstHits<D>::meet(const Ray& ray, std::uint32_t wall) const -> Kind {
  const Sign before = side(wall, ray.from), behind = side(wall, ray.to);
  if (before == behind && (before != Sign::zero || is_apart_in_plane(ray, wall))) return Kind::none;
  const auto s = corners(wall);
  bool positive = false, negative = false, zero = behind == Sign::zero;
  for (std::size_t i = 0; i < D; ++i) {
    Sign turn;
    if constexpr (D == 2)
      turn = i == 0 ? orient2d(ray.from, ray.to, s[0]) : -orient2d(ray.from, ray.to, s[1]);
    else
      turn = orient3d(ray.from, ray.to, s[i], s[(i + 1) % 3]);
    positive |= turn == Sign::positive;
    negative |= turn == Sign::negative;
    zero |= turn == Sign::zero;
  }
  if (positive && negative) return Kind::none;
  if (before == Sign::zero) return zero && behind == Sign::zero ? Kind::degenerate : Kind::on_wall;
  return zero ? Kind::degenerate : Kind::hit;
}

/// Where the ray is inside of a box, and some roundings around it.
template <int D>
auto FirstHits<D>::inside(const Ray& ray, const Box<D>& box) -> Interval {
  Interval in{0, 1};
  for (int i = 0; i < D; ++i) {
    const double way = ray.to[i] - ray.from[i];
    if (way == 0 && !(box.low[i] <= ray.from[i] && ray.from[i] <= box.high[i])) return {1, 0};
    if (way == 0) continue;
    const double a = (box.low[i] - ray.from[i]) / way, b = (box.high[i] - ray.from[i]) / way;
    in.low = std::max(in.low, std::min(a, b) - rounding::of_pruning);
    in.high = std::min(in.high, std::max(a, b) + rounding::of_pruning);
  }
  return in;
}

/// Where the ray crosses the wall.
template <int D>
auto FirstHits<D>::place(const Ray& ray, std::uint32_t wall) const -> Interval {
  const auto s = corners(wall);
  const auto [before, of_before] = signed_measure<D>(s, ray.from);
  const auto [behind, of_behind] = signed_measure<D>(s, ray.to);
  const double whole = before - behind, error = 4 * (of_before + of_behind) / std::fabs(whole);
  const Interval in = inside(ray, boxes_[wall]);
  if (!(error < 1)) return in;
  return {std::max(in.low, before / whole - error), std::min(in.high, before / whole + error)};
}

/// Of two walls that the ray crosses; none if it crosses both at once.
template <int D>
std::optional<bool> FirstHits<D>::comes_first(const Ray& ray, std::uint32_t a, std::uint32_t b) const {
  const Interval of_a = place(ray, a), of_b = place(ray, b);
  if (of_a.high < of_b.low) return true;
  if (of_b.high < of_a.low) return false;
  const auto order = checking::order_along<D>(ray.from, ray.to, {corners(a), corners(b)});
  if (order.empty()) return std::nullopt;
  return order[0] == 0;
}

template <int D>
auto FirstHits<D>::first(const Ray& ray, std::uint32_t after) const -> Hit {
  Hit found;
  const double least = after == no_entity ? 0 : inside(ray, boxes_[after]).low;
  double limit = 1;
  tree_.nearest(
      [&](const Box<D>& box, std::uint32_t) {
        const Interval in = inside(ray, box);
        return in.low <= in.high && in.high >= least ? in.low : std::numeric_limits<double>::infinity();
      },
      [&](std::uint32_t i) {
        if (found.kind == Kind::on_wall || found.kind == Kind::degenerate || i == after) return limit;
        const Interval in = inside(ray, boxes_[i]);
        if (!(in.low <= in.high && in.low <= limit)) return limit;
        const Kind kind = meet(ray, i);
        if (kind == Kind::none || (kind == Kind::on_wall && after != no_entity)) return limit;
        const auto is_later = kind == Kind::hit && after != no_entity ? comes_first(ray, after, i) : true;
        const auto is_first = kind == Kind::hit && found.kind == Kind::hit ? comes_first(ray, i, found.wall) : true;
        if (kind != Kind::hit || !is_later || !is_first) {
          found = {kind == Kind::hit ? Kind::degenerate : kind, i, false};
        } else if (*is_later && *is_first) {
          found = {Kind::hit, i, side(i, ray.from) == Sign::negative};
          limit = std::min(limit, in.high);
        }
        return limit;
      });
  return found;
}

template class FirstHits<2>;
template class FirstHits<3>;

}  // namespace pgdr::detail
