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
