// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The reproducible schedule: the same bytes for any number of threads and any executor, on the shared models plain and
// turned, and for any way to divide them into leaves; and for any build (fingerprints.txt).
#include <gtest/gtest.h>

#include <atomic>
#include <cfenv>
#include <cmath>
#include <limits>
#include <numbers>

#ifdef __SSE2__
#include <xmmintrin.h>
#endif

#include "fingerprints.hpp"
#include "meeting.hpp"
#include "parallel_support.hpp"
#include "pgdr/io.hpp"

namespace pgdr::test_run_reproducible {

using test::eight_threads;
using test::eight_threads_or_shuffled;
using test::expect_same;
using test::Model;

test::Fingerprints& fingerprints() {
  static auto* const all = static_cast<test::Fingerprints*>(testing::AddGlobalTestEnvironment(new test::Fingerprints));
  return *all;
}
[[maybe_unused]] const test::Fingerprints& registered = fingerprints();  // before the tests run

/// The same by all of `runners`, and in all builds. `name`: in fingerprints.txt.
template <int D>
RefineResult<D> expect_reproducible_in_all_builds(const Plc<D>& plc, const RefineOptions<D>& options, const std::string& name,
                                                  const std::vector<test::Runner>& runners = test::concurrent_runners) {
  auto result = test::expect_reproducible<D>(plc, options, name,
                                             test::Fingerprints::writing() ? std::vector<test::Runner>{} : runners);
  fingerprints().expect(name, test::fingerprint<D>(result));
  return result;
}

class ParallelModel : public ::testing::TestWithParam<std::tuple<Model, bool>> {};

TEST_P(ParallelModel, SameBytesForAnyThreads) {
  const auto& [model, is_turned] = GetParam();
  RefineOptions<3> options;
  const Plc<3> plc = is_turned ? test::turned<3>(model.make()) : model.make();
  options.size = model.fine;
  options.schedule.floor = 20;
  const std::string name = std::string(model.name) + (is_turned ? ", turned" : "");
  const auto result = expect_reproducible_in_all_builds<3>(plc, options, name);
  EXPECT_LE(static_cast<double>(result.poor_left), model.most_poor * static_cast<double>(result.mesh.cells.size()));
  EXPECT_GT(result.scheduler.leaves, 16u);
  // As large as the model is itself; and in leaves so small that many insertions reach beyond a claim.
  options.schedule.floor = 5;
  options.size = model.size;
  expect_reproducible_in_all_builds<3>(plc, options, name + ", coarse", eight_threads_or_shuffled);
  options.size = model.fine;
  options.schedule.split_ratio = 1.5;
  EXPECT_GT(
      expect_reproducible_in_all_builds<3>(plc, options, name + ", small leaves", eight_threads_or_shuffled).scheduler.set_aside,
      0u);
}

INSTANTIATE_TEST_SUITE_P(Models, ParallelModel, ::testing::Combine(::testing::ValuesIn(test::refined_models), ::testing::Bool()),
                         [](const auto& info) {
                           return std::string(std::get<0>(info.param).name) + (std::get<1>(info.param) ? "_turned" : "");
                         });

TEST(Parallel, PartFromAFile) {
  const Plc<3> plc = read_plc<3>(PGDR_TEST_MODELS "/bracket.poly");
  RefineOptions<3> options;
  options.schedule.floor = 30;
  expect_reproducible_in_all_builds<3>(plc, options, "bracket");
  expect_reproducible_in_all_builds<3>(test::turned<3>(plc), options, "bracket, turned", eight_threads_or_shuffled);
}

TEST(Parallel, Pipe) {
  RefineOptions<3> options;
  options.schedule.floor = 10;
  expect_reproducible_in_all_builds<3>(test::pipe(40, 0.17, 0.311), options, "pipe", eight_threads_or_shuffled);
}

TEST(Parallel, Plane) {
  RefineOptions<2> options;
  options.radius_edge_bound = 1 / (2 * std::sin(20.7 * std::numbers::pi / 180));
  options.size = 0.002;
  for (const bool is_turned : {false, true}) {
    const Plc<2> plc = is_turned ? test::turned<2>(test::square_with_hole()) : test::square_with_hole();
    for (const std::size_t floor : {1, 20, 100}) {
      options.schedule.floor = floor;
      const std::string name = std::string("square") + (is_turned ? ", turned" : "") + ", floor " + std::to_string(floor);
      const auto result = expect_reproducible_in_all_builds<2>(plc, options, name);
      EXPECT_GT(result.scheduler.leaves, 16u);
    }
  }
  options.size = {};
  options.schedule.floor = 10;
  expect_reproducible_in_all_builds<2>(read_plc<2>(PGDR_TEST_MODELS "/plate.poly"), options, "plate");
}

// Beside small angles nearly all local changes have work: flips, collapses, relocations, refilled cavities, points beside what
// was refused. (tests/regressions has the stories of these.)
TEST(Parallel, SmallAngles) {
  RefineOptions<3> options;
  options.schedule.floor = 10;
  for (const std::string file :
       {"wedge_of_1_degree.off", "plate_one_cell.poly", "plate_fifty_cells.poly", "needle_1e-7.off", "twisted_strips.off"}) {
    const Plc<3> plc = read_plc<3>(PGDR_TEST_REGRESSIONS "/" + file);
    if (file.starts_with("wedge"))
      options.size = 0.15;  // else it has three cells
    else
      options.size = {};
    const auto result = expect_reproducible_in_all_builds<3>(plc, options, file, eight_threads_or_shuffled);
    EXPECT_GT(result.reasons.size(), 0u) << file;
    EXPECT_GE(result.reasons.size(), result.poor_left) << file;
  }
  const Plc<3> plate = read_plc<3>(PGDR_TEST_REGRESSIONS "/plate_fifty_cells.poly");
  expect_reproducible_in_all_builds<3>(test::turned<3>(plate), options, "plate_fifty_cells.poly, turned",
                                       eight_threads_or_shuffled);
}

/// Nine segments of two lengths from one corner of a square, three degrees apart or so.
Plc<2> fan() {
  Plc<2> plc;
  plc.points = {{{0, 0}}, {{4, 0}}, {{4, 4}}, {{0, 4}}};
  for (std::uint32_t i = 0; i < 4; ++i) plc.segments.push_back({{i, (i + 1) % 4}, 1});
  for (std::uint32_t i = 0; i < 9; ++i) {
    const double length = i % 2 == 0 ? 3 : 1.5;
    plc.points.push_back({{length, length * (i + 1) / 16}});
    plc.segments.push_back({{0, 4 + i}, 2});
  }
  return plc;
}

TEST(Parallel, Fan) {
  RefineOptions<2> options;
  options.radius_edge_bound = 1 / (2 * std::sin(20.7 * std::numbers::pi / 180));
  options.schedule.floor = 5;
  for (const bool is_turned : {false, true}) {
    const Plc<2> plc = is_turned ? test::turned<2>(fan()) : fan();
    const auto result = expect_reproducible_in_all_builds<2>(plc, options, is_turned ? "fan, turned" : "fan");
    EXPECT_GT(result.poor_left, 0u);
  }
}

TEST(Parallel, GradedCube) {
  RefineOptions<3> options;
  options.size = [](const Point3& p) { return 0.01 + 0.15 * std::sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]); };
  options.schedule.floor = 20;
  expect_reproducible_in_all_builds<3>(test::cube(), options, "graded cube", eight_threads_or_shuffled);
  const Plc<3> plc = test::turned<3>(test::cube(), 0);
  const auto result = expect_reproducible_in_all_builds<3>(plc, options, "graded cube, turned", eight_threads_or_shuffled);
  EXPECT_GT(result.scheduler.leaves, 64u);
}

// However the leaves are made, they give a checked mesh, the same for any threads: one leaf, which is the sequential
// algorithm, thousands of them, leaves that split long before the theory lets them, narrow and wide claims, visits that
// end early.
TEST(Parallel, AnyWayToDivideTheWork) {
  const Plc<3> plc = test::turned<3>(test::plate_with_hole());
  RefineOptions<3> options;
  options.size = 0.2;
  const ScheduleOptions ordinary = options.schedule;
  const auto run = [&](auto change, const char* what) {
    options.schedule = ordinary;
    options.schedule.floor = 30;
    change(options.schedule);
    const std::string name = std::string("plate_with_hole divided: ") + what;
    return expect_reproducible_in_all_builds<3>(plc, options, name, eight_threads_or_shuffled).scheduler;
  };
  const auto one = run([](ScheduleOptions& s) { s.floor = std::numeric_limits<std::size_t>::max(); }, "one leaf");
  EXPECT_EQ(one.leaves, 1u);
  EXPECT_EQ(one.set_aside, 0u);
  const auto small = run([](ScheduleOptions& s) { s.floor = 1; }, "no floor");
  EXPECT_GT(small.leaves, 16u);
  run([](ScheduleOptions& s) { s.split_ratio = 1.0 / 6; }, "split ratio 1/6");
  const auto early = run(
      [](ScheduleOptions& s) {
        s.split_ratio = 2;
        s.floor = 5;
      },
      "split ratio 2");
  EXPECT_GT(early.set_aside, 0u);
  run([](ScheduleOptions& s) { s.claim_order = 2; }, "claim order 2");
  run(
      [](ScheduleOptions& s) {
        s.claim_order = 4;
        s.floor = 10;
      },
      "claim order 4");
  run([](ScheduleOptions& s) { s.claim_order = 9; }, "claim order 9");
  run([](ScheduleOptions& s) { s.claims = ClaimRule::leaves; }, "leaves");
  run(
      [](ScheduleOptions& s) {
        s.claims = ClaimRule::leaves;
        s.claim_order = 2;
        s.floor = 10;
      },
      "leaves, claim order 2");
  run([](ScheduleOptions& s) { s.granularity = 1; }, "granularity 1");
}

// A caller's rounding mode, or its denormals flushed to zero, are those of its own thread alone.
TEST(Parallel, CallersFloatingPointModeDoesNotMatter) {
  const Plc<3> plc = test::turned<3>(test::l_block());
  RefineOptions<3> options;
  options.size = 0.3;
  options.schedule.floor = 20;
  const test::AllowThreads allow(8);
  const auto expected = refine<3>(plc, test::with<3>(options, test::serial));
  for (const int mode : {FE_UPWARD, FE_TOWARDZERO}) {
    std::vector<RefineResult<3>> results;
    std::fesetround(mode);
    results.push_back(refine<3>(plc, test::with<3>(options, test::serial)));
    for (const test::Runner& runner : eight_threads) results.push_back(refine<3>(plc, test::with<3>(options, runner)));
    const int after = std::fegetround();
    std::fesetround(FE_TONEAREST);
    EXPECT_EQ(after, mode);
    for (const auto& result : results) expect_same<3>(expected, result, "rounding mode " + std::to_string(mode));
  }
#ifdef __SSE2__
  const unsigned before = _mm_getcsr();
  _mm_setcsr(before | 0x8040);  // flush to zero, denormals are zero
  const auto result = refine<3>(plc, test::with<3>(options, test::serial));
  EXPECT_EQ(_mm_getcsr() & 0x8040, 0x8040u);
  _mm_setcsr(before);
  expect_same<3>(expected, result, "flushed to zero");
#endif
}

// Eight threads run visits at one time, on any machine: a size function that waits for them now and then leaves them the cores.
TEST(Parallel, EightThreadsReallyRun) {
  const test::AllowThreads allow(8);
  RefineOptions<3> options;
  options.schedule.floor = 30;  // many small leaves
  options.size = 0.05;
  const auto expected = refine<3>(test::cube(), test::with<3>(options, test::serial));
  for (const test::Runner& runner : eight_threads) {
    std::atomic<unsigned> calls{0};
    test::Meeting eight(8);
    options.size = [&](const Point3&) {
      if (++calls % 64 == 0) eight.wait();
      return 0.05;
    };
    const auto result = refine<3>(test::cube(), test::with<3>(options, runner));
    expect_same<3>(expected, result, runner.name);
    EXPECT_EQ(result.scheduler.max_concurrent, 8u) << runner.name;
    EXPECT_EQ(result.scheduler.threads, 8) << runner.name;
    EXPECT_EQ(result.scheduler.busy_seconds.size(), 8u) << runner.name;
  }
}

}  // namespace pgdr::test_run_reproducible
