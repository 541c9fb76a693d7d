// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The executors that a mesh must not depend on, and the comparison of results to the last bit.
#pragma once

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <string>
#include <thread>
#include <vector>

#include "allow_threads.hpp"
#include "refined_models.hpp"
#include "same_bytes.hpp"
#include "sanitized.hpp"

namespace pgdr::test {

struct Runner {
  const char* name;
  Executor executor;
  int threads;
};

inline constexpr Runner serial{"serial", Executor::serial, 1};
inline constexpr Runner shuffled{"shuffled", Executor::shuffled, 3};
/// All others; those of eight threads last.
inline const std::vector<Runner> concurrent_runners = {
    shuffled,
    {"threads 1", Executor::threads, 1},
    {"threads 2", Executor::threads, 2},
#if PGDR_TEST_TBB
    {"flow graph 2", Executor::flow_graph, 2},
    {"flow graph 8", Executor::flow_graph, 8},
#endif
    {"threads 8", Executor::threads, 8},
};
inline const std::vector<Runner> eight_threads(concurrent_runners.end() - (PGDR_TEST_TBB ? 2 : 1), concurrent_runners.end());
/// Beside these, visits in other orders and other numbers for cells and vertices.
inline const std::vector<Runner> eight_threads_or_shuffled = [] {
  std::vector<Runner> all = eight_threads;
  all.insert(all.end(), {shuffled, {"shuffled 5", Executor::shuffled, 5}});
  return all;
}();

/// For what takes long: with the address sanitizer the calling thread alone. Others look for errors of concurrency there.
inline const std::vector<Runner> two_if_quick = sanitized ? std::vector<Runner>{} : std::vector{shuffled, eight_threads[0]};

template <int D>
RefineOptions<D> with(RefineOptions<D> options, const Runner& runner) {
  options.schedule.executor = runner.executor;
  options.schedule.threads = runner.threads;
  return options;
}

template <int D>
void expect_same_mesh(const OutputMesh<D>& a, const OutputMesh<D>& b) {
  EXPECT_EQ(a.input_points, b.input_points);
  EXPECT_EQ(a.names, b.names);
  EXPECT_EQ(a.points.size(), b.points.size());
  EXPECT_TRUE(same_bytes(a.points, b.points));
  EXPECT_TRUE(same_bytes(a.point_markers, b.point_markers));
  EXPECT_TRUE(same_bytes(a.point_attributes, b.point_attributes));
  EXPECT_TRUE(same_bytes(a.leaves, b.leaves));
  EXPECT_EQ(a.cells.size(), b.cells.size());
  EXPECT_TRUE(same_bytes(a.cells, b.cells));
  EXPECT_TRUE(same_bytes(a.regions, b.regions));
  EXPECT_TRUE(same_bytes(a.subsegments, b.subsegments));
  EXPECT_TRUE(same_bytes(a.subfacets, b.subfacets));
}

/// The mesh, why cells stayed poor, and all that was counted.
template <int D>
void expect_same(const RefineResult<D>& a, const RefineResult<D>& b, const std::string& what) {
  const testing::ScopedTrace trace(__FILE__, __LINE__, what);
  expect_same_mesh<D>(a.mesh, b.mesh);
  EXPECT_EQ(a.stop, b.stop);
  EXPECT_EQ(a.poor_left, b.poor_left);
  EXPECT_EQ(a.size_met, b.size_met);
  ASSERT_EQ(a.reasons.size(), b.reasons.size());
  for (std::size_t i = 0; i < a.reasons.size(); ++i) {
    EXPECT_EQ(a.reasons[i].cell, b.reasons[i].cell);
    EXPECT_EQ(a.reasons[i].code, b.reasons[i].code);
    EXPECT_EQ(a.reasons[i].entities, b.reasons[i].entities);
    EXPECT_EQ(a.reasons[i].angle, b.reasons[i].angle);
  }
  EXPECT_EQ(a.statistics.insertions_committed, b.statistics.insertions_committed);
  EXPECT_EQ(a.statistics.insertions_refused, b.statistics.insertions_refused);
  EXPECT_EQ(a.statistics.selector_outside, b.statistics.selector_outside);
  EXPECT_EQ(a.statistics.selector_further, b.statistics.selector_further);
  EXPECT_EQ(a.statistics.selector_dropped, b.statistics.selector_dropped);
  EXPECT_EQ(a.optimization.moves, b.optimization.moves);
  EXPECT_EQ(a.optimization.edge_removals, b.optimization.edge_removals);
  EXPECT_EQ(a.optimization.evaluated, b.optimization.evaluated);
  EXPECT_EQ(a.optimization.left, b.optimization.left);
  EXPECT_EQ(a.scheduler.leaves, b.scheduler.leaves);
  EXPECT_EQ(a.scheduler.generations, b.scheduler.generations);
  EXPECT_EQ(a.scheduler.visits, b.scheduler.visits);
  EXPECT_EQ(a.scheduler.set_aside, b.scheduler.set_aside);
}

/// Refined by the calling thread alone, and checked; then by all of `runners`, with the same result.
template <int D>
RefineResult<D> expect_reproducible(const Plc<D>& plc, const RefineOptions<D>& options, const std::string& what,
                                    const std::vector<Runner>& runners = concurrent_runners) {
  const AllowThreads allow(8);
  const Outcome<D> first = refine_and_check<D>(plc, with<D>(options, serial));
  EXPECT_EQ(first.result.stop, StopCause::finished) << what;
  EXPECT_LE(first.report.exit_code(), 1) << what << "\n" << findings(first.report);
  for (const Runner& runner : runners) {
    const RefineResult<D> again = refine<D>(plc, with<D>(options, runner));
    expect_same<D>(first.result, again, what + ", " + runner.name);
    EXPECT_LE(again.scheduler.max_concurrent, static_cast<std::uint32_t>(runner.threads));
    EXPECT_LE(again.scheduler.busy_seconds.size(), static_cast<std::size_t>(runner.threads)) << runner.name;
  }
  return first.result;
}

}  // namespace pgdr::test
