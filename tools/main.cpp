// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <cstdlib>

#include "command.hpp"
#include "console.hpp"

namespace {

/// Has a launcher of MPI started several of this process? Each would write the same file.
bool is_one_of_several() {
  for (const char* const variable : {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE"})
    if (const char* const size = std::getenv(variable); size && std::atol(size) > 1) return true;
  return false;
}

}  // namespace

int main(int argc, char** argv) {
  pgdr::tool::prepare_process();
  if (is_one_of_several()) {
    std::fputs("pgdr: error: MPI has started several of this program, which is for one process: use pgdr-mpi\n", stderr);
    return pgdr::tool::exit_usage;
  }
  return pgdr::tool::run(argc, argv);
}
