// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Selectors that are asked by blocks make the mesh that they make element by element, with the same counts, for any number of
// threads, with every schedule that is reproducible, and on ranks; what they throw, and points outside of the disk, count as
// there.
#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <cmath>
#include <functional>
#include <set>
#include <span>
#include <string>

#include "parallel_support.hpp"
#include "pgdr/io.hpp"
#include "planar_plcs.hpp"
#include "scattered_models.hpp"
#include "uniform_on_ranks.hpp"

namespace pgdr::test_run_selector_blocks {

template <int D>
using Choice = std::function<Point<D>(const PoorElement<D>&)>;

/// A selector by blocks, and what it was asked.
template <int D>
struct Counted {
  std::atomic<std::uint64_t> calls{0}, elements{0};

  PointSelector<D> by_blocks(const Choice<D>& f) {
    return PointSelector<D>::by_blocks([this, f](std::span<const PoorElement<D>> e, std::span<Point<D>> points) {
      calls += 1;
      elements += e.size();
      for (std::size_t i = 0; i < e.size(); ++i) points[i] = f(e[i]);
    });
  }
};

/// From the circumcentre towards the first corner: `far` is in radii of the disk.
template <int D>
Choice<D> towards_a_corner(double far) {
  return [far](const PoorElement<D>& e) {
    Point<D> p = e.circumcenter;
    for (int k = 0; k < D; ++k) p[k] += far * e.disk.radius / e.circumradius * (e.corners[0][k] - p[k]);
    return p;
  };
}

/// The same, but outside of the disk, or nowhere, for some.
template <int D>
Point<D> sometimes_outside(const PoorElement<D>& e) {
  const int what = static_cast<int>(std::fmod(1e6 * std::abs(e.circumcenter[0] / e.circumradius), 3));
  if (what == 0) return towards_a_corner<D>(0.5)(e);
  if (what == 1) return e.corners[0];
  Point<D> nowhere;
  nowhere.x.fill(NAN);
  return nowhere;
}

/// @returns how many elements were asked for in a call, with one thread
template <int D>
double expect_same_by_blocks(const Plc<D>& plc, RefineOptions<D> options, const Choice<D>& f) {
  const test::AllowThreads allow(8);
  options.disk.type = DiskType::type1;
  options.schedule.threads = 1;
  RefineOptions<D> one_by_one = options;
  std::atomic<std::uint64_t> asked{0};
  one_by_one.selector = [&](const PoorElement<D>& e) { return ++asked, f(e); };
  const auto wanted = test::checked_alone<D>(plc, one_by_one);
  EXPECT_GT(asked, 50u);
  double a_call = 0;
  for (const int threads : {1, 2, 8}) {
    Counted<D> counted;
    options.selector = counted.by_blocks(f);
    options.schedule.threads = threads;
    test::expect_same<D>(wanted, refine(plc, options), std::to_string(threads) + " threads");
    EXPECT_LT(counted.calls, asked);
    if (threads == 1) a_call = static_cast<double>(counted.elements) / static_cast<double>(counted.calls);
  }
  return a_call;
}

template <class Dimension>
class SelectorBlocks : public testing::Test {};
template <int D>
using Dim = std::integral_constant<int, D>;
using Dimensions = testing::Types<Dim<2>, Dim<3>>;
TYPED_TEST_SUITE(SelectorBlocks, Dimensions);

TYPED_TEST(SelectorBlocks, SameMeshForAnyThreads) {
  constexpr int D = TypeParam::value;
  const Plc<D> box = test::box_with_pairs<D>(D == 2 ? 100 : 20, 0.002, 5);
  for (const Plc<D>& plc : {box, test::turned<D>(box)})
    for (const std::size_t floor : {std::size_t{0}, std::size_t{5}})
      for (const double bound : {smallest_proved_bound<D>(), D == 2 ? 1.1 : 1.6}) {  // two orders of elements of poor shape
        RefineOptions<D> options;
        options.schedule.floor = floor;
        options.radius_edge_bound = bound;
        expect_same_by_blocks<D>(plc, options, towards_a_corner<D>(0.9));
        expect_same_by_blocks<D>(plc, options, sometimes_outside<D>);
      }
}

TYPED_TEST(SelectorBlocks, BesideSizesByBlocksAndGranularity) {
  constexpr int D = TypeParam::value;
  RefineOptions<D> options;
  options.schedule.floor = 60;
  options.schedule.granularity = 1;
  options.size = SizingField<D>::by_blocks([](std::span<const Point<D>> at, std::span<double> sizes) {
    for (std::size_t i = 0; i < at.size(); ++i) sizes[i] = (D == 2 ? 0.0005 : 0.06) * (1 + at[i][0]);
  });
  expect_same_by_blocks<D>(test::box_with_pairs<D>(D == 2 ? 100 : 40, 0.004, 7), options, towards_a_corner<D>(0.5));
}

TYPED_TEST(SelectorBlocks, UniformAndOnRanks) {
  constexpr int D = TypeParam::value;
  const Plc<D> plc = test::box_with_pairs<D>(D == 2 ? 100 : 20, 0.01, 3);
  RefineOptions<D> options = test::uniform_options<D>(D == 2 ? 0.001 : 0.12);
  expect_same_by_blocks<D>(plc, options, towards_a_corner<D>(0.5));
  Counted<D> counted;
  options.disk.type = DiskType::type1;
  options.selector = counted.by_blocks(towards_a_corner<D>(0.5));
  EXPECT_GT(test::expect_same_on_ranks<D>(plc, options, 3, 1).cut_cells, 0u);
}

/// Some points more, inside the circumsphere.
template <int D>
SelectedPoints<D> several(const PoorElement<D>& e) {
  SelectedPoints<D> points;
  for (const double far : {0.5, -0.5, -0.9}) points.push_back(towards_a_corner<D>(far * (points.empty() ? 1 : 2))(e));
  return points;
}

// Of several points: the same element by element, by blocks, for any number of threads, with all schedules and on ranks.
TYPED_TEST(SelectorBlocks, SeveralPoints) {
  constexpr int D = TypeParam::value;
  const test::AllowThreads allow(8);
  const Plc<D> plc = test::box_with_pairs<D>(D == 2 ? 100 : 20, 0.01, 3);
  const auto by_blocks = PointSelector<D>::by_blocks_of_several(
      [](std::span<const PoorElement<D>> e, std::span<SelectedPoints<D>> points) {
        for (std::size_t i = 0; i < e.size(); ++i) points[i] = several<D>(e[i]);
      });
  for (const bool is_uniform : {false, true}) {
    RefineOptions<D> options = is_uniform ? test::uniform_options<D>(D == 2 ? 0.001 : 0.12) : RefineOptions<D>{};
    options.disk.type = DiskType::type1;
    options.schedule.floor = 5;
    options.selector = several<D>;
    options.schedule.threads = 1;
    const auto wanted = test::checked_alone<D>(plc, options);
    EXPECT_GT(wanted.statistics.selector_further, 10u);
    options.selector = by_blocks;
    for (const int threads : {1, 2, 8}) {
      options.schedule.threads = threads;
      test::expect_same<D>(wanted, refine(plc, options), std::to_string(threads) + " threads");
    }
  }
  RefineOptions<D> options = test::uniform_options<D>(D == 2 ? 0.001 : 0.12);
  options.disk.type = DiskType::type1;
  options.selector = by_blocks;
  EXPECT_GT(test::expect_same_on_ranks<D>(plc, options, 3, 1).cut_cells, 0u);
}

TEST(SelectorBlocksModels, Regions) {
  RefineOptions<3> options;
  options.schedule.floor = 60;
  options.regions = RegionMode::automatic;
  expect_same_by_blocks<3>(read_plc<3>(PGDR_TEST_MODELS "/bracket.poly"), options, towards_a_corner<3>(0.9));
  RefineOptions<2> planar;
  planar.size = 0.001;
  planar.radius_edge_bound = min_angle_degrees(30);
  planar.regions = RegionMode::automatic;
  expect_same_by_blocks<2>(test::turned<2>(test::square_with_hole()), planar, towards_a_corner<2>(0.5));
}

// Scattered points are what many elements of poor shape wait at from the first on.
TEST(SelectorBlocksModels, BlocksAreLarge) {
  EXPECT_GT(expect_same_by_blocks<2>(test::box_with_pairs<2>(400, 0.0005, 2), {}, towards_a_corner<2>(0.5)), 2);
}

struct OfTheCaller {
  double where;
};

TYPED_TEST(SelectorBlocks, WhatTheyThrowComesOutAsItIs) {
  constexpr int D = TypeParam::value;
  RefineOptions<D> options;
  Counted<D> counted;
  options.selector = counted.by_blocks([](const PoorElement<D>& e) {
    if (e.circumcenter[0] > 0.6) throw OfTheCaller{e.circumcenter[0]};
    return e.circumcenter;
  });
  for (const int threads : {1, 2}) {
    options.schedule.threads = threads;
    try {
      refine(test::box_with_pairs<D>(D == 2 ? 100 : 20, 0.002, 5), options);
      ADD_FAILURE() << "nothing was thrown with " << threads << " threads";
    } catch (const OfTheCaller& e) {
      EXPECT_GT(e.where, 0.6);
    }
  }
}

// Only what is asked for, but never treated, is outside: no error, and nothing counts.
TYPED_TEST(SelectorBlocks, AnswersThatAreNotUsedDoNotCount) {
  constexpr int D = TypeParam::value;
  const Plc<D> plc = test::box_with_pairs<D>(D == 2 ? 100 : 20, 0.002, 5);
  RefineOptions<D> options;
  options.disk.type = DiskType::type1;
  options.outside = OutsidePolicy::error;
  options.schedule.threads = 1;
  std::set<std::array<double, D>> treated;
  const Choice<D> choice = towards_a_corner<D>(0.5);
  options.selector = [&](const PoorElement<D>& e) { return treated.insert(e.circumcenter.x), choice(e); };
  const auto wanted = test::checked_alone<D>(plc, options);
  Counted<D> counted;
  std::uint64_t unused = 0;
  options.selector = counted.by_blocks([&](const PoorElement<D>& e) {
    if (treated.contains(e.circumcenter.x)) return choice(e);
    return ++unused, e.corners[0];
  });
  test::expect_same<D>(wanted, refine(plc, options), "unused answers outside");
  EXPECT_GT(unused, 0u);
  options.selector = counted.by_blocks([](const PoorElement<D>& e) { return e.corners[0]; });
  EXPECT_THROW(refine(plc, options), UsageError);
}

TEST(SelectorBlocksModels, AnEmptyOneIsNone) {
  EXPECT_FALSE(PointSelector<3>::by_blocks({}));
  const auto selector = PointSelector<2>::by_blocks([](std::span<const PoorElement<2>>, std::span<Point<2>>) {});
  EXPECT_TRUE(selector && selector.is_by_blocks());
  EXPECT_FALSE(PointSelector<2>(towards_a_corner<2>(0.5)).is_by_blocks());
  const PoorElement<2> element{};
  Point2 point{};
  selector(std::span(&element, 1), std::span(&point, 1));
  EXPECT_TRUE(std::isnan(point[0]) && std::isnan(point[1]));  // what is left unset
}

}  // namespace pgdr::test_run_selector_blocks
