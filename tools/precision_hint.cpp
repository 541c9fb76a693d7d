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
void hint_at_precision(const Plc<D>& plc, const Domain<D>* domain, const InputArguments& reading, bool quiet, Report& report) {
  if constexpr (D == 3) {
    if (reading.precision || reading.precision_auto || plc.precision_of_file) return;
    double suggested;
    std::size_t facets, fewer;
    const double written = written_precision(plc.points);
    try {
      std::optional<Domain<3>> made;
      if (domain == nullptr) domain = &made.emplace(plc);
      suggested = written > plc.precision ? written : apparent_precision(*domain);
      if (suggested <= plc.precision) return;
      facets = domain->facets().size();
      Plc<3> merged = plc;
      merged.precision = suggested;
      fewer = Domain<3>(merged).facets().size();
    } catch (const std::exception&) {
      return;  // faces that their digits have bent so far are no better; and the mesh is there without a hint
    }
    if (10 * fewer > 9 * facets || fewer < 4) return;
    report.set("precision_hint", JsonObject{{"precision", suggested}, {"facets", facets}, {"facets_then", fewer}});
    if (!quiet)
      print_row("hint", format("--precision auto (%.1e, by %s) makes %s out of %s", suggested,
                               suggested == written ? "the digits of the coordinates" : "how far faces are off their planes",
                               count(fewer, "facet", "facets").c_str(), count(facets, "facet", "facets").c_str()));
  }
}

template <int D>
void note_precision(const Plc<D>& plc, double used) {
  if (!plc.precision_of_file) return;
  print_row("precision", used < plc.precision
                             ? format("--precision %.1e: the numbers of the file allow %.1e, but its facets then fold over", used, plc.precision)
                             : format("--precision %.1e: what the numbers of the file allow", used));
}

template void note_precision<2>(const Plc<2>&, double);
template void note_precision<3>(const Plc<3>&, double);
template void hint_at_precision<2>(const Plc<2>&, const Domain<2>*, const InputArguments&, bool, Report&);
template void hint_at_precision<3>(const Plc<3>&, const Domain<3>*, const InputArguments&, bool, Report&);

}  // namespace pgdr::tool
