// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The only source that calls MPI. Nothing blocks inside of it: some implementations spin there, and take the core from the
// threads of other ranks. What has to wait tests for about as long as the shortest sleep takes, since it could not wake up sooner
// from one, and sleeps then.
//
// A message is one MPI message, head and bytes, or, if it is long, a head followed by its parts. All have one MPI tag, so that
// those of one sender come in their order (and no tag is too large for MPI); the tag of the transport is in the head.
#include "pgdr/mpi.hpp"

#include <algorithm>
#include <cstring>
#include <exception>
#include <list>
#include <map>
#include <string>
#include <thread>
#include <utility>

namespace pgdr {
namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::microseconds;

constexpr int mpi_tag = 0;
constexpr std::size_t longest_with_head = 1 << 16;              // bytes: a copy of so few costs less than a message
constexpr microseconds shortest_sleep{50}, longest_sleep{200};  // a system may add as much as the first

struct Head {
  std::uint64_t tag, size;
};

[[noreturn]] void fail(const std::string& why) { throw RankFailure({.code = Errc::rank_failed, .message = why}); }
[[noreturn]] void refuse(const char* why) { throw UsageError({.code = Errc::bad_option, .message = why}); }

/// Of a call of MPI whose communicator returns its errors.
void require(int code, const char* call) {
  if (code == MPI_SUCCESS) return;
  char words[MPI_MAX_ERROR_STRING];
  int length = 0;
  MPI_Error_string(code, words, &length);
  fail(std::string(call) + ": " + std::string(words, static_cast<std::size_t>(length)));
}

void require_ready() {
  int initialized = 0, finalized = 0, provided = MPI_THREAD_SINGLE, is_main = 0;
  MPI_Initialized(&initialized);
  MPI_Finalized(&finalized);
  if (!initialized || finalized) refuse("MPI is not initialised, or finalised already");
  MPI_Query_thread(&provided);
  if (provided < MPI_THREAD_FUNNELED) refuse("MPI must be initialised with MPI_THREAD_FUNNELED or more: pgdr has threads");
  MPI_Is_thread_main(&is_main);
  if (provided == MPI_THREAD_FUNNELED && !is_main) refuse("with MPI_THREAD_FUNNELED only the main thread may use MPI");
}

/// Between tests: lets other threads run at first, then sleeps for an eighth of the time that it has waited.
class Patience {
 public:
  void rest() {
    const auto waited = std::chrono::duration_cast<microseconds>(Clock::now() - start_);
    if (waited < 2 * shortest_sleep)
      std::this_thread::yield();
    else
      std::this_thread::sleep_for(std::clamp(waited / 8, shortest_sleep, longest_sleep));
  }

 private:
  Clock::time_point start_ = Clock::now();
};

MPI_Comm duplicate(MPI_Comm communicator) {
  MPI_Comm own = MPI_COMM_NULL;
  MPI_Request request = MPI_REQUEST_NULL;
  require(MPI_Comm_idup(communicator, &own, &request), "MPI_Comm_idup");
  int done = 0;
  for (Patience patience; true; patience.rest()) {
    require(MPI_Test(&request, &done, MPI_STATUS_IGNORE), "MPI_Test");
    if (done) break;
  }
  require(MPI_Comm_set_errhandler(own, MPI_ERRORS_RETURN), "MPI_Comm_set_errhandler");
  return own;
}

}  // namespace

struct MpiTransport::State {
  /// A message on its way to another rank.
  struct Outgoing {
    Bytes head, body;
    std::vector<MPI_Request> requests;
  };
  /// A long message that comes in parts.
  struct Partial {
    std::uint64_t tag = 0;
    Bytes body;
    std::size_t filled = 0;
  };

  State(MPI_Comm communicator, const MpiOptions& given) : options(given), comm(duplicate(communicator)) {
    require(MPI_Comm_rank(comm, &rank), "MPI_Comm_rank");
    require(MPI_Comm_size(comm, &size), "MPI_Comm_size");
  }

  void isend(Outgoing& out, const std::byte* data, std::size_t count, int to) {
    MPI_Request& request = out.requests.emplace_back(MPI_REQUEST_NULL);
    require(MPI_Isend(data, static_cast<int>(count), MPI_BYTE, to, mpi_tag, comm, &request), "MPI_Isend");
  }

  void send(int to, std::uint64_t tag, Bytes message) {
    Outgoing& out = going.emplace_back();
    const Head head{tag, message.size()};
    const bool is_short = message.size() <= std::min(longest_with_head, options.chunk);
    out.head.resize(sizeof head + (is_short ? message.size() : 0));
    std::memcpy(out.head.data(), &head, sizeof head);
    if (is_short)
      std::copy(message.begin(), message.end(), out.head.begin() + sizeof head);
    else
      out.body = std::move(message);
    isend(out, out.head.data(), out.head.size(), to);
    for (std::size_t at = 0; at < out.body.size(); at += options.chunk)
      isend(out, out.body.data() + at, std::min(options.chunk, out.body.size() - at), to);
    forget_sent();
  }

  /// Lets MPI work on what is being sent, and frees what has left.
  void forget_sent() {
    for (auto out = going.begin(); out != going.end();) {
      int done = 0;
      require(MPI_Testall(static_cast<int>(out->requests.size()), out->requests.data(), &done, MPI_STATUSES_IGNORE),
              "MPI_Testall");
      out = done ? going.erase(out) : std::next(out);
    }
  }

  /// The one place that waits: until `is_done`, for rank `other` if it is one.
  template <class IsDone>
  void wait(int other, IsDone is_done) {
    const auto start = Clock::now();
    for (Patience patience; !is_done(); patience.rest()) {
      forget_sent();
      if (options.timeout && Clock::now() - start > *options.timeout) {
        const std::string whom = other < 0 ? "others" : "rank " + std::to_string(other);
        fail("rank " + std::to_string(rank) + " has waited too long for " + whom + ": it has ended, or hangs");
      }
    }
  }

  /// Takes in one message of MPI, if any is there.
  bool take_any() {
    int is_there = 0, count = 0;
    MPI_Message message;
    MPI_Status status;
    require(MPI_Improbe(MPI_ANY_SOURCE, mpi_tag, comm, &is_there, &message, &status), "MPI_Improbe");
    if (!is_there) return false;
    require(MPI_Get_count(&status, MPI_BYTE, &count), "MPI_Get_count");
    const int from = status.MPI_SOURCE;
    if (const auto open = partial.find(from); open != partial.end()) {
      Partial& part = open->second;
      if (static_cast<std::size_t>(count) > part.body.size() - part.filled) fail("a message is longer than it should be");
      take(message, part.body.data() + part.filled, count, from);
      part.filled += static_cast<std::size_t>(count);
      if (part.filled < part.body.size()) return true;
      arrived[{from, part.tag}] = std::move(part.body);
      partial.erase(open);
      return true;
    }
    Bytes bytes(static_cast<std::size_t>(count));
    take(message, bytes.data(), count, from);
    begin(from, std::move(bytes));
    return true;
  }

  void take(MPI_Message& message, std::byte* to, int count, int from) {
    MPI_Request request = MPI_REQUEST_NULL;
    require(MPI_Imrecv(to, count, MPI_BYTE, &message, &request), "MPI_Imrecv");
    wait(from, [&] {
      int done = 0;
      require(MPI_Test(&request, &done, MPI_STATUS_IGNORE), "MPI_Test");
      return done != 0;
    });
  }

  /// A head, and what comes with it.
  void begin(int from, Bytes bytes) {
    Head head{};
    if (bytes.size() < sizeof head) fail("a message without a head");
    std::memcpy(&head, bytes.data(), sizeof head);
    bytes.erase(bytes.begin(), bytes.begin() + sizeof head);
    if (bytes.size() == head.size)
      arrived[{from, head.tag}] = std::move(bytes);
    else
      partial[from] = {head.tag, Bytes(head.size), 0};
  }

  Bytes receive(int from, std::uint64_t tag) {
    auto found = arrived.find({from, tag});
    wait(from, [&] {
      while (found == arrived.end() && take_any()) found = arrived.find({from, tag});
      return found != arrived.end();
    });
    Bytes message = std::move(found->second);
    arrived.erase(found);
    return message;
  }

  const MpiOptions options;
  const MPI_Comm comm;
  const int exceptions = std::uncaught_exceptions();
  int rank = 0, size = 1;
  bool has_failed = false;
  std::list<Outgoing> going;
  std::map<int, Partial> partial;                          // by sender
  std::map<std::pair<int, std::uint64_t>, Bytes> arrived;  // by sender and tag
};

MpiTransport::MpiTransport(MPI_Comm communicator, const MpiOptions& options) {
  require_ready();
  if (options.chunk < 1 || options.chunk >= std::size_t{1} << 31) refuse("a part of a message has from 1 to 2^31 - 1 bytes");
  state_ = std::make_unique<State>(communicator, options);
}

MpiTransport::~MpiTransport() {
  const bool is_lost = state_->has_failed || std::uncaught_exceptions() > state_->exceptions;
  try {
    state_->forget_sent();
    if (!is_lost) state_->wait(-1, [this] { return state_->forget_sent(), state_->going.empty(); });
  } catch (const RankFailure&) {
  }
  // MPI still reads what has not left: that must stay, and so must the communicator.
  MPI_Comm comm = state_->comm;
  if (state_->going.empty())
    MPI_Comm_free(&comm);
  else
    static_cast<void>(state_.release());
}

int MpiTransport::rank() const { return state_->rank; }
int MpiTransport::size() const { return state_->size; }
bool MpiTransport::has_failed() const { return state_->has_failed; }

void MpiTransport::send(int to, std::uint64_t tag, Bytes message) {
  if (to == state_->rank) {
    state_->arrived[{to, tag}] = std::move(message);
    return;
  }
  state_->has_failed = true;  // unless it goes well
  state_->send(to, tag, std::move(message));
  state_->has_failed = false;
}

Bytes MpiTransport::receive(int from, std::uint64_t tag) {
  state_->has_failed = true;
  Bytes message = state_->receive(from, tag);
  state_->has_failed = false;
  return message;
}

template <int D>
DistributedResult<D> refine(MPI_Comm communicator, const Plc<D>& plc, const RefineOptions<D>& options) {
  MpiTransport transport(communicator);
  return refine(static_cast<Transport&>(transport), plc, options);
}

template <int D>
void write_mesh(MPI_Comm communicator, const std::string& file, const DistributedResult<D>& result, const WriteOptions& options) {
  MpiTransport transport(communicator);
  write_mesh(static_cast<Transport&>(transport), file, result, options);
}

template <int D>
OutputMesh<D> gather(MPI_Comm communicator, const MeshPiece<D>& piece) {
  MpiTransport transport(communicator);
  return gather(static_cast<Transport&>(transport), piece);
}

template PGDR_API DistributedResult<2> refine<2>(MPI_Comm, const Plc<2>&, const RefineOptions<2>&);
template PGDR_API DistributedResult<3> refine<3>(MPI_Comm, const Plc<3>&, const RefineOptions<3>&);
template PGDR_API void write_mesh<2>(MPI_Comm, const std::string&, const DistributedResult<2>&, const WriteOptions&);
template PGDR_API void write_mesh<3>(MPI_Comm, const std::string&, const DistributedResult<3>&, const WriteOptions&);
template PGDR_API OutputMesh<2> gather<2>(MPI_Comm, const MeshPiece<2>&);
template PGDR_API OutputMesh<3> gather<3>(MPI_Comm, const MeshPiece<3>&);

}  // namespace pgdr
