// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The uniform schedule on ranks makes the mesh that it makes in one process, byte for byte, whatever the number of ranks and
// threads and the order in which messages come.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "local_ranks.hpp"
#include "model_plcs.hpp"
#include "pgdr/ranks.hpp"
#include "planar_plcs.hpp"
#include "same_bytes.hpp"

namespace pgdr::test {
namespace {

template <int D>
RefineOptions<D> uniform(double size, int threads = 1) {
  RefineOptions<D> options;
  options.size = size;
  options.schedule.schedule = Schedule::uniform;
  options.schedule.threads = threads;
  options.schedule.floor = 60;  // small windows, so that small meshes are cut
  if constexpr (D == 3) options.min_dihedral = 0;
  return options;
}

template <int D>
void expect_same(const OutputMesh<D>& a, const OutputMesh<D>& b, const std::string& what) {
  EXPECT_TRUE(same_bytes(a.points, b.points)) << what;
  EXPECT_TRUE(same_bytes(a.cells, b.cells)) << what;
  EXPECT_TRUE(same_bytes(a.regions, b.regions)) << what;
  EXPECT_TRUE(same_bytes(a.point_markers, b.point_markers)) << what;
  EXPECT_TRUE(same_bytes(a.subfacets, b.subfacets)) << what;
  EXPECT_TRUE(same_bytes(a.subsegments, b.subsegments)) << what;
}

/// Does the run on ranks make the mesh of one process? @returns how the ranks shared it
template <int D>
DistributedStatistics expect_same_on_ranks(const Plc<D>& plc, const RefineOptions<D>& options, int ranks, std::uint64_t seed) {
  const RefineResult<D> whole = refine(plc, options);
  std::vector<DistributedResult<D>> results(static_cast<std::size_t>(ranks));
  run_on_local_ranks(ranks, seed, [&](Transport& transport) {
    results[static_cast<std::size_t>(transport.rank())] = refine(transport, plc, options);
  });
  std::vector<MeshPiece<D>> pieces;
  for (auto& r : results) pieces.push_back(std::move(r.piece));
  expect_same(join_pieces<D>(pieces), whole.mesh, std::to_string(ranks) + " ranks, seed " + std::to_string(seed));
  // Its phases, too: what is refused for good or set aside is the same.
  EXPECT_EQ(results.front().run.scheduler.generations, whole.scheduler.generations);
  for (const auto& r : results) EXPECT_EQ(r.run.poor_left, whole.poor_left);
  return results.front().distributed;
}

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
TEST(RanksUniform, NobodyGathers) {
  for (const int ranks : {2, 4}) {
    const DistributedStatistics solid = expect_same_on_ranks(cube(), uniform<3>(0.045), ranks, 1);
    EXPECT_GT(solid.cut_cells, 0u);
    EXPECT_GT(solid.cells_applied, 0u);
    EXPECT_FALSE(solid.gathered);
    const DistributedStatistics planar = expect_same_on_ranks(square_with_hole(), uniform<2>(0.0002), ranks, 1);
    EXPECT_GT(planar.cut_cells, 0u);
    EXPECT_GT(planar.cells_applied, 0u);
    EXPECT_FALSE(planar.gathered);
  }
}

class RanksSolid : public testing::TestWithParam<Solid> {};

TEST_P(RanksSolid, SameBytes) {
  RefineOptions<3> options = uniform<3>(GetParam().size);
  options.min_dihedral = GetParam().min_dihedral;
  for (const int ranks : {2, 3, 5}) {
    options.schedule.threads = ranks == 3 ? 2 : 1;
    expect_same_on_ranks(GetParam().plc, options, ranks, static_cast<std::uint64_t>(ranks));
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
  RefineOptions<2> options = uniform<2>(GetParam().size);
  for (const int ranks : {2, 3, 5, 7}) {
    options.schedule.threads = ranks == 3 ? 2 : 1;
    expect_same_on_ranks(GetParam().plc, options, ranks, static_cast<std::uint64_t>(ranks));
  }
}

INSTANTIATE_TEST_SUITE_P(Models, RanksPlanar, testing::ValuesIn(planars()), [](const auto& info) { return info.param.name; });

}  // namespace
}  // namespace pgdr::test
