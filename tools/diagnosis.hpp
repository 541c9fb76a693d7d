// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// A diagnosis in words and as JSON.
#pragma once

#include <optional>

#include "pgdr/diagnosis.hpp"
#include "proposal.hpp"
#include "report.hpp"

namespace pgdr::tool {

/// Sets a member for every kind of finding that there is: {count, listed [an error, or one with `measure`]}.
template <int D>
void set_findings(JsonObject& object, const Diagnosis<D>& diagnosis);

/// A row for every kind of finding, with the first of each.
template <int D>
void print_findings(const Diagnosis<D>& diagnosis);

/// Puts all listed errors into the report and a few on stderr, and there which flags have been found to help.
/// Returns exit_input. `is_resolved`: crossings were resolved, so that the flag for that is no help.
template <int D>
int refuse(const Plc<D>& plc, const Diagnosis<D>& diagnosis, bool is_resolved, Report& report);

/// A proposal, in the report as `proposal`, and in a row unless `quiet`.
void give(const std::optional<Proposal>& proposal, bool quiet, Report& report);

}  // namespace pgdr::tool
