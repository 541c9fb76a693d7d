// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The uniform schedule on ranks makes the mesh that it makes in one process, byte for byte, whatever the number of ranks and
// threads and the order in which messages come.
#include <gtest/gtest.h>

#include <array>
#include <string>
#include <vector>

#include "model_plcs.hpp"
#include "planar_plcs.hpp"
#include "ranks/outlook.hpp"
#include "uniform_on_ranks.hpp"

namespace pgdr::test {
namespace {

struct Solid {
  std::string name;
  Plc<3> plc;
  double size;
  double min_dihedral = 0;
};

std::vector<Solid> solids() {
  return {{"cube", cube(), 0.045},
          {"two_points", cube_with_two_points(), 0.06},
          {"two_regions", turned(two_region_cube()), 0.06},
          {"cavity", block_with_cavity(), 0.12},
          {"u", turned(u_block()), 0.12},
          {"plate", plate_with_hole(), 0.1},
          {"pipe", pipe(40, 0.9, 1), 0.1},
          {"pipe_turned", turned(pipe(40, 0.9, 1)), 0.1},
          {"marked", cube_with_marked_facet(), 0.06},
          {"ball", icosphere(2), 0.1},
          {"ball_optimised", icosphere(2), 0.15, 15}};
}

/// Where nothing is refused or set aside, no rank ever has all of the mesh.
detail::Outlook outlook(StopCause stop, std::uint64_t first, std::uint64_t visits, std::uint64_t committed) {
  detail::Outlook one;
  one.stop = stop;
  one.first = first;
  one.visits = visits;
  one.totals.counts.committed = one.totals.vertices = committed;
  return one;
}

TEST(RanksUniform, AllGoOnWithThePhaseThatAnyRankHasFirst) {
  using detail::no_phase;
  using detail::Outlook;
  const auto on = StopCause::finished;
  std::vector<std::vector<std::uint64_t>> rows;
  for (const Outlook& one : {outlook(on, 5, 3, 10), outlook(on, 4, 2, 20), outlook(on, no_phase, 0, 0), outlook(on, 4, 6, 1)})
    rows.push_back(one.to_row());
  detail::RunTotals before;
  before.counts.committed = before.vertices = 100;
  const std::array<std::uint64_t, 4> visits_before{0, 0, 2, 2};
  for (int rank = 0; rank < 4; ++rank) {
    const Outlook all = Outlook::of_all(rows, rank, before);
    EXPECT_EQ(all.stop, on);
    EXPECT_EQ(all.first, 4u);
    EXPECT_EQ(all.visits, 8u);
    EXPECT_EQ(all.visits_before, visits_before[static_cast<std::size_t>(rank)]);
    EXPECT_FALSE(all.is_any_left);
    EXPECT_EQ(all.totals.counts.committed, 131u);
    EXPECT_EQ(all.totals.vertices, 131u);
    EXPECT_FALSE(all.totals.min_edge_hit);
  }
  Outlook last = outlook(StopCause::cancelled, no_phase, 0, 0);
  last.is_any_left = last.totals.min_edge_hit = true;
  rows.push_back(last.to_row());
  rows.push_back(outlook(StopCause::max_vertices, no_phase, 0, 0).to_row());
  const Outlook all = Outlook::of_all(rows, 0, before);
  EXPECT_EQ(all.stop, StopCause::cancelled);
  EXPECT_TRUE(all.is_any_left && all.totals.min_edge_hit);
  rows.back().pop_back();
  EXPECT_THROW(Outlook::of_all(rows, 0, before), ResourceError);
}

TEST(RanksUniform, NobodyGathers) {
  for (const int ranks : {2, 4}) {
    const DistributedStatistics solid = expect_same_on_ranks(cube(), uniform_options<3>(0.045), ranks, 1);
    EXPECT_GT(solid.cut_cells, 0u);
    EXPECT_GT(solid.cells_applied, 0u);
    EXPECT_FALSE(solid.gathered);
    const DistributedStatistics planar = expect_same_on_ranks(square_with_hole(), uniform_options<2>(0.0002), ranks, 1);
    EXPECT_GT(planar.cut_cells, 0u);
    EXPECT_GT(planar.cells_applied, 0u);
    EXPECT_FALSE(planar.gathered);
  }
}

class RanksSolid : public testing::TestWithParam<Solid> {};

TEST_P(RanksSolid, SameBytes) {
  RefineOptions<3> options = uniform_options<3>(GetParam().size);
  options.min_dihedral = GetParam().min_dihedral;
  Plc<3> plc = GetParam().plc;
  plc.names.markers[0] = "walls";
  const RefineResult<3> alone = checked_alone<3>(plc, options);
  for (const int ranks : {2, 3, 5}) {
    options.schedule.threads = ranks == 3 ? 2 : 1;
    expect_on_ranks<3>(plc, options, alone, ranks, static_cast<std::uint64_t>(ranks));
  }
}

INSTANTIATE_TEST_SUITE_P(Models, RanksSolid, testing::ValuesIn(solids()), [](const auto& info) { return info.param.name; });

struct Planar {
  std::string name;
  Plc<2> plc;
  double size;
};

std::vector<Planar> planars() {
  return {{"square", square_with_hole(), 0.0002},
          {"square_turned", turned(square_with_hole()), 0.0004},
          {"fan", fan(9, 3, 5), 0.002},
          {"hairy", hairy_polygon(40, 3), 0.001},
          {"graph", random_graph(40, 30, 64, 7), 2}};
}

class RanksPlanar : public testing::TestWithParam<Planar> {};

TEST_P(RanksPlanar, SameBytes) {
  RefineOptions<2> options = uniform_options<2>(GetParam().size);
  const RefineResult<2> alone = checked_alone<2>(GetParam().plc, options);
  for (const int ranks : {2, 3, 5, 7}) {
    options.schedule.threads = ranks == 3 ? 2 : 1;
    expect_on_ranks<2>(GetParam().plc, options, alone, ranks, static_cast<std::uint64_t>(ranks));
  }
}

INSTANTIATE_TEST_SUITE_P(Models, RanksPlanar, testing::ValuesIn(planars()), [](const auto& info) { return info.param.name; });

}  // namespace
}  // namespace pgdr::test
