// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Points that are found again by places within a distance, while more come. One thread.
#pragma once

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include "space/point_places.hpp"

namespace pgdr::detail {

template <int D>
class NearPoints {
 public:
  /// @param like  points about as large as all that come, for the width of the grid
  NearPoints(std::span<const Point<D>> like, double reach) : reach_(reach), grid_(0, 1, 1) {
    const auto [scale, largest] = scale_of<D>(like);
    scale_ = scale;
    width_ = std::max(reach * scale, largest * 0x1p-50);  // a grid has a width
    make_room(16);
  }

  /// The nearest within the distance, the first of several, or no_entity.
  std::uint32_t find(const Point<D>& p) const {
    const std::uint32_t v = grid_.nearest(p, points_);
    return v != no_entity && squared_distance(points_[v], p) <= reach_ * reach_ ? v : no_entity;
  }
  /// @returns its number
  std::uint32_t add(const Point<D>& p) {
    const auto v = static_cast<std::uint32_t>(points_.size());
    points_.push_back(p);
    if (points_.size() > room_) return make_room(2 * points_.size()), v;
    grid_.insert(p, v);
    return v;
  }
  const std::vector<Point<D>>& all() const { return points_; }
  const Point<D>& operator[](std::uint32_t v) const { return points_[v]; }
  std::uint32_t size() const { return static_cast<std::uint32_t>(points_.size()); }

 private:
  void make_room(std::size_t most) {
    room_ = most;
    grid_ = PointGrid<D>(most, scale_, width_);
    for (std::uint32_t v = 0; v < points_.size(); ++v) grid_.insert(points_[v], v);
  }

  double reach_, scale_ = 1, width_ = 1;
  std::size_t room_ = 0;
  std::vector<Point<D>> points_;
  PointGrid<D> grid_;
};

}  // namespace pgdr::detail
