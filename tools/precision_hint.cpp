// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "precision_hint.hpp"

#include <exception>
#include <optional>

#include "console.hpp"
#include "pgdr/domain.hpp"
#include "pgdr/written_precision.hpp"

namespace pgdr::tool {

template <int D>
std::optional<PrecisionHint> find_precision_hint(const Plc<D>& plc, const Domain<D>* domain, const InputArguments& reading) {
  if constexpr (D == 3) {
    if (reading.precision || reading.precision_auto || plc.precision_of_file) return std::nullopt;
    PrecisionHint hint;
    const double written = written_precision(plc.points);
    hint.by_digits = written > plc.precision;
    try {
      std::optional<Domain<3>> made;
      if (domain == nullptr) domain = &made.emplace(plc);
      hint.precision = hint.by_digits ? written : apparent_precision(*domain);
      hint.facets = domain->facets().size();
      if (hint.precision <= plc.precision || 10 * most_facets_saved(*domain, hint.precision) < hint.facets) return std::nullopt;
      Plc<3> merged = plc;
      merged.precision = hint.precision;
      hint.facets_then = Domain<3>(merged).facets().size();
    } catch (const std::exception&) {
      return std::nullopt;  // faces that their digits have bent so far are no better; and the mesh is there without a hint
    }
    if (10 * hint.facets_then <= 9 * hint.facets && hint.facets_then >= 4) return hint;
  }
  return std::nullopt;
}

void give(const std::optional<PrecisionHint>& hint, bool quiet, Report& report) {
  if (!hint) return;
  report.set("precision_hint",
             JsonObject{{"precision", hint->precision}, {"facets", hint->facets}, {"facets_then", hint->facets_then}});
  if (!quiet)
    print_row("hint",
              format("--precision auto (%.1e, by %s) makes %s out of %s", hint->precision,
                     hint->by_digits ? "the digits of the coordinates" : "how far faces are off their planes",
                     count(hint->facets_then, "facet", "facets").c_str(), count(hint->facets, "facet", "facets").c_str()));
}

template <int D>
void note_precision(const Plc<D>& plc, double used) {
  if (!plc.precision_of_file) return;
  print_row("precision", used < plc.precision
                             ? format("--precision %.1e: the numbers of the file allow %.1e, but its facets then fold over", used,
                                      plc.precision)
                             : format("--precision %.1e: what the numbers of the file allow (%.1e keeps apart what they bend)",
                                      used, Plc<3>{}.precision));
}

template void note_precision<2>(const Plc<2>&, double);
template void note_precision<3>(const Plc<3>&, double);
template std::optional<PrecisionHint> find_precision_hint<2>(const Plc<2>&, const Domain<2>*, const InputArguments&);
template std::optional<PrecisionHint> find_precision_hint<3>(const Plc<3>&, const Domain<3>*, const InputArguments&);

}  // namespace pgdr::tool
