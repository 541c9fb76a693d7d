// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "replace/coverage.hpp"

#include <cmath>
#include <limits>

#include "replace/complex.hpp"
#include "replace/numbers.hpp"

namespace pgdr::detail {
namespace {

constexpr int deepest = 40;  // parts of parts

/// Within the plane of a triangle and above it: a little less than e, so that what is cut off at that height passes the test of
/// its corners against it in spite of rounding.
constexpr double part_of_height = 0.999;
/// Of e: a part of a smaller diameter is given up.
constexpr double least_part = 1.0 / 16;

double height(const Vector<3>& normal, const Point3& p) { return normal[0] * p[0] + normal[1] * p[1] + normal[2] * p[2]; }

bool normalize(Vector<3>& v) {
  const double length = std::sqrt(dot(v, v));
  if (!(length > 0)) return false;
  for (double& x : v) x /= length;
  return true;
}

/// The centroid of its area: of any line through it no side has less than 4/9 of that. Of what has no area that of its corners.
Point3 centre(const CutPolygon& polygon) {
  Point3 sum, c;
  double area = 0;
  const Point3& origin = polygon[0];
  for (std::size_t k = 1; k + 1 < polygon.count(); ++k) {
    const auto u = difference(polygon[k], origin), v = difference(polygon[k + 1], origin);
    const auto n = cross(u, v);
    const double twice = std::sqrt(dot(n, n));
    area += twice;
    for (std::size_t i = 0; i < 3; ++i) sum.x[i] += twice * (u[i] + v[i]);
  }
  if (area > 0) {
    for (int i = 0; i < 3; ++i) c[i] = origin[i] + sum[i] / (3 * area);
    return c;
  }
  for (const Point3& p : polygon.all())
    for (int i = 0; i < 3; ++i) c[i] += p[i] / static_cast<double>(polygon.count());
  return c;
}

}  // namespace

bool cut(const CutPolygon& polygon, const Vector<3>& normal, double offset, CutPolygon& inside, CutPolygon& beyond) {
  std::array<double, CutPolygon::most_corners> side;
  const std::size_t count = polygon.count();
  bool any_beyond = false, any_inside = false;
  for (std::size_t k = 0; k < count; ++k) {
    side[k] = height(normal, polygon[k]) - offset;
    (side[k] > 0 ? any_beyond : any_inside) = true;
  }
  if (!any_beyond || !any_inside) {
    (any_beyond ? inside : beyond).clear();
    (any_beyond ? beyond : inside) = polygon;
    return true;
  }
  inside.clear();
  beyond.clear();
  for (std::size_t k = 0; k < count; ++k) {
    const std::size_t next = k + 1 == count ? 0 : k + 1;
    const Point3 &p = polygon[k], &q = polygon[next];
    if (!(side[k] > 0 ? beyond : inside).add(p)) return false;
    if ((side[k] > 0) == (side[next] > 0)) continue;
    const Point3 x = on_edge(p, q, side[k] / (side[k] - side[next]));
    if (!inside.add(x) || !beyond.add(x)) return false;
  }
  return true;
}

bool cut_to_box(CutPolygon& polygon, const Box<3>& box) {
  CutPolygon inside, beyond;
  for (std::size_t i = 0; i < 3 && polygon.count() > 0; ++i) {
    const int k = static_cast<int>(i);
    const auto all = polygon.all();
    if (std::all_of(all.begin(), all.end(), [&](const Point3& p) { return box.low[k] <= p[k] && p[k] <= box.high[k]; })) continue;
    Vector<3> axis{};
    for (const double way : {1.0, -1.0}) {
      axis[i] = way;
      if (!cut(polygon, axis, way > 0 ? box.high[k] : -box.low[k], inside, beyond)) return false;
      polygon = inside;
    }
  }
  return true;
}

void Cover::add(const std::array<Point3, 3>& sorted_corners) {
  numbers_.push_back(static_cast<std::uint32_t>(size()));
  boxes_.push_back(Box<3>::of(sorted_corners));
  triangles_.push_back({.corners = sorted_corners});
}

const Cover::Plane& Cover::plane_of(std::size_t number) {
  Triangle& t = triangles_[number];
  if (t.plane != none) return planes_[t.plane];
  t.plane = static_cast<std::uint32_t>(planes_.size());
  Plane& plane = planes_.emplace_back();
  const auto& c = t.corners;
  plane.normal = cross(difference(c[1], c[0]), difference(c[2], c[0]));
  plane.is_one = normalize(plane.normal);
  for (std::size_t i = 0; i < 3 && plane.is_one; ++i) {
    plane.outward[i] = cross(difference(c[(i + 1) % 3], c[i]), plane.normal);
    plane.is_one = normalize(plane.outward[i]);
  }
  return plane;
}

bool Cover::covers(const CutPolygon& polygon, std::size_t first, std::size_t each) {
  const List used{0, lists_.size()};
  std::size_t left = first + each * used.last;
  const bool is_covered = used.last > 0 && look(polygon, used, 0, left);
  lists_.resize(used.last);
  return is_covered;
}

const TriangleDistance& Cover::distance_of(std::size_t number) const {
  Triangle& t = triangles_[number];
  if (t.distance != none) return distances_[t.distance];
  t.distance = static_cast<std::uint32_t>(distances_.size());
  return distances_.emplace_back(t.corners[0], t.corners[1], t.corners[2]);
}

bool Cover::might_hold(std::size_t t, const Box<3>& box) const {
  const Box<3>& own = boxes_[t];
  for (int i = 0; i < 3; ++i)
    if (box.low[i] < own.low[i] - e_ || box.high[i] > own.high[i] + e_) return false;
  return true;
}

bool Cover::holds(std::size_t t, std::span<const Point3> corners) const {
  const TriangleDistance& distance = distance_of(t);
  return std::all_of(corners.begin(), corners.end(), [&](const Point3& p) { return distance.is_within(p, square_); });
}

bool Cover::has_one_near(std::span<const Point3> corners, std::span<const std::uint32_t> numbers) const {
  const Box<3> box = Box<3>::of(corners);
  for (const std::uint32_t t : numbers)
    if (might_hold(t, box) && holds(t, corners)) return true;
  return false;
}

bool Cover::reaches(const Point3& p, std::span<const std::uint32_t> numbers) const {
  for (const std::uint32_t t : numbers)
    if (boxes_[t].squared_distance_to(p) <= square_ && distance_of(t).is_within(p, square_)) return true;
  return false;
}

/// Its number; size(): none is within e.
std::size_t Cover::nearest(const Point3& p, const List& list) const {
  std::size_t best = size();
  double square = square_;
  for (const std::uint32_t t : numbers(list)) {
    if (boxes_[t].squared_distance_to(p) > square) continue;
    const double d = distance_of(t).square(p);
    const bool is_tie = d == square && best < size();
    if (d > square || (is_tie && !triangle_less(triangles_[t].corners, triangles_[best].corners))) continue;
    square = d;
    best = t;
  }
  return best;
}

/// Those whose boxes come near this one.
Cover::List Cover::narrowed(const List& list, const Box<3>& box) {
  const std::size_t first = lists_.size();
  const Box<3> reach = with_margin(box);
  lists_.resize(first + (list.last - list.first));
  std::size_t end = first;
  for (std::size_t k = list.first; k < list.last; ++k) {
    lists_[end] = lists_[k];
    end += boxes_[lists_[k]].meets(reach);
  }
  lists_.resize(end);
  return {first, end};
}

bool Cover::look(const CutPolygon& polygon, const List& wide, int depth, std::size_t& left) {
  if (polygon.count() < 3) return true;  // no more than an edge of another part
  if (left == 0 || depth > deepest) return false;
  --left;
  const Point3 c = centre(polygon);
  Box<3> box = Box<3>::of(polygon.all());
  box.add(c);  // which rounding may have put beside it
  const List list = narrowed(wide, box);
  const auto done = [&](bool answer) {
    lists_.resize(list.first);
    return answer;
  };
  const std::size_t t = nearest(c, list);
  if (t == size()) return done(false);
  if (holds(t, polygon.all()) || has_one_near(polygon.all(), numbers(list))) return done(true);
  if (plane_of(t).is_one) {
    bool was_cut = false;
    const bool is_covered = look_beyond(t, polygon, c, list, depth, left, was_cut);
    if (was_cut) return done(is_covered);
  }
  return done(look_at_halves(polygon, list, depth, left));
}

bool Cover::look_beyond(std::size_t number, const CutPolygon& polygon, const Point3& c, const List& list, int depth,
                        std::size_t& left, bool& was_cut) {
  const Point3& corner = triangles_[number].corners[0];
  std::array<CutPolygon, 5> rest;
  std::array<CutPolygon, 2> both{polygon, {}};
  CutPolygon *here = &both[0], *inside = &both[1];
  std::size_t parts = 0;
  // With the centroid inside, what is cut off is no more than 5/9 of the polygon each time, so that this ends. An edge alone
  // could be inside again and again.
  const auto take = [&](const Vector<3>& normal, double offset) {
    if (height(normal, c) > offset || !cut(*here, normal, offset, *inside, rest[parts])) return false;
    std::swap(here, inside);
    if (rest[parts].count() > 0) ++parts;
    return here->count() > 0;
  };
  {
    const Plane& plane = plane_of(number);
    const double level = height(plane.normal, corner), reach = part_of_height * e_;
    for (std::size_t i = 0; i < 3; ++i)
      if (!take(plane.outward[i], height(plane.outward[i], triangles_[number].corners[i]))) return false;
    Vector<3> down = plane.normal;
    for (double& x : down) x = -x;
    if (!take(plane.normal, level + reach) || !take(down, reach - level)) return false;
  }
  if (!holds(number, here->all()) || parts == 0) return false;
  was_cut = true;
  for (std::size_t k = 0; k < parts; ++k)
    if (!look(rest[k], list, depth + 1, left)) return false;
  return true;
}

bool Cover::look_at_halves(const CutPolygon& polygon, const List& list, int depth, std::size_t& left) {
  double longest = -1;
  const Point3 *from = nullptr, *to = nullptr;
  const auto all = polygon.all();
  for (std::size_t i = 0; i < all.size(); ++i)
    for (std::size_t j = i + 1; j < all.size(); ++j)
      if (const double d = squared_distance(all[i], all[j]); d > longest) {
        longest = d;
        from = &all[i];
        to = &all[j];
      }
  const double least = least_part * e_;
  if (!(longest >= least * least)) return false;
  if (lex_less(*to, *from)) std::swap(from, to);
  Vector<3> along = difference(*to, *from);
  if (!normalize(along)) return false;
  CutPolygon near, far;
  if (!cut(polygon, along, height(along, on_edge(*from, *to, 0.5)), near, far)) return false;
  return look(near, list, depth + 1, left) && look(far, list, depth + 1, left);
}

bool SegmentCover::covers(const Point3& a, const Point3& b) const {
  std::size_t left = 60 + 4 * segments_.size();
  return !segments_.empty() && look(a, b, left);
}

bool SegmentCover::look(const Point3& a, const Point3& b, std::size_t& left) const {
  if (left == 0) return false;
  --left;
  const Point3 middle = on_edge(a, b, 0.5);
  const auto is_near = [this](const Point3& p, const std::array<Point3, 2>& s) {
    return closest_to_edge(p, s[0], s[1]).square <= e_ * e_;
  };
  bool any = false;
  for (const auto& s : segments_) {
    if (is_near(a, s) && is_near(b, s)) return true;
    any = any || is_near(middle, s);
  }
  const double least = least_part * e_;
  return any && squared_distance(a, b) >= least * least && look(a, middle, left) && look(middle, b, left);
}

}  // namespace pgdr::detail
