// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// One mesh by several processes, each of which ends with a piece of it. Over MPI: pgdr/mpi.hpp.
#pragma once

#include <cstdint>
#include <exception>

#include "pgdr/check.hpp"
#include "pgdr/export.hpp"
#include "pgdr/io.hpp"
#include "pgdr/mesh_piece.hpp"
#include "pgdr/output_mesh.hpp"
#include "pgdr/plc.hpp"
#include "pgdr/quality.hpp"
#include "pgdr/refine.hpp"
#include "pgdr/refine_options.hpp"
#include "pgdr/transport.hpp"

namespace pgdr PGDR_API {

/// How the ranks shared a run. Counts are sums over all ranks, seconds the most of any rank.
struct DistributedStatistics {
  int ranks = 1;                       ///< that took part
  std::uint64_t messages = 0;          ///< from one rank to another
  std::uint64_t bytes_sent = 0;        ///< in these
  std::uint64_t cut_generation = 0;    ///< after which each rank kept its own part; 0: there was no cut
  std::uint64_t cut_cells = 0;         ///< of the whole mesh then
  std::uint64_t cells_applied = 0;     ///< that ranks got from others
  bool gathered = false;               ///< did rank 0 finish the run alone?
  double seconds_prologue = 0;         ///< until the cut, which every rank does alike
  double seconds_pack = 0;             ///< making messages
  double seconds_apply = 0;            ///< putting what came into the mesh
  double seconds_wait = 0;             ///< for messages
  double seconds_finish = 0;           ///< after the last phase: gathering, numbering
  std::uint64_t least_peak_rss = 0;    ///< bytes of memory at most, of the rank that needed least
  std::uint64_t largest_peak_rss = 0;  ///< of the rank that needed most
};

/// What one rank has of a mesh that several made.
template <int D>
struct DistributedResult {
  /// Without its mesh. Its fields are those of one rank, or joined from all:
  ///
  ///   | field                                  | of all ranks                                                          |
  ///   | -------------------------------------- | --------------------------------------------------------------------- |
  ///   | times, threads, predicates, trace      | this rank's own                                                       |
  ///   | scheduler: visits, set_aside, ...      | the sum; what all made alike, before the cut, counts once              |
  ///   | scheduler: work_seconds                | the sum without waiting; only visits, where rank 0 ended the run alone |
  ///   | scheduler: serial and critical seconds | the most                                                              |
  ///   | all else                               | equal                                                                 |
  RefineResult<D> run;
  MeshPiece<D> piece;                 ///< of this rank; empty where there is no mesh
  SharingRanks sharing;               ///< which other ranks have each point of the piece
  DistributedStatistics distributed;  ///< the same on all ranks
};

/// Meshes the Domain of the input on all ranks of the transport, which call this at once, with the same input and the same
/// options. Together the pieces are the mesh that refine(plc, options) makes. Callbacks are called on every rank, and say the
/// same on each; progress and the clock of the time limit are those of rank 0 alone. An exception of a callback, on any rank,
/// comes out of all: as it is where it was thrown, as RankFailure with its words elsewhere if it is no Error.
/// @throws what refine() throws, of the lowest rank that failed, on all; UsageError bad_option (also for the greedy schedule,
///   which depends on timing); ResourceError unlike_ranks if the ranks did not make the same mesh: unlike input, options,
///   callbacks, builds; RankFailure
template <int D>
DistributedResult<D> refine(Transport& transport, const Plc<D>& plc, const RefineOptions<D>& options);

/// Writes the mesh of all pieces as write_mesh() of io.hpp writes it of one process: a .vtu by all ranks at once, byte for byte
/// the same, on a file system that all have; a .pvtu in options.pieces files, or one a rank; other formats by rank 0, which gets
/// the whole mesh. All ranks call it, with the same name and options. An error of one rank is one of all, and leaves no file.
/// @throws FileError cannot_write; InputError unknown_format; UsageError bad_option; ResourceError ids_exhausted if there are
///   more points or cells than the format holds; RankFailure
template <int D>
void write_mesh(Transport& transport, const std::string& file, const DistributedResult<D>& result,
                const WriteOptions& options = {});

/// The quality of the mesh of all pieces, as summarize_quality() finds it of the whole: the same on all ranks, for any number of
/// them. No rank gets cells of another. All ranks call it. @throws RankFailure
template <int D>
QualitySummary summarize_quality(Transport& transport, const MeshPiece<D>& piece);

/// What count_not_delaunay(mesh, violations_seen) counts in the mesh of all pieces, on all ranks. A rank gets the cells beside
/// its own. All ranks call it. @throws ResourceError, RankFailure
template <int D>
NotDelaunay count_not_delaunay(Transport& transport, const DistributedResult<D>& result);

/// The input of rank 0, on all ranks; those of the others do not matter. All ranks call it. @throws RankFailure
template <int D>
Plc<D> broadcast(Transport& transport, const Plc<D>& plc);

/// The whole mesh on rank 0, an empty one on the others. @throws ResourceError, RankFailure
template <int D>
OutputMesh<D> gather(Transport& transport, const MeshPiece<D>& piece);

/// Throws on all ranks if any rank gives an error: that of the lowest rank, as it is there, and of the same type on the others;
/// what is no Error is a RankFailure there. Null: none. @throws RankFailure
void throw_together(Transport& transport, const std::exception_ptr& error);

/// The largest of the numbers that the ranks give, on all: codes to exit with, for example. @throws RankFailure
int largest_of_ranks(Transport& transport, int number);

}  // namespace pgdr
