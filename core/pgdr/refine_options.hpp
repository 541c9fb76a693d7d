// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The options of a refinement. Plain values.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <stop_token>

#include "pgdr/domain.hpp"
#include "pgdr/export.hpp"
#include "pgdr/point_selector.hpp"
#include "pgdr/predicates.hpp"
#include "pgdr/region_mode.hpp"
#include "pgdr/sizing.hpp"

namespace pgdr PGDR_API {

/// How far a run is, for a progress line or a bar; approximate.
struct Progress {
  std::uint64_t vertices = 0;  ///< vertices so far
  std::uint64_t waiting = 0;   ///< entries on the work lists; 0 while the boundary is recovered
  const char* stage = "";      ///< what it is at: "recover", "insert", ..., as StageTime::name; in the end "done". Lives for ever
  std::optional<double> done;  ///< about this share of its time is over: from 0 to 1, never falls; none while nothing is known
};

/// The order in which leaves of the tree are visited.
enum class Schedule {
  reproducible,  ///< the tree follows the mesh, and the mesh is the same, bit for bit, for any number of threads
  /// All leaves are of one size, and are visited in 2^D phases, each of leaves that are apart. Such a mesh does not depend on the
  /// number of threads either, nor on that of ranks (pgdr/ranks.hpp). For sizes that vary little.
  uniform,
  greedy,  ///< whatever is free runs next, and the mesh depends on timing, which shows what reproducibility costs
};
/// What runs the visits. A reproducible mesh does not depend on it.
enum class Executor {
  flow_graph,  ///< a oneTBB flow graph in the caller's arena
  threads,     ///< plain threads, for thread sanitizers, which do not see through TBB
  serial,      ///< the calling thread alone
  /// For tests: the calling thread, in a random order of the visits that need not wait, with other numbers for all cells and
  /// vertices after each generation. `threads` seeds both, and says how many pools of memory there are. So an error that takes
  /// luck elsewhere is there again at the next run.
  shuffled,
};

/// What a visit of a leaf claims: no other visit runs there meanwhile. Where all leaves are of one size both are the same.
enum class ClaimRule {
  boxes,   ///< the leaf's box, grown by its own side on every face, whatever leaves that is in
  leaves,  ///< the leaf and BUF(leaf), whole leaves however large: the dissertation's rule, by which fine leaves beside a coarse
           ///< one wait
};

/// How the work is divided; the defaults are good. A mesh that is not made greedily depends on `schedule`, `granularity`,
/// `split_ratio`, `floor`, `claims`, `claim_order` and `lattice`, and on nothing else here.
struct ScheduleOptions {
  Schedule schedule = Schedule::reproducible;  ///< order of the visits
  Executor executor = Executor::flow_graph;    ///< what runs them
  /// Threads to ask for, not negative; 0: all that the caller's arena has. Never more run than TBB allows the program.
  int threads = 0;
  /// A visit ends after this many buckets, at least 1 (factors of two) of circumradius below its largest, if the leaf still holds
  /// work.
  int granularity = std::numeric_limits<int>::max();
  /// An element belongs to the smallest node around it whose side times split_ratio is its circumradius or more; by leaves, to
  /// the leaf, which does not split while an element in it is too large for its children. Uniform: half of its side, as the
  /// claims grow by half a side.
  double split_ratio = 0.5;
  /// A leaf splits once this many poor elements wait in it for its children, or three times as many will take the place of those
  /// that are too big.
  /// 0: 1000 in 3D, 2000 in 2D.
  std::size_t floor = 0;
  ClaimRule claims = ClaimRule::boxes;  ///< what a visit claims
  /// By boxes a visit claims its leaf's box, grown by claim_order times its side; by leaves, the leaf L and BUF^claim_order(L).
  std::uint32_t claim_order = 1;
  /// Uniform: the lattice has 2^lattice cells at most along each axis of the tree's root, two along the side of a leaf, also
  /// called a window. 1 to most_lattice<D>(). 0: as many as give a leaf some four thousand elements.
  int lattice = 0;
  /// Record when each visit ran, and where (`RefineResult::trace`).
  bool trace = false;
};

/// The finest lattice of the uniform schedule.
template <int D>
constexpr int most_lattice() {
  return D == 2 ? 10 : 7;
}

constexpr double default_min_dihedral = 15;  ///< degrees; mostly reached where the input has no needles and no small angles
constexpr double most_min_dihedral = 35;     ///< degrees; above 30 there is mostly no such mesh

/// What `refine` is asked for. A plain value: the callbacks in it are copied with it, and are called from several threads.
template <int D>
struct RefineOptions {
  /// Upper bound on circumradius over shortest edge. Proved for >= 2 (3D, without the optimiser), >= sqrt 2 (2D), away from small
  /// angles of the input.
  double radius_edge_bound = smallest_proved_bound<D>();
  SizingField<D> size;                                          ///< circumradius (3D) or area (2D) bound at the centroid
  RegionSizes<D> region_sizes;                                  ///< further such bounds, on the cells of single regions
  double max_volume = std::numeric_limits<double>::infinity();  ///< 3D: volume bound of all cells; 2D: must be infinite
  RegionMode regions = RegionMode::seeds;                       ///< what is meshed, and how it is labelled
  /// 3D: bound on the dihedral angles of all cells in degrees, from 0 to most_min_dihedral, reached by an optimiser after the
  /// refinement, which gives up that cells are Delaunay. None: default_min_dihedral, or 0 with a selector that is not the default
  /// one, whose points the optimiser would move. 0: no optimiser.
  std::optional<double> min_dihedral;
  PointSelector<D> selector = default_selector<D>();               ///< empty: circumcentre
  DiskOptions disk = default_disk<D>();                            ///< the disk in which the selector may put a point
  OutsidePolicy outside = OutsidePolicy::replace_by_circumcenter;  ///< what becomes of points outside of it (and NaN)
  bool refine = true;                                              ///< false: boundary recovery alone
  /// 2D: no new point on any segment. Elements that this leaves poor have the reason kept_boundary.
  bool keep_boundary = false;
  double min_edge = 0;  ///< insertions that would make an edge shorter than this are refused
  std::uint64_t max_vertices = std::numeric_limits<std::uint64_t>::max();  ///< a budget; input points count
  std::optional<std::chrono::duration<double>> time_limit;  ///< seconds from the call; then the mesh so far is returned
  /// Cancels the run, from any thread. Each visit ends with the insertion that it is at; then the mesh so far is returned,
  /// unless `partial_mesh` says no.
  std::stop_token stop;
  /// What a run that was cancelled (by `stop`, or as part of the caller's tasks) returns. True: the mesh so far, valid, its
  /// Steiner points and cells in no particular order (as after the time limit), without reasons. False: no mesh, sooner.
  bool partial_mesh = true;
  /// Leaves the points of the input that are in no cell, as they lie outside or in voids, out of the mesh. They are counted, and
  /// warned of, either way.
  bool drop_unused_points = false;
  bool leaves = false;       ///< tell for each cell which leaf of the tree holds its circumcentre (OutputMesh::leaves)
  ScheduleOptions schedule;  ///< threads, and how work is divided among them
  /// Refuse at once, by a ResourceError, an input in whose gaps there are more cells than there is memory for (require_memory()
  /// in estimate.hpp); it takes half a second for a million triangles. Not looked at where `max_vertices`, `time_limit`,
  /// `min_edge` or `keep_boundary` bound the run, nor without `refine`.
  bool memory_guard = true;
  /// Called once, by the thread that calls `refine`, with the input that was checked and before anything is meshed: for an
  /// estimate, say. May throw.
  std::function<void(const Domain<D>&)> prepared;
  /// Called by one thread at a time, a few times a second at most, from any of the threads; and once in the end, unless the run
  /// was cancelled, with all of it done. May throw.
  std::function<void(const Progress&)> progress;
};

/// 2D: the radius-edge bound that no triangle without an angle below `degrees` exceeds, and no other meets: 1 / (2 sin). For
/// `options.radius_edge_bound = min_angle_degrees(25)`, and for CheckOptions. Up to 20.7 degrees there is a proof; beyond some 33
/// few triangles meet it.
/// @throws UsageError bad_option: not above 0 and at most 60
double min_angle_degrees(double degrees);

/// Why a run ended.
enum class StopCause { finished, max_vertices, min_edge, time_limit, cancelled };

}  // namespace pgdr
