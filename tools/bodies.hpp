// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// --regions union, fragments, priority, disjoint: what the command makes of the bodies of an input, and says of them.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "options.hpp"
#include "pgdr/bodies.hpp"
#include "pgdr/region_volume.hpp"
#include "report.hpp"

namespace pgdr::tool {

/// What is known of bodies, once the input has seeds for them.
struct BodyTable {
  std::vector<BodyRegion> regions;
  std::vector<std::string> names;
  std::vector<Diagnostic> repairs, warnings;
};

/// Gives the input the seeds that its bodies ask for, where crossings are resolved if that is asked, too; none if nobody asked
/// for bodies. @throws UsageError in 2D; what with_bodies throws
template <int D>
std::optional<BodyTable> label_bodies(Plc<D>& plc, const InputArguments& reading);

/// The word of --regions, whichever was asked for.
const char* name(RegionMode mode, const std::optional<BodyMode>& bodies);

/// `regions` of the report with their bodies, and `body_names`.
void set_regions(Report& report, const std::vector<RegionVolume>& volumes, const BodyTable& bodies);
/// A line a region.
void print_bodies(const BodyTable& bodies);

}  // namespace pgdr::tool
