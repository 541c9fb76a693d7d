// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "planar_hint.hpp"

#include <algorithm>
#include <exception>
#include <vector>

#include "pgdr/arrangement.hpp"
#include "pgdr/planar_plc.hpp"

namespace pgdr::tool {
namespace {

/// As the command does it: the hull first.
bool is_valid_with(const Plc<2>& plc, bool convex_hull, bool resolve_crossings) {
  try {
    Plc<2> mended = convex_hull ? with_convex_hull(plc) : plc;
    std::vector<Diagnostic> ignored;
    if (resolve_crossings) mended = pgdr::resolve_crossings(mended, ignored);
    return diagnose(mended, {.most_listed = 0, .errors_only = true, .stop = {}}).error_count() == 0;
  } catch (const std::exception&) {
    return false;
  }
}

/// Is anything wrong that cutting could cure, and nothing else?
bool is_crossed(const Diagnosis<3>& diagnosis) {
  std::uint64_t crossings = 0;
  for (const Finding kind : {Finding::facets_cross, Finding::facets_overlap, Finding::segment_crosses_facet,
                             Finding::segments_cross, Finding::point_on_facet, Finding::point_on_segment})
    crossings += diagnosis[kind].count;
  const FindingList& invalid = diagnosis[Finding::invalid_entity];
  return crossings + invalid.count > 0 && std::ranges::all_of(invalid.listed, [](const FindingList::Item& item) {
           return item.what.code == Errc::entities_intersect || item.what.code == Errc::facets_overlap;
         });
}

bool is_valid_cut(const Plc<3>& plc) {
  try {
    std::vector<Diagnostic> ignored;
    return diagnose(resolve_crossings(plc, ignored), {.most_listed = 0, .errors_only = true, .stop = {}}).error_count() == 0;
  } catch (const std::exception&) {
    return false;
  }
}

}  // namespace

template <int D>
std::optional<std::string> flags_for_refused(const Plc<D>& plc, const Diagnosis<D>& diagnosis) {
  if constexpr (D == 2) {
    const bool crosses = diagnosis[Finding::segments_cross].count > 0, is_open = diagnosis[Finding::encloses_nothing].count > 0;
    if (is_open && is_valid_with(plc, true, false))
      return "--convex-hull makes it valid: the convex hull of all points is meshed then";
    if (crosses && is_valid_with(plc, false, true))
      return "--resolve-crossings makes it valid: segments are split then where they cross";
    if (crosses && is_valid_with(plc, true, true))
      return "--resolve-crossings with --convex-hull makes it valid: segments are split where they cross, and the convex hull of "
             "all points is meshed";
  } else if (is_crossed(diagnosis) && is_valid_cut(plc)) {
    return "--resolve-crossings makes it valid: facets are cut along each other then where they cross";
  }
  return std::nullopt;
}

template std::optional<std::string> flags_for_refused<2>(const Plc<2>&, const Diagnosis<2>&);
template std::optional<std::string> flags_for_refused<3>(const Plc<3>&, const Diagnosis<3>&);

}  // namespace pgdr::tool
