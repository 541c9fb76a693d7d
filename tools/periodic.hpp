// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// --periodic: sides of a mesh that correspond, vertex by vertex.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "pgdr/io.hpp"
#include "pgdr/names.hpp"
#include "pgdr/periodic.hpp"
#include "report.hpp"

namespace pgdr::tool {

/// Is this FROM=TO, or FROM=TO:NUMBERS with 6 or 12 numbers between commas?
bool is_periodic(const std::string& text);
/// The sides of these flags; markers are numbers, or names. @throws UsageError: no such name; another dimension
template <int D>
std::vector<PeriodicSides<D>> periodic_sides(const std::vector<std::string>& flags, const Names& names);

/// The flags that say the same.
template <int D>
std::vector<std::string> flags_of(const std::vector<PeriodicSides<D>>& sides);
/// What a file says of sides that markers tell apart; others, as those of no marker, are left out.
template <int D>
StatedPeriods periods_of(InputFile& file);

/// `periodic` of the report, and a line each.
void set_periodic(Report& report, const std::vector<PeriodicPairs>& pairs);
void print_periodic(const std::vector<PeriodicPairs>& pairs);

/// Of a mesh: the pairs, or what is wrong. Those that its file states are verified, too, and follow the others.
struct PeriodicCheck {
  std::vector<PeriodicPairs> pairs;
  std::optional<Diagnostic> failure;
};
template <int D>
PeriodicCheck check_periodic(const OutputMesh<D>& mesh, const std::vector<PeriodicSides<D>>& sides, const StatedPeriods& stated,
                             double tolerance);

}  // namespace pgdr::tool
