// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// What cancellation leaves behind: a valid partial mesh whose poor cells are counted as a look at every cell counts them, and
// no call of a slow size function on the way; or a typed error, while the input is prepared. (More of them in flight:
// test_run_stress.cpp.)
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <ctime>
#include <functional>
#include <numbers>
#include <thread>

#include "parallel_support.hpp"
#include "pgdr/circumsphere.hpp"
#include "pgdr/diagnosis.hpp"
#include "pgdr/flat_arrays.hpp"
#include "pgdr/io.hpp"
#include "pgdr/predicates.hpp"

namespace pgdr::test_run_cancel {

using test::Runner;

template <int D>
Plc<D> model() {
  if constexpr (D == 3) {
    return test::turned<3>(test::cube_with_two_points());
  } else {
    const double xy[] = {0, 0, 1, 0, 1, 1, 0, 1, 0.5, 0.5, 0.5, 0.5001};
    const std::uint32_t segments[] = {0, 1, 1, 2, 2, 3, 3, 0};
    Plc<2> plc = plc_from_arrays<2>(xy, segments);
    plc.regions = {{{0.25, 0.25}, 4, 0}};
    return plc;
  }
}

template <int D>
double size_at(const Point<D>& p) {
  return (D == 3 ? 0.07 : 4e-4) * (1 + 0.3 * std::sin(20 * p[0]));
}

struct Counted {
  std::uint64_t poor = 0;
  bool over_size = false;
};

template <int D>
Counted count_poor(const OutputMesh<D>& mesh, double radius_edge_bound) {
  Counted counted;
  for (const auto& cell : mesh.cells) {
    Simplex<D> s;
    for (int i = 0; i <= D; ++i) s[i] = mesh.points[cell[i]];
    const double size = size_at<D>(centroid<D>(s));
    bool large;
    if constexpr (D == 3) {
      large = !circumradius_within<3>(s, size);
    } else {
      large = !measure_within<2>(s, size);
    }
    counted.poor += large || !radius_edge_within<D>(s, radius_edge_bound) ? 1 : 0;
    counted.over_size = counted.over_size || large;
  }
  return counted;
}

template <class T>
class Cancel : public testing::Test {};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(Cancel, Dimensions);

template <int D>
RefineOptions<D> options() {
  RefineOptions<D> o;
  o.radius_edge_bound = smallest_proved_bound<D>();
  o.schedule.floor = 20;
  return o;
}

// At many moments of a run, and after its last insertion: as soon as the functions have returned no more of them are called
// but for the insertions that are under way.
TYPED_TEST(Cancel, PartialMeshesAreValidAndTheirPoorCellsCounted) {
  constexpr int D = TypeParam::value;
  const test::AllowThreads allow(8);
  std::atomic<std::uint64_t> calls{0}, stop_at{0};
  std::stop_source* source = nullptr;
  const SizingField<D> counting = [&](const Point<D>& p) {
    if (calls.fetch_add(1) + 1 == stop_at) source->request_stop();
    return size_at<D>(p);
  };
  std::vector<Runner> runners{test::serial};
  runners.insert(runners.end(), test::eight_threads.begin(), test::eight_threads.end());
  std::vector<std::pair<Schedule, Runner>> ways;
  for (const Runner& runner : runners) ways.push_back({Schedule::reproducible, runner});
  ways.push_back({Schedule::greedy, test::eight_threads[0]});
  for (const auto& [schedule, runner] : ways) {
    auto o = test::with<D>(options<D>(), runner);
    o.schedule.schedule = schedule;
    o.size = counting;
    calls = stop_at = 0;
    const auto whole = refine<D>(model<D>(), o);
    const std::uint64_t all = calls;
    for (const std::uint64_t percent : {0, 5, 20, 45, 70, 90, 99}) {
      std::stop_source this_one;
      source = &this_one;
      o.stop = this_one.get_token();
      calls = 0;
      stop_at = all * percent / 100 + 1;
      const Plc<D> plc = model<D>();
      const Domain<D> domain(plc);
      const auto result = refine<D>(domain, o);
      if (schedule == Schedule::greedy && calls < stop_at) continue;  // no two runs are the same
      const std::uint64_t late = calls - stop_at;
      stop_at = 0;
      ASSERT_EQ(result.stop, StopCause::cancelled) << runner.name << percent;
      EXPECT_TRUE(result.reasons.empty());
      EXPECT_EQ(result.mesh.regions.size(), whole.mesh.regions.empty() ? 0 : result.mesh.cells.size());
      CheckOptions<D> check_options;
      check_options.input = &plc;
      check_options.delaunay = result.delaunay;
      const auto report = check<D>(result.mesh, check_options);
      EXPECT_TRUE(test::unfinished_but_valid(report)) << runner.name << percent << "\n" << test::findings(report);
      const Counted counted = count_poor<D>(result.mesh, o.radius_edge_bound);
      EXPECT_EQ(result.poor_left, counted.poor) << runner.name << percent;
      EXPECT_EQ(result.size_met, !counted.over_size) << runner.name << percent;
      // Eight insertions of some hundred cells at most, not all cells.
      if (percent >= 5 && schedule != Schedule::greedy) {
        EXPECT_LT(late, 8u * 400u) << runner.name << percent;
      }
    }
  }
}

// Beside small angles cavities are cut back, and faces that are not locally Delaunay wait for their repair. A run that is
// cancelled then does not say that its mesh is Delaunay.
TEST(Cancel, MeshWithoutItsRepairsIsNotCalledDelaunay) {
  const Plc<3> plc = read_plc<3>(PGDR_TEST_REGRESSIONS "/plate_fifty_cells.poly");
  const Domain<3> domain(plc);
  std::uint64_t calls = 0, stop_at = 0;
  std::stop_source* source = nullptr;
  auto o = test::with<3>(options<3>(), test::serial);
  o.min_dihedral = 0;
  o.size = SizingField<3>([&](const Point3&) {
    if (++calls == stop_at) source->request_stop();
    return 10.0;
  });
  ASSERT_TRUE(refine<3>(domain, o).delaunay);
  const std::uint64_t all = calls;
  int not_delaunay = 0;
  for (int part = 1; part < 12; ++part) {
    std::stop_source this_one;
    source = &this_one;
    o.stop = this_one.get_token();
    calls = 0;
    stop_at = all * static_cast<std::uint64_t>(part) / 12;
    const auto result = refine<3>(domain, o);
    stop_at = 0;
    ASSERT_EQ(result.stop, StopCause::cancelled) << part;
    CheckOptions<3> check_options;
    check_options.input = &plc;
    check_options.delaunay = result.delaunay;
    const auto report = check<3>(result.mesh, check_options);
    EXPECT_TRUE(test::unfinished_but_valid(report)) << part << "\n" << test::findings(report);
    check_options.delaunay = true;
    not_delaunay += check<3>(result.mesh, check_options).count(CheckFinding::Kind::not_delaunay) > 0 ? 1 : 0;
  }
  EXPECT_GT(not_delaunay, 0);
}

// What a time limit leaves is numbered likewise.
TYPED_TEST(Cancel, TimeLimit) {
  constexpr int D = TypeParam::value;
  const Plc<D> plc = model<D>();
  const Domain<D> domain(plc);
  for (const int limit : {0, 5, 20}) {
    auto o = options<D>();
    o.size = [](const Point<D>& p) { return size_at<D>(p) / 16; };
    o.time_limit = std::chrono::milliseconds(limit);
    const auto result = refine<D>(domain, o);
    ASSERT_EQ(result.stop, StopCause::time_limit);
    if (result.mesh.cells.empty()) continue;  // a slow machine: no boundary yet
    CheckOptions<D> check_options;
    check_options.input = &plc;
    check_options.delaunay = result.delaunay;
    const auto report = check<D>(result.mesh, check_options);
    EXPECT_TRUE(test::unfinished_but_valid(report)) << test::findings(report);
  }
}

/// A surface, or a polygon, with so many parts that it takes a while to look at.
template <int D>
Plc<D> large() {
  constexpr double pi = 3.14159265358979323846;
  Plc<D> plc;
  if constexpr (D == 3) {
    constexpr std::uint32_t n = 250, m = 250;  // of a torus, two triangles each
    for (std::uint32_t i = 0; i < n; ++i)
      for (std::uint32_t j = 0; j < m; ++j) {
        const double a = 2 * pi * i / n, b = 2 * pi * j / m, r = 2 + std::cos(b);
        plc.points.push_back({r * std::cos(a), r * std::sin(a), std::sin(b)});
      }
    const auto at = [](std::uint32_t i, std::uint32_t j) { return i % n * m + j % m; };
    for (std::uint32_t i = 0; i < n; ++i)
      for (std::uint32_t j = 0; j < m; ++j) {
        plc.facets.push_back({{{at(i, j), at(i + 1, j), at(i + 1, j + 1)}}, {}, 0});
        plc.facets.push_back({{{at(i, j), at(i + 1, j + 1), at(i, j + 1)}}, {}, 0});
      }
  } else {
    constexpr std::uint32_t n = 200000;
    for (std::uint32_t i = 0; i < n; ++i) {
      plc.points.push_back({std::cos(2 * pi * i / n), std::sin(2 * pi * i / n)});
      plc.segments.push_back({{i, (i + 1) % n}, 0});
    }
  }
  return plc;
}

template <class F>
bool is_cancelled(const F& f) {
  try {
    f();
  } catch (const CancelledError& e) {
    EXPECT_EQ(e.code(), Errc::cancelled);
    EXPECT_EQ(name(e.code()), "cancelled");
    return true;
  }
  return false;
}

// Before the work begins, and from another thread while it is done: a typed error, and no mesh from `refine`.
TYPED_TEST(Cancel, WhileTheInputIsPrepared) {
  constexpr int D = TypeParam::value;
  const Plc<D> plc = large<D>();
  const Domain<D> domain(plc);
  const std::function<void(std::stop_token)> works[] = {
      [&](std::stop_token stop) { Domain<D>(plc, stop); },
      [&](std::stop_token stop) {
        std::vector<Diagnostic> refused;
        Domain<D>::without_invalid(plc, refused, stop);
      },
      [&](std::stop_token stop) { diagnose<D>(plc, {.stop = stop}); },
      [&](std::stop_token stop) { diagnose<D>(domain, {.stop = stop}); },
  };
  int late_ones = 0;
  for (const auto& work : works) {
    std::stop_source before, later;
    before.request_stop();
    EXPECT_TRUE(is_cancelled([&] { work(before.get_token()); }));
    const std::jthread other([&later] {
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
      later.request_stop();
    });
    late_ones += is_cancelled([&] { work(later.get_token()); });
  }
  EXPECT_GE(late_ones, 1);  // the last one may be done by then
  std::stop_source source;
  const Domain<D> same(plc, source.get_token());
  EXPECT_EQ(diagnose<D>(same, {.stop = source.get_token()}).error_count(), 0u);
  EXPECT_NO_THROW(require_no_errors<D>(same, source.get_token()));
  EXPECT_EQ(same.segments().size(), domain.segments().size());
  source.request_stop();
  auto o = options<D>();
  o.stop = source.get_token();
  for (const auto& result : {refine<D>(plc, o), refine<D>(domain, o)}) {
    EXPECT_EQ(result.stop, StopCause::cancelled);
    EXPECT_TRUE(result.mesh.cells.empty());
    EXPECT_FALSE(result.size_met);
  }
}

/// Processor seconds of this process.
double processor_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

/// Processor seconds that a run takes once it was told to end after so many, as a part of these; 0: it had ended before.
template <int D>
double lateness(const Plc<D>& plc, RefineOptions<D> o, double seconds, std::size_t& cells) {
  std::stop_source source;
  o.stop = source.get_token();
  const double start = processor_seconds();
  double asked = 0;
  const auto ask = [&](const std::stop_token& over) {
    while (!over.stop_requested() && processor_seconds() - start < seconds)
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    asked = processor_seconds();
    source.request_stop();
  };
  std::jthread other(ask);
  const auto result = refine<D>(plc, o);
  const double end = processor_seconds();
  other.request_stop();
  other.join();
  cells = result.mesh.cells.size();
  return result.stop == StopCause::cancelled ? (end - asked) / (asked - start) : 0;
}

// Between two plates, or where a point nearly is on a segment, millions of entries wait for few leaves, which splits hand them
// down to, level by level. (A run that had to end did all that first: twice as long as it had run until then.)
TEST(Cancel, WhereMillionsWait) {
  if (test::sanitized) GTEST_SKIP() << "too slow";
  const double xyz[] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0, 0, 0, 1e-5, 1, 0, 1e-5, 0, 1, 1e-5, 1, 1, 1e-5};
  const std::uint32_t triangles[] = {0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6, 0, 1, 5, 0, 5, 4,
                                     2, 6, 7, 2, 7, 3, 0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5};
  const Plc<3> plate = plc_from_arrays<3>(xyz, triangles);
  const double xy[] = {-8.5036734715375211, 10.095916872155248,  -8.12928682570357,   9.7201727850254009,  -7.7549001798695452,
                       9.344428697895621,   -7.3805135340357486, 8.9686846107656439,  -7.0061268882017229, 8.592940523635864,
                       -6.6317402423676963, 8.2171964365060806,  -6.2573535965338998, 7.841452349376107,   -5.8829669506998732,
                       7.4657082622463253,  -1.5310149050511335, 11.131306902628786,  -3.685167691645244,  14.154488301752702};
  const std::uint32_t segments[] = {0, 1, 1, 2, 2, 3, 3, 4, 4, 5, 5, 6, 6, 7, 7, 8, 8, 9, 9, 0, 2, 5};
  const Plc<2> points = plc_from_arrays<2>(xy, segments);
  constexpr double seconds = 0.4;
  for (const bool partial : {true, false})
    for (const Schedule schedule : {Schedule::reproducible, Schedule::uniform, Schedule::greedy}) {
      RefineOptions<3> o;
      RefineOptions<2> planar;
      o.memory_guard = planar.memory_guard = false;
      o.partial_mesh = planar.partial_mesh = partial;
      o.schedule.schedule = planar.schedule.schedule = schedule;
      std::size_t cells = 0;
      EXPECT_LT(lateness<3>(plate, o, seconds, cells), partial ? 0.6 : 0.3) << static_cast<int>(schedule);
      EXPECT_TRUE(partial || cells == 0);
      EXPECT_LT(lateness<2>(points, planar, seconds, cells), partial ? 0.6 : 0.3) << static_cast<int>(schedule);
      EXPECT_TRUE(partial || cells == 0);
    }
}

// (A wing of 3,996 strips took minutes before there was a word.)
TEST(Cancel, ProgressIsToldWhileTheBoundaryIsRecovered) {
  RefineOptions<3> options;
  std::stop_source source;
  options.stop = source.get_token();
  std::vector<Progress> told;
  options.progress = [&](const Progress& p) {
    told.push_back(p);
    source.request_stop();
  };
  std::vector<Point2> circle;
  for (int i = 0; i < 1200; ++i)
    circle.push_back({{0.02 * std::cos(i * std::numbers::pi / 600), 0.02 * std::sin(i * std::numbers::pi / 600)}});
  const Plc<3> plc = test::prism(circle, 1);  // each of whose sides needs some ten thousand triangles
  const auto result = refine(plc, options);
  EXPECT_EQ(result.stop, StopCause::cancelled);
  EXPECT_TRUE(result.mesh.cells.empty());
  ASSERT_EQ(told.size(), 1u);
  EXPECT_GE(told[0].vertices, plc.points.size());
  EXPECT_EQ(told[0].waiting, 0u);
}

}  // namespace pgdr::test_run_cancel
