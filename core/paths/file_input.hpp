// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// A whole file in memory: what all readers start from, so that each count can be held against the bytes there are.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "pgdr/error.hpp"

namespace pgdr::detail {

/// @throws FileError cannot_open for anything that is missing, a directory, or cannot be read to its end.
std::string read_whole_file(const std::filesystem::path& file);

/// Files by their names, each read once, as a FIFO can be. One thread.
class FileTexts {
 public:
  /// The view lives until clear(). @throws as read_whole_file
  std::string_view of(const std::filesystem::path& file) {
    const auto known = texts_.find(file.string());
    return known != texts_.end() ? known->second : texts_.emplace(file.string(), read_whole_file(file)).first->second;
  }
  void clear() { texts_.clear(); }
  /// What readers left out of these files.
  std::vector<Diagnostic>& warnings() { return warnings_; }

 private:
  std::map<std::string, std::string> texts_;
  std::vector<Diagnostic> warnings_;
};

}  // namespace pgdr::detail
