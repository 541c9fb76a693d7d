// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// What of the boundary is kept as it is: the flag, and what is said of it.
#pragma once

#include <string>
#include <vector>

#include "json.hpp"
#include "pgdr/refine.hpp"

namespace CLI {
class App;
class Option;
}

namespace pgdr::tool {

/// The words of --keep-boundary.
struct KeptArguments {
  std::string words;  ///< empty: nothing; "true": all; else markers, with commas between

  bool any() const { return !words.empty(); }
  std::vector<int> markers() const;  ///< empty: all. @pre error() has none
  std::string error() const;         ///< what is wrong with the words; empty: nothing
};

/// The flag; it means `what`, for this command.
CLI::Option* add_kept(CLI::App& app, KeptArguments& kept, const std::string& what);

/// Puts into the report what is kept, and what points that takes.
void set_kept(JsonObject& report, const KeptArguments& kept, const RefineStatistics& s);
void print_kept(const RefineStatistics& s);  ///< the latter, if there are any

}  // namespace pgdr::tool
