// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The JSON report of --report. Its keys are a fixed contract (docs/usage.md): they may be added, never changed, and a
// key is there only with a value that was measured.
#pragma once

#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "pgdr/check.hpp"
#include "pgdr/error.hpp"
#include "pgdr/quality.hpp"
#include "pgdr/refine.hpp"

namespace pgdr::tool {

class Report {
 public:
  Report();
  ~Report();
  Report(const Report&) = delete;
  Report& operator=(const Report&) = delete;

  /// The object itself; keys appear in the file in the order of their first use.
  nlohmann::ordered_json& json() { return *json_; }
  void add_error(const Diagnostic& error);
  /// Writes to a temporary name beside `file` and renames it. @throws FileError cannot_write
  void write(const std::string& file) const;

  /// The mesh file that this run has written, if any. It goes again should the run still end with exit_resource.
  std::string mesh_file;

 private:
  std::unique_ptr<nlohmann::ordered_json> json_;
};

nlohmann::ordered_json to_json(const Diagnostic& d);
nlohmann::ordered_json to_json(const std::vector<Diagnostic>& list);
nlohmann::ordered_json to_json(const QualitySummary& q);
nlohmann::ordered_json to_json(const std::vector<PoorReason>& reasons);
nlohmann::ordered_json to_json(const PredicateCounts& counts);  ///< shares by stage, and `calls`
nlohmann::ordered_json to_json(const CheckFinding& finding);

const char* name(PoorReason::Code code);
const char* name(EntityKind kind);

/// `bounds.reasons` of a report that `pgdr mesh` wrote.
/// @throws FileError if it cannot be opened, InputError if it is not such a report.
std::vector<PoorReason> read_reasons(const std::string& file);

}  // namespace pgdr::tool
