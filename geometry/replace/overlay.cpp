// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "replace/overlay.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "pgdr/predicates.hpp"

namespace pgdr::detail {
namespace {

struct Side {
  double area;  // twice that of the triangle
  int sign;     // exact
};

inline Side side(const Point2& a, const Point2& b, const Point2& p) {
  const double left = (b[0] - a[0]) * (p[1] - a[1]), right = (b[1] - a[1]) * (p[0] - a[0]);
  const double area = left - right;
  constexpr double error = 0x1p-51;  // Shewchuk 1997, bound A of two dimensions
  if (std::fabs(area) > error * (std::fabs(left) + std::fabs(right))) return {area, area > 0 ? 1 : -1};
  if (p == a || p == b) return {0, 0};  // most of the others: corners that both have
  return {area, static_cast<int>(orient2d(a, b, p))};
}

/// Of three points and the lines of three edges: sides[i][j], of point j beside edge i; inside of the triangle are positive ones.
using Sides = std::array<std::array<Side, 3>, 3>;

/// @returns false if all are beyond one of the edges, or on it
bool find_sides(const RaisedTriangle& t, const std::array<Point2, 3>& points, Sides& sides) {
  for (std::size_t i = 0; i < 3; ++i) {
    bool any = false;
    for (std::size_t j = 0; j < 3; ++j) {
      Side s = side(t.at[i], t.at[next_corner(i)], points[j]);
      if (t.way < 0) s = {-s.area, -s.sign};
      any = any || s.sign > 0;
      sides[i][j] = s;
    }
    if (!any) return false;
  }
  return true;
}

bool is_in(const Sides& sides, std::size_t j) { return sides[0][j].sign >= 0 && sides[1][j].sign >= 0 && sides[2][j].sign >= 0; }

/// Weights of the corners at point j.
std::array<double, 3> weights(const Sides& sides, std::size_t j) {
  const double sum = sides[0][j].area + sides[1][j].area + sides[2][j].area;
  return {sides[1][j].area / sum, sides[2][j].area / sum, sides[0][j].area / sum};
}
double at(const std::array<double, 3>& heights, const std::array<double, 3>& weights) {
  return weights[0] * heights[0] + weights[1] * heights[1] + weights[2] * heights[2];
}

/// The edges of one triangle that meet the inside of another: a line that separates the two is that of an edge of either.
/// @param of_edge  sides of the ends, beside the other's edges  @param across  of the other's corners, beside these edges
std::uint8_t edges_inside(const Sides& of_ends, const Sides& across) {
  std::uint8_t edges = 0;
  for (std::size_t j = 0; j < 3; ++j) {
    bool is_apart = false, any_left = false, any_right = false;
    for (std::size_t i = 0; i < 3; ++i) {
      is_apart = is_apart || (of_ends[i][j].sign <= 0 && of_ends[i][next_corner(j)].sign <= 0);
      any_left = any_left || across[j][i].sign > 0;
      any_right = any_right || across[j][i].sign < 0;
    }
    if (!is_apart && any_left && any_right) edges = static_cast<std::uint8_t>(edges | (1u << j));
  }
  return edges;
}

void note(Overlay& o, double apart, const std::array<double, 3>& where) {
  apart = std::fabs(apart);
  if (apart <= o.apart) return;
  o.apart = apart;
  o.where = where;
}

/// The second one is all in the first one, as most are.
void put_inside(const RaisedTriangle& first, const RaisedTriangle& second, const Sides& of_second, Overlay& o) {
  o.is_any = true;
  for (std::size_t j = 0; j < 3; ++j) {
    bool is_on_edge = false;
    for (std::size_t i = 0; i < 3; ++i)
      is_on_edge = is_on_edge || (of_second[i][j].sign == 0 && of_second[i][next_corner(j)].sign == 0);
    if (!is_on_edge) o.edges_of_second = static_cast<std::uint8_t>(o.edges_of_second | (1u << j));
    const auto w = weights(of_second, j);
    note(o, at(first.height, w) - second.height[j], w);
  }
}

}  // namespace

int side_of(const Point2& a, const Point2& b, const Point2& p) { return side(a, b, p).sign; }

bool are_apart(const RaisedTriangle& a, const RaisedTriangle& b, double distance) {
  const auto is_beyond = [distance](const RaisedTriangle& t, const RaisedTriangle& other) {
    for (std::size_t i = 0; i < 3; ++i) {
      const Point2 &p = t.at[i], &q = t.at[next_corner(i)];
      const double x = t.way * (q[0] - p[0]), y = t.way * (q[1] - p[1]);
      const double least = distance * std::sqrt(x * x + y * y);
      bool are_all = true;
      for (const Point2& r : other.at) are_all = are_all && x * (r[1] - p[1]) - y * (r[0] - p[0]) < -least;
      if (are_all) return true;
    }
    return false;
  };
  return a.way != 0 && b.way != 0 && (is_beyond(a, b) || is_beyond(b, a));
}

Projection::Projection(const Point3& origin, const Vector<3>& normal, double extent, double e) : origin_(origin) {
  // Below the least normal number a square has fewer digits, and what is divided by its root is not of length 1.
  const double square = dot(normal, normal), length = std::sqrt(square);
  if (!(square >= std::numeric_limits<double>::min()) || !std::isfinite(square) || !(extent > 0) || !std::isfinite(extent))
    return;
  auto& [u, v, n] = axes_;
  for (std::size_t i = 0; i < 3; ++i) n[i] = normal[i] / length;
  // The axis that is the least along the normal.
  std::size_t least = 0;
  for (std::size_t i = 1; i < 3; ++i)
    if (std::fabs(n[i]) < std::fabs(n[least])) least = i;
  Vector<3> axis{};
  axis[least] = 1;
  u = cross(axis, n);
  const double across = std::sqrt(dot(u, u));
  for (double& x : u) x /= across;
  v = cross(n, u);
  scale_ = std::ldexp(1.0, -std::ilogb(extent));
  e_ = scale_ * e;
  constexpr double least_distance = 0x1p-30;  // of the extent: places and heights have errors of some 2^-50 of it
  is_one_ = e_ > least_distance;
}

RaisedTriangle Projection::raised(const std::array<Point3, 3>& corners) const {
  RaisedTriangle t;
  double low = 0, high = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto d = difference(corners[i], origin_);
    t.at[i] = Point2{{scale_ * dot(axes_[0], d), scale_ * dot(axes_[1], d)}};
    t.height[i] = scale_ * dot(axes_[2], d);
    t.box.add(t.at[i]);
    low = i == 0 ? t.height[0] : std::min(low, t.height[i]);
    high = i == 0 ? t.height[0] : std::max(high, t.height[i]);
  }
  // Areas have errors of some 2^-50 L^2, heights found with them as much over the area, times L. That is 2^-14 of the distance.
  const double length = std::max(t.box.longest_side(), high - low);
  constexpr double condition = 0x1p-36;
  t.least_area = condition * length * length * length / e_;
  const Side s = side(t.at[0], t.at[1], t.at[2]);
  if (std::fabs(s.area) > t.least_area) t.way = s.sign;
  return t;
}

Overlay overlay(const RaisedTriangle& first, const RaisedTriangle& second) {
  assert(first.way != 0 && second.way != 0);
  Overlay o;
  if (!first.box.meets(second.box)) return o;
  Sides of_second, of_first;  // corners of the second one beside edges of the first one, and the other way round
  if (!find_sides(first, second.at, of_second)) return o;
  if (is_in(of_second, 0) && is_in(of_second, 1) && is_in(of_second, 2)) {
    put_inside(first, second, of_second, o);
    return o;
  }
  if (!find_sides(second, first.at, of_first)) return o;
  o.is_any = true;
  o.edges_of_second = edges_inside(of_second, of_first);
  o.edges_of_first = edges_inside(of_first, of_second);
  for (std::size_t j = 0; j < 3; ++j) {
    if (is_in(of_second, j)) {
      const auto w = weights(of_second, j);
      note(o, at(first.height, w) - second.height[j], w);
    }
    if (is_in(of_first, j)) {
      std::array<double, 3> corner{};
      corner[j] = 1;
      note(o, first.height[j] - at(second.height, weights(of_first, j)), corner);
    }
  }
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) {
      const Side &from = of_second[i][j], &to = of_second[i][next_corner(j)], &start = of_first[j][i],
                 &end = of_first[j][next_corner(i)];
      if (from.sign * to.sign >= 0 || start.sign * end.sign >= 0) continue;
      const double across = from.area - to.area;  // the product of both edges
      if (!(std::fabs(across) > std::max(first.least_area, second.least_area))) {
        o.is_clear = false;
        return o;
      }
      const double along = start.area / (start.area - end.area), other = from.area / across;
      std::array<double, 3> w{};
      w[i] = 1 - along;
      w[next_corner(i)] = along;
      const double above = second.height[j] + other * (second.height[next_corner(j)] - second.height[j]);
      note(o, at(first.height, w) - above, w);
    }
  return o;
}

}  // namespace pgdr::detail
