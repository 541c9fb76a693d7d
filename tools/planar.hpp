// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Reading an input, and what the flags for planar ones ask to be done to it.
#pragma once

#include <string>
#include <vector>

#include "options.hpp"
#include "pgdr/io.hpp"
#include "pgdr/planar_plc.hpp"

namespace pgdr::tool {

/// @param repairs gets what was done. @throws UsageError for a flag of the other dimension; what read_plc throws
template <int D>
Plc<D> read_input(const std::string& file, const PlanarArguments& planar, std::vector<Diagnostic>& repairs) {
  if constexpr (D == 3) {
    if (planar.resolve_crossings || planar.convex_hull)
      throw UsageError({.code = Errc::bad_option, .message = "--resolve-crossings and --convex-hull are for 2D"});
    return read_plc<3>(file);
  } else {
    Plc<2> plc = read_plc<2>(file);
    if (planar.convex_hull) plc = with_convex_hull(plc);
    if (planar.resolve_crossings) plc = resolve_crossings(plc, repairs);
    return plc;
  }
}

}  // namespace pgdr::tool
