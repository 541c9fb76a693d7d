// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "treatment.hpp"

#include <algorithm>

#include "pgdr/arrangement.hpp"
#include "pgdr/convex_hull.hpp"
#include "pgdr/openings.hpp"
#include "pgdr/planar_plc.hpp"
#include "text.hpp"

namespace pgdr::tool {
namespace {

bool is_opening(const Diagnostic& repair) { return repair.code == Errc::open_boundary; }

Plc<3> resolved(const Plc<3>& plc, const Treatment& how, std::vector<Diagnostic>& repairs, const std::stop_token& stop) {
  return resolve_crossings(plc, repairs, {.markers = how.markers.value_or(SharedMarker::smallest), .stop = stop});
}

}  // namespace

template <int D>
Plc<D> treated(Plc<D> plc, const Treatment& how, std::vector<Diagnostic>& repairs, const std::stop_token& stop) {
  if (how.convex_hull) plc = with_convex_hull(plc);
  if constexpr (D == 2) {
    if (how.resolve_crossings) plc = resolve_crossings(plc, repairs);
  } else {
    if (how.close_openings) plc = close_planar_openings(plc, repairs, stop);
    if (!how.resolve_crossings) return plc;
    const bool are_closed = std::ranges::any_of(repairs, is_opening);
    if (!how.bodies) plc = resolved(plc, how, repairs, stop);
    if (!how.close_openings || are_closed) return plc;
    // A Domain may refuse an input for what crosses, so that its openings are seen afterwards alone; what closes them may cross,
    // too.
    if (how.bodies) plc = resolved(plc, how, repairs, stop);
    plc = close_planar_openings(plc, repairs, stop);
    if (!how.bodies && std::ranges::any_of(repairs, is_opening)) plc = resolved(plc, how, repairs, stop);
  }
  return plc;
}

template Plc<2> treated<2>(Plc<2>, const Treatment&, std::vector<Diagnostic>&, const std::stop_token&);
template Plc<3> treated<3>(Plc<3>, const Treatment&, std::vector<Diagnostic>&, const std::stop_token&);

std::optional<Diagnostic> warning_of_openings(const std::vector<Diagnostic>& repairs) {
  constexpr std::size_t most_said = 5;
  std::optional<Diagnostic> warning;
  std::size_t found = 0;
  for (const Diagnostic& repair : repairs) {
    if (!is_opening(repair)) continue;
    if (!warning) warning = Diagnostic{.code = Errc::open_boundary, .message = {}, .file = repair.file, .ids = {}, .points = {}};
    if (++found <= most_said) warning->message += "; " + repair.message;
  }
  if (!warning) return warning;
  if (found > most_said)
    warning->message += "; and " + std::to_string(found - most_said) + " more, which are repairs of the report";
  warning->message = count(found, "opening is closed by a facet", "openings are closed by facets") +
                     " that the input does not have" + warning->message;
  return warning;
}

}  // namespace pgdr::tool
