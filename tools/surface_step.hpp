// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// --surface-tolerance: another surface is put in the place of the given one, and what that was is reported.
#pragma once

#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "bounds.hpp"
#include "options.hpp"
#include "pgdr/surface.hpp"
#include "pgdr/surface_counts.hpp"
#include "report.hpp"

namespace pgdr::tool {

/// What was done.
struct SurfaceStep {
  std::string given;         ///< the text of the flag
  ReplacedSurface replaced;  ///< whose plc goes on
  SurfaceCounts before, after;
};

/// @throws UsageError bad_option if the flag is given for a plane input; as require_surface_writable
void require_3d(const SurfaceArguments& arguments, int dimension);

/// Writes the surface, too, where that is asked for.
/// @param tolerance  that of the flag --tolerance
/// @param fixed_markers  of SurfaceOptions
/// @throws as pgdr::replace_surface and write_surface
SurfaceStep replace_surface(const Plc<3>& plc, const SurfaceArguments& arguments, std::optional<double> tolerance,
                            const Bounds<3>& bounds, std::vector<int> fixed_markers, const std::stop_token& stop);

/// The keys `surface_tolerance` and `surface`.
void set_surface(Report& report, const SurfaceStep& step);
void print_surface(const SurfaceStep& step);

}  // namespace pgdr::tool
