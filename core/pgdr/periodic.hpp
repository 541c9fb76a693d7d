// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Sides of a mesh that are one but for a motion, as those of a cell that repeats: which vertices of one are which of the other.
// Decided from the mesh alone, however it was made. Pure functions, any thread.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "pgdr/export.hpp"
#include "pgdr/output_mesh.hpp"

namespace pgdr PGDR_API {

/// A rigid motion, row by row: of each coordinate of the image the D factors of x, y(, z), and what is added. No scaling.
template <int D>
using Motion = std::array<double, static_cast<std::size_t>(D*(D + 1))>;

/// Two sides, by the markers of their segments (3D: facets).
template <int D>
struct PeriodicSides {
  int from = 0;                       ///< marker of the one that the other is an image of
  int to = 0;                         ///< and of that one
  std::optional<Motion<D>> motion{};  ///< which takes `from` to `to`. None: the translation between the boxes of the two
};

/// The vertices of two sides, one to one.
struct PeriodicPairs {
  int from = 0;                                      ///< markers
  int to = 0;                                        ///< likewise
  std::vector<double> motion;                        ///< a Motion, as given or found
  std::vector<std::array<std::uint32_t, 2>> points;  ///< vertex of `from`, and its image; ascending
  std::uint64_t walls = 0;                           ///< so many subsegments (3D: subfacets) of each, image by image
  std::uint64_t exact = 0;                           ///< of the points: the image is that by the motion, exact and rounded once
  double largest_gap = 0;                            ///< most that an image is from that
};

/// What a file says of sides that correspond (InputFile::read_periods). None of it is verified.
struct StatedPeriods {
  std::vector<PeriodicPairs> pairs;        ///< markers, and motions where there are any; of a .msh `points`; all else 0
  std::vector<std::uint32_t> periodic_of;  ///< of a .vtu, as periodic_of(); else empty
};

/// Of each of so many vertices the smallest that is one with it where all these are: itself, if there is no other.
std::vector<std::uint32_t> periodic_of(const std::vector<PeriodicPairs>& pairs, std::size_t vertices);

/// @throws UsageError bad_option: lengths or angles do not stay, but for the digits that a motion was written with
template <int D>
void require_rigid(const Motion<D>& motion);

/// The image of a point, exact and rounded once a coordinate.
template <int D>
Point<D> moved(const Motion<D>& motion, const Point<D>& p);

/// The translation that takes the box of some points to that of others.
template <int D>
Motion<D> translation_between(const std::vector<Point<D>>& from, const std::vector<Point<D>>& to);

/// Pairs the vertices of two sides of a mesh, if they correspond one to one and their subsegments (3D: subfacets) do, too.
/// n log n.
/// @param mesh  any; its walls need markers
/// @param sides  by markers
/// @param tolerance  most that a vertex may be from the image of its partner
/// @throws UsageError bad_option: no wall has one of the markers; the motion is none; or the sides do not correspond: with the
///   vertices and where they are
template <int D>
PeriodicPairs periodic_pairs(const OutputMesh<D>& mesh, const PeriodicSides<D>& sides, double tolerance);

/// The sides that a file names. @throws UsageError bad_option: a motion has another number of numbers than motions in D
/// dimensions
template <int D>
std::vector<PeriodicSides<D>> stated_sides(const StatedPeriods& stated);

/// Does a file say what is so?
/// @param found  the pairs of all stated_sides() of its mesh
/// @param stated  what the file says
/// @throws UsageError bad_option, with the vertices, where it pairs others
void require_as_stated(const std::vector<PeriodicPairs>& found, const StatedPeriods& stated);

}  // namespace pgdr
