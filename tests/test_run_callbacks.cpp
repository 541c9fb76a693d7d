// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// What callbacks may do to a run: return nonsense, be slow, cancel. The answer is a typed error that names the point, or a valid
// mesh. (What they throw: test_run_stress.cpp.)
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <stdexcept>

#include "parallel_support.hpp"
#include "pgdr/flat_arrays.hpp"

namespace pgdr::test_run_callbacks {

using test::expect_same;
using test::Runner;
using Clock = std::chrono::steady_clock;

std::vector<Runner> all_runners() {
  std::vector<Runner> all{test::serial};
  all.insert(all.end(), test::concurrent_runners.begin(), test::concurrent_runners.end());
  return all;
}

/// A model with elements that a selector is asked about.
template <int D>
Plc<D> model() {
  if constexpr (D == 3) {
    return test::turned<3>(test::cube_with_two_points());
  } else {
    const double xy[] = {0, 0, 1, 0, 1, 1, 0, 1, 0.5, 0.5, 0.5, 0.5001};
    const std::uint32_t segments[] = {0, 1, 1, 2, 2, 3, 3, 0};
    return plc_from_arrays<2>(xy, segments);
  }
}

template <int D>
RefineOptions<D> options() {
  RefineOptions<D> o;
  o.radius_edge_bound = 3;
  o.schedule.floor = 5;
  return o;
}

template <class T>
class Callbacks : public testing::Test {};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(Callbacks, Dimensions);

template <int D>
Point<D> filled(double c) {
  Point<D> p;
  p.x.fill(c);
  return p;
}

// Outside of the disk the point counts and is replaced: the mesh is that of circumcentres, for any number of threads.
TYPED_TEST(Callbacks, PointsThatCannotBeAreReplacedAndCounted) {
  constexpr int D = TypeParam::value;
  const test::AllowThreads allow(8);
  auto circumcenters = test::with<D>(options<D>(), test::serial);
  circumcenters.selector = {};
  circumcenters.min_dihedral = 0;  // as with a selector of one's own
  const auto expected = refine<D>(model<D>(), circumcenters);
  const PointSelector<D> nonsense[] = {
      [](const PoorElement<D>&) { return filled<D>(NAN); },
      [](const PoorElement<D>&) { return filled<D>(INFINITY); },
      [](const PoorElement<D>&) { return filled<D>(-1e300); },
      [](const PoorElement<D>& e) {
        Point<D> p = e.disk.center;
        p[0] += 1.001 * e.disk.radius;  // a little outside
        return p;
      },
      [](const PoorElement<D>& e) { return e.corners[0]; },
  };
  for (const auto& selector : nonsense)
    for (const Runner& runner : all_runners()) {
      auto o = test::with<D>(options<D>(), runner);
      o.selector = selector;
      const auto result = refine<D>(model<D>(), o);
      test::expect_same_mesh<D>(expected.mesh, result.mesh);
      EXPECT_GT(result.statistics.selector_outside, 0u) << runner.name;
      o.outside = OutsidePolicy::error;
      try {
        refine<D>(model<D>(), o);
        ADD_FAILURE() << "no error, " << runner.name;
      } catch (const UsageError& e) {
        EXPECT_EQ(e.code(), Errc::bad_option);
        EXPECT_EQ(e.diagnostic().points.size(), 2u);  // the point, the centre of the disk
      }
    }
}

// Once, with what is meshed, before anything is; what it throws ends the run.
TYPED_TEST(Callbacks, PreparedIsCalledOnceBeforeTheMesh) {
  constexpr int D = TypeParam::value;
  auto o = test::with<D>(options<D>(), test::serial);
  int calls = 0;
  bool meshing = false;
  o.progress = [&](const Progress&) { meshing = true; };
  o.prepared = [&](const Domain<D>& domain) {
    ++calls;
    EXPECT_FALSE(meshing);
    EXPECT_EQ(domain.points().size(), model<D>().points.size());
  };
  refine<D>(model<D>(), o);
  EXPECT_EQ(calls, 1);
  meshing = false;
  refine<D>(Domain<D>(model<D>()), o);
  EXPECT_EQ(calls, 2);
  o.prepared = [](const Domain<D>&) { throw std::runtime_error("enough"); };
  EXPECT_THROW(refine<D>(model<D>(), o), std::runtime_error);
}

// Also where nothing is there yet but the input.
TYPED_TEST(Callbacks, ATimeLimitEndsWhatComesBeforeTheMesh) {
  constexpr int D = TypeParam::value;
  auto o = test::with<D>(options<D>(), test::serial);
  o.time_limit = std::chrono::duration<double>(0);
  const auto result = refine<D>(model<D>(), o);
  EXPECT_EQ(result.stop, StopCause::time_limit);
  EXPECT_TRUE(result.mesh.cells.empty());
  o.time_limit = std::chrono::duration<double>(1e300);  // which no clock counts
  EXPECT_EQ(refine<D>(model<D>(), o).stop, StopCause::finished);
}

TYPED_TEST(Callbacks, SizesThatCannotBeNameThePoint) {
  constexpr int D = TypeParam::value;
  const test::AllowThreads allow(8);
  for (const double bad : {0.0, -0.0, -1.0, double(NAN), double(-INFINITY)})
    for (const Runner& runner : all_runners()) {
      auto o = test::with<D>(options<D>(), runner);
      o.size = [bad](const Point<D>& p) { return p[0] > 0.75 ? bad : 0.05; };
      try {
        refine<D>(model<D>(), o);
        ADD_FAILURE() << "no error, " << runner.name;
      } catch (const UsageError& e) {
        EXPECT_EQ(e.code(), Errc::bad_size);
        ASSERT_EQ(e.diagnostic().points.size(), 1u);
        EXPECT_GT(e.diagnostic().points[0][0], 0.75);
      }
    }
  // No bound in a part of the domain is fine.
  auto o = options<D>();
  o.size = [](const Point<D>& p) { return p[0] > 0.5 ? INFINITY : 0.05; };
  EXPECT_TRUE(test::expect_reproducible<D>(model<D>(), o, "infinite size").size_met);
}

// A size that no mesh meets before the memory is full: the budget ends it.
TYPED_TEST(Callbacks, SizesThatAreHopelesslySmallEndByBudget) {
  constexpr int D = TypeParam::value;
  auto o = options<D>();
  o.size = [](const Point<D>&) { return 1e-300; };
  o.max_vertices = 3000;
  const auto outcome = test::refine_and_check<D>(model<D>(), o);
  EXPECT_EQ(outcome.result.stop, StopCause::max_vertices);
  EXPECT_FALSE(outcome.result.size_met);
  EXPECT_EQ(outcome.result.poor_left, outcome.result.mesh.cells.size());
  EXPECT_TRUE(test::unfinished_but_valid(outcome.report)) << test::findings(outcome.report);
}

/// Sleeps for some time, as a callback that asks another program might.
void be_slow() { std::this_thread::sleep_for(std::chrono::milliseconds(2)); }

// Callbacks that take a thousand times as long as an insertion: after time limits and cancellations there are no more calls than
// single insertions make. As each takes two milliseconds, a slow machine makes fewer before, not more.
TYPED_TEST(Callbacks, SlowOnesAreStoppedInTime) {
  constexpr int D = TypeParam::value;
  const test::AllowThreads allow(8);
  constexpr std::uint64_t most_calls = 2500;  // of a thread; to the end there would be millions
  for (const bool by_time : {false, true})
    for (const bool size : {false, true})
      for (const Runner& runner : {test::serial, test::eight_threads[0]}) {
        auto o = test::with<D>(options<D>(), runner);
        std::atomic<std::uint64_t> calls = 0;
        if (size) {
          o.size = [&](const Point<D>&) { return be_slow(), ++calls, 1e-5; };
        } else {
          o.radius_edge_bound = smallest_proved_bound<D>();
          o.size = 1e-5;
          o.selector = [&](const PoorElement<D>& e) { return be_slow(), ++calls, e.disk.center; };
        }
        std::stop_source source;
        o.stop = source.get_token();
        std::jthread other;
        if (by_time) {
          o.time_limit = std::chrono::milliseconds(60);
        } else {
          other = std::jthread([&] {
            std::this_thread::sleep_for(std::chrono::milliseconds(60));
            source.request_stop();
          });
        }
        o.partial_mesh = by_time;
        const auto result = refine<D>(model<D>(), o);
        EXPECT_LT(calls, most_calls * std::max(1, o.schedule.threads)) << runner.name;
        EXPECT_EQ(result.stop, by_time ? StopCause::time_limit : StopCause::cancelled);
      }
}

/// What was told of a run, whose size function takes its time, so that it is told often.
template <int D>
std::vector<Progress> told_of(Schedule schedule, const Runner& runner) {
  auto o = test::with<D>(options<D>(), runner);
  o.schedule.schedule = schedule;
  o.size = [](const Point<D>&) {
    std::this_thread::sleep_for(std::chrono::microseconds(D == 2 ? 300 : 100));
    return D == 2 ? 2e-3 : 0.2;
  };
  std::vector<Progress> told;
  o.progress = [&](const Progress& p) { told.push_back(p); };
  EXPECT_EQ(refine<D>(model<D>(), o).stop, StopCause::finished);
  return told;
}

// The share done never falls, and is 1 in the end alone; a stage is always named.
TYPED_TEST(Callbacks, ProgressCanDriveABar) {
  constexpr int D = TypeParam::value;
  const test::AllowThreads allow(8);
  for (const Schedule schedule : {Schedule::reproducible, Schedule::uniform, Schedule::greedy})
    for (const Runner& runner : {test::serial, test::eight_threads[0]}) {
      const std::vector<Progress> told = told_of<D>(schedule, runner);
      ASSERT_GT(told.size(), 1u);
      double last = 0;
      bool is_known = false;
      for (const Progress& p : told) {
        EXPECT_FALSE(std::string(p.stage).empty());
        EXPECT_FALSE(is_known && !p.done);
        is_known = p.done.has_value();
        if (!is_known) continue;
        EXPECT_GE(*p.done, last);
        EXPECT_EQ(*p.done == 1, &p == &told.back());
        last = *p.done;
      }
      EXPECT_EQ(last, 1);
      EXPECT_STREQ(told.back().stage, "done");
    }
}

// Without a partial mesh: all or nothing, whenever the cancellation comes.
TYPED_TEST(Callbacks, CancelledWithoutPartialMesh) {
  constexpr int D = TypeParam::value;
  const test::AllowThreads allow(8);
  auto o = options<D>();
  o.size = D == 2 ? 4e-4 : 0.08;
  const auto start = Clock::now();
  const auto expected = refine<D>(model<D>(), test::with<D>(o, test::serial));
  const auto time = Clock::now() - start;
  o.partial_mesh = false;
  expect_same<D>(expected, refine<D>(model<D>(), o), "not cancelled");
  std::size_t cancelled = 0;
  for (const Runner& runner : {test::serial, test::eight_threads[0]})
    for (int percent = 0; percent <= 150; percent += 15) {
      auto p = test::with<D>(o, runner);
      std::stop_source source;
      p.stop = source.get_token();
      std::jthread other([&] {
        std::this_thread::sleep_for(time * percent / 100);
        source.request_stop();
      });
      const auto result = refine<D>(model<D>(), p);
      if (result.stop == StopCause::finished) {
        expect_same<D>(expected, result, runner.name);
      } else {
        ++cancelled;
        EXPECT_EQ(result.stop, StopCause::cancelled);
        EXPECT_TRUE(result.mesh.cells.empty() && result.mesh.points.empty() && result.reasons.empty());
        EXPECT_FALSE(result.size_met);
      }
    }
  EXPECT_GT(cancelled, 1u);
}

// A large input is given up while its points are being triangulated.
TYPED_TEST(Callbacks, CancelledBeforeTheBoundaryIsThere) {
  constexpr int D = TypeParam::value;
  Plc<D> plc = model<D>();
  for (std::uint32_t i = 0; i < 20000; ++i) {
    Point<D> p;
    for (int j = 0; j < D; ++j) p[j] = 0.3 + 0.2 * std::fmod(i * std::sqrt(2.0 + j), 1.0);
    plc.points.push_back(p);
  }
  const Domain<D> domain(plc);
  std::stop_source source;
  source.request_stop();
  auto o = options<D>();
  o.stop = source.get_token();
  const auto result = refine<D>(domain, o);
  EXPECT_EQ(result.stop, StopCause::cancelled);
  EXPECT_TRUE(result.mesh.cells.empty());
}

}  // namespace pgdr::test_run_callbacks
