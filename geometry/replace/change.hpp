// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Local changes of a surface: some faces go, others with the same rim come in their place, and one vertex at most moves.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "replace/complex.hpp"

namespace pgdr::detail {

/// A change that could be made. Says nothing of whether it may.
struct SurfaceChange {
  enum class Kind : std::uint8_t { contract, flip, move, split };
  Kind kind = Kind::contract;
  std::uint32_t u = no_index, v = no_index;  ///< the edge; of a move, u alone. A contraction takes u away
  std::uint32_t moved = no_index;            ///< the vertex that is at `place` after it; of a split the number that it will get
  Point3 place{};
  std::vector<std::uint32_t> gone;  ///< faces
  std::vector<SurfaceFace> come;
  std::vector<std::uint32_t> from;  ///< of each of `come` one of `gone`, whose class it has
  /// Kept edges that go, and that come, with their curves. Of a vertex that moves along its curve both have the same ends.
  struct Kept {
    std::array<std::uint32_t, 2> ends;
    std::uint32_t curve;
  };
  std::vector<Kept> kept_gone, kept_come;

  bool is_gone(std::uint32_t f) const { return std::find(gone.begin(), gone.end(), f) != gone.end(); }
};

/// Is the surface with u and v put together the same, up to a homeomorphism (the link conditions of Dey, Edelsbrunner, Guha and
/// Nekhayev, 1999)? For either into the other. Do the faces at u and v, and their edges, become the same ones only where they
/// have to? @pre uv is an edge
bool is_contractible(const SurfaceComplex& s, std::uint32_t u, std::uint32_t v);
/// Puts u into v, which is at `place` then: at its own, or at another where both are free. None if u may not go, or a curve would
/// be another. @pre is_contractible(s, u, v)
std::optional<SurfaceChange> contraction(const SurfaceComplex& s, std::uint32_t u, std::uint32_t v, const Point3& place);
/// The other diagonal of the two faces at a plain edge; none if it is an edge already, or the edge is not plain.
std::optional<SurfaceChange> flip(const SurfaceComplex& s, std::uint32_t a, std::uint32_t b);
/// A vertex that is not fixed goes to another place.
SurfaceChange move(const SurfaceComplex& s, std::uint32_t v, const Point3& place);
/// A new vertex on an edge.
SurfaceChange split(const SurfaceComplex& s, std::uint32_t a, std::uint32_t b, const Point3& place);

/// Takes the faces out of their flat groups that are no part of these any more. @param read  what was looked at is added
/// @returns false if that breaks a wide one
bool regroup(const SurfaceComplex& s, SurfaceChange& change, Box<3>& read);

/// Where a vertex is after the change.
inline const Point3& place_after(const SurfaceComplex& s, const SurfaceChange& c, std::uint32_t v) {
  return v == c.moved ? c.place : s.at(v);
}
/// The corners of a face that comes, as they will be.
inline std::array<Point3, 3> triangle_after(const SurfaceComplex& s, const SurfaceChange& c, const SurfaceFace& f) {
  return {place_after(s, c, f.corners[0]), place_after(s, c, f.corners[1]), place_after(s, c, f.corners[2])};
}

}  // namespace pgdr::detail
