// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Inputs whose meshes have sides that correspond, vertex by vertex: cells that repeat.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "pgdr/export.hpp"
#include "pgdr/output_mesh.hpp"
#include "pgdr/periodic.hpp"
#include "pgdr/plc.hpp"
#include "pgdr/poor_reason.hpp"
#include "pgdr/refine_options.hpp"

namespace pgdr PGDR_API {

/// An input to mesh, and how.
template <int D>
struct PeriodicInput {
  Plc<D> plc;                           ///< the given one, with its periodic sides in pieces that correspond
  bool keep_boundary = false;           ///< RefineOptions::keep_boundary must be set: the sides do not stay in step without
  std::vector<int> kept_markers;        ///< and RefineOptions::kept_markers be these
  std::uint32_t rounds = 0;             ///< how often it (3D: the sides) was meshed to find that
  std::uint64_t added_points = 0;       ///< behind those of the given input
  std::vector<PeriodicSides<D>> sides;  ///< as asked for, each with its motion

  /// 3D, where the sides were divided: of each facet of `plc` the one of the given input that it is of, or is part of. Else
  /// empty.
  std::vector<std::uint32_t> given_facets;
  /// 3D: edges of the triangles of sides that are on no segment of the given input; points of `plc`, the smaller first, sorted.
  std::vector<std::array<std::uint32_t, 2>> inner_edges;
};

/// Divides periodic sides as their meshes ask for it, both alike, so that periodic_pairs() of the mesh of the result holds.
///
/// The input is meshed. A piece of a side that the mesh has cut, at either side, is cut as it has cut it where it has more cuts.
/// Cuts are made on the first side of a chain, and carried over from side to side: exactly, where the motion can be represented,
/// else rounded once. Then all that again, until the mesh cuts no piece: the sides of this mesh correspond. Where that has not
/// ended after a few rounds, the rest of the boundary becomes what the last mesh made of it, and all of it is kept, which ends.
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

/// 3D: sides are all facets of a marker, planar or not. The first side of each chain is meshed as a surface, plane by plane, by
/// the refinement of 2D; its triangles are facets of the result, and so are their images on the other sides. All of these are
/// kept.
///
/// How large triangles are: a mesh of the input without pairs is made first, without the optimiser. At no place a triangle has
/// more than twice the area of an equilateral one with the circumradius that this mesh has there, on any side of the chain; and
/// no triangle with angles of 30 degrees or more has a larger circumradius than `size` says, on any side. Angles are 20.7 degrees
/// or more, where those of the lines on the sides are not smaller.
///
/// Lines of the sides, where facets meet them, are pieces as those of 2D: cut where the meshes of the planes cut them, until
/// these cut none; after so many rounds their outlines are kept. An edge may belong to several sides, as those of a cell do:
/// all its images under any of the motions are cut alike. What one side alone has (a point, or a line where an inner facet
/// meets it) the others get.
/// @param plc  the input
/// @param sides  pairs of markers of facets
/// @param options  those of the mesh. Where they keep the facets of sides these stay as given, and it is up to these to
/// correspond;
///   where `refine` is not set, no point is added but partners
/// @param most_rounds  so often planes are meshed before their outlines are kept
/// @throws UsageError bad_option: as in 2D; a place of one side that is on no facet of another, or lines of several that cross
PeriodicInput<3> make_periodic(const Plc<3>& plc, std::span<const PeriodicSides<3>> sides, const RefineOptions<3>& options,
                               std::uint32_t most_rounds = 16);

/// Tells the mesh of a `plc` of make_periodic() in terms of the given input: the inner edges of sides are no subsegments, and
/// reasons name facets of the given input.
void name_as_given(const PeriodicInput<3>& made, OutputMesh<3>& mesh, std::vector<PoorReason>& reasons);

}  // namespace pgdr
