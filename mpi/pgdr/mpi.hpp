// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Ranks that are the processes of an MPI communicator. Needs a build with PGDR_MPI, and pgdr::mpi beside pgdr::pgdr.
//
// The caller initialises MPI, with MPI_THREAD_FUNNELED or more, and finalises it; here only the calling thread talks to it, which
// must be the main one unless MPI was initialised for more. Each call works on a duplicate of the communicator, aborts nothing,
// and sleeps while it waits for long.
#pragma once

#include <mpi.h>

#include <chrono>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>

#include "pgdr/io.hpp"
#include "pgdr/output_mesh.hpp"
#include "pgdr/plc.hpp"
#include "pgdr/ranks.hpp"
#include "pgdr/refine_options.hpp"
#include "pgdr/transport.hpp"

namespace pgdr PGDR_API {

/// How messages travel.
struct MpiOptions {
  /// A rank that waits longer for another than this throws RankFailure, which names it. None: it waits for ever.
  std::optional<std::chrono::duration<double>> timeout;
  std::size_t chunk = std::size_t{1} << 30;  ///< bytes: longer messages go in parts of this length, at least 1 and below 2^31
};

/// A duplicate of a communicator.
class MpiTransport final : public Transport {
 public:
  /// All processes of the communicator make it at once.
  /// @throws UsageError bad_option: MPI is not initialised, or not for threads, or this is not its thread; RankFailure
  explicit MpiTransport(MPI_Comm communicator, const MpiOptions& options = {});
  /// Waits until all that was sent has left, unless a rank has failed or an exception is on its way.
  ~MpiTransport() override;
  MpiTransport(const MpiTransport&) = delete;             ///< one a rank
  MpiTransport& operator=(const MpiTransport&) = delete;  ///< the same

  int rank() const override;
  int size() const override;
  void send(int to, std::uint64_t tag, Bytes message) override;
  Bytes receive(int from, std::uint64_t tag) override;
  bool has_failed() const override;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// As refine(Transport&, ...) on all processes of the communicator. Two calls may follow each other; on different communicators
/// they may run in different processes at once.
/// @throws as refine(Transport&, ...); UsageError bad_option as MpiTransport
template <int D>
DistributedResult<D> refine(MPI_Comm communicator, const Plc<D>& plc, const RefineOptions<D>& options);

/// As write_mesh(Transport&, ...) on all processes of the communicator that made the mesh, which call it at once.
/// @throws as write_mesh(Transport&, ...); UsageError bad_option as MpiTransport
template <int D>
void write_mesh(MPI_Comm communicator, const std::string& file, const DistributedResult<D>& result,
                const WriteOptions& options = {});

/// The whole mesh on process 0 of the communicator, an empty one on the others. @throws as gather(Transport&, ...)
template <int D>
OutputMesh<D> gather(MPI_Comm communicator, const MeshPiece<D>& piece);

}  // namespace pgdr
