// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The pgdr command: subcommands and exit codes. This folder alone prints and decides on exit codes; the library only throws. The
// whole command can be called as a function, as tests do.
#pragma once

#include "options.hpp"
#include "ranks.hpp"
#include "report.hpp"

namespace pgdr::tool {

/// The exit codes, as docs/usage.md lists them.
enum ExitCode : int {
  exit_done = 0,          ///< done, and every bound is met
  exit_poor_left = 1,     ///< done, with elements that stayed poor for listed reasons
  exit_usage = 2,         ///< the arguments are wrong
  exit_input = 3,         ///< the input is malformed, of an unknown format, or refused by diagnosis
  exit_file = 4,          ///< a file cannot be opened or written
  exit_stopped = 5,       ///< stopped by a budget or a signal; a valid partial mesh was written
  exit_check_failed = 6,  ///< `check` found something wrong
  exit_resource = 7,      ///< out of memory, ids exhausted, internal error; no output file
};

/// The whole command, from the arguments to the exit code. Never throws.
int run(int argc, const char* const* argv) noexcept;
/// The part of the command that follows once the arguments are understood. It survives any failure to allocate (CLI11, which
/// reads the arguments, does not). On several ranks, which all call it at once: `mesh` alone, and all return the same, unless
/// they are lost.
int execute(const Arguments& arguments, const Ranks& ranks = {}) noexcept;

// The subcommands. They print their summary, fill the report, and return the exit code; errors are thrown.
int mesh(const MeshArguments& arguments, Report& report, const Ranks& ranks);
int check(const CheckArguments& arguments, Report& report);
int info(const InfoArguments& arguments, Report& report);
int view(const ViewArguments& arguments, Report& report);
int join(const JoinArguments& arguments, Report& report);

}  // namespace pgdr::tool
