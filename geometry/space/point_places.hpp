// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Points found again by their coordinates: those at the same place, and those within a distance.
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "pgdr/types.hpp"

namespace pgdr::detail {

template <int D>
std::size_t hash_of(const Point<D>& p) {
  std::uint64_t h = 0x9e3779b97f4a7c15u;
  for (const double x : p.x) {
    h = (h ^ std::bit_cast<std::uint64_t>(x)) * 0xff51afd7ed558ccdu;
    h ^= h >> 32;
  }
  return static_cast<std::size_t>(h);
}

/// Points by their place in a table; two with the same key are told apart by `same`.
class PointPlaces {
 public:
  explicit PointPlaces(std::size_t most) : table_(std::bit_ceil(2 * most + 1), no_entity) {}

  /// The first in the chain of this hash that `same` takes, or no_entity.
  template <class Same>
  std::uint32_t find(std::size_t hash, const Same& same) const {
    std::size_t at = hash & (table_.size() - 1);
    while (table_[at] != no_entity && !same(table_[at])) at = (at + 1) & (table_.size() - 1);
    return table_[at];
  }
  void insert(std::size_t hash, std::uint32_t point) {
    std::size_t at = hash & (table_.size() - 1);
    while (table_[at] != no_entity) at = (at + 1) & (table_.size() - 1);
    table_[at] = point;
  }

 private:
  std::vector<std::uint32_t> table_;
};

/// Of each point the first one at its place. @pre coordinates are finite
template <int D>
std::vector<std::uint32_t> first_at_places(std::span<const Point<D>> points) {
  PointPlaces places(points.size());
  std::vector<std::uint32_t> first(points.size());
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    Point<D> p = points[i];
    for (double& x : p.x) x += 0.0;  // -0 is 0
    const std::size_t hash = hash_of(p);
    first[i] = places.find(hash, [&](std::uint32_t v) { return points[v] == p; });
    if (first[i] != no_entity) continue;
    first[i] = i;
    places.insert(hash, i);
  }
  return first;
}

/// A grid of cubes as wide as the distance: whoever is near enough is in a point's own, or in one beside it.
template <int D>
class PointGrid {
 public:
  /// `scale`: a power of two that makes coordinates of the size of 1; `distance`: after that.
  PointGrid(std::size_t most, double scale, double distance) : places_(most), scale_(scale), distance_(distance) {}

  /// The nearest that is near enough, the first of several; or no_entity.
  std::uint32_t nearest(const Point<D>& p, std::span<const Point<D>> points) const {
    const Point<D> x = scaled(p), home = cube(x);
    std::uint32_t best = no_entity;
    double least = distance_ * distance_;
    for (int k = 0, n = D == 3 ? 27 : 9; k < n; ++k) {
      Point<D> at = home;
      for (int i = 0, rest = k; i < D; ++i, rest /= 3) at[i] = home[i] + (rest % 3 - 1) + 0.0;
      // Visits all of the cube: nothing is ever the same.
      places_.find(hash_of(at), [&](std::uint32_t v) {
        const Point<D> y = scaled(points[v]);
        const double d = squared_distance(x, y);
        if (cube(y) == at && (d < least || (d == least && v < best))) {
          least = d;
          best = v;
        }
        return false;
      });
    }
    return best;
  }
  void insert(const Point<D>& p, std::uint32_t v) { places_.insert(hash_of(cube(scaled(p))), v); }

 private:
  Point<D> scaled(Point<D> p) const {
    for (double& x : p.x) x *= scale_;
    return p;
  }
  Point<D> cube(const Point<D>& x) const {
    Point<D> c;
    for (int i = 0; i < D; ++i) c[i] = std::floor(x[i] / distance_) + 0.0;
    return c;
  }

  PointPlaces places_;
  double scale_, distance_;
};

/// The power of two that brings the largest coordinate to [1, 2), and that coordinate then.
template <int D>
std::pair<double, double> scale_of(std::span<const Point<D>> points) {
  double largest = 0;
  for (const Point<D>& p : points)
    for (const double x : p.x) largest = std::max(largest, std::fabs(x));
  if (!(largest > 0)) return {1, 1};
  const double scale = std::ldexp(1.0, std::min(-std::ilogb(largest), 1022));
  return {scale, largest * scale};
}

}  // namespace pgdr::detail
