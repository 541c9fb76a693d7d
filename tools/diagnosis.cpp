// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "diagnosis.hpp"

#include <array>
#include <cstdio>
#include <string>

#include "command.hpp"
#include "console.hpp"
#include "cures.hpp"

namespace pgdr::tool {
namespace {

/// Of one, and of many.
std::array<const char*, 2> words(Finding kind) {
  switch (kind) {
    case Finding::invalid_entity: return {"entity that cannot be", "entities that cannot be"};
    case Finding::facets_cross: return {"pair of facets that intersect", "pairs of facets that intersect"};
    case Finding::facets_overlap: return {"pair of facets that overlap", "pairs of facets that overlap"};
    case Finding::segment_crosses_facet: return {"segment through a facet", "segments through facets"};
    case Finding::segments_cross: return {"pair of segments that cross", "pairs of segments that cross"};
    case Finding::point_on_facet: return {"point inside a facet", "points inside facets"};
    case Finding::point_on_segment: return {"point inside an edge", "points inside edges"};
    case Finding::encloses_nothing: return {"input without an inside", "inputs without an inside"};
    case Finding::duplicate_point: return {"point given twice, merged", "points given twice, merged"};
    case Finding::unreferenced_point: return {"point that belongs to nothing", "points that belong to nothing"};
    case Finding::repeated_facet: return {"facet given twice, dropped", "facets given twice, dropped"};
    case Finding::open_boundary: return {"open boundary", "open boundaries"};
    case Finding::near_points:
      return {"pair of points of open boundaries that nearly coincide",
              "pairs of points of open boundaries that nearly coincide"};
    case Finding::non_manifold_edge: return {"edge of more than two facets", "edges of more than two facets"};
    case Finding::non_manifold_point: return {"point where surfaces touch", "points where surfaces touch"};
    case Finding::inconsistent_orientation: return {"edge of ill-oriented facets", "edges of ill-oriented facets"};
    case Finding::segments_below_60: return {"angle of segments below 60 degrees", "angles of segments below 60 degrees"};
    case Finding::segment_facet_below_90:
      return {"angle of segment and facet below 90 degrees", "angles of segments and facets below 90 degrees"};
    case Finding::facets_below_90:
      return {"dihedral angle of facets below 90 degrees", "dihedral angles of facets below 90 degrees"};
  }
  return {"", ""};
}

bool has_measure(Finding kind) {
  return kind == Finding::open_boundary || kind == Finding::near_points || kind >= Finding::segments_below_60;
}

void say(const std::vector<Cure>& cures, bool in_row, Report& report) {
  if (cures.empty()) return;
  std::vector<Json> needs;
  for (const Cure& cure : cures)
    needs.push_back(JsonObject{{"ailment", cure.ailment}, {"flags", cure.flags}, {"words", cure.words}});
  report.set("needs", needs);
  if (in_row) print_row("needs", cures.front().need());
  std::fprintf(stderr, "pgdr: needs: %s\n", cures.front().need().c_str());
  for (const Cure& cure : cures)
    if (cure.words != cure.need() || &cure != &cures.front()) std::fprintf(stderr, "pgdr: %s\n", cure.words.c_str());
}

}  // namespace

template <int D>
void set_findings(JsonObject& object, const Diagnosis<D>& diagnosis) {
  for (std::size_t k = 0; k < finding_kinds; ++k) {
    const auto kind = static_cast<Finding>(k);
    const FindingList& found = diagnosis[kind];
    std::vector<Json> listed;
    for (const FindingList::Item& item : found.listed) {
      JsonObject one = to_json(item.what);
      if (has_measure(kind)) one.set("measure", item.measure);
      listed.push_back(one);
    }
    object.set(name(kind), JsonObject{{"count", found.count}, {"listed", listed}});
  }
}

template <int D>
void print_findings(const Diagnosis<D>& diagnosis) {
  for (std::size_t k = 0; k < finding_kinds; ++k) {
    const auto kind = static_cast<Finding>(k);
    const FindingList& found = diagnosis[kind];
    if (found.count == 0) continue;
    const auto [one, many] = words(kind);
    print_row(is_error(kind) ? "error" : "found", count(found.count, one, many));
    if (found.listed.empty()) continue;
    const Diagnostic& first = found.listed[0].what;
    const std::string place = first.line == 0 ? "" : "line " + std::to_string(first.line) + ": ";
    print_row("", (found.count == 1                     ? ""
                   : kind >= Finding::segments_below_60 ? "least: "
                   : kind == Finding::near_points       ? "farthest: "
                                                        : "first: ") +
                      place + first.message);
  }
}

template <int D>
int refuse(const Refused<D>& input, const Diagnosis<D>& diagnosis, bool in_row, Report& report) {
  constexpr std::size_t most = 5;
  const std::vector<Diagnostic> errors = diagnosis.errors();
  const std::string bodies = words_of_bodies(input.plc, diagnosis, input.stop);
  if (!bodies.empty()) std::fprintf(stderr, "pgdr: error: %s\n", bodies.c_str());
  for (std::size_t i = 0; i < errors.size(); ++i) {
    report.add_error(errors[i]);
    if (i < most && bodies.empty()) std::fprintf(stderr, "pgdr: error: %s\n", Error(errors[i]).what());
  }
  if (const std::uint64_t all = diagnosis.error_count(); all > most && bodies.empty())
    std::fprintf(stderr, "pgdr: and %llu more errors\n", static_cast<unsigned long long>(all - most));
  say(cures_of(input.given, input.done, diagnosis, input.stop), in_row, report);
  return exit_input;
}

template <int D>
bool say_cure(const Refused<D>& input, const Error& error, bool in_row, Report& report) {
  if constexpr (D == 3)
    if (const auto cure = cure_of_bodies(input.given, input.done, error.code(), input.stop))
      return say({*cure}, in_row, report), true;
  return false;
}

void give(const std::optional<Proposal>& proposal, bool quiet, Report& report) {
  if (!proposal) return;
  report.set("proposal", JsonObject{{"tolerance", proposal->tolerance},
                                    {"facets", proposal->facets},
                                    {"facets_then", proposal->facets_then},
                                    {"joined", proposal->joined}});
  if (quiet) return;
  std::string what;
  if (proposal->joined > 0)
    what = "joins " + count(proposal->joined, "point to a point, a segment or a facet", "points to points, segments and facets");
  if (proposal->facets_then < proposal->facets)
    what += (what.empty() ? "" : " and ") + ("makes " + count(proposal->facets_then, "facet", "facets")) + " of " +
            count(proposal->facets, "facet", "facets");
  print_row("proposal",
            "--tolerance " + digits(proposal->tolerance) + ", two units of the last digit of the coordinates, " + what);
}

#define PGDR_INSTANTIATE(D)                                                      \
  template void set_findings<D>(JsonObject&, const Diagnosis<D>&);               \
  template void print_findings<D>(const Diagnosis<D>&);                          \
  template int refuse<D>(const Refused<D>&, const Diagnosis<D>&, bool, Report&); \
  template bool say_cure<D>(const Refused<D>&, const Error&, bool, Report&);
PGDR_INSTANTIATE(2)
PGDR_INSTANTIATE(3)
#undef PGDR_INSTANTIATE

}  // namespace pgdr::tool
