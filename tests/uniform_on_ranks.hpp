// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Runs of the uniform schedule on local ranks beside the same run of one process.
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "local_ranks.hpp"
#include "parallel_support.hpp"
#include "pgdr/ranks.hpp"

namespace pgdr::test {

/// Windows so small that small meshes are cut.
template <int D>
RefineOptions<D> uniform_options(double size, int threads = 1) {
  RefineOptions<D> options;
  options.size = size;
  options.schedule.schedule = Schedule::uniform;
  options.schedule.threads = threads;
  options.schedule.floor = 60;
  if (!PGDR_TEST_TBB) options.schedule.executor = Executor::threads;
  if constexpr (D == 3) options.min_dihedral = 0;
  return options;
}

/// The run of one process. Its mesh goes through the checker.
template <int D>
RefineResult<D> checked_alone(const Plc<D>& plc, const RefineOptions<D>& options) {
  Outcome<D> outcome = refine_and_check<D>(plc, options);
  EXPECT_TRUE(outcome.result.stop != StopCause::finished || outcome.report.exit_code() <= 1) << findings(outcome.report);
  EXPECT_TRUE(outcome.result.stop == StopCause::finished || unfinished_but_valid(outcome.report)) << findings(outcome.report);
  return std::move(outcome.result);
}

/// Do the ranks make this mesh, with the same counts? @returns how they shared the run
template <int D>
DistributedStatistics expect_on_ranks(const Plc<D>& plc, const RefineOptions<D>& options, const RefineResult<D>& alone, int ranks,
                                      std::uint64_t seed) {
  const testing::ScopedTrace trace(__FILE__, __LINE__, std::to_string(ranks) + " ranks, seed " + std::to_string(seed));
  std::vector<DistributedResult<D>> results(static_cast<std::size_t>(ranks));
  run_on_local_ranks(ranks, seed, [&](Transport& transport) {
    results[static_cast<std::size_t>(transport.rank())] = refine(transport, plc, options);
  });
  std::vector<MeshPiece<D>> pieces;
  for (auto& r : results) pieces.push_back(std::move(r.piece));
  expect_same_mesh<D>(alone.mesh, join_pieces<D>(pieces));
  for (const auto& r : results) {
    EXPECT_EQ(r.run.stop, alone.stop);
    EXPECT_EQ(r.run.poor_left, alone.poor_left);
    EXPECT_EQ(r.run.size_met, alone.size_met);
    EXPECT_EQ(r.run.reasons.size(), alone.reasons.size());
    EXPECT_EQ(r.run.statistics.insertions_committed, alone.statistics.insertions_committed);
    EXPECT_EQ(r.run.statistics.insertions_refused, alone.statistics.insertions_refused);
    EXPECT_EQ(r.run.scheduler.generations, alone.scheduler.generations);
  }
  return results.front().distributed;
}

/// The same, beside a run of one process that is made for it.
template <int D>
DistributedStatistics expect_same_on_ranks(const Plc<D>& plc, const RefineOptions<D>& options, int ranks, std::uint64_t seed) {
  return expect_on_ranks<D>(plc, options, checked_alone<D>(plc, options), ranks, seed);
}

}  // namespace pgdr::test
