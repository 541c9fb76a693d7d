// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// What ranks talk through: a rank is one of several processes, or threads, that make one mesh together. Over MPI: pgdr::mpi.
// Another network, or none, is a class of one's own.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "pgdr/error.hpp"
#include "pgdr/export.hpp"

namespace pgdr PGDR_API {

/// A message, as it travels. Numbers in it are those of the machine: all ranks are of one kind.
using Bytes = std::vector<std::byte>;

/// Another rank has ended, does not answer, or failed in a way that has no type here (exit code 7). Nothing can be sent any more
/// unless the message says otherwise.
struct RankFailure : Error {
  using Error::Error;
};

/// Messages between ranks. One object a rank, used by one thread at a time.
class Transport {
 public:
  virtual ~Transport();
  virtual int rank() const = 0;  ///< of the caller, from 0
  virtual int size() const = 0;  ///< number of ranks, at least 1
  /// Hands a message over and does not wait. Each (from, to, tag) is used once; a rank may send to itself.
  /// @throws RankFailure
  virtual void send(int to, std::uint64_t tag, Bytes message) = 0;
  /// Waits for that message, and spins no longer than a sleep takes. Others may come before it, and are kept until they are asked
  /// for. @throws RankFailure
  virtual Bytes receive(int from, std::uint64_t tag) = 0;
  /// Did send() or receive() throw? Then the others cannot be reached any more.
  virtual bool has_failed() const { return false; }

  /// A number for the tags of the next conversation: 0, 1, ... All ranks begin their conversations in one order, and so agree.
  std::uint64_t begin_conversation() { return conversations_++; }

 protected:
  Transport() = default;
  Transport(const Transport&) = default;             ///< for classes of one's own
  Transport& operator=(const Transport&) = default;  ///< the same

 private:
  std::uint64_t conversations_ = 0;
};

}  // namespace pgdr
