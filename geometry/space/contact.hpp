// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The contact of two pieces of an input (a point, a segment, or a triangle each): where they meet although they should not. Two
// pieces may meet in the hull of their common corners and nowhere else. Exact, without tolerance. Pure functions, any thread.
//
// Why the hits below are all: the intersection of two pieces is convex, the hull of its extreme points, and an extreme
// point is a corner of one that lies on the other, or the inside of an edge of one crossing the inside of an edge or of
// the triangle of the other in one point. Each of these, the common corners excepted, is outside of the common hull.
// (The one exception is two triangles with the same corners; they overlap.)
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "pgdr/types.hpp"

namespace pgdr::detail {

/// A simplex by its corners; a triangle (3D) is positively oriented in the projection along `axis`.
struct Piece {
  std::array<std::uint32_t, 3> corners{no_entity, no_entity, no_entity};
  std::uint8_t count = 0;  ///< of corners
  std::uint8_t axis = 0;
  EntityId owner = no_entity;  ///< the facet or the segment of a Domain that it is of
  bool has(std::uint32_t v) const { return corners[0] == v || corners[1] == v || corners[2] == v; }
  std::span<const std::uint32_t> points() const { return std::span(corners).first(count); }
  /// @pre it is of a Domain
  EntityRef entity() const {
    if (count == 3) return {EntityKind::facet, owner};
    return count == 2 ? EntityRef{EntityKind::segment, owner} : EntityRef{EntityKind::vertex, corners[0]};
  }
};

/// How two pieces meet, and where.
struct Contact {
  enum class Kind : std::uint8_t {
    none,
    touch,    ///< only corners of the one on the other (and what lies between such)
    cross,    ///< an edge through the inside of an edge or of a triangle
    overlap,  ///< of triangles of one plane: an area in common
  };
  /// A corner of one piece on the other.
  struct Corner {
    std::uint32_t point;
    std::array<std::uint32_t, 2> edge{no_entity, no_entity};  ///< on the inside of this edge; else of the triangle
    bool of_second = false;                                   ///< whose corner `point` is
  };
  /// An edge (a corner twice: that corner) through an edge, or a triangle of three corners.
  struct Crossing {
    std::array<std::uint32_t, 2> edge;
    std::array<std::uint32_t, 3> through{no_entity, no_entity, no_entity};
  };
  Kind kind = Kind::none;
  std::vector<Corner> corners;
  std::vector<Crossing> crossings;
};

/// The contact of a and b, whose corners are indices into `points` (pairwise distinct). `same_plane`: it is known that
/// two triangles lie in one plane.
template <int D>
Contact contact(std::span<const Point<D>> points, const Piece& a, const Piece& b, bool same_plane = false);

/// Where it is, for messages: the distinct points of its hits, rounded; of overlapping triangles the corners of the
/// area in common. Sorted lexicographically.
template <int D>
std::vector<Point<D>> contact_points(std::span<const Point<D>> points, const Contact& c);

}  // namespace pgdr::detail
