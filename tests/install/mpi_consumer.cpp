// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// A program of a user who has MPI: one mesh by all processes of a communicator.
#include <cstdio>

#include <pgdr/mpi.hpp>
#include <pgdr/pgdr.hpp>

int main(int argc, char** argv) {
  int provided = 0;
  MPI_Init_thread(&argc, &argv, MPI_THREAD_FUNNELED, &provided);
  pgdr::Plc<2> square;
  square.points = {{{0, 0}}, {{1, 0}}, {{1, 1}}, {{0, 1}}};
  square.segments = {{{0, 1}}, {{1, 2}}, {{2, 3}}, {{3, 0}}};
  pgdr::RefineOptions<2> options;
  options.size = 0.01;
  const auto result = pgdr::refine(MPI_COMM_WORLD, square, options);
  const pgdr::OutputMesh<2> whole = pgdr::gather(MPI_COMM_WORLD, result.piece);
  std::printf("%zu triangles of %zu\n", result.piece.mesh.cells.size(), whole.cells.size());
  MPI_Finalize();
  return result.run.stop == pgdr::StopCause::finished && whole.cells.size() >= 100 ? 0 : 1;
}
