// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The public entry: from an input to a finished mesh. No global state, no printing. Several calls may run at once from
// several threads. Callbacks (size, selector) are called concurrently; progress from one thread at a time.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "pgdr/check.hpp"
#include "pgdr/domain.hpp"
#include "pgdr/output_mesh.hpp"
#include "pgdr/plc.hpp"
#include "pgdr/point_selector.hpp"
#include "pgdr/predicates.hpp"
#include "pgdr/refine_options.hpp"
#include "pgdr/sizing.hpp"

namespace pgdr {

struct RefineStatistics {
  double seconds_mesh = 0, seconds_initial = 0, seconds_refine = 0;
  std::uint64_t segment_points = 0, facet_points = 0;  ///< Steiner points of the boundary recovery
  std::uint64_t insertions_committed = 0, insertions_refused = 0, selector_outside = 0;
  PredicateCounts predicates;
};

/// How the visits went (design notes, "Scheduler").
struct SchedulerStatistics {
  std::uint64_t leaves = 1, generations = 0, visits = 0, set_aside = 0;  ///< set_aside: attempts
  std::uint32_t max_concurrent = 0;         ///< most visits that ran at one time
  int threads = 1;                          ///< threads that visits could run on
  double serial_seconds = 0;                ///< of the refinement outside visits
  double work_seconds = 0;                  ///< all visits and serial_seconds
  double critical_path_seconds = 0;         ///< serial_seconds and, of each generation, the longest chain of visits
  double seconds_in_generations = 0;        ///< from the start of each generation's first visit to the end of its last
  std::vector<double> busy_seconds;         ///< in visits, of each thread that ran any; a thread that ended has a successor
};

/// One visit, as it ran. Seconds since the meshing began.
struct VisitTrace {
  std::uint32_t thread;
  double start, end;
  std::uint32_t leaf, level, order;         ///< order: of its claim, BUF^order; 0xffffffff for the whole tree
  std::uint64_t generation, committed, set_aside;
};

template <int D>
struct RefineResult {
  OutputMesh<D> mesh;
  StopCause stop = StopCause::finished;  ///< ended before the boundary was recovered: `mesh` is empty
  std::uint64_t poor_left = 0;
  bool size_met = true;               ///< every cell within the size and measure bounds
  std::vector<PoorReason> reasons;    ///< one for every poor cell when finished
  RefineStatistics statistics;
  SchedulerStatistics scheduler;
  bool violations_seen = false;       ///< faces that are not locally Delaunay were met; without, none is left
  std::vector<VisitTrace> trace;      ///< if asked for; in the order in which the visits ended
  std::vector<Diagnostic> repairs, warnings;
};

/// Meshes the input.
/// @throws UsageError (bad option or size), InputError (see Domain; the first error of its diagnosis, found
///   before anything is meshed; seeds), ResourceError. An exception of a callback comes out as it is.
template <int D>
RefineResult<D> refine(const Plc<D>& plc, const RefineOptions<D>& options);
/// The same for an input already prepared.
template <int D>
RefineResult<D> refine(const Domain<D>& domain, const RefineOptions<D>& options);

}  // namespace pgdr
