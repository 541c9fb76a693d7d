// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Linear interpolation on a mesh: exact point location by a tree of boxes, nearest point of the boundary outside.
// Immutable once made; any thread.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "pgdr/types.hpp"
#include "space/box_tree.hpp"

namespace pgdr::detail {

/// A point as the mean of N others with weights that are not negative; their sum is not 1.
template <std::size_t N>
struct WeightedCorners {
  std::array<std::uint32_t, N> corner;
  std::array<double, N> weight;

  /// The mean of the values of the corners, never beyond them.
  template <class Value>
  double mean(const Value& value_of) const {
    double sum = 0, total = 0, least = value_of(corner[0]), most = least;
    for (std::size_t i = 0; i < N; ++i) {
      const double value = value_of(corner[i]);
      sum += weight[i] * value;
      total += weight[i];
      least = std::min(least, value);
      most = std::max(most, value);
    }
    const double m = sum / total;
    return m >= least ? std::min(m, most) : least;  // NaN: weights that underflow
  }
};

/// Weights of the point of the segment (triangle) next to x.
std::array<double, 2> nearest_weights(const std::array<Point2, 2>& face, const Point2& x);
std::array<double, 3> nearest_weights(const std::array<Point3, 3>& face, const Point3& x);

template <int D>
class MeshInterpolation {
 public:
  using Cell = std::array<std::uint32_t, D + 1>;
  using Face = std::array<std::uint32_t, D>;

  /// Flat cells are left out, and the orientation of the others does not matter.
  MeshInterpolation(std::vector<Point<D>> points, std::span<const Cell> cells);

  /// No cell has a volume: at() may not be called.
  bool empty() const { return cells_.empty(); }
  /// x in the cell that holds it, the one with the smallest number if there are several; else next to x on the boundary.
  WeightedCorners<D + 1> at(const Point<D>& x) const;
  /// The number of that cell among the given ones; none outside.
  std::uint32_t cell_at(const Point<D>& x) const;

  static constexpr std::uint32_t none = 0xffffffffu;

 private:
  template <std::size_t N>
  std::vector<Box<D>> boxes(const std::vector<std::array<std::uint32_t, N>>& simplices) const;
  std::uint32_t place_of(const Point<D>& x) const;
  bool holds(std::uint32_t c, const Point<D>& x) const;
  WeightedCorners<D + 1> inside(std::uint32_t c, const Point<D>& x) const;
  WeightedCorners<D + 1> outside(const Point<D>& x) const;

  std::vector<Point<D>> points_;
  std::vector<std::uint32_t> numbers_;  ///< of those of the given cells that are not flat
  std::vector<Cell> cells_;             ///< these
  std::vector<Face> faces_;
  BoxTree<D> cell_tree_, face_tree_;
};

extern template class MeshInterpolation<2>;
extern template class MeshInterpolation<3>;

}  // namespace pgdr::detail
