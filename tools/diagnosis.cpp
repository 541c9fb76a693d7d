// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "diagnosis.hpp"

#include <cstdio>

#include "command.hpp"
#include "console.hpp"

namespace pgdr::tool {
namespace {

std::string words(Finding kind) {
  std::string text(name(kind));
  for (char& c : text)
    if (c == '_') c = ' ';
  return text;
}

bool has_measure(Finding kind) { return kind == Finding::open_boundary || kind >= Finding::segments_below_60; }

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
    print_row(is_error(kind) ? "error" : "found", words(kind) + ": " + count(found.count, "", ""));
    if (!found.listed.empty()) print_row("", Error(found.listed[0].what).what());
  }
}

template <int D>
int refuse(const Diagnosis<D>& diagnosis, Report& report) {
  constexpr std::size_t most = 5;
  const std::vector<Diagnostic> errors = diagnosis.errors();
  for (std::size_t i = 0; i < errors.size(); ++i) {
    report.add_error(errors[i]);
    if (i < most) std::fprintf(stderr, "pgdr: error: %s\n", Error(errors[i]).what());
  }
  if (const std::uint64_t all = diagnosis.error_count(); all > most)
    std::fprintf(stderr, "pgdr: and %llu more errors\n", static_cast<unsigned long long>(all - most));
  return exit_input;
}

#define PGDR_INSTANTIATE(D)                                             \
  template void set_findings<D>(JsonObject&, const Diagnosis<D>&);      \
  template void print_findings<D>(const Diagnosis<D>&);                 \
  template int refuse<D>(const Diagnosis<D>&, Report&);
PGDR_INSTANTIATE(2)
PGDR_INSTANTIATE(3)
#undef PGDR_INSTANTIATE

}  // namespace pgdr::tool
