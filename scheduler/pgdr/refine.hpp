// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The public entry: from an input to a finished mesh. No global state, no printing. Several calls may run at once from
// several threads. Callbacks (size, selector) are called concurrently; progress from one thread at a time.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "pgdr/check.hpp"
#include "pgdr/domain.hpp"
#include "pgdr/output_mesh.hpp"
#include "pgdr/plc.hpp"
#include "pgdr/point_selector.hpp"
#include "pgdr/predicates.hpp"
#include "pgdr/sizing.hpp"

namespace pgdr {

struct Progress {
  std::uint64_t vertices = 0, cells = 0, poor = 0;  ///< poor: entries waiting in the lists
};

template <int D>
struct RefineOptions {
  /// Upper bound on circumradius over shortest edge. Proved for >= 2 (3D), >= sqrt 2 (2D).
  double radius_edge_bound = smallest_proved_bound<D>();
  SizingField<D> size;            ///< circumradius (3D) or area (2D) bound at the centroid
  double max_volume = std::numeric_limits<double>::infinity();  ///< 3D: volume bound of all cells
  PointSelector<D> selector;      ///< empty: circumcentre
  DiskOptions disk;
  OutsidePolicy outside = OutsidePolicy::replace_by_circumcenter;
  bool refine = true;             ///< false: boundary recovery alone
  double min_edge = 0;            ///< insertions that would make an edge shorter than this are refused
  std::uint64_t max_vertices = std::numeric_limits<std::uint64_t>::max();
  std::optional<std::chrono::duration<double>> time_limit;
  std::stop_token stop;
  std::function<void(const Progress&)> progress;
};

enum class StopCause { finished, max_vertices, time_limit, cancelled };

struct RefineStatistics {
  double seconds_mesh = 0, seconds_initial = 0, seconds_refine = 0;
  std::uint64_t insertions_committed = 0, insertions_refused = 0, selector_outside = 0;
  PredicateCounts predicates;
};

template <int D>
struct RefineResult {
  OutputMesh<D> mesh;
  StopCause stop = StopCause::finished;
  std::uint64_t poor_left = 0;
  bool size_met = true;               ///< every cell within the size and measure bounds
  std::vector<PoorReason> reasons;    ///< one for every poor cell when finished
  RefineStatistics statistics;
  std::vector<Diagnostic> repairs, warnings;
};

/// Meshes the input.
/// @throws UsageError (bad option or size), InputError (see Domain; encloses_nothing, seeds), ResourceError. An
///   exception of a callback comes out as it is.
template <int D>
RefineResult<D> refine(const Plc<D>& plc, const RefineOptions<D>& options);
/// The same for an input already prepared.
template <int D>
RefineResult<D> refine(const Domain<D>& domain, const RefineOptions<D>& options);

}  // namespace pgdr
