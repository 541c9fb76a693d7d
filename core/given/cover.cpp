// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "given/cover.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include "numbers/vectors.hpp"

namespace pgdr::checking {
namespace {

using detail::cross;
using detail::difference;
using detail::dot;
using detail::Vector;

/// The numbers t in [0, 1] with |u + t v| <= r: a low and a high one; low above high if there are none. On both sides of where
/// the line comes nearest, since the discriminant of the quadratic equation cancels where u and v are much longer than r.
template <std::size_t N>
std::array<double, 2> within(const Vector<N>& u, const Vector<N>& v, double r) {
  const double a = dot(v, v);
  if (a <= 0) return dot(u, u) <= r * r ? std::array{0.0, 1.0} : std::array{1.0, 0.0};
  const double nearest = -dot(u, v) / a;
  Vector<N> there = u;
  for (std::size_t i = 0; i < N; ++i) there[i] += nearest * v[i];
  const double rest = r * r - dot(there, there);
  if (rest < 0) return {1, 0};
  const double half = std::sqrt(rest / a);
  return {std::max(0.0, nearest - half), std::min(1.0, nearest + half)};
}

/// Leaves of a part of a segment where a height, which is known at both ends of the segment, is at most 0.
void cut(std::array<double, 2>& part, double from, double to) {
  if (from > 0 && to > 0) part = {1, 0};
  if (from <= 0 && to <= 0) return;
  const double there = from / (from - to);
  if (from > 0)
    part[0] = std::max(part[0], there);
  else
    part[1] = std::min(part[1], there);
}

}  // namespace

template <int D>
std::vector<std::array<double, 2>> uncovered_parts(const std::array<Point<D>, 2>& segment,
                                                   const std::vector<CoveringSegment<D>>& others) {
  const auto d = difference(segment[1], segment[0]);
  const double length = std::sqrt(dot(d, d));
  std::vector<std::array<double, 2>> covered;
  for (const auto& other : others) {
    std::array<double, 2> along;
    std::array<Vector<D>, 2> off;  // of its ends from the line
    double farthest = length;
    for (int k = 0; k < 2; ++k) {
      off[k] = difference(other.ends[k], segment[0]);
      farthest = std::max(farthest, std::sqrt(dot(off[k], off[k])));
      along[k] = dot(off[k], d) / length;
      for (int i = 0; i < D; ++i) off[k][i] -= along[k] / length * d[i];
    }
    Vector<D> change;
    for (int i = 0; i < D; ++i) change[i] = off[1][i] - off[0][i];
    const double reach = other.reach + 0x1p-51 * farthest;  // and the rounding of what is computed here
    const auto [from, to] = within(off[0], change, reach);
    if (from > to) continue;
    const double first = along[0] + from * (along[1] - along[0]), last = along[0] + to * (along[1] - along[0]);
    covered.push_back({std::min(first, last) - reach, std::max(first, last) + reach});
  }
  std::sort(covered.begin(), covered.end());
  covered.push_back({length, length});
  std::vector<std::array<double, 2>> gaps;
  double end = 0;
  for (const auto& [low, high] : covered) {
    if (low > end && end < length) gaps.push_back({end / length, std::min(1.0, low / length)});
    end = std::max(end, high);
  }
  return gaps;
}

// A cross product of two edges of a needle is off its plane by rounding over its height, and so by much more along its length.
// What is left of the third corner off the longest edge has no more error than the corner itself.
PlaneFrame::PlaneFrame(const std::array<Point3, 3>& t) {
  int longest = 0;
  double length = 0;
  for (int i = 0; i < 3; ++i)
    if (const double squared = squared_distance(t[i], t[(i + 1) % 3]); squared > length) {
      length = squared;
      longest = i;
    }
  origin_ = t[longest];
  if (!(length > 0)) return;
  length = std::sqrt(length);
  const auto edge = difference(t[(longest + 1) % 3], origin_);
  for (int k = 0; k < 3; ++k) axes_[0][k] = edge[k] / length;
  auto off = difference(t[(longest + 2) % 3], origin_);
  for (int twice = 0; twice < 2; ++twice) {  // the second time for what rounding left
    const double along = dot(off, axes_[0]);
    for (int k = 0; k < 3; ++k) off[k] -= along * axes_[0][k];
  }
  width_ = std::sqrt(dot(off, off));
  if (!(width_ > 0)) return;
  for (int k = 0; k < 3; ++k) axes_[1][k] = off[k] / width_;
  axes_[2] = cross(axes_[0], axes_[1]);
}

std::array<double, 3> PlaneFrame::place(const Point3& x) const {
  const auto d = difference(x, origin_);
  return {dot(d, axes_[0]), dot(d, axes_[1]), dot(d, axes_[2])};
}

Point3 PlaneFrame::in_space(const Point2& x) const {
  Point3 p;
  for (int i = 0; i < 3; ++i) p[i] = origin_[i] + x[0] * axes_[0][i] + x[1] * axes_[1][i];
  return p;
}

double area(const FlatPolygon& polygon) {
  double doubled = 0;
  for (std::size_t k = 2; k < polygon.size(); ++k) {
    const auto u = difference(polygon[k - 1], polygon[0]), v = difference(polygon[k], polygon[0]);
    doubled += u[0] * v[1] - u[1] * v[0];
  }
  return doubled / 2;
}

double diameter(const FlatPolygon& polygon) {
  double longest = 0;
  for (const Point2& p : polygon)
    for (const Point2& q : polygon) longest = std::max(longest, squared_distance(p, q));
  return std::sqrt(longest);
}

Point2 centre(const FlatPolygon& polygon) {
  Point2 c{};
  for (const Point2& p : polygon)
    for (int i = 0; i < 2; ++i) c[i] += p[i] / static_cast<double>(polygon.size());
  return c;
}

CoveringTriangle::CoveringTriangle(const PlaneFrame& frame, const std::array<Point3, 3>& triangle, double reach, double height) {
  std::array<std::array<double, 3>, 3> at{frame.place(triangle[0]), frame.place(triangle[1]), frame.place(triangle[2])};
  const auto [lowest, highest] = std::minmax({at[0][2], at[1][2], at[2][2]});
  if (lowest > height || highest < -height) return;
  const double doubled = (at[1][0] - at[0][0]) * (at[2][1] - at[0][1]) - (at[1][1] - at[0][1]) * (at[2][0] - at[0][0]);
  if (doubled == 0) return;
  turned_ = doubled < 0;
  if (turned_) std::swap(at[1], at[2]);
  add_sides(at, reach);
  if (count_ == 0) return;
  if (highest > height) add_level(at, height, 1);
  if (lowest < -height) add_level(at, height, -1);
  for (const auto& p : at) box_.add(Point2{{p[0], p[1]}});
  box_ = box_.widened(3 * reach);  // (1 + sin a) / cos a <= 1 + sqrt 2 at a corner of 2 a <= 90 degrees, see add_sides
}

// Parallels of the edges, a reach outside of them. Two of them meet far beyond a sharp corner: there a third side cuts them off,
// a reach beyond the corner, across its bisector.
void CoveringTriangle::add_sides(const std::array<std::array<double, 3>, 3>& at, double reach) {
  std::array<Vector<2>, 3> out;  // normals of the edges from corner i
  for (int i = 0; i < 3; ++i) {
    const auto &p = at[i], &q = at[(i + 1) % 3];
    const double x = q[0] - p[0], y = q[1] - p[1], length = std::hypot(x, y);
    if (length == 0) {
      count_ = 0;
      return;
    }
    out[i] = {y / length, -x / length};
    add({out[i][0], out[i][1], out[i][0] * p[0] + out[i][1] * p[1] + reach});
  }
  for (int i = 0; i < 3; ++i) {
    const auto &before = out[(i + 2) % 3], &after = out[i];
    if (dot(before, after) >= 0) continue;  // the angle is at least 90 degrees
    // Against the sum of the directions of the two edges from the corner, which is at least sqrt(2) long.
    const Vector<2> bisector{before[1] - after[1], after[0] - before[0]};
    const double length = std::hypot(bisector[0], bisector[1]);
    const double a = -bisector[0] / length, b = -bisector[1] / length;
    add({a, b, a * at[i][0] + b * at[i][1] + reach});
  }
}

// The line of a level goes through where it meets the two edges from the corner that is alone on its side. Its coefficients from
// the three heights by Cramer's rule are another thing: of a needle's they are off by its length over its width, and hold
// nowhere.
void CoveringTriangle::add_level(const std::array<std::array<double, 3>, 3>& at, double height, double sense) {
  const auto above = [&](int i) { return sense * at[i % 3][2] > height; };
  int lone = 0;
  while (lone < 3 && (above(lone) == above(lone + 1) || above(lone) == above(lone + 2))) ++lone;
  if (lone == 3) return;  // all are on one side
  std::array<Point2, 2> x;
  for (int k = 0; k < 2; ++k) {
    const auto &p = at[lone], &q = at[(lone + 1 + k) % 3];
    const double t = (height - sense * p[2]) / (sense * (q[2] - p[2]));
    x[k] = {{p[0] + t * (q[0] - p[0]), p[1] + t * (q[1] - p[1])}};
  }
  // The corner is to the left of the line, counter-clockwise as they are.
  Vector<2> left{x[0][1] - x[1][1], x[1][0] - x[0][0]};
  if (left[0] == 0 && left[1] == 0) left = {at[lone][0] - x[0][0], at[lone][1] - x[0][1]};
  const double out = above(lone) ? 1 : -1;
  add({out * left[0], out * left[1], out * (left[0] * x[0][0] + left[1] * x[0][1])});
}

bool CoveringTriangle::contains(const Point2& x) const {
  return count_ > 0 &&
         std::all_of(sides_.begin(), sides_.begin() + count_, [&](const HalfPlane& s) { return s.a * x[0] + s.b * x[1] <= s.c; });
}

std::array<double, 2> CoveringTriangle::part_of(const Point2& p, const Point2& q) const {
  std::array<double, 2> part{0, 1};
  if (count_ == 0) return {1, 0};
  for (const HalfPlane& s : std::span(sides_).first(count_))
    cut(part, s.a * p[0] + s.b * p[1] - s.c, s.a * q[0] + s.b * q[1] - s.c);
  return part;
}

std::array<double, 2> part_near(const std::array<Point3, 2>& segment, const std::array<Point3, 3>& triangle, double reach) {
  const PlaneFrame frame(triangle);
  if (frame.width() <= 10 * reach) return {1, 0};
  const auto p = frame.place(segment[0]), q = frame.place(segment[1]);
  auto part = CoveringTriangle(frame, triangle, reach, reach).part_of({{p[0], p[1]}}, {{q[0], q[1]}});
  for (const double sense : {1.0, -1.0}) cut(part, sense * p[2] - reach, sense * q[2] - reach);
  return part;
}

bool CoveringTriangle::misses(const FlatPolygon& polygon) const {
  return std::ranges::any_of(std::span(sides_).first(count_), [&](const HalfPlane& s) {
    return std::ranges::all_of(polygon, [&](const Point2& x) { return s.a * x[0] + s.b * x[1] > s.c; });
  });
}

void CoveringTriangle::subtract(const FlatPolygon& polygon, std::vector<FlatPolygon>& rest) const {
  FlatPolygon inside = polygon, outside, kept;
  const std::size_t first = rest.size();
  for (const HalfPlane& side : std::span(sides_).first(count_)) {
    outside.clear();
    kept.clear();
    for (std::size_t k = 0; k < inside.size(); ++k) {
      const Point2 &p = inside[k], &q = inside[(k + 1) % inside.size()];
      const double of_p = side.a * p[0] + side.b * p[1] - side.c, of_q = side.a * q[0] + side.b * q[1] - side.c;
      if (of_p <= 0) kept.push_back(p);
      if (of_p >= 0) outside.push_back(p);
      if ((of_p < 0 && of_q > 0) || (of_p > 0 && of_q < 0)) {
        const double t = of_p / (of_p - of_q);
        const Point2 x{{p[0] + t * (q[0] - p[0]), p[1] + t * (q[1] - p[1])}};
        kept.push_back(x);
        outside.push_back(x);
      }
    }
    if (kept.size() < 3) {  // all of it lies outside of the triangle
      rest.resize(first);
      rest.push_back(polygon);
      return;
    }
    if (outside.size() >= 3) rest.push_back(outside);
    std::swap(inside, kept);
  }
}

namespace {

class Subtraction {
 public:
  Subtraction(const std::vector<CoveringTriangle>& others, double rounding) : others_(others), rounding_(rounding) {}

  // In halves, as long as each has at most three fourths of the others: so cuts end, and a place at which many overlap, as the
  // tip of a fan, is looked at in one piece. Where most of the others lie close together, as in a graded mesh, the middle of the
  // polygon has them all on one side, and a line through theirs divides them.
  void run(const FlatPolygon& polygon, const std::vector<std::uint32_t>& list) {
    if (is_thin(polygon)) return;
    constexpr std::size_t few = 24;  // the rest of so many is found as fast without a cut
    if (list.size() <= few) return subtract(polygon, list);
    const auto box = detail::Box<2>::of(polygon);
    const int axis = box.high[0] - box.low[0] >= box.high[1] - box.low[1] ? 0 : 1;
    if (divide(polygon, list, axis, box.low[axis] + (box.high[axis] - box.low[axis]) / 2) ||
        divide(polygon, list, axis, median(list, axis)) || divide(polygon, list, 1 - axis, median(list, 1 - axis)))
      return;
    subtract(polygon, list);
  }
  std::vector<FlatPolygon> result;

 private:
  /// @returns false if the line has too many of the others on one side or on both
  bool divide(const FlatPolygon& polygon, const std::vector<std::uint32_t>& list, int axis, double middle) {
    std::array<FlatPolygon, 2> halves;
    std::array<std::vector<std::uint32_t>, 2> near;
    for (const int k : {0, 1}) {
      halves[k] = cut(polygon, axis, middle, k == 0 ? 1.0 : -1.0);
      const auto half_box = detail::Box<2>::of(halves[k]);
      for (const std::uint32_t i : list)
        if (others_[i].box().meets(half_box) && !others_[i].misses(halves[k])) near[k].push_back(i);
    }
    if (4 * std::max(near[0].size(), near[1].size()) > 3 * list.size()) return false;
    for (const int k : {0, 1})
      if (halves[k].size() >= 3) run(halves[k], near[k]);
    return true;
  }
  double median(const std::vector<std::uint32_t>& list, int axis) const {
    std::vector<double> middles;
    middles.reserve(list.size());
    for (const std::uint32_t i : list) middles.push_back(others_[i].box().low[axis] / 2 + others_[i].box().high[axis] / 2);
    const auto half = middles.begin() + static_cast<std::ptrdiff_t>(middles.size() / 2);
    std::nth_element(middles.begin(), half, middles.end());
    return *half;
  }
  bool is_thin(const FlatPolygon& polygon) const { return area(polygon) <= rounding_ * diameter(polygon); }

  static FlatPolygon cut(const FlatPolygon& polygon, int axis, double middle, double sense) {
    FlatPolygon half;
    for (std::size_t k = 0; k < polygon.size(); ++k) {
      const Point2 &p = polygon[k], &q = polygon[(k + 1) % polygon.size()];
      const double of_p = sense * (p[axis] - middle), of_q = sense * (q[axis] - middle);
      if (of_p <= 0) half.push_back(p);
      if ((of_p < 0 && of_q > 0) || (of_p > 0 && of_q < 0)) {
        const double t = of_p / (of_p - of_q);
        Point2 x{{p[0] + t * (q[0] - p[0]), p[1] + t * (q[1] - p[1])}};
        x[axis] = middle;
        half.push_back(x);
      }
    }
    return half;
  }

  void subtract(const FlatPolygon& polygon, const std::vector<std::uint32_t>& list) {
    const auto contains_all = [&](std::uint32_t i) {
      return std::ranges::all_of(polygon, [&](const Point2& x) { return others_[i].contains(x); });
    };
    if (std::ranges::any_of(list, contains_all)) return;
    std::vector<FlatPolygon> pieces{polygon}, rest;
    for (const std::uint32_t i : list) {
      rest.clear();
      for (const FlatPolygon& piece : pieces) others_[i].subtract(piece, rest);
      pieces.clear();
      for (FlatPolygon& piece : rest)
        if (!is_thin(piece)) pieces.push_back(std::move(piece));
      if (pieces.empty()) return;
    }
    result.insert(result.end(), pieces.begin(), pieces.end());
  }

  const std::vector<CoveringTriangle>& others_;
  double rounding_;
};

}  // namespace

std::vector<FlatPolygon> uncovered_parts(const FlatPolygon& triangle, const std::vector<CoveringTriangle>& others,
                                         double rounding) {
  std::vector<std::uint32_t> list;
  for (std::uint32_t i = 0; i < others.size(); ++i)
    if (!others[i].covers_nothing() && !others[i].misses(triangle)) list.push_back(i);
  Subtraction subtraction(others, rounding);
  subtraction.run(triangle, list);
  return std::move(subtraction.result);
}

template std::vector<std::array<double, 2>> uncovered_parts(const std::array<Point2, 2>&, const std::vector<CoveringSegment<2>>&);
template std::vector<std::array<double, 2>> uncovered_parts(const std::array<Point3, 2>&, const std::vector<CoveringSegment<3>>&);

}  // namespace pgdr::checking
