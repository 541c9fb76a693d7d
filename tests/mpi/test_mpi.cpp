// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Ranks that are processes: to be started by mpirun with four of them. Every process runs all tests; each prints its own
// failures.
#include "pgdr/mpi.hpp"

#include <gtest/gtest.h>

#include <stdexcept>
#include <string>

#include "refined_models.hpp"
#include "same_bytes.hpp"

namespace pgdr::test_mpi {

constexpr int processes = 4;

RefineOptions<3> coarse() {
  RefineOptions<3> options;
  options.size = 0.3;
  options.schedule.threads = 1;
  return options;
}

Bytes message_of(int from, int to, std::uint64_t tag) {
  return Bytes((static_cast<std::size_t>(from) * 977 + static_cast<std::size_t>(to) * 31 + tag * 517) % 3000,
               static_cast<std::byte>(from + 4 * to + 16 * static_cast<int>(tag)));
}

/// All to all, asked for in another order than sent, in parts of any length.
TEST(Mpi, MessagesArriveWhole) {
  constexpr std::uint64_t tags = 9;
  for (const std::size_t chunk : {std::size_t{1}, std::size_t{7}, std::size_t{1000}, std::size_t{1} << 30}) {
    MpiTransport transport(MPI_COMM_WORLD, {.chunk = chunk});
    ASSERT_EQ(transport.size(), processes);
    for (std::uint64_t tag = 0; tag < tags; ++tag)
      for (int to = 0; to < processes; ++to) transport.send(to, tag << 50, message_of(transport.rank(), to, tag));
    for (std::uint64_t tag = tags; tag-- > 0;)
      for (int from = 0; from < processes; ++from)
        EXPECT_EQ(transport.receive(from, tag << 50), message_of(from, transport.rank(), tag)) << chunk;
  }
}

TEST(Mpi, LongMessagesGoBothWaysAtOnce) {
  MpiTransport transport(MPI_COMM_WORLD, {.chunk = std::size_t{1} << 20});
  const Bytes message((std::size_t{10} << 20) + 3, static_cast<std::byte>(transport.rank()));
  const int next = (transport.rank() + 1) % processes, before = (transport.rank() + processes - 1) % processes;
  transport.send(next, 1, message);
  EXPECT_EQ(transport.receive(before, 1), Bytes(message.size(), static_cast<std::byte>(before)));
}

TEST(Mpi, ARankThatDoesNotAnswerIsNamed) {
  {
    MpiTransport transport(MPI_COMM_WORLD, {.timeout = std::chrono::milliseconds(200)});
    if (transport.rank() == 0) {
      try {
        transport.receive(2, 5);
        ADD_FAILURE() << "a message that nobody sent";
      } catch (const RankFailure& e) {
        EXPECT_NE(std::string(e.what()).find("rank 2"), std::string::npos) << e.what();
      }
      EXPECT_TRUE(transport.has_failed());
    }
  }
  MPI_Barrier(MPI_COMM_WORLD);
}

/// The caller's communicator: each half of the world makes a mesh of its own, and then another.
TEST(Mpi, HalvesOfTheWorldMakeMeshesSideBySide) {
  int rank = 0;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  MPI_Comm half = MPI_COMM_NULL;
  MPI_Comm_split(MPI_COMM_WORLD, rank % 2, rank, &half);
  for (const Plc<3>& plc : {rank % 2 ? test::cube() : test::l_block(), test::two_region_cube()}) {
    const test::Outcome<3> alone = test::refine_and_check<3>(plc, coarse());
    EXPECT_EQ(alone.report.exit_code(), 0) << test::findings(alone.report);
    const DistributedResult<3> result = refine(half, plc, coarse());
    EXPECT_EQ(result.distributed.ranks, 2);
    EXPECT_EQ(result.run.poor_left, alone.result.poor_left);
    const OutputMesh<3> whole = gather(half, result.piece);
    if (rank >= 2) continue;
    EXPECT_TRUE(test::same_bytes(whole.points, alone.result.mesh.points));
    EXPECT_TRUE(test::same_bytes(whole.cells, alone.result.mesh.cells));
    EXPECT_TRUE(test::same_bytes(whole.subfacets, alone.result.mesh.subfacets));
  }
  MPI_Comm_free(&half);
}

/// `error` is thrown by the callback of process 1. @returns what this one gets
template <class E>
std::exception_ptr thrown_by_one(const E& error) {
  int rank = 0;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  RefineOptions<3> options = coarse();
  if (rank == 1) options.prepared = [error](const Domain<3>&) { throw error; };
  try {
    refine(MPI_COMM_WORLD, test::cube(), options);
  } catch (...) {
    return std::current_exception();
  }
  return nullptr;
}

TEST(Mpi, ACallbackThatThrowsOnOneProcessThrowsOnAll) {
  const std::exception_ptr error = thrown_by_one(UsageError({.code = Errc::bad_size, .message = "no size here"}));
  ASSERT_TRUE(error);
  try {
    std::rethrow_exception(error);
  } catch (const UsageError& e) {
    EXPECT_EQ(e.code(), Errc::bad_size);
    EXPECT_STREQ(e.what(), "no size here");
  }
}

TEST(Mpi, AnUntypedErrorHasItsWordsOnAll) {
  const std::exception_ptr error = thrown_by_one(std::runtime_error("the caller's"));
  ASSERT_TRUE(error);
  try {
    std::rethrow_exception(error);
  } catch (const std::exception& e) {
    EXPECT_NE(std::string(e.what()).find("the caller's"), std::string::npos) << e.what();
  }
}

TEST(Mpi, UnlikeInputsAreFound) {
  int rank = 0;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  try {
    refine(MPI_COMM_WORLD, rank == 3 ? test::l_block() : test::cube(), coarse());
    ADD_FAILURE() << "unlike meshes were taken";
  } catch (const ResourceError& e) {
    EXPECT_EQ(e.code(), Errc::unlike_ranks);
  }
}

}  // namespace pgdr::test_mpi

int main(int argc, char** argv) {
  int provided = 0;
  MPI_Init_thread(&argc, &argv, MPI_THREAD_FUNNELED, &provided);
  testing::InitGoogleTest(&argc, argv);
  const int failed = RUN_ALL_TESTS();
  MPI_Finalize();
  return failed;
}
