// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// What a run says: its part of the report, the summary, the trace.
#pragma once

#include <optional>
#include <string>

#include "bounds.hpp"
#include "options.hpp"
#include "pgdr/quality.hpp"
#include "pgdr/ranks.hpp"
#include "pgdr/refine.hpp"
#include "report.hpp"
#include "threads.hpp"

namespace pgdr::tool {

/// Seconds that each part took, and when it began, since the command did.
struct Seconds {
  double read = 0, write = 0, total = 0;
  double read_at = 0, mesh_at = 0, write_at = 0;
};

/// What is known of the mesh itself, wherever it is.
struct Measured {
  std::uint64_t vertices = 0, cells = 0;
  QualitySummary quality;
  std::optional<NotDelaunay> not_delaunay;  ///< if they were counted
};

template <int D>
Measured measure(const RefineResult<D>& r);
/// The same on all ranks.
template <int D>
Measured measure(Transport& transport, const DistributedResult<D>& r);

/// Puts into the report what is known of the run and its mesh.
template <int D>
void fill(Report& report, const MeshArguments& a, const Threads& threads, const Bounds<D>& bounds, const RefineResult<D>& r,
          const Measured& measured);

template <int D>
void print_summary(const MeshArguments& a, const std::string& inputs, std::size_t points, const Bounds<D>& bounds,
                   const RefineResult<D>& r, const Measured& measured, const Seconds& seconds, double seconds_of_surface);

/// @throws FileError cannot_write
template <int D>
void write_trace(const MeshArguments& a, const RefineResult<D>& r, const Seconds& seconds);

}  // namespace pgdr::tool
