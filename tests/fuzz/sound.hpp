// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// What every mesh that a fuzz target makes has to be.
#pragma once

#include <string>

#include "expect.hpp"
#include "pgdr/check.hpp"
#include "pgdr/refine.hpp"

namespace pgdr::fuzz {

inline std::string findings(const CheckReport& report) {
  std::string text;
  for (const auto& f : report.findings) text += std::string(name(f.kind)) + ": " + f.message + "\n";
  return text;
}

/// The checker passes it. One that a bound on vertices ended may have elements without a reason, and is none before the boundary
/// is there.
template <int D>
void expect_sound(const Plc<D>& plc, const RefineOptions<D>& options, const RefineResult<D>& result) {
  if (result.mesh.cells.empty() && result.stop != StopCause::finished) return;
  CheckOptions<D> check_options;
  check_options.input = &plc;
  check_options.tolerance = result.tolerance;
  check_options.regions = options.regions;
  if (result.stop == StopCause::finished) check_options.radius_edge_bound = options.radius_edge_bound;
  check_options.largest_cosine = result.optimization.claimed_cosine;
  check_options.delaunay = result.delaunay;
  check_options.reasons = &result.reasons;
  const CheckReport report = check<D>(result.mesh, check_options);
  if (result.stop == StopCause::finished) {
    FUZZ_EXPECT(report.exit_code() <= 1, findings(report));
    return;
  }
  for (const auto& f : report.findings) FUZZ_EXPECT(f.kind == CheckFinding::Kind::bad_reason, findings(report));
}

/// In another order, and with other slots and numbers of cells and vertices, the same comes out.
template <int D>
void expect_same_shuffled(const Domain<D>& domain, RefineOptions<D> options, const RefineResult<D>& result) {
  options.schedule.executor = Executor::shuffled;
  options.schedule.threads = 3;
  const auto again = refine<D>(domain, options);
  FUZZ_EXPECT(again.mesh.points == result.mesh.points && again.mesh.cells == result.mesh.cells);
  FUZZ_EXPECT(again.mesh.regions == result.mesh.regions && again.poor_left == result.poor_left && again.stop == result.stop);
}

/// Small and fast, with a few leaves.
template <int D>
RefineOptions<D> small_run(bool automatic_regions) {
  RefineOptions<D> options;
  options.max_vertices = 400;
  options.regions = automatic_regions ? RegionMode::automatic : RegionMode::seeds;
  options.schedule.executor = Executor::serial;
  options.schedule.floor = 5;
  return options;
}

}  // namespace pgdr::fuzz
