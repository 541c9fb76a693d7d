// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Meshing inside other parallel work, and other parallel work inside meshing: the mesh is that of the calling thread alone.
#include <gtest/gtest.h>

#include <cmath>

#include "parallel_support.hpp"

#if PGDR_TEST_TBB
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>
#include <tbb/task_group.h>
#endif

namespace pgdr::test_run_embedding {

using test::expect_same;
using test::Runner;
using test::serial;

/// Small models, all different, in small leaves.
struct Case {
  Plc<3> plc;
  RefineOptions<3> options;
  RefineResult<3> expected;
};
std::vector<Case> cases() {
  std::vector<Case> all;
  for (const auto& model :
       {test::cube(), test::turned<3>(test::u_block()), test::icosphere(1), test::turned<3>(test::l_block())}) {
    Case c{model, {}, {}};
    c.options.size = 0.25;
    c.options.schedule.floor = 10;
    c.expected = refine<3>(c.plc, test::with<3>(c.options, serial));
    all.push_back(c);
  }
  return all;
}

TEST(ParallelEmbedding, SeveralMeshesAtOnceFromSeveralThreads) {
  const test::AllowThreads allow(8);
  const std::vector<Case> all = cases();
  for (const Runner& runner : test::eight_threads) {
    std::vector<RefineResult<3>> results(2 * all.size());
    {
      std::vector<std::jthread> threads;
      for (std::size_t i = 0; i < results.size(); ++i)
        threads.emplace_back([&, i] {
          const Case& c = all[i % all.size()];
          results[i] = refine<3>(c.plc, test::with<3>(c.options, runner));
        });
    }
    for (std::size_t i = 0; i < results.size(); ++i) expect_same<3>(all[i % all.size()].expected, results[i], runner.name);
  }
}

#if PGDR_TEST_TBB

TEST(ParallelEmbedding, InsideAParallelLoop) {
  const test::AllowThreads allow(8);
  const std::vector<Case> all = cases();
  for (const int threads : {0, 2}) {
    std::vector<RefineResult<3>> results(3 * all.size());
    tbb::task_arena(8).execute([&] {
      tbb::parallel_for(std::size_t{0}, results.size(), [&](std::size_t i) {
        const Case& c = all[i % all.size()];
        results[i] = refine<3>(c.plc, test::with<3>(c.options, {"nested", Executor::flow_graph, threads}));
      });
    });
    for (std::size_t i = 0; i < results.size(); ++i) expect_same<3>(all[i % all.size()].expected, results[i], "nested");
  }
}

TEST(ParallelEmbedding, TheCallersArenaIsUsed) {
  const test::AllowThreads allow(8);
  for (const Case& c : cases())
    for (const int slots : {1, 2, 3}) {
      tbb::task_arena arena(slots);
      const auto result = arena.execute([&] {
        return refine<3>(c.plc, test::with<3>(c.options, {"", Executor::flow_graph, 0}));
      });
      expect_same<3>(c.expected, result, "arena of " + std::to_string(slots));
      EXPECT_EQ(result.scheduler.threads, slots);
      EXPECT_LE(result.scheduler.max_concurrent, static_cast<std::uint32_t>(slots));
    }
}

/// Parallel work, as a callback may do it, that returns 1.
double one(const Point3& p) {
  std::atomic<int> sum{0};
  tbb::parallel_for(0, 16, [&](int i) { sum += i + (p[0] < 1e9 ? 0 : 1); });
  return sum == 120 ? 1 : NAN;
}

TEST(ParallelEmbedding, CallbacksThatWorkInParallel) {
  for (const bool is_turned : {false, true}) {
    const Plc<3> plc = is_turned ? test::turned<3>(test::cube_with_two_points()) : test::cube_with_two_points();
    RefineOptions<3> options;
    options.schedule.floor = 10;
    options.radius_edge_bound = 3;
    const auto selector = [](const PoorElement<3>& e) {
      Point3 p = e.disk.center;
      if (e.disk.radius > 0) p[0] += e.disk.radius / 4;
      return p;
    };
    options.size = 0.2;
    options.selector = selector;
    const auto expected = refine<3>(plc, test::with<3>(options, serial));
    options.size = [](const Point3& p) { return 0.2 * one(p); };
    options.selector = [&](const PoorElement<3>& e) {
      const Point3 p = selector(e);
      return one(p) == 1 ? p : Point3{};
    };
    const auto result = test::expect_reproducible<3>(plc, options, "parallel callbacks");
    test::expect_same<3>(expected, result, "callbacks in parallel or not");
    EXPECT_GT(result.scheduler.leaves, 50u);
  }
}

// Somebody cancels the work that the meshing is part of: the rest is not run, nothing is thrown, and the mesh is valid.
TEST(ParallelEmbedding, CancelledWithTheCallersTasks) {
  const test::AllowThreads allow(8);
  RefineOptions<3> options;
  options.schedule.floor = 5;
  std::atomic<int> calls{0};
  tbb::task_group group;
  options.size = [&](const Point3&) {
    if (++calls == 20000) group.cancel();
    return 0.1;
  };
  const Plc<3> plc = test::turned<3>(test::cube());
  test::Outcome<3> outcome;
  std::atomic<bool> done{false};
  tbb::task_arena(8).execute([&] {
    group.run([&] {
      outcome.result = refine<3>(plc, options);
      done = true;
    });
    group.wait();
  });
  ASSERT_TRUE(done);
  EXPECT_FALSE(outcome.result.mesh.cells.empty());
  CheckOptions<3> check_options;
  check_options.input = &plc;
  check_options.delaunay = outcome.result.delaunay;
  const CheckReport report = check<3>(outcome.result.mesh, check_options);
  EXPECT_EQ(report.exit_code(), 0) << test::findings(report);
  if (outcome.result.stop == StopCause::finished) {
    options.schedule.executor = Executor::serial;
    expect_same<3>(refine<3>(plc, options), outcome.result, "not cancelled after all");
  } else {
    EXPECT_EQ(outcome.result.stop, StopCause::cancelled);
  }
}

#endif

}  // namespace pgdr::test_run_embedding
