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
#include <vector>

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
/// Lengths are in the units of the coordinates. `refine` throws a UsageError (bad_option) that names what is not as REQUIRED
/// here.
///
///   pgdr::RefineOptions<3> options;
///   options.radius_edge_bound = 2;                                                  // the default, and the least that is proved
///   options.size = [](const pgdr::Point3& p) { return 0.1 + 0.1 * p[2]; };          // circumradii: finer at the bottom
///   options.region_sizes = {{7.0, pgdr::SizingField<3>(0.05)}};                     // and at most this in the region labelled 7
///   options.schedule.threads = 4;                                                   // the mesh does not depend on it
///   options.time_limit = std::chrono::seconds(60);                                  // then the mesh so far
///   const auto result = pgdr::refine(plc, options);
template <int D>
struct RefineOptions {
  // ---- what is asked of the cells ------------------------------------------------------------------------------------

  /// Upper bound on circumradius over shortest edge, of each cell. Proved for the default or more (3D: without the optimiser),
  /// away from small angles of the input. In 2D min_angle_degrees() makes it of an angle. DEFAULT: 2 (3D), the square root of 2
  /// (2D: 20.7 degrees). REQUIRES: above 0; below what is proved a warning says so.
  double radius_edge_bound = smallest_proved_bound<D>();

  /// Bound on the circumradius (3D) or the area (2D) of a cell, at its centroid. A number, or a function that several threads may
  /// call at once and that says the same of a point each time; it may throw, which ends the run. DEFAULT: none. REQUIRES: above
  /// 0.
  SizingField<D> size;

  /// Further such bounds, by label of the region, on the cells of single regions. DEFAULT: none. REQUIRES: sizes above 0.
  RegionSizes<D> region_sizes;

  /// 3D: bound on the volume of each cell. DEFAULT: infinity, none. REQUIRES: above 0; 2D: infinity.
  double max_volume = std::numeric_limits<double>::infinity();

  /// 3D: bound on the dihedral angles of all cells in degrees, worked for by an optimiser after the refinement, which gives up
  /// that cells are Delaunay. 0: no optimiser. DEFAULT: none, which is default_min_dihedral, or 0 with a selector that is not the
  /// default one, whose points the optimiser would move. REQUIRES: 0 to most_min_dihedral, and `refine`; 2D: none, or 0.
  std::optional<double> min_dihedral;

  // ---- what of the input is meshed, and where points may be ----------------------------------------------------------

  /// What is meshed, and how it is labelled. DEFAULT: every volume but those of hole seeds.
  RegionMode regions = RegionMode::seeds;

  /// False: boundary recovery alone, without a bound. DEFAULT: true.
  bool refine = true;

  /// No new point on any segment or facet. 3D: each triangle of the input is one subfacet, each edge of a polygon one subsegment;
  /// a polygon of more corners, or one that others touch, is triangulated once. Elements that this leaves poor have the reason
  /// kept_boundary. A Domain that is given keeps the segments and facets that it has: make it of with_kept_edges()
  /// (kept_edges.hpp). DEFAULT: false. REQUIRES: in 3D one process (no ranks).
  bool keep_boundary = false;

  /// With `keep_boundary`: the facets (2D: segments) with these markers alone are kept, and the edges that these have; the others
  /// are refined as always. DEFAULT: none, all are kept. REQUIRES: none without `keep_boundary`.
  std::vector<int> kept_markers;
  /// 2D: subsegments are split until none has a vertex of a cell inside its diametral circle but such as lie on its own segment.
  /// So every triangle is Delaunay, across subsegments, too, and circumcentres lie in the domain: a dual mesh of Voronoi cells is
  /// there (core/refine/encroachment.hpp has the proof that it ends). What lies beyond a void does not count. DEFAULT: false.
  /// REQUIRES: 2D, `refine`, and not `keep_boundary`. With `radius_edge_bound` infinite, this alone adds points.
  bool conforming_delaunay = false;

  /// Insertions that would make an edge shorter than this are refused; it is a length. DEFAULT: 0. REQUIRES: not negative.
  double min_edge = 0;

  /// Where a new point goes, for an element and the mesh about it (point_selector.hpp). Called by several threads at once.
  /// DEFAULT: circumcentres (3D), off-centres (2D).
  PointSelector<D> selector = default_selector<D>();
  /// The disk in which the selector may put a point. DEFAULT: that in which any choice ends the run.
  DiskOptions disk = default_disk<D>();
  /// What becomes of its points outside of the disk (and NaN). DEFAULT: the circumcentre in their place, which is counted.
  OutsidePolicy outside = OutsidePolicy::replace_by_circumcenter;

  // ---- when it ends --------------------------------------------------------------------------------------------------

  /// So many vertices at most, those of the input among them; then the mesh so far is returned. DEFAULT: no limit.
  std::uint64_t max_vertices = std::numeric_limits<std::uint64_t>::max();

  /// Seconds from the call; then the mesh so far is returned, which is not reproducible. DEFAULT: none. REQUIRES: not negative.
  std::optional<std::chrono::duration<double>> time_limit;

  /// Cancels the run, from any thread. Each visit ends with the insertion that it is at; then the mesh so far is returned,
  /// unless `partial_mesh` says no. DEFAULT: nothing can.
  std::stop_token stop;

  /// What a run that was cancelled (by `stop`, or as part of the caller's tasks) returns. True: the mesh so far, valid, its
  /// Steiner points and cells in no particular order (as after the time limit), without reasons. False: no mesh, sooner.
  /// DEFAULT: true.
  bool partial_mesh = true;

  /// Refuse at once, by a ResourceError, an input in whose gaps there are more cells than there is memory for (require_memory()
  /// in estimate.hpp); it takes half a second for a million triangles. Not looked at where `max_vertices`, `time_limit`,
  /// `min_edge` or `keep_boundary` bound the run, nor without `refine`. DEFAULT: true.
  bool memory_guard = true;

  // ---- how it runs, and what it tells --------------------------------------------------------------------------------

  /// Threads, and how work is divided among them. DEFAULT: all threads of the caller's arena, the same mesh for any number.
  ScheduleOptions schedule;

  /// Leaves the points of the input that are in no cell, as they lie outside or in voids, out of the mesh. They are counted, and
  /// warned of, either way. DEFAULT: false.
  bool drop_unused_points = false;

  /// Tell for each cell which leaf of the tree holds its circumcentre (OutputMesh::leaves). DEFAULT: false.
  bool leaves = false;

  /// Called once, by the thread that calls `refine`, with the input that was checked and before anything is meshed: for an
  /// estimate, say. May throw. DEFAULT: none.
  std::function<void(const Domain<D>&)> prepared;

  /// Called by one thread at a time, a few times a second at most, from any of the threads; and once in the end, unless the run
  /// was cancelled, with all of it done. May throw. DEFAULT: none.
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
