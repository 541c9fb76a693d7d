// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The pgdr command: subcommands and exit codes. Words, exit codes and files of the project are made in this folder
// alone; the library only throws. The whole command can be called as a function (tests do).
#pragma once

#include "options.hpp"
#include "report.hpp"

namespace pgdr::tool {

/// A fixed contract, see docs/usage.md.
enum ExitCode : int {
  exit_done = 0,          ///< and every bound met
  exit_poor_left = 1,     ///< done, with elements that stayed poor for listed reasons
  exit_usage = 2,
  exit_input = 3,         ///< malformed, unknown format, or refused by diagnosis
  exit_file = 4,          ///< cannot be opened or written
  exit_stopped = 5,       ///< by a budget or a signal; a valid partial mesh was written
  exit_check_failed = 6,
  exit_resource = 7,      ///< out of memory, ids exhausted, internal error; no output file
};

/// The whole command, from the arguments to the exit code. Never throws.
int run(int argc, const char* const* argv) noexcept;
/// What is left of it once the arguments are understood: this part survives any failure to allocate (CLI11, which
/// reads the arguments, does not).
int execute(const Arguments& arguments) noexcept;

// The subcommands. They print their summary, fill the report, and return the exit code; errors are thrown.
int mesh(const MeshArguments& arguments, Report& report);
int check(const CheckArguments& arguments, Report& report);
int info(const InfoArguments& arguments, Report& report);
int view(const ViewArguments& arguments, Report& report);

}  // namespace pgdr::tool
