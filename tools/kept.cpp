// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "kept.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>

#include "console.hpp"
#include "text.hpp"

namespace pgdr::tool {

std::string KeptArguments::error() const {
  if (words == "true") return {};
  std::size_t begin = 0;
  while (true) {
    const std::size_t end = std::min(words.find(',', begin), words.size());
    int marker = 0;
    const auto [rest, wrong] = std::from_chars(words.data() + begin, words.data() + end, marker);
    if (wrong != std::errc() || rest != words.data() + end) return "markers are whole numbers with commas between";
    if (end == words.size()) return {};
    begin = end + 1;
  }
}

std::vector<int> KeptArguments::markers() const {
  std::vector<int> list;
  for (std::size_t begin = 0; words != "true" && begin < words.size();) {
    const std::size_t end = std::min(words.find(',', begin), words.size());
    std::from_chars(words.data() + begin, words.data() + end, list.emplace_back());
    begin = end + 1;
  }
  return list;
}

CLI::Option* add_kept(CLI::App& app, KeptArguments& kept, const std::string& what) {
  return app
      .add_flag("--keep-boundary", kept.words,
                what + "; =MARKERS, with commas between: of facets (2D: segments) with these alone")
      ->check(CLI::Validator([](std::string& text) { return KeptArguments{text}.error(); }, "", "markers"));
}

void set_kept(JsonObject& report, const KeptArguments& kept, const RefineStatistics& s) {
  report.set("keep_boundary", kept.any());
  if (!kept.any() && s.boundary_points + s.inner_points == 0) return;  // of periodic sides there may be some
  if (const std::vector<int> markers = kept.any() ? kept.markers() : std::vector<int>(); !markers.empty())
    report.set("kept_markers", markers);
  report.set("kept_boundary", JsonObject{{"boundary_points", s.boundary_points}, {"inner_points", s.inner_points}});
}

void print_kept(const RefineStatistics& s) {
  if (s.boundary_points + s.inner_points > 0)
    print_row("kept", "the boundary but for " + count(s.boundary_points, "point", "points") + " of its own; " +
                          count(s.inner_points, "point", "points") + " inside that its recovery needs");
}

}  // namespace pgdr::tool
