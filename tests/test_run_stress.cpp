// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Runs that end early, with eight threads in flight on many tiny leaves: cancelled, out of time, out of vertices, or by an
// exception of a callback. The mesh is valid, the exception comes out as it is, and the next run knows nothing of it.
#include <gtest/gtest.h>

#include <functional>
#include <memory>
#include <stdexcept>
#include <stop_token>

#include "parallel_support.hpp"

namespace pgdr::test_run_stress {

using test::eight_threads;
using test::expect_same;
using test::findings;
using test::refine_and_check;
using test::Runner;
using test::serial;

constexpr double size = 0.09;

/// A cube in more than a thousand leaves, so small that every second insertion reaches beyond a claim.
Plc<3> model() { return test::turned<3>(test::cube()); }
RefineOptions<3> tiny_leaves() {
  RefineOptions<3> options;
  options.size = size;
  options.schedule.floor = 1;
  options.schedule.split_ratio = 2;
  return options;
}

/// A size function that does something at its n-th call, from whatever thread.
class AtCall {
 public:
  AtCall(std::uint64_t n, std::function<void()> act) : n_(n), act_(std::move(act)) {}
  SizingField<3> size_function() {
    return [this](const Point3&) {
      if (calls_.fetch_add(1, std::memory_order_relaxed) + 1 == n_) act_();
      return size;
    };
  }
  std::uint64_t calls() const { return calls_; }

 private:
  const std::uint64_t n_;
  const std::function<void()> act_;
  std::atomic<std::uint64_t> calls_{0};
};

/// How often the size function is called in all.
std::uint64_t calls_in_all() {
  static const std::uint64_t calls = [] {
    AtCall never(0, [] {});
    auto options = tiny_leaves();
    options.size = never.size_function();
    refine<3>(model(), test::with<3>(options, serial));
    return never.calls();
  }();
  return calls;
}

void expect_valid(const test::Outcome<3>& outcome, const char* what) {
  EXPECT_FALSE(outcome.result.mesh.cells.empty()) << what;
  EXPECT_TRUE(test::unfinished_but_valid(outcome.report)) << what << "\n" << findings(outcome.report);
}

TEST(ParallelStress, ThousandsOfTinyLeaves) {
  auto options = tiny_leaves();
  EXPECT_GT(test::expect_reproducible<3>(model(), options, "tiny leaves").scheduler.leaves, 1000u);
  options.schedule.split_ratio = 4;
  const auto result = test::expect_reproducible<3>(model(), options, "tinier leaves", eight_threads);
  EXPECT_GT(result.scheduler.leaves, 5000u);
  EXPECT_GT(result.scheduler.set_aside, 1000u);
}

TEST(ParallelStress, CancelledInFlight) {
  const test::AllowThreads allow(8);
  for (const Runner& runner : eight_threads)
    for (const std::uint64_t part : {1, 4, 9}) {
      auto options = test::with<3>(tiny_leaves(), runner);
      std::stop_source source;
      options.stop = source.get_token();
      AtCall stopper(calls_in_all() * part / 10, [&] { source.request_stop(); });
      options.size = stopper.size_function();
      const auto outcome = refine_and_check<3>(model(), options);
      EXPECT_EQ(outcome.result.stop, StopCause::cancelled) << runner.name;
      EXPECT_TRUE(outcome.result.reasons.empty());
      expect_valid(outcome, runner.name);
    }
}

TEST(ParallelStress, CancelledFromOutside) {
  const test::AllowThreads allow(8);
  for (const Runner& runner : eight_threads)
    for (const int delay : {0, 30, 90}) {
      auto options = test::with<3>(tiny_leaves(), runner);
      options.size = size / 4;
      std::stop_source source;
      options.stop = source.get_token();
      std::jthread other([&] {
        std::this_thread::sleep_for(std::chrono::milliseconds(delay));
        source.request_stop();
      });
      const auto result = refine<3>(model(), options);
      EXPECT_EQ(result.stop, StopCause::cancelled) << runner.name;
    }
}

TEST(ParallelStress, OutOfTime) {
  const test::AllowThreads allow(8);
  for (const Runner& runner : eight_threads) {
    auto options = test::with<3>(tiny_leaves(), runner);
    options.size = size / 4;
    options.time_limit = std::chrono::duration<double>(0.2);
    const auto outcome = refine_and_check<3>(model(), options);
    EXPECT_EQ(outcome.result.stop, StopCause::time_limit) << runner.name;
    // The boundary itself may take longer than that, under a sanitizer.
    if (!outcome.result.mesh.cells.empty()) expect_valid(outcome, runner.name);
  }
}

struct Mine {
  int number;
};

TEST(ParallelStress, SizeFunctionThrowsInFlight) {
  const test::AllowThreads allow(8);
  const auto expected = refine<3>(model(), test::with<3>(tiny_leaves(), serial));
  for (const Runner& runner : eight_threads) {
    for (const std::uint64_t part : {0, 1, 5, 9}) {
      auto options = test::with<3>(tiny_leaves(), runner);
      AtCall thrower(calls_in_all() * part / 10 + 1, [] { throw Mine{42}; });
      options.size = thrower.size_function();
      try {
        refine<3>(model(), options);
        ADD_FAILURE() << "nothing came out";
      } catch (const Mine& mine) {
        EXPECT_EQ(mine.number, 42);
      }
    }
    expect_same<3>(expected, refine<3>(model(), test::with<3>(tiny_leaves(), runner)), runner.name);
  }
}

TEST(ParallelStress, ManyThrowAtOnce) {
  const test::AllowThreads allow(8);
  for (const Runner& runner : eight_threads) {
    auto options = test::with<3>(tiny_leaves(), runner);
    std::atomic<std::uint64_t> calls{0};
    options.size = [&](const Point3&) -> double {
      if (calls.fetch_add(1) > calls_in_all() / 3) throw std::domain_error("mine");
      return size;
    };
    EXPECT_THROW(refine<3>(model(), options), std::domain_error) << runner.name;
  }
}

TEST(ParallelStress, SelectorAndProgressThrowInFlight) {
  const test::AllowThreads allow(8);
  for (const Runner& runner : eight_threads) {
    auto options = test::with<3>(tiny_leaves(), runner);
    options.size = {};
    options.selector = [calls = std::make_shared<std::atomic<int>>(0)](const PoorElement<3>& e) {
      if (++*calls == 300) throw Mine{7};
      return e.disk.center;
    };
    EXPECT_THROW(refine<3>(test::cube_with_two_points(), options), Mine) << runner.name;

    options = test::with<3>(tiny_leaves(), runner);
    options.size = size / 4;
    options.progress = [](const Progress&) { throw Mine{8}; };
    EXPECT_THROW(refine<3>(model(), options), Mine) << runner.name;
  }
}

// A size that is not positive, found by one of many visits.
TEST(ParallelStress, BadSizeInFlight) {
  const test::AllowThreads allow(8);
  for (const Runner& runner : eight_threads) {
    auto options = test::with<3>(tiny_leaves(), runner);
    std::atomic<std::uint64_t> calls{0};
    options.size = [&](const Point3&) { return ++calls == calls_in_all() / 2 ? -1.0 : size; };
    EXPECT_THROW(refine<3>(model(), options), UsageError) << runner.name;
  }
}

TEST(ParallelStress, VertexBudgetIsDividedBeforehand) {
  const test::AllowThreads allow(8);
  for (const std::uint64_t budget : {40, 100, 555, 1200}) {
    auto options = tiny_leaves();
    options.schedule.floor = 5;
    options.max_vertices = budget;
    const auto expected = refine_and_check<3>(model(), test::with<3>(options, serial));
    EXPECT_EQ(expected.result.stop, StopCause::max_vertices);
    EXPECT_EQ(expected.result.mesh.points.size(), budget);
    expect_valid(expected, "budget");
    for (const Runner& runner : test::eight_threads_or_shuffled)
      expect_same<3>(expected.result, refine<3>(model(), test::with<3>(options, runner)),
                     std::to_string(budget) + ", " + runner.name);
  }
}

TEST(ParallelStress, ShortestEdgeAllowed) {
  const test::AllowThreads allow(8);
  auto options = tiny_leaves();
  options.min_edge = 0.09;
  const auto expected = refine_and_check<3>(model(), test::with<3>(options, serial));
  EXPECT_EQ(expected.result.stop, StopCause::min_edge);
  expect_valid(expected, "shortest edge");
  for (const Runner& runner : eight_threads)
    expect_same<3>(expected.result, refine<3>(model(), test::with<3>(options, runner)), runner.name);
}

}  // namespace pgdr::test_run_stress
