// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Reading an input, and what flags ask to be done to it.
#pragma once

#include <string>
#include <vector>

#include "options.hpp"
#include "pgdr/io.hpp"
#include "pgdr/planar_plc.hpp"

namespace pgdr::tool {

/// @param repairs gets what was done. @throws UsageError for a flag of the other dimension; what read_plc throws
template <int D>
Plc<D> read_input(InputFile& file, const InputArguments& reading, std::vector<Diagnostic>& repairs) {
  if (D == 3 && (reading.resolve_crossings || reading.convex_hull || reading.region_areas))
    throw UsageError({.code = Errc::bad_option, .message = "--resolve-crossings, --convex-hull and --region-areas are for 2D"});
  Plc<D> plc = file.read_plc<D>({.region_areas = reading.region_areas});
  plc.tolerance = reading.tolerance;
  plc.is_coarse = reading.yes_coarse;
  if constexpr (D == 2) {
    if (reading.convex_hull) plc = with_convex_hull(plc);
    if (reading.resolve_crossings) plc = resolve_crossings(plc, repairs);
  }
  return plc;
}

}  // namespace pgdr::tool
