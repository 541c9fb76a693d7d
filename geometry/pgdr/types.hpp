// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The vocabulary of all layers: points, ids. Depends on the standard library alone. Plain values, any thread.
#pragma once

#include <array>
#include <compare>
#include <cstddef>
#include <cstdint>

#include "pgdr/export.hpp"

namespace pgdr PGDR_API {

/// A point of the plane (D = 2) or of space (D = 3); coordinates in the units of the input.
template <int D>
struct Point {
  static_assert(D == 2 || D == 3);
  std::array<double, D> x{};  ///< the coordinates

  /// Coordinate i, 0 <= i < D, not checked.
  constexpr double& operator[](int i) { return x[static_cast<std::size_t>(i)]; }
  /// Coordinate i, 0 <= i < D, not checked.
  constexpr double operator[](int i) const { return x[static_cast<std::size_t>(i)]; }
  /// Equal coordinates (so -0 equals 0).
  friend constexpr bool operator==(const Point&, const Point&) = default;
};

using Point2 = Point<2>;  ///< of the plane
using Point3 = Point<3>;  ///< of space

/// Lexicographic order of coordinates: the one total order of points that decisions rest on (never ids).
template <int D>
constexpr bool lex_less(const Point<D>& a, const Point<D>& b) {
  for (int i = 0; i < D; ++i) {
    if (a[i] < b[i]) return true;
    if (b[i] < a[i]) return false;
  }
  return false;
}

/// Squared Euclidean distance, summed in the order of the axes.
template <int D>
constexpr double squared_distance(const Point<D>& a, const Point<D>& b) {
  double s = 0;
  for (int i = 0; i < D; ++i) s += (a[i] - b[i]) * (a[i] - b[i]);
  return s;
}

/// The corners of a simplex of full dimension.
template <int D>
using Simplex = std::array<Point<D>, D + 1>;

/// Exact signs. For orientations: positive = counter-clockwise (2D), det[b-a; c-a; d-a] > 0 (3D).
enum class Sign : int { negative = -1, zero = 0, positive = 1 };

/// The opposite sign.
constexpr Sign operator-(Sign s) { return static_cast<Sign>(-static_cast<int>(s)); }
/// Of a number; zero for a NaN.
template <class Number>
constexpr Sign sign_of(const Number& v) {
  return v > 0 ? Sign::positive : v < 0 ? Sign::negative : Sign::zero;
}

/// Number of a segment, or of a facet, of a Domain, counted from 0; of a domain point where an EntityRef names a vertex.
using EntityId = std::uint32_t;
inline constexpr EntityId no_entity = 0xffffffffu;  ///< no entity has this id

/// The kinds of entities of a Domain (domain.hpp), by ascending dimension.
enum class EntityKind : std::uint8_t { vertex, segment, facet, volume };
/// The name of an entity: its kind, and its number among those of its kind.
struct EntityRef {
  EntityKind kind = EntityKind::volume;  ///< what it is
  EntityId id = no_entity;               ///< a domain point, segment or facet; no_entity for the volume
  friend bool operator==(const EntityRef&, const EntityRef&) = default;  ///< the same entity
};

}  // namespace pgdr
