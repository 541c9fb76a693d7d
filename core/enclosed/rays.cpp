// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Lines through the input: which walls a line crosses and in which order. Exact; a line that meets a ridge, or lies in
// a wall, is given up for another one.
#include <algorithm>
#include <cmath>
#include <limits>

#include "enclosed/input_volumes.hpp"
#include "numbers/exact_tests.hpp"
#include "numbers/rounding.hpp"
#include "pgdr/predicates.hpp"

namespace pgdr::checking {
namespace {

enum class Crossing { miss, hit, degenerate };

template <int D>
Crossing crossing(const std::array<Point<D>, D>& s, const Point<D>& q, const Point<D>& p) {
  const auto against = [&](const Point<D>& x) {
    if constexpr (D == 2)
      return orient2d(s[0], s[1], x);
    else
      return orient3d(s[0], s[1], s[2], x);
  };
  const Sign of_q = against(q), of_p = against(p);
  if (of_q == of_p && of_q != Sign::zero) return Crossing::miss;
  // Seen along the line, the simplex surrounds it iff its D faces turn round it the same way.
  bool positive = false, negative = false, zero = of_q == Sign::zero || of_p == Sign::zero;
  for (int i = 0; i < D; ++i) {
    Sign turn;
    if constexpr (D == 2)
      turn = i == 0 ? orient2d(q, p, s[0]) : -orient2d(q, p, s[1]);
    else
      turn = orient3d(q, p, s[i], s[(i + 1) % 3]);
    positive |= turn == Sign::positive;
    negative |= turn == Sign::negative;
    zero |= turn == Sign::zero;
  }
  if (positive && negative) return Crossing::miss;
  return zero ? Crossing::degenerate : Crossing::hit;
}

std::uint64_t mix(std::uint64_t x) {  // splitmix64
  x += 0x9e3779b97f4a7c15u;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
  return x ^ (x >> 31);
}

/// Distances of boxes from a line, along D - 1 directions normal to it, in doubles with a bound of their error.
template <int D>
class Strip {
 public:
  Strip(const Point<D>& q, const Point<D>& p) : q_(q), p_(p) {
    Point<D>& d = along_;
    double length = 0, magnitude = 0;
    for (int i = 0; i < D; ++i) {
      d[i] = p[i] - q[i];
      length = std::max(length, std::abs(d[i]));
      magnitude = std::max({magnitude, std::abs(q[i]), std::abs(p[i])});
    }
    for (int i = 0; i < D; ++i) d[i] /= length;
    int least = 0;
    for (int i = 1; i < D; ++i)
      if (std::abs(d[i]) < std::abs(d[least])) least = i;
    // Any D - 1 directions would do: an exact normal is not needed, the error term covers what they are off.
    if constexpr (D == 2) {
      normal_[0] = {{-d[1], d[0]}};
    } else {
      const int j = (least + 1) % 3, k = (least + 2) % 3;
      normal_[0][j] = -d[k];
      normal_[0][k] = d[j];
      for (int i = 0; i < 3; ++i)
        normal_[1][i] = d[(i + 1) % 3] * normal_[0][(i + 2) % 3] - d[(i + 2) % 3] * normal_[0][(i + 1) % 3];
    }
    slack_ = rounding::of_pruning * (magnitude + length);
  }

  bool may_cross(const detail::Box<D>& box) const {
    const auto& [low, high] = box;
    for (const auto& n : normal_) {
      double height = 0, reach = slack_;
      for (int i = 0; i < D; ++i) {
        height += n[i] * ((low[i] - q_[i]) + (high[i] - q_[i])) / 2;
        reach += std::abs(n[i]) * (high[i] - low[i]) / 2;
      }
      if (std::abs(height) > reach) return false;
    }
    return true;
  }

  /// How far it is from the end, at least and at most, against the direction of the line.
  std::array<double, 2> extent_from_end(const detail::Box<D>& box) const {
    double from = -slack_, to = slack_;
    for (int i = 0; i < D; ++i) {
      const double a = along_[i] * (p_[i] - box.low[i]), b = along_[i] * (p_[i] - box.high[i]);
      from += std::min(a, b);
      to += std::max(a, b);
    }
    return {from, to};
  }

 private:
  Point<D> q_, p_, along_;
  std::array<Point<D>, D - 1> normal_{};
  double slack_ = 0;
};

}  // namespace

template <int D>
std::array<Point<D>, D> InputVolumes<D>::simplex(std::uint32_t i) const {
  std::array<Point<D>, D> s;
  for (int k = 0; k < D; ++k) s[k] = walls_.points[walls_.simplices[i][k]];
  return s;
}

template <int D>
void InputVolumes<D>::plant_simplices() {
  std::vector<detail::Box<D>> boxes;
  boxes.reserve(walls_.simplices.size());
  for (std::uint32_t i = 0; i < walls_.simplices.size(); ++i) boxes.push_back(detail::Box<D>::of(simplex(i)));
  tree_.emplace(boxes);
}

template <int D>
std::optional<std::vector<std::uint32_t>> InputVolumes<D>::crossings(const Point<D>& q, const Point<D>& p) const {
  const Strip<D> strip(q, p);
  std::vector<std::uint32_t> hits;
  bool degenerate = false;
  tree_->wherever([&](const detail::Box<D>& box) { return !degenerate && strip.may_cross(box); },
                  [&](std::uint32_t i) {
                    const Crossing c = crossing<D>(simplex(i), q, p);
                    degenerate |= c == Crossing::degenerate;
                    if (c == Crossing::hit) hits.push_back(i);
                  });
  if (degenerate) return {};
  return in_order(q, p, hits);
}

template <int D>
std::optional<std::vector<std::uint32_t>> InputVolumes<D>::last_crossings(const Point<D>& q, const Point<D>& p) const {
  const Strip<D> strip(q, p);
  struct Hit {
    std::uint32_t simplex;
    double from;
  };
  std::vector<Hit> hits;
  bool degenerate = false;
  double least = std::numeric_limits<double>::max();  // less than the bound of what the line passes
  const auto bound = [&](const detail::Box<D>& box, std::uint32_t) {
    const auto [from, to] = strip.extent_from_end(box);
    return !degenerate && to >= 0 && strip.may_cross(box) ? from : std::numeric_limits<double>::infinity();
  };
  tree_->nearest(bound, [&](std::uint32_t i) {
    const detail::Box<D> box = detail::Box<D>::of(simplex(i));
    if (degenerate || !strip.may_cross(box)) return least;
    const auto [from, to] = strip.extent_from_end(box);
    if (from > least) return least;
    const Crossing c = crossing<D>(simplex(i), q, p);
    degenerate |= c == Crossing::degenerate;
    if (c != Crossing::hit) return least;
    hits.push_back({i, from});
    least = std::min(least, to);
    return least;
  });
  if (degenerate) return {};
  std::vector<std::uint32_t> near;
  for (const Hit& hit : hits)
    if (hit.from <= least) near.push_back(hit.simplex);
  return in_order(q, p, near);
}

template <int D>
std::optional<std::vector<std::uint32_t>> InputVolumes<D>::in_order(const Point<D>& q, const Point<D>& p,
                                                                    const std::vector<std::uint32_t>& hits) const {
  std::vector<std::array<Point<D>, D>> simplices;
  for (const std::uint32_t i : hits) simplices.push_back(simplex(i));
  const auto order = order_along<D>(q, p, simplices);
  if (order.size() != hits.size()) return {};
  std::vector<std::uint32_t> sorted;
  for (const std::uint32_t i : order) sorted.push_back(hits[i]);
  return sorted;
}

/// A point outside the bounding box, in a direction that depends on the attempt alone.
template <int D>
Point<D> InputVolumes<D>::far_from(const Point<D>& p, std::uint64_t attempt) const {
  Point<D> q = p;
  for (int i = 0; i < D; ++i) {
    const double unit = static_cast<double>(mix(8 * attempt + static_cast<std::uint64_t>(i)) >> 11) * 0x1p-52 - 1;
    // At least two spans in every axis, so that the point is outside the box, whatever p in it.
    q[i] += span_ * (unit < 0 ? unit - 0.25 : unit + 0.25) * 8;
  }
  return q;
}

template <int D>
std::optional<std::uint32_t> InputVolumes<D>::locate(const Point<D>& p) const {
  constexpr std::uint64_t attempts = 32;  // a line in general position is found at once unless p is on a wall
  for (std::uint64_t attempt = 0; attempt < attempts; ++attempt) {
    const auto hits = last_crossings(far_from(p, attempt), p);
    if (!hits) continue;
    if (hits->empty()) return 0;
    const auto s = simplex(hits->back());
    const Sign side = [&] {
      if constexpr (D == 2)
        return orient2d(s[0], s[1], p);
      else
        return orient3d(s[0], s[1], s[2], p);
    }();
    return sides_[hits->back()][side == Sign::negative];
  }
  return {};
}

template class InputVolumes<2>;
template class InputVolumes<3>;

}  // namespace pgdr::checking
