// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The public entry: from an input to a finished mesh. No global state, no printing. Several calls may run at once from
// several threads. Callbacks (size, selector) are called concurrently; progress from one thread at a time.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "pgdr/domain.hpp"
#include "pgdr/export.hpp"
#include "pgdr/output_mesh.hpp"
#include "pgdr/plc.hpp"
#include "pgdr/point_selector.hpp"
#include "pgdr/poor_reason.hpp"
#include "pgdr/predicates.hpp"
#include "pgdr/refine_options.hpp"
#include "pgdr/region_volume.hpp"
#include "pgdr/sizing.hpp"

namespace pgdr PGDR_API {

/// When a stage of a run began, and how long it took.
struct StageTime {
  std::string name;    ///< of the stage
  double start = 0;    ///< seconds since the meshing began
  double seconds = 0;  ///< on the wall
  double work = 0;     ///< seconds of all threads together
  double path = 0;     ///< seconds of its critical path: with any number of threads it takes these at least
};

/// What was done. Times are of the clock on the wall.
struct RefineStatistics {
  double seconds_mesh = 0;           ///< from the input in memory to the finished mesh in memory
  double seconds_initial = 0;        ///< of these, until the boundary is there
  double seconds_refine = 0;         ///< of these, the refinement
  double seconds_optimize = 0;       ///< of these, the optimiser
  std::vector<StageTime> stages;     ///< those that ran, in their order
  std::uint64_t segment_points = 0;  ///< Steiner points on segments, of the boundary recovery
  std::uint64_t facet_points = 0;    ///< Steiner points on facets, of the boundary recovery
  /// With RefineOptions::keep_boundary, of these: on what was to be kept, as no way was found to do without them.
  std::uint64_t boundary_points = 0;
  std::uint64_t inner_points = 0;          ///< with it: points inside, which the recovery needs in their place
  std::uint64_t insertions_committed = 0;  ///< points that the refinement inserted
  /// Beside small angles, or with `min_edge`. Not counted: encroached subsegments that their rings refuse, which are never listed
  /// (refine/subsegment_ring.hpp), and elements that lean on the refusal of an entity, which counts once.
  std::uint64_t insertions_refused = 0;
  std::uint64_t selector_outside = 0;  ///< points of the selector outside their disk, replaced
  std::uint64_t selector_further = 0;  ///< of the insertions: further points of a selector of several (SelectedPoints)
  std::uint64_t selector_dropped = 0;  ///< further points that were left out, where the first went in
  PredicateCounts predicates;          ///< of all threads
};

/// What the optimiser did (RefineOptions::min_dihedral).
struct OptimizationStatistics {
  double target = 0;          ///< degrees; 0: there was no optimiser
  double claimed_cosine = 1;  ///< of the target, correctly rounded: what CheckOptions::largest_cosine is compared with exactly
  std::uint64_t moves = 0;    ///< vertices that got another place
  std::uint64_t edge_removals = 0;  ///< edges that went, and faces in whose place one came
  std::uint64_t reconnections = 0;  ///< small polyhedra that were filled anew
  std::uint64_t inserted = 0;       ///< vertices that came
  std::uint64_t removed = 0;        ///< vertices that went
  std::uint64_t evaluated = 0;      ///< qualities of cells that were computed: the unit of work
  std::uint64_t left = 0;           ///< when finished: cells over a bound in the end
  std::uint64_t unexplained = 0;    ///< of these, without an excuse
};

/// How the visits went (docs/design.md, "Generations, and why meshes are reproducible").
struct SchedulerStatistics {
  std::uint64_t leaves = 1;       ///< of the tree, in the end
  std::uint64_t generations = 0;  ///< of visits
  /// Uniform: how many times the phases of the finest lattice came round, before the optimiser; other schedules: 0.
  std::uint64_t cycles = 0;
  std::uint64_t visits = 0;          ///< all
  std::uint64_t set_aside = 0;       ///< attempts that were left to a visit that claims more
  std::uint32_t max_concurrent = 0;  ///< most visits that ran at one time
  int threads = 1;                   ///< threads that visits could run on
  double serial_seconds = 0;         ///< of the whole run, outside of all that runs side by side
  double work_seconds = 0;           ///< of the whole run, of all threads
  /// Of the whole run, from the input in memory to the finished mesh: serial_seconds, the longest chain of visits of each
  /// generation, and the longest piece of each loop. No number of threads makes the run shorter.
  double critical_path_seconds = 0;
  double seconds_in_generations = 0;  ///< from the start of each generation's first visit to the end of its last
  std::vector<double> busy_seconds;   ///< in visits, of each thread that ran any; a thread that ended has a successor
};

/// One visit, as it ran. Seconds since the meshing began.
struct VisitTrace {
  static constexpr std::uint32_t whole_tree = 0xffffffffu;  ///< an order
  std::uint32_t thread;                                     ///< as in SchedulerStatistics::busy_seconds
  double start;                                             ///< seconds
  double end;                                               ///< seconds
  std::uint32_t leaf;                                       ///< node of the tree
  std::uint32_t level;                                      ///< of the leaf; 0 is the root
  std::uint32_t order;       ///< of its claim: RefineOptions::claims; `whole_tree` for all of space
  std::uint64_t generation;  ///< counted from 1
  std::uint64_t committed;   ///< insertions
  std::uint64_t set_aside;   ///< attempts left to a visit that claims more
};

/// A mesh and all that is known about how it came to be. `mesh` and its arrays may be moved out.
template <int D>
struct RefineResult {
  OutputMesh<D> mesh;  ///< valid, whatever `stop` says; empty where it says that no partial mesh was wanted
  /// Why the run ended. If that was before the boundary was recovered, or if it was cancelled and no partial mesh is wanted,
  /// `mesh` is empty.
  StopCause stop = StopCause::finished;
  /// Cells over a bound. Where a limit has ended the run, the bound on dihedral angles does not count.
  std::uint64_t poor_left = 0;
  /// Of these, when finished, those in a corner of a facet that is so sharp that every mesh has one there (sharp_corners.hpp).
  std::uint64_t poor_unavoidable = 0;
  bool size_met = true;  ///< every cell within the size and measure bounds; false without a mesh
  /// One for every poor cell when finished. Of a mesh that a limit has ended before the optimiser began: for cells with faces
  /// that are not locally Delaunay.
  std::vector<PoorReason> reasons;
  std::vector<RegionVolume> regions;    ///< one a label that cells have, ascending; none without a mesh
  RefineStatistics statistics;          ///< counts and times
  SchedulerStatistics scheduler;        ///< how the visits went
  OptimizationStatistics optimization;  ///< 3D: what the optimiser did
  /// Is the mesh constrained Delaunay, but for rounding and beside the entities in `reasons`? False once the optimiser has begun,
  /// and where a clock or the caller has ended a run in which faces were met that are not locally Delaunay.
  bool delaunay = true;
  /// Were faces met that are not locally Delaunay? If not, none is left but by rounding, beside slanted entities.
  bool violations_seen = false;
  /// Points of the Domain in no cell, as they lie outside or in voids, ascending: vertices with these numbers, or dropped.
  std::vector<std::uint32_t> unused_points;
  double tolerance = 0;              ///< Domain::tolerance
  double largest_move = 0;           ///< Domain::largest_move
  std::vector<VisitTrace> trace;     ///< if asked for; in the order in which the visits ended
  std::vector<Diagnostic> repairs;   ///< of the input, see Domain
  std::vector<Diagnostic> warnings;  ///< of the input, see Domain; seeds that lie outside; points of no cell
};

/// Meshes the Domain of the input.
/// @throws UsageError (bad option or size), InputError (see Domain; the first error of its diagnosis, found
///   before anything is meshed; seeds), ResourceError (out_of_memory: there is not enough memory for what the input's gaps ask
///   for, found before anything is meshed (RefineOptions::memory_guard), or it has run out; ids_exhausted). An exception of a
///   callback comes out as it is, but for std::bad_alloc, which is a ResourceError, too.
template <int D>
RefineResult<D> refine(const Plc<D>& plc, const RefineOptions<D>& options);
/// The same for an input already prepared, which may be shared by several calls at once.
template <int D>
RefineResult<D> refine(const Domain<D>& domain, const RefineOptions<D>& options);

}  // namespace pgdr
