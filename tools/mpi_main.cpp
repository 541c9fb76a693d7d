// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// pgdr-mpi: the command on the processes of MPI. `mesh` runs on all of them, everything else on the first, while the others
// sleep.
#include <mpi.h>
#include <pthread.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <optional>
#include <type_traits>

#include "command.hpp"
#include "console.hpp"
#include "pgdr/mpi.hpp"

namespace pgdr::tool {
namespace {

/// What a rank other than the first does: the same work, in silence.
Arguments silent(Arguments arguments) {
  if (auto* a = std::get_if<MeshArguments>(&arguments)) {
    a->quiet = true;
    a->report.clear();
    a->trace.clear();
  }
  return arguments;
}

MpiOptions options_of(const Arguments& arguments) {
  MpiOptions options;
  if (const auto* a = std::get_if<MeshArguments>(&arguments); a && a->rank_timeout)
    options.timeout = std::chrono::duration<double>(*a->rank_timeout);
  return options;
}

/// @returns the exit code, the same on all ranks. Where they cannot agree any more all processes are ended.
int execute_on_ranks(const Arguments& arguments) {
  MpiTransport transport(MPI_COMM_WORLD, options_of(arguments));
  const Ranks ranks(transport);
  int code = exit_done;
  if (std::holds_alternative<MeshArguments>(arguments))
    code = execute(ranks.is_first() ? arguments : silent(arguments), ranks);
  else
    code = ranks.largest(ranks.is_first() ? execute(arguments) : exit_done);
  if (ranks.are_lost()) MPI_Abort(MPI_COMM_WORLD, exit_resource);
  return code;
}

int run_on_ranks(int argc, char** argv) {
  int rank = 0;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  const auto parsed = parse(argc, argv, rank == 0);
  return std::holds_alternative<int>(parsed) ? std::get<int>(parsed) : execute_on_ranks(std::get<Arguments>(parsed));
}

/// Threads that MPI makes for itself must not take the signals that a run waits for (StopOnSignal).
bool init_mpi(int& argc, char**& argv) {
  sigset_t signals, before;
  sigemptyset(&signals);
  sigaddset(&signals, SIGINT);
  sigaddset(&signals, SIGTERM);
  pthread_sigmask(SIG_BLOCK, &signals, &before);
  int provided = 0;
  const bool is_ready = MPI_Init_thread(&argc, &argv, MPI_THREAD_FUNNELED, &provided) == MPI_SUCCESS;
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
  return is_ready;
}

}  // namespace
}  // namespace pgdr::tool

int main(int argc, char** argv) {
  pgdr::tool::prepare_process();
  if (!pgdr::tool::init_mpi(argc, argv)) return pgdr::tool::exit_resource;
  int code = pgdr::tool::exit_resource;
  try {
    code = pgdr::tool::run_on_ranks(argc, argv);
  } catch (const std::exception& e) {  // of this rank alone: the others would wait for it
    std::fprintf(stderr, "pgdr-mpi: error: %s\n", e.what());
    MPI_Abort(MPI_COMM_WORLD, code);
  }
  MPI_Finalize();
  return code;
}
