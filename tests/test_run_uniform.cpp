// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The uniform schedule: the same bytes for any number of threads and any executor, about as many cells as the graded schedule
// makes, in few cycles; what it refuses, and how its runs end early.
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <functional>
#include <map>
#include <set>
#include <stop_token>
#include <utility>

#include "dimensions.hpp"
#include "parallel_support.hpp"
#include "pgdr/io.hpp"
#include "planar_plcs.hpp"

namespace pgdr::test_run_uniform {

using test::eight_threads;
using test::expect_reproducible;
using test::expect_same;
using test::Runner;
using test::serial;

/// Small windows, and no optimiser.
template <int D>
RefineOptions<D> uniform(const SizingField<D>& size) {
  RefineOptions<D> options;
  options.size = size;
  options.min_dihedral = 0;
  options.schedule.schedule = Schedule::uniform;
  options.schedule.floor = 60;
  return options;
}

template <int D>
Plc<D> shifted(Plc<D> plc, double by) {
  test::for_each_point(plc, [by](Point<D>& p) {
    for (double& x : p.x) x += by;
  });
  return plc;
}

template <int D>
Plc<D> square_or_cube() {
  if constexpr (D == 3) {
    return test::cube();
  } else {
    Plc<2> plc;
    test::add_square(plc, 0, 1);
    return plc;
  }
}

class UniformModel : public testing::TestWithParam<test::Model> {};

TEST_P(UniformModel, SameBytesForAnyThreads) {
  const test::Model& model = GetParam();
  RefineOptions<3> options = uniform<3>(0.7 * model.fine);
  const auto result = expect_reproducible<3>(model.make(), options, model.name);
  EXPECT_GE(result.scheduler.leaves, 8u);
  EXPECT_GE(result.scheduler.cycles, 1u);
  expect_reproducible<3>(test::turned<3>(model.make()), options, "turned", test::eight_threads_or_shuffled);
  options.schedule.lattice = 2;
  options.size = model.fine;
  const auto given = expect_reproducible<3>(shifted<3>(model.make(), 0.3), options, "lattice 2", test::two_if_quick);
  EXPECT_LE(given.scheduler.leaves, 8u);
}

INSTANTIATE_TEST_SUITE_P(Models, UniformModel, testing::ValuesIn(test::refined_models),
                         [](const auto& info) { return std::string(info.param.name); });

TEST(Uniform, PartWithTheOptimiser) {
  const Plc<3> plc = read_plc<3>(PGDR_TEST_MODELS "/bracket.poly");
  RefineOptions<3> options = uniform<3>(0.3);
  options.min_dihedral = default_min_dihedral;
  const auto result = expect_reproducible<3>(plc, options, "bracket", test::eight_threads_or_shuffled);
  EXPECT_GT(result.optimization.moves, 0u);
  options.schedule.lattice = 3;
  expect_reproducible<3>(test::turned<3>(plc), options, "bracket, turned", test::two_if_quick);
}

TEST(Uniform, Plane) {
  const std::pair<Plc<2>, double> inputs[] = {{test::square_with_hole(), 0.002},
                                              {test::turned<2>(test::square_with_hole()), 0.002},
                                              {shifted<2>(test::square_with_hole(), 0.3), 0.004},
                                              {read_plc<2>(PGDR_TEST_MODELS "/plate.poly"), 0.0005},
                                              {test::random_graph(40, 30, 64, 7), 0.001}};
  for (std::size_t i = 0; i < std::size(inputs); ++i)
    for (const int lattice : {0, 1, 3, most_lattice<2>()}) {
      RefineOptions<2> options = uniform<2>(inputs[i].second);
      options.schedule.lattice = lattice;
      const std::string what = "input " + std::to_string(i) + ", lattice " + std::to_string(lattice);
      const auto result = expect_reproducible<2>(inputs[i].first, options, what,
                                                 lattice == 0 ? test::concurrent_runners : test::two_if_quick);
      if (lattice == 1) {
        EXPECT_EQ(result.scheduler.leaves, 1u) << what;
      } else {
        EXPECT_GE(result.scheduler.leaves, 16u) << what;
      }
    }
}

// Beside small angles elements stay poor, and insertions reach farther than the theory has it.
TEST(Uniform, SmallAngles) {
  for (const std::string file : {"wedge_of_1_degree.off", "plate_one_cell.poly", "needle_1e-7.off", "twisted_strips.off"}) {
    RefineOptions<3> options = uniform<3>(file.starts_with("wedge") ? SizingField<3>(0.15) : SizingField<3>());
    options.schedule.floor = 10;
    const auto result = expect_reproducible<3>(read_plc<3>(PGDR_TEST_REGRESSIONS "/" + file), options, file, test::two_if_quick);
    EXPECT_GT(result.reasons.size(), 0u) << file;
  }
  const auto result = expect_reproducible<2>(test::fan(9, 3, 5), uniform<2>(0.002), "fan");
  EXPECT_GT(result.poor_left, 0u);
}

TEST(Uniform, SizesThatVary) {
  RefineOptions<3> options = uniform<3>([](const Point3& p) { return 0.02 + 0.1 * std::hypot(p[0], p[1], p[2]); });
  expect_reproducible<3>(test::cube(), options, "graded cube", test::eight_threads_or_shuffled);
  options = uniform<3>(0.08);
  options.region_sizes = {{10, 0.04}};
  expect_reproducible<3>(test::two_region_cube(), options, "sizes of regions", test::eight_threads_or_shuffled);
}

/// In windows that visits of the size of those by default, and small ones, work off: about as many cells as the graded schedule
/// makes, in few cycles.
template <int D>
void expect_like_graded(const Plc<D>& plc, double size, const std::string& what) {
  RefineOptions<D> graded = uniform<D>(size);
  graded.schedule.schedule = Schedule::reproducible;
  graded.schedule.floor = 0;
  const auto reference = test::refine_and_check<D>(plc, graded);
  EXPECT_EQ(reference.report.exit_code(), 0) << what << "\n" << test::findings(reference.report);
  const auto cells = static_cast<double>(reference.result.mesh.cells.size());
  for (const std::size_t floor : {0, 500, 60}) {
    RefineOptions<D> options = uniform<D>(size);
    options.schedule.floor = floor;
    options.schedule.trace = true;
    const auto [result, report] = test::refine_and_check<D>(plc, options);
    EXPECT_EQ(report.exit_code(), 0) << what << "\n" << test::findings(report);
    EXPECT_LE(static_cast<double>(result.mesh.cells.size()), 1.03 * cells) << what << ", floor " << floor;
    EXPECT_GT(result.scheduler.leaves, 1u) << what;
    EXPECT_TRUE(1 <= result.scheduler.cycles && result.scheduler.cycles <= 3) << what << ", " << result.scheduler.cycles;
    std::map<std::uint32_t, std::set<std::uint64_t>> phases;
    for (const VisitTrace& visit : result.trace) phases[visit.level].insert(visit.generation);
    for (const auto& [level, generations] : phases)
      EXPECT_LE(generations.size(), 3u << D) << what << ", floor " << floor << ", level " << level;
  }
}

// (Of a square along the axes one window makes 65,536 equal triangles where the graded schedule makes 56,395 of any kind: there
// the structure counts, not the schedule.)
TEST(Uniform, CellsAndCyclesAreFew) {
  expect_like_graded<2>(test::turned<2>(square_or_cube<2>()), 3e-5, "square");
  expect_like_graded<2>(test::square_with_hole(), 3e-4, "square with a hole");
  expect_like_graded<3>(test::cube(), 0.05, "cube");
  expect_like_graded<3>(test::block_with_cavity(), 0.11, "block with a cavity");
  expect_like_graded<3>(test::turned<3>(test::u_block()), 0.09, "block in the form of a U");
}

template <class>
class UniformOf : public testing::Test {};
TYPED_TEST_SUITE(UniformOf, test::Dimensions);

template <int D>
void expect_refused(const RefineOptions<D>& options, const std::string& word) {
  try {
    refine<D>(square_or_cube<D>(), options);
    ADD_FAILURE() << "no error: " << word;
  } catch (const UsageError& e) {
    EXPECT_EQ(e.code(), Errc::bad_option);
    EXPECT_NE(std::string(e.what()).find(word), std::string::npos) << e.what();
  }
}

TYPED_TEST(UniformOf, RefusesOptionsThatCannotBe) {
  constexpr int D = TypeParam::value;
  RefineOptions<D> options = uniform<D>(0.5);
  for (const int lattice : {-1, most_lattice<D>() + 1}) {
    options.schedule.lattice = lattice;
    expect_refused<D>(options, "lattice");
  }
  for (const Schedule other : {Schedule::reproducible, Schedule::greedy}) {
    options.schedule.schedule = other;
    options.schedule.lattice = 3;
    expect_refused<D>(options, "lattice");
    options.schedule.lattice = 0;
    EXPECT_EQ(refine<D>(square_or_cube<D>(), options).stop, StopCause::finished);
  }
  options = uniform<D>(0.5);
  options.schedule.claims = ClaimRule::leaves;
  expect_refused<D>(options, "claims");
}

// Where few doubles lie across the input the lattice is not halved beyond them, whatever is asked for, though windows of the next
// one would take all elements.
TEST(Uniform, CoarseDoubles) {
  Plc<2> plc;
  test::add_square(plc, 0x1p51, 0x1p51 + 64);  // 128 doubles to a side
  RefineOptions<2> options = uniform<2>(300);
  options.schedule.lattice = 9;
  options.schedule.split_ratio = 1000;
  const auto result = expect_reproducible<2>(plc, options, "coarse doubles", test::two_if_quick);
  EXPECT_GE(result.scheduler.leaves, 64u * 64u);
  EXPECT_LE(result.scheduler.leaves, 128u * 128u);
}

// One window holds what is not refined much; and a thin plate leaves most windows empty.
TYPED_TEST(UniformOf, InputsSmallerThanAWindow) {
  constexpr int D = TypeParam::value;
  for (const int lattice : {0, 1, most_lattice<D>()}) {
    RefineOptions<D> options = uniform<D>({});
    options.schedule.lattice = lattice;
    const auto result = expect_reproducible<D>(square_or_cube<D>(), options, "without a size", test::two_if_quick);
    EXPECT_EQ(result.scheduler.leaves, 1u);
  }
  Plc<D> thin = square_or_cube<D>();
  test::for_each_point(thin, [](Point<D>& p) { p[D - 1] *= 0.02; });
  const auto result = expect_reproducible<D>(thin, uniform<D>(D == 3 ? 0.012 : 1e-5), "thin", test::two_if_quick);
  EXPECT_GE(result.scheduler.leaves, 64u);
}

/// A size for some ten thousand cells.
template <int D>
constexpr double usual_size = D == 3 ? 0.07 : 1e-4;

/// A size function that does something at its n-th call, from whatever thread.
template <int D>
SizingField<D> at_call(std::atomic<std::uint64_t>& calls, std::uint64_t n, std::function<void()> act) {
  return [&calls, n, act = std::move(act)](const Point<D>&) {
    if (calls.fetch_add(1) + 1 == n) act();
    return usual_size<D>;
  };
}

template <int D>
std::uint64_t calls_in_all() {
  std::atomic<std::uint64_t> calls{0};
  const auto never = [] {};
  refine<D>(square_or_cube<D>(), test::with<D>(uniform<D>(at_call<D>(calls, 0, never)), serial));
  return calls;
}

template <int D>
test::Outcome<D> expect_stopped(const RefineOptions<D>& options, StopCause cause, const std::string& what) {
  auto outcome = test::refine_and_check<D>(square_or_cube<D>(), options);
  EXPECT_EQ(outcome.result.stop, cause) << what;
  EXPECT_FALSE(outcome.result.mesh.cells.empty()) << what;
  EXPECT_TRUE(test::unfinished_but_valid(outcome.report)) << what << "\n" << test::findings(outcome.report);
  return outcome;
}

TYPED_TEST(UniformOf, EndsWithinABudgetOfVertices) {
  constexpr int D = TypeParam::value;
  const test::AllowThreads allow(8);
  for (const std::uint64_t most : {100u, 1501u}) {
    RefineOptions<D> options = uniform<D>(usual_size<D>);
    options.max_vertices = most;
    const auto first = expect_stopped<D>(test::with<D>(options, serial), StopCause::max_vertices, "serial");
    EXPECT_LE(first.result.mesh.points.size(), most);
    EXPECT_GE(first.result.mesh.points.size(), most - most / 10);
    for (const Runner& runner : test::concurrent_runners)
      expect_same<D>(first.result, refine<D>(square_or_cube<D>(), test::with<D>(options, runner)), runner.name);
  }
}

TYPED_TEST(UniformOf, EndsWhenItIsCancelled) {
  constexpr int D = TypeParam::value;
  const test::AllowThreads allow(8);
  const std::uint64_t all = calls_in_all<D>();
  for (const Runner& runner : {serial, eight_threads.back()})
    for (const std::uint64_t tenth : {1, 5, 9}) {
      std::stop_source source;
      std::atomic<std::uint64_t> calls{0};
      RefineOptions<D> options = uniform<D>(at_call<D>(calls, all * tenth / 10, [&] { source.request_stop(); }));
      options.stop = source.get_token();
      const auto outcome = expect_stopped<D>(test::with<D>(options, runner), StopCause::cancelled, runner.name);
      EXPECT_LT(outcome.result.mesh.points.size(), all);
    }
}

TYPED_TEST(UniformOf, EndsWithItsTime) {
  constexpr int D = TypeParam::value;
  const test::AllowThreads allow(8);
  for (const Runner& runner : {serial, eight_threads.back()}) {
    RefineOptions<D> options = uniform<D>([](const Point<D>&) {
      std::this_thread::sleep_for(std::chrono::microseconds(200));
      return usual_size<D>;
    });
    options.time_limit = std::chrono::duration<double>(test::sanitized ? 2 : 0.3);
    expect_stopped<D>(test::with<D>(options, runner), StopCause::time_limit, runner.name);
  }
}

TYPED_TEST(UniformOf, ThrowsWhatTheSizeFunctionThrows) {
  constexpr int D = TypeParam::value;
  struct Mine {
    std::uint64_t number;
  };
  const test::AllowThreads allow(8);
  const std::uint64_t all = calls_in_all<D>();
  for (const Runner& runner : {serial, eight_threads[0], eight_threads.back()})
    for (const std::uint64_t tenth : {0, 3, 9}) {
      std::atomic<std::uint64_t> calls{0};
      const RefineOptions<D> options = uniform<D>(at_call<D>(calls, all * tenth / 10 + 1, [&] { throw Mine{tenth}; }));
      try {
        refine<D>(square_or_cube<D>(), test::with<D>(options, runner));
        ADD_FAILURE() << "nothing came out, " << runner.name;
      } catch (const Mine& mine) {
        EXPECT_EQ(mine.number, tenth);
      }
    }
}

}  // namespace pgdr::test_run_uniform
