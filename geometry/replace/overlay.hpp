// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Two triangles over one plane: where their projections overlap, and how far one is above the other there. Both heights are
// linear over the common part, so that they differ most at one of its corners: a corner of one that lies in the other, or where
// two edges cross.
//
// Which corners these are is decided exactly, of the projected corners as they are rounded. Heights have errors, which are kept
// small beside the distance that matters: what would have larger ones is not clear, and says nothing.
#pragma once

#include <array>
#include <cstdint>

#include "numbers/vectors.hpp"
#include "pgdr/types.hpp"
#include "space/box.hpp"

namespace pgdr::detail {

constexpr std::size_t next_corner(std::size_t i) { return i == 2 ? 0 : i + 1; }

/// A triangle above a plane.
struct RaisedTriangle {
  std::array<Point2, 3> at{};
  std::array<double, 3> height{};
  Box<2> box = Box<2>::empty();
  int way = 0;            ///< 1: it runs round counter-clockwise, -1: clockwise; 0: it has no area, or next to none
  double least_area = 0;  ///< where two of its size cross: a product of edges that is smaller is next to none
};

/// Projects along a direction. Lengths are scaled by a power of two, so that no product of them underflows.
class Projection {
 public:
  /// @param extent  how far from the origin points may be, about
  /// @param e  the distance that heights are compared with
  Projection(const Point3& origin, const Vector<3>& normal, double extent, double e);

  /// Is there a direction, and is the distance large enough beside the extent, so that something can be said?
  bool is_one() const { return is_one_; }
  /// Heights may differ by so much: the distance, but for errors.
  double most_apart() const { return (1 - errors) * e_; }
  /// What is farther in the projection is so in space.
  double least_apart() const { return (1 + errors) * e_; }
  Point2 at(const Point3& p) const {
    const auto d = difference(p, origin_);
    return Point2{{scale_ * dot(axes_[0], d), scale_ * dot(axes_[1], d)}};
  }
  RaisedTriangle raised(const std::array<Point3, 3>& corners) const;

 private:
  Point3 origin_;
  std::array<Vector<3>, 3> axes_{};
  static constexpr double errors = 0x1p-12;  ///< of the distance
  double scale_ = 1, e_ = 0;
  bool is_one_ = false;
};

/// Are their projections farther apart than this? A line along an edge of either of them shows it, or nothing does.
bool are_apart(const RaisedTriangle& a, const RaisedTriangle& b, double distance);

/// On which side of the line from a to b is p? 1: to its left. Exact.
int side_of(const Point2& a, const Point2& b, const Point2& p);

/// What two triangles have in common.
struct Overlay {
  bool is_any = false;                                   ///< do their insides meet? If not, nothing else is said
  bool is_clear = true;                                  ///< else nothing is known of the heights
  std::uint8_t edges_of_first = 0, edges_of_second = 0;  ///< bit i: the edge from corner i on meets the inside of the other one
  double apart = 0;                                      ///< how far their heights differ at most
  std::array<double, 3> where{};                         ///< where that is, by weights of the corners of the first one
};
/// @pre both have an area
Overlay overlay(const RaisedTriangle& first, const RaisedTriangle& second);

}  // namespace pgdr::detail
