// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// What a mesh of an input will be like, before it is made: how near its entities are to each other, at what angles they meet, and
// how many cells it takes at least. Near-linear time (half a second for a million triangles), but for inputs of long thin
// triangles whose boxes all overlap. What comes out does not depend on the number of threads. Pure functions; long loops run on
// the threads of the caller's tbb::task_arena, and any number of calls may run at once.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <stop_token>
#include <string>

#include "pgdr/domain.hpp"
#include "pgdr/export.hpp"
#include "pgdr/types.hpp"

namespace pgdr PGDR_API {

/// Two entities of a Domain without a common point, and where they are nearest to each other.
template <int D>
struct Gap {
  double distance = 0;                ///< in units of the input, rounded
  std::array<EntityRef, 2> entities;  ///< vertices (domain points), segments or facets, those of the largest dimension there
  std::array<Point<D>, 2> points;     ///< on each of them, rounded
};

/// Two segments with a common point, or two facets with a common segment, and their angle.
template <int D>
struct SharpAngle {
  double degrees = 180;               ///< the angle
  std::array<EntityRef, 2> entities;  ///< that meet at it
  Point<D> point;                     ///< that they share
};

/// Which gaps count: by what is between the two entities. Meshed is what walls (facets, 2D: segments) enclose, but for holes, and
/// each wall that has any of it on a side.
enum class GapsIn : std::uint8_t {
  meshed,      ///< what takes cells
  not_meshed,  ///< the outside, and voids
  all_space,   ///< any two entities
};

/// What is asked of narrowest_gap.
struct GapOptions {
  GapsIn in = GapsIn::meshed;     ///< those that count
  bool voids_by_nesting = false;  ///< as RegionMode::automatic: what is void by nesting alone is not meshed
  /// Only gaps of at most this width are looked for, in units of the input. Where few or none count, as outside of a convex body,
  /// it is by this that few pairs are looked at.
  double within = std::numeric_limits<double>::infinity();
  std::stop_token stop = {};  ///< ends it by a CancelledError
};

/// The nearest two entities without a common point; none if there are no two. Of more than some hundred million pairs of pieces
/// with boxes that meet not all are looked at: then it is one of the nearest.
/// @throws CancelledError
template <int D>
std::optional<Gap<D>> narrowest_gap(const Domain<D>& domain, const GapOptions& options = {});

/// The least angle between two segments at a point or two facets at a segment; none where nothing meets. At a point of more than
/// 2000 segments only the first are compared.
/// @throws CancelledError
template <int D>
std::optional<SharpAngle<D>> least_angle(const Domain<D>& domain, const std::stop_token& stop = {});

/// What is known beside the Domain.
template <int D>
struct EstimateOptions {
  bool voids_by_nesting = false;  ///< as GapOptions
  double radius_edge_bound = 2;   ///< as RefineOptions
  /// The largest volume (area) of a cell about x, in a region of this label, that sizes allow, in units of the input; infinity:
  /// none do. Empty: none do anywhere. Those of the regions' seeds (RegionSeed::size) are looked at without it. Several threads
  /// call it.
  std::function<double(const Point<D>& x, double label)> measure;
  std::stop_token stop = {};  ///< ends it by a CancelledError
};

/// How many cells there will be at least, in a mesh that meets the bounds. What else bounds a run does not count
/// (RefineOptions::min_edge, max_vertices, keep_boundary).
template <int D>
struct CellEstimate {
  /// The largest of three: at_least; one in D + 1 of the triangles (2D: segments) on sides of walls that are meshed; the integral
  /// over what is meshed of one over the largest volume (area) that sizes allow. The second is a bound, and so is the third of
  /// sizes that are the same all over a region. A function of sizes is integrated by its values at some thousand places.
  /// Infinity: it allows none.
  double cells = 0;
  /// By gaps alone: entities without a common point, and what is meshed between, are so near to each other. Sizes do not count.
  /// It is found at some hundred places on the walls, and supposes that a vertex is joined to one of the subfacet opposite to it,
  /// which slivers between may prevent (docs/usage.md).
  double at_least = 0;
  std::optional<Gap<D>> most_due_to;  ///< the two entities that `at_least` owes most to
};

/// @throws CancelledError, and what `measure` throws
template <int D>
CellEstimate<D> estimate_cells(const Domain<D>& domain, const EstimateOptions<D>& options = {});

/// Is there memory for the cells that gaps alone need (`at_least`)? That is this machine's, or what a limit on this process or
/// its group leaves. Sizes do not count. Any thread.
template <int D>
bool has_memory_for(const CellEstimate<D>& estimate);

/// Refuses what there is no memory for, as has_memory_for() says.
/// @throws ResourceError out_of_memory: it names the two entities, with the points where they are nearest to each other
template <int D>
void require_memory(const Domain<D>& domain, const CellEstimate<D>& estimate);
/// The same of an estimate that is made only where entities are so near to each other that it may be refused: elsewhere it takes
/// a thousandth of the time that a mesh does. `measure` is not needed.
/// @throws CancelledError, and what the other throws
template <int D>
void require_memory(const Domain<D>& domain, const EstimateOptions<D>& options);

/// The number in the input (its own numbering, see `Plc::first_index`) of a vertex (a domain point), a segment or a facet; none
/// for an edge of facets that is no segment of the input.
template <int D>
std::optional<std::uint64_t> input_number(const Domain<D>& domain, EntityRef entity);

/// The two in words, by these numbers: "facets 1 and 2", "point 7 and segment 3, from point 1 to point 2".
template <int D>
std::string words_of(const Domain<D>& domain, const std::array<EntityRef, 2>& pair);

}  // namespace pgdr
