// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Inputs whose meshes have sides that correspond, vertex by vertex: cells that repeat. 2D.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "pgdr/export.hpp"
#include "pgdr/periodic.hpp"
#include "pgdr/plc.hpp"
#include "pgdr/refine_options.hpp"

namespace pgdr PGDR_API {

/// An input to mesh, and how.
template <int D>
struct PeriodicInput {
  Plc<D> plc;                           ///< the given one, with its periodic sides in pieces that correspond
  bool keep_boundary = false;           ///< RefineOptions::keep_boundary must be set: the sides do not stay in step without
  std::vector<int> kept_markers;        ///< and RefineOptions::kept_markers be these
  std::uint32_t rounds = 0;             ///< how often it was meshed to find that
  std::uint64_t added_points = 0;       ///< behind those of the given input
  std::vector<PeriodicSides<D>> sides;  ///< as asked for, each with its motion
};

/// Divides periodic sides as their meshes ask for it, both alike, so that periodic_pairs() of the mesh of the result holds.
///
/// The input is meshed. A piece of a side that the mesh has divided, at either side, is halved, and so are its halves, until no
/// part is longer than a piece of the mesh there. Halves are made on the first side of a chain, and carried over from side to
/// side: exactly, where the motion can be represented, else rounded once. Then all that again, until the mesh divides no piece:
/// the sides of this mesh correspond. Pieces become shorter by half each time, and no shorter than those that the mesh made by
/// itself; where that has not ended after a few rounds, the rest of the boundary becomes what the last mesh made of it, and all
/// of it is kept, which ends.
///
/// Points of the input are not moved: one that is within the tolerance of the image of another is its partner, and where one has
/// no partner, a point is added. Sides may share corners, and be chained, as 1 = 2 and 2 = 3.
/// @param plc  the input
/// @param sides  pairs of markers of segments
/// @param options  those of the mesh. With `keep_boundary` only partners of points of the input are added, and it is not meshed
/// @param most_rounds  so often it is meshed before all of the boundary is kept
/// @throws UsageError bad_option: a marker that no segment has, or both of a pair; sides that do not match within the tolerance;
///   pairs that contradict each other, by other motions: with the points and where they are. What `refine` throws
PeriodicInput<2> make_periodic(const Plc<2>& plc, std::span<const PeriodicSides<2>> sides, const RefineOptions<2>& options,
                               std::uint32_t most_rounds = 16);

}  // namespace pgdr
