// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The files of a run by their names: none that it writes may be one that it reads, or writes besides.
#pragma once

#include <string>
#include <vector>

#include "options.hpp"

namespace pgdr::tool {

class RunFiles {
 public:
  explicit RunFiles(const Arguments& arguments);

  /// @throws UsageError bad_option if the report would replace another file. Then it must not be written.
  void require_own_report() const;
  /// @throws UsageError bad_option if anything else that is written would
  void require_own_outputs() const;

 private:
  struct File {
    std::string name;
    const char* what;  ///< with its article
  };
  void read(const std::string& file, const char* what);
  void read(const BoundArguments& bounds);
  void require_none_of(const std::vector<File>& others, const File& written) const;

  std::vector<File> read_, outputs_, report_;  // the report is none or one
};

}  // namespace pgdr::tool
