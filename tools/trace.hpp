// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The file of --trace: Chrome trace events, which Perfetto shows. One row for the phases of the command, which one
// thread runs one after the other, one for the stages of refining and optimising, and one for each thread that visited leaves.
#pragma once

#include <span>
#include <string>

#include "pgdr/refine.hpp"

namespace pgdr::tool {

/// A part of the command. Seconds since the command began.
struct Phase {
  const char* name;
  double start, end;
};

/// Writes to a temporary name and renames. @param mesh_at when the meshing began, from which stages and visits count their time.
/// @throws FileError cannot_write
void write_trace(const std::string& file, std::span<const Phase> phases, std::span<const StageTime> stages,
                 std::span<const VisitTrace> visits, double mesh_at);

}  // namespace pgdr::tool
