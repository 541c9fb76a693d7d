// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// A diagnosis in words and as JSON.
#pragma once

#include <optional>
#include <stop_token>

#include "pgdr/diagnosis.hpp"
#include "proposal.hpp"
#include "report.hpp"
#include "treatment.hpp"

namespace pgdr::tool {

/// Sets a member for every kind of finding that there is: {count, listed [an error, or one with `measure`]}.
template <int D>
void set_findings(JsonObject& object, const Diagnosis<D>& diagnosis);

/// A row for every kind of finding, with the first of each.
template <int D>
void print_findings(const Diagnosis<D>& diagnosis);

/// An input, and how it was read.
template <int D>
struct Refused {
  const Plc<D>& given;  ///< as it was read
  const Plc<D>& plc;    ///< what was made of that
  const Treatment& done;
  std::stop_token stop = {};  ///< ends the search for cures
};
/// Puts all listed errors into the report and a few on stderr, and there what has been found to help; in the report as `needs`.
/// In a row, too, if `in_row`. Returns exit_input.
template <int D>
int refuse(const Refused<D>& input, const Diagnosis<D>& diagnosis, bool in_row, Report& report);
/// Says what helps against an error of bodies, likewise. False if it is none, or nothing does.
template <int D>
bool say_cure(const Refused<D>& input, const Error& error, bool in_row, Report& report);

/// A proposal, in the report as `proposal`, and in a row unless `quiet`.
void give(const std::optional<Proposal>& proposal, bool quiet, Report& report);

}  // namespace pgdr::tool
