// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Another surface in the place of the given one: within a distance of it, both ways and marker by marker, of the same topology,
// with its borders, creases, corners, segments and volumes, and without the needles that a mesh would have to keep
// (docs/surface.md). A plain function from Plc to Plc: call it, then make a Domain of the result, then `refine`.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <stop_token>
#include <vector>

#include "pgdr/export.hpp"
#include "pgdr/plc.hpp"
#include "pgdr/types.hpp"

namespace pgdr PGDR_API {

/// How far the other surface may be, and what it is wanted for.
struct SurfaceOptions {
  double tolerance = 0;       ///< E, an absolute length in the units of the coordinates: most that one surface is from the other
  double feature_angle = 40;  ///< degrees: facets of one marker whose normals differ by more meet at a crease; 180: none do
  double wanted_corner = 30;  ///< degrees: angles of facets that are smaller are made larger where that is possible
  /// The size that a mesh is to have here: no edge is made longer than twice the size at its ends. Empty: E alone limits. Several
  /// threads may call it at once, as they do a SizingField: it has to be the same for the same point whoever asks.
  std::function<double(const Point3&)> size;
  std::vector<int> fixed_markers;  ///< facets with these stay as they are, with all of their points
  std::stop_token stop;            ///< ends the step after any change, with a valid surface
};

/// What was done.
struct SurfaceReport {
  double tolerance = 0;                            ///< SurfaceOptions::tolerance
  double used = 0;                                 ///< the distance that changes were held to: a little less
  double feature_angle = 0;                        ///< degrees
  std::array<std::uint64_t, 2> triangles{};        ///< of the surface as given, and of the other; likewise below
  std::array<std::uint64_t, 2> sharp_triangles{};  ///< with a counted corner below 14.5 degrees
  std::array<double, 2> smallest_corner{};         ///< the least counted corner, in degrees; 180: none is counted
  std::array<double, 2> sharp_heights{};           ///< least heights of the sharp triangles as given: median, largest; 0: none
  std::array<std::uint64_t, 2> flat_groups{};      ///< of two triangles or more
  std::uint64_t creases = 0;                       ///< edges of creases as given
  std::uint64_t corners = 0;                       ///< vertices that are kept in place
  std::uint64_t contracted = 0;                    ///< edges, to a point
  std::uint64_t flipped = 0;                       ///< edges, to the other diagonal
  std::uint64_t moved = 0;                         ///< vertices
  std::uint64_t split = 0;                         ///< edges, by a new vertex
  /// Changes that were not made, by the first test that refused them.
  struct Refused {
    std::uint64_t angle = 0;     ///< a corner too small, a wide flat group broken, or nothing won where all corners are as wanted
    std::uint64_t fold = 0;      ///< a ridge that was not there
    std::uint64_t cells = 0;     ///< more cells expected; of a split with what follows from it
    std::uint64_t size = 0;      ///< an edge longer than the sizes there
    std::uint64_t distance = 0;  ///< too far, of facets or of curves
    std::uint64_t meets = 0;     ///< facets would cross or touch
    std::uint64_t gap = 0;       ///< a gap too narrow
    std::uint64_t swept = 0;     ///< something would be on its other side
  } refused;                     ///< how many of each
  /// Triangles with corners smaller than wanted for which not all was tried: the effort, so many changes a triangle, was spent.
  std::uint64_t given_up = 0;
  double to_given = 0;      ///< the largest distance that a vertex of the other surface is from the given one
  double from_given = 0;    ///< the largest that a given one is from the other surface
  Point3 farthest_point{};  ///< where the larger of these is
  bool stopped = false;     ///< the caller's token ended it early
  double seconds = 0;       ///< that it took
};

/// The other surface, and what it stands for.
struct ReplacedSurface {
  /// Holes, regions, names, points of no facet and segments as in the input; facets are polygons where the surface is flat.
  /// Points and facets are in an order that depends on the geometry alone, not on the numbering of the input.
  Plc<3> plc;
  SurfaceReport report;                       ///< of what was done
  std::vector<std::uint32_t> facet_of_input;  ///< of each facet of plc an input facet that it is near
};

/// The surface within `options.tolerance` of the input's (docs/surface.md). A function of the input's geometry: the same for any
/// order of its points and facets, and any number of threads. Runs on the calling thread and those of its tbb::task_arena.
/// @throws UsageError bad_option: the tolerance is not positive and finite, or below 16 times the one within which things meet
///   (tolerance_of), or an angle is outside of [0, 180]. InputError as a Domain and require_no_errors do; seed_on_boundary: a
///   hole or region seed within the tolerance of the surface. CancelledError: stopped before there was a surface to begin with.
ReplacedSurface replace_surface(const Plc<3>& input, const SurfaceOptions& options);

}  // namespace pgdr
