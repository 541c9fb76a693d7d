// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Which of many walls (triangles; 2D: edges) a ray meets first, and which comes after that one. Exact: a ray through the rim of a
// wall is given up, and the caller takes another. Immutable once made, any thread.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "pgdr/types.hpp"
#include "space/box_tree.hpp"
#include "space/bulk.hpp"

namespace pgdr::detail {

/// The corners of a wall, as indices of points.
template <int D>
using Wall = std::array<std::uint32_t, static_cast<std::size_t>(D)>;

template <int D>
class FirstHits {
 public:
  enum class Kind : std::uint8_t {
    none,        ///< the ray meets no wall (any more)
    hit,         ///< inside a wall, which is strictly on one side of its beginning
    on_wall,     ///< it begins on a wall
    degenerate,  ///< it meets a rim, or two walls at once
  };
  struct Hit {
    Kind kind = Kind::none;
    std::uint32_t wall = no_entity;
    bool from_negative = false;  ///< the ray comes from the wall's negative side
  };
  /// From a point to another one, beyond all walls.
  struct Ray {
    Point<D> from, to;
  };

  /// The points must outlive this. @pre walls are not degenerate
  FirstHits(std::span<const Point<D>> points, std::vector<Wall<D>> walls, const Bulk& bulk);

  std::uint32_t count() const { return static_cast<std::uint32_t>(walls_.size()); }
  std::span<const Wall<D>> walls() const { return walls_; }
  std::span<const Point<D>> points() const { return points_; }
  std::array<Point<D>, D> corners(std::uint32_t wall) const;
  Sign side(std::uint32_t wall, const Point<D>& x) const;  ///< of the wall, on which x is
  const BoxTree<D>& tree() const { return tree_; }         ///< of the walls

  /// In a direction that goes by the number of the attempt, and that no input has in mind.
  Ray ray(const Point<D>& from, int attempt) const;
  /// The wall that the ray meets first; `after`: of those behind this one, which it crosses.
  Hit first(const Ray& ray, std::uint32_t after = no_entity) const;
  /// Does the ray cross the inside of the wall?
  bool crosses(const Ray& ray, std::uint32_t wall) const { return meet(ray, wall) == Kind::hit; }
  /// Has the ray left the box for good where it crosses the wall?
  bool is_beyond(const Ray& ray, const Box<D>& box, std::uint32_t wall) const {
    return inside(ray, box).high < place(ray, wall).low;
  }

 private:
  /// A part of a ray, 0 at its beginning.
  struct Interval {
    double low, high;
  };
  Kind meet(const Ray& ray, std::uint32_t wall) const;
  bool is_apart_in_plane(const Ray& ray, std::uint32_t wall) const;
  static Interval inside(const Ray& ray, const Box<D>& box);
  Interval place(const Ray& ray, std::uint32_t wall) const;
  std::optional<bool> comes_first(const Ray& ray, std::uint32_t a, std::uint32_t b) const;

  std::span<const Point<D>> points_;
  std::vector<Wall<D>> walls_;
  std::vector<Box<D>> boxes_;
  BoxTree<D> tree_;
  double reach_ = 0;  ///< longer than the box of all points
};

extern template class FirstHits<2>;
extern template class FirstHits<3>;

}  // namespace pgdr::detail
