// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Which wall of an input (a triangle of a facet; 2D: a segment) a ray meets first, and which comes after that one. Exact: a ray
// through the rim of a wall is given up, and the caller takes another. Immutable once made, any thread.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "diagnose/near_pieces.hpp"
#include "space/box_tree.hpp"

namespace pgdr::detail {

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

  FirstHits(const NearPieces<D>& pieces, const Bulk& bulk);

  std::uint32_t walls() const { return walls_; }  ///< they are the first of the pieces
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

  const NearPieces<D>& pieces_;
  std::uint32_t walls_ = 0;
  std::vector<Box<D>> boxes_;
  BoxTree<D> tree_;
  double reach_ = 0;  ///< longer than the box of all points
};

extern template class FirstHits<2>;
extern template class FirstHits<3>;

}  // namespace pgdr::detail
