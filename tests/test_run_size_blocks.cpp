// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Size functions that are asked by blocks make the mesh that they make point by point, for any number of threads, with every
// schedule that is reproducible, and on ranks; what they throw or return that is no size comes out.
#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <limits>
#include <span>
#include <string>

#include "parallel_support.hpp"
#include "pgdr/check.hpp"
#include "pgdr/io.hpp"
#include "pgdr/size_fields.hpp"
#include "planar_plcs.hpp"
#include "uniform_on_ranks.hpp"

namespace pgdr::test_run_size_blocks {

/// A field by blocks, and what it was asked.
template <int D>
struct Counted {
  std::atomic<std::uint64_t> calls{0}, points{0};

  SizingField<D> by_blocks(const SizeFunction<D>& f) {
    return SizingField<D>::by_blocks([this, f](std::span<const Point<D>> at, std::span<double> sizes) {
      calls += 1;
      points += at.size();
      for (std::size_t i = 0; i < at.size(); ++i) sizes[i] = f(at[i]);
    });
  }
};

/// Smaller to one side.
template <int D>
SizeFunction<D> graded(double least, double growth) {
  return [=](const Point<D>& x) { return least + growth * std::abs(x[0]); };
}

/// `set(options, field)` puts the field where it belongs.
template <int D, class Set>
void expect_same_by_blocks(const Plc<D>& plc, RefineOptions<D> options, const SizeFunction<D>& f, Set set) {
  RefineOptions<D> by_points = options;
  set(by_points, SizingField<D>(f));
  by_points.schedule.threads = 1;
  const auto wanted = test::checked_alone<D>(plc, by_points);
  ASSERT_GT(wanted.mesh.cells.size(), 300u);
  for (const int threads : {1, 2, 8}) {
    Counted<D> counted;
    set(options, counted.by_blocks(f));
    options.schedule.threads = threads;
    const auto found = refine(plc, options);
    test::expect_same_mesh<D>(wanted.mesh, found.mesh);
    EXPECT_EQ(wanted.poor_left, found.poor_left);
    EXPECT_EQ(wanted.statistics.insertions_committed, found.statistics.insertions_committed);
    EXPECT_GT(counted.points, counted.calls);
  }
}

template <int D>
void set_size(RefineOptions<D>& options, const SizingField<D>& field) {
  options.size = field;
}

TEST(SizeBlocks, SolidWithAndWithoutTheOptimiser) {
  const Plc<3> bracket = read_plc<3>(PGDR_TEST_MODELS "/bracket.poly");
  RefineOptions<3> options;
  options.schedule.floor = 60;
  expect_same_by_blocks<3>(bracket, options, graded<3>(0.15, 0.1), set_size<3>);
  options.min_dihedral = 0;
  for (const std::size_t floor : {std::size_t{0}, std::size_t{60}}) {
    options.schedule.floor = floor;
    expect_same_by_blocks<3>(bracket, options, graded<3>(0.1, 0.1), set_size<3>);
  }
  options.radius_edge_bound = 1.5;  // the other order of elements of one bucket
  expect_same_by_blocks<3>(bracket, options, graded<3>(0.15, 0.1), set_size<3>);
}

TEST(SizeBlocks, WhereTheOptimiserDoesAllThatItCan) {
  RefineOptions<3> options;
  options.schedule.floor = 60;
  options.min_dihedral = 22;  // reconnection, new vertices, detours, splits of edges
  expect_same_by_blocks<3>(read_plc<3>(PGDR_TEST_MODELS "/bracket.poly"), options, graded<3>(0.2, 0.1), set_size<3>);
  options.max_volume = 0.002;
  expect_same_by_blocks<3>(test::cube(), options, graded<3>(0.08, 0.08), set_size<3>);
}

/// How often a function is called by a run, or asked point by point.
std::uint64_t calls_of(RefineOptions<3> options, bool by_blocks) {
  Counted<3> counted;
  const SizeFunction<3> f = graded<3>(0.05, 0.05);
  std::atomic<std::uint64_t> points{0};
  options.schedule.threads = 1;
  options.size = by_blocks ? counted.by_blocks(f) : SizingField<3>([&](const Point3& x) {
    ++points;
    return f(x);
  });
  refine(test::cube(), options);
  return by_blocks ? counted.calls : points;
}

TEST(SizeBlocks, TheOptimiserAsksForManyPointsAtOnce) {
  RefineOptions<3> with, without;
  without.min_dihedral = 0;
  const std::uint64_t by_points = calls_of(with, false) - calls_of(without, false);
  const std::uint64_t by_blocks = calls_of(with, true) - calls_of(without, true);
  ASSERT_GT(by_points, 10000u);
  EXPECT_LT(40 * by_blocks, by_points) << by_blocks << " calls for what takes " << by_points << " point by point";
}

TEST(SizeBlocks, TheCheckerAsksForManyPointsAtOnce) {
  RefineOptions<3> options;
  options.regions = RegionMode::automatic;
  options.region_sizes = {{1, 0.2}};
  const auto made = refine(test::cube(), options);
  ASSERT_GT(made.mesh.cells.size(), 200u);
  Counted<3> of_all, of_label;
  CheckOptions<3> bounds;
  bounds.size = of_all.by_blocks([](const Point3& x) { return x[0] < 0.5 ? 0.3 : 0.1; });
  bounds.region_sizes = {{1, of_label.by_blocks(graded<3>(0.3, 0))}};
  const CheckReport by_blocks = check(made.mesh, bounds);
  EXPECT_EQ(of_all.calls, 1u);
  EXPECT_EQ(of_label.calls, 1u);
  EXPECT_EQ(of_all.points, made.mesh.cells.size());
  bounds.size = [](const Point3& x) { return x[0] < 0.5 ? 0.3 : 0.1; };
  bounds.region_sizes = {{1, graded<3>(0.3, 0)}};
  const CheckReport by_points = check(made.mesh, bounds);
  EXPECT_GT(by_points.over_size, 0u);
  EXPECT_EQ(by_blocks.over_size, by_points.over_size);
}

TEST(SizeBlocks, WithoutRefinementPoorCellsAreCountedByBlocks) {
  const Plc<3> bracket = read_plc<3>(PGDR_TEST_MODELS "/bracket.poly");
  RefineOptions<3> options;
  options.refine = false;
  options.size = SizingField<3>(graded<3>(0.1, 0.1));
  const auto by_points = refine(bracket, options);
  Counted<3> counted;
  options.size = counted.by_blocks(graded<3>(0.1, 0.1));
  const auto by_blocks = refine(bracket, options);
  test::expect_same_mesh<3>(by_points.mesh, by_blocks.mesh);
  EXPECT_GT(by_points.poor_left, 10u);
  EXPECT_EQ(by_points.poor_left, by_blocks.poor_left);
  EXPECT_GT(counted.points, 10 * counted.calls);
}

TEST(SizeBlocks, Plane) {
  RefineOptions<2> options;
  options.schedule.floor = 60;
  expect_same_by_blocks<2>(test::square_with_hole(), options, graded<2>(0.0002, 0.001), set_size<2>);
  options.radius_edge_bound = min_angle_degrees(28);
  const auto wave = [](const Point2& x) { return 0.0004 + 0.0003 * std::sin(5 * x[0]); };  // wherever the copy was turned to
  expect_same_by_blocks<2>(test::turned<2>(test::square_with_hole()), options, wave, set_size<2>);
}

TEST(SizeBlocks, BesideConstantsVolumesAndOfRegions) {
  const Plc<3> bracket = read_plc<3>(PGDR_TEST_MODELS "/bracket.poly");
  RefineOptions<3> options;
  options.min_dihedral = 0;
  options.schedule.floor = 60;
  options.max_volume = 0.004;
  expect_same_by_blocks<3>(bracket, options, graded<3>(0.1, 0.2), [](RefineOptions<3>& o, const SizingField<3>& field) {
    o.size = smallest<3>({0.3, field, SizingField<3>([](const Point3& x) { return 0.2 + 0.1 * std::abs(x[1]); })});
    EXPECT_TRUE(o.size.bounded());
  });
  options.regions = RegionMode::automatic;
  expect_same_by_blocks<3>(bracket, options, graded<3>(0.1, 0.2), [](RefineOptions<3>& o, const SizingField<3>& field) {
    o.region_sizes = {{1, field}};
  });
}

TEST(SizeBlocks, UniformAndOnRanks) {
  Plc<2> square;
  test::add_square(square, 0, 1);
  RefineOptions<2> options = test::uniform_options<2>(1);
  expect_same_by_blocks<2>(square, options, graded<2>(0.0005, 0.001), set_size<2>);
  Counted<2> counted;
  options.size = counted.by_blocks(graded<2>(0.0005, 0.001));
  EXPECT_GT(test::expect_same_on_ranks<2>(square, options, 3, 1).cut_cells, 0u);
}

struct OfTheCaller {
  double where;
};

TEST(SizeBlocks, WhatTheyThrowComesOutAsItIs) {
  RefineOptions<3> options;
  options.size = SizingField<3>::by_blocks([](std::span<const Point3> at, std::span<double> sizes) {
    for (std::size_t i = 0; i < at.size(); ++i) {
      if (at[i][0] > 0.6) throw OfTheCaller{at[i][0]};
      sizes[i] = 0.1;
    }
  });
  for (const int threads : {1, 2}) {
    options.schedule.threads = threads;
    try {
      refine(test::cube(), options);
      ADD_FAILURE() << "nothing was thrown with " << threads << " threads";
    } catch (const OfTheCaller& e) {
      EXPECT_GT(e.where, 0.6);
    }
  }
}

TEST(SizeBlocks, WhatIsNoSizeIsNamed) {
  for (const double bad : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN()}) {
    RefineOptions<3> options;
    options.size = SizingField<3>::by_blocks([bad](std::span<const Point3> at, std::span<double> sizes) {
      for (std::size_t i = 0; i < at.size(); ++i)
        if (at[i][0] <= 0.6)
          sizes[i] = 0.1;  // else it is left unset
        else if (bad == bad)
          sizes[i] = bad;
    });
    try {
      refine(test::cube(), options);
      ADD_FAILURE() << "nothing was thrown for " << bad;
    } catch (const UsageError& e) {
      EXPECT_EQ(e.code(), Errc::bad_size);
      ASSERT_EQ(e.diagnostic().points.size(), 1u);
      EXPECT_GT(e.diagnostic().points[0][0], 0.6);
    }
  }
}

TEST(SizeBlocks, AnEmptyOneIsNoBound) {
  EXPECT_FALSE(SizingField<3>::by_blocks({}).bounded());
  const auto field = SizingField<2>::by_blocks([](std::span<const Point2> at, std::span<double> sizes) {
    for (std::size_t i = 0; i < at.size(); ++i) sizes[i] = at[i][0];
  });
  EXPECT_TRUE(field.is_by_blocks());
  EXPECT_EQ(field.at({3, 4}), 3);
  EXPECT_TRUE(smallest<2>({field, 2.0}).is_by_blocks());
  EXPECT_EQ(smallest<2>({field, 2.0}).at({3, 4}), 2);
}

}  // namespace pgdr::test_run_size_blocks
