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
#include "pgdr/written_precision.hpp"

namespace pgdr::tool {

/// @param repairs gets what was done. @throws UsageError for a flag of the other dimension; what read_plc throws
template <int D>
Plc<D> read_input(const std::string& file, const InputArguments& reading, std::vector<Diagnostic>& repairs) {
  if constexpr (D == 3) {
    if (reading.resolve_crossings || reading.convex_hull)
      throw UsageError({.code = Errc::bad_option, .message = "--resolve-crossings and --convex-hull are for 2D"});
    Plc<3> plc = read_plc<3>(file);
    if (reading.precision || reading.precision_auto) plc.precision_of_file = false;
    if (reading.precision) plc.precision = *reading.precision;
    if (reading.merge_points) plc.merge_within = *reading.merge_points;
    if (reading.precision_auto) plc.precision = suggested_precision(plc);
    return plc;
  } else {
    if (reading.precision || reading.precision_auto)
      throw UsageError({.code = Errc::bad_option, .message = "--precision is for 3D"});
    Plc<2> plc = read_plc<2>(file);
    if (reading.merge_points) plc.merge_within = *reading.merge_points;
    if (reading.convex_hull) plc = with_convex_hull(plc);
    if (reading.resolve_crossings) plc = resolve_crossings(plc, repairs);
    return plc;
  }
}

}  // namespace pgdr::tool
