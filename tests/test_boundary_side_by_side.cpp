// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The recovery and the carving whose loops run as pieces: slot by slot the same mesh, however the pieces run. The inputs have
// thousands of entities, since a loop over fewer is one piece.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <random>
#include <thread>

#include "boundary/labeling.hpp"
#include "boundary/recovery.hpp"
#include "cavity/delaunay.hpp"
#include "model_plcs.hpp"
#include "planar_plcs.hpp"
#include "space/disjoint_sets.hpp"

namespace pgdr::test_boundary_side_by_side {

/// Last piece first.
class Backwards final : public detail::Pieces {
 public:
  void run(std::size_t count, const std::function<void(std::size_t)>& piece) const override {
    most_ = std::max(most_, count);
    for (std::size_t i = count; i-- > 0;) piece(i);
  }
  bool is_parallel() const override { return false; }
  std::size_t most() const { return most_; }  ///< pieces of a loop

 private:
  mutable std::size_t most_ = 0;
};

/// On several threads, each of which takes the next piece.
class OnThreads final : public detail::Pieces {
 public:
  explicit OnThreads(unsigned threads) : threads_(threads) {}
  void run(std::size_t count, const std::function<void(std::size_t)>& piece) const override {
    std::atomic<std::size_t> next = 0;
    std::vector<std::jthread> threads;
    for (unsigned t = 0; t < threads_; ++t)
      threads.emplace_back([&] {
        for (std::size_t i = next++; i < count; i = next++) piece(i);
      });
  }
  bool is_parallel() const override { return true; }

 private:
  unsigned threads_;
};

/// All that there is to know of a mesh.
template <int D>
struct Contents {
  std::vector<std::array<VertexId, D + 1>> cells;
  std::vector<std::array<std::uint32_t, D + 1>> links;
  std::vector<std::uint16_t> regions;
  std::vector<std::array<std::uint32_t, 2 + D + 1 + 6>> constraints;
  std::vector<Point<D>> points;
  std::vector<std::string> warnings;
  RecoveryCounts counts;
};

template <int D>
Contents<D> contents(const Domain<D>& domain, RegionMode mode, const detail::Pieces& pieces) {
  Contents<D> all;
  Mesh<D> mesh(domain.points().size());
  auto pools = mesh.make_pools();
  Delaunay<D> delaunay(mesh, pools);
  EXPECT_TRUE(delaunay.build(domain.points()));
  recover_boundary<D>(mesh, pools, delaunay, domain, {}, std::chrono::steady_clock::now(), all.counts, pieces);
  std::vector<Diagnostic> warnings;
  carve<D>(mesh, pools, delaunay, domain, mode, warnings, pieces);
  for (const Diagnostic& d : warnings) all.warnings.push_back(d.message);
  for (std::uint32_t i = 0; i < mesh.cell_bound(); ++i) {
    const CellId c{i};
    auto& vertices = all.cells.emplace_back();
    if (!mesh.alive(c)) continue;
    vertices = mesh.cell(c).vertices;
    auto& links = all.links.emplace_back();
    for (int f = 0; f <= D; ++f) links[f] = mesh.cell(c).links[f].code;
    all.regions.push_back(mesh.region(c));
    auto& constraints = all.constraints.emplace_back();
    if (const auto* k = mesh.constraints(c)) {
      constraints[0] = k->faces;
      constraints[1] = k->edges;
      for (int f = 0; f <= D; ++f)
        if (k->has_face(f)) constraints[2 + f] = k->face_entity[f];
      if constexpr (D == 3)
        for (int e = 0; e < 6; ++e)
          if (k->has_edge(e)) constraints[6 + e] = k->edge_entity[e];
    }
  }
  // Slots that were freed are used again in the same order.
  for (int i = 0; i < 5000; ++i) all.cells.push_back({VertexId{index(mesh.new_cell(pools))}});
  for (std::uint32_t v = 0; v < mesh.vertex_bound(); ++v) all.points.push_back(mesh.point(VertexId{v}));
  return all;
}

template <int D>
void expect_equal(const Contents<D>& a, const Contents<D>& b, const std::string& what) {
  EXPECT_EQ(a.cells, b.cells) << what;
  EXPECT_EQ(a.links, b.links) << what;
  EXPECT_EQ(a.regions, b.regions) << what;
  EXPECT_EQ(a.constraints, b.constraints) << what;
  EXPECT_TRUE(a.points == b.points) << what;
  EXPECT_EQ(a.warnings, b.warnings) << what;
  EXPECT_EQ(a.counts.rounds, b.counts.rounds) << what;
  EXPECT_EQ(a.counts.segment_points, b.counts.segment_points) << what;
  EXPECT_EQ(a.counts.facet_points, b.counts.facet_points) << what;
}

template <int D>
Contents<D> expect_same_for_all_pieces(const Plc<D>& plc, RegionMode mode, const std::string& what) {
  const Domain<D> domain(plc);
  const Contents<D> one = contents<D>(domain, mode, detail::OneByOne());
  const Backwards backwards;
  expect_equal<D>(one, contents<D>(domain, mode, backwards), what + ", backwards");
  EXPECT_GT(backwards.most(), 8u) << what;
  for (const unsigned threads : {2u, 8u})
    expect_equal<D>(one, contents<D>(domain, mode, OnThreads(threads)), what + ", " + std::to_string(threads) + " threads");
  return one;
}

/// A sphere of 5,120 triangles, flattened, so that much is missing; with a box inside that is a region, and one that is a hole.
Plc<3> flattened_sphere() {
  Plc<3> plc = test::icosphere(4);
  for (Point3& p : plc.points) p = {{p[0], p[1] + 0.1 * p[0], 0.02 * p[2] + 0.1 * p[1] * p[1]}};
  test::add_box(plc, {{-0.02, -0.02, -0.004}}, {{0.02, 0.02, 0.004}}, 7);
  test::add_box(plc, {{0.3, 0.01, -0.004}}, {{0.33, 0.05, 0.004}}, 13);
  plc.regions.push_back({{{0, 0, 0}}, 5, 0});
  plc.holes.push_back({{0.31, 0.03, 0}});
  plc.holes.push_back({{3, 3, 3}});  // outside
  return plc;
}

TEST(SideBySide, RecoveryAndCarvingOfASurface) {
  const Contents<3> all = expect_same_for_all_pieces<3>(flattened_sphere(), RegionMode::seeds, "flattened sphere");
  EXPECT_GT(all.counts.segment_points + all.counts.facet_points, 20u);
  EXPECT_EQ(all.warnings.size(), 1u);
  EXPECT_NE(std::count(all.regions.begin(), all.regions.end(), 1), 0);
  EXPECT_NE(std::count(all.regions.begin(), all.regions.end(), 0), 0);
}

TEST(SideBySide, AutomaticRegionsOfASurface) {
  Plc<3> plc = flattened_sphere();
  plc.regions.clear();
  plc.holes.clear();
  const Contents<3> all = expect_same_for_all_pieces<3>(plc, RegionMode::automatic, "flattened sphere");
  EXPECT_FALSE(all.cells.empty());
}

TEST(SideBySide, SegmentsOfAPlaneGraph) {
  // Rows of segments, nearer to each other than these are long, so that many are no edges at first.
  constexpr std::uint32_t row = 60;
  std::mt19937 random(1);
  Plc<2> plc;
  test::add_square(plc, -10, 70);
  for (std::uint32_t j = 0; j < row; ++j)
    for (std::uint32_t i = 0; i < row; ++i) {
      if (i > 0)
        test::add_segment(plc, static_cast<std::uint32_t>(plc.points.size()) - 1, static_cast<std::uint32_t>(plc.points.size()));
      plc.points.push_back({{i + 0.1 * static_cast<double>(random() % 3), 0.3 * j + 0.01 * static_cast<double>(random() % 10)}});
    }
  expect_same_for_all_pieces<2>(plc, RegionMode::seeds, "plane graph");
}

/// Many threads unite the same numbers in different orders; against a serial union.
TEST(SideBySide, DisjointSetsHangOnTheirLeastNumber) {
  constexpr std::uint32_t count = 20000;
  std::mt19937 random(1);
  const auto below_count = [&] { return static_cast<std::uint32_t>(random() % count); };
  std::vector<std::array<std::uint32_t, 2>> pairs;
  for (std::uint32_t i = 0; i < count; ++i) pairs.push_back({below_count(), below_count()});
  std::erase_if(pairs, [](const auto& p) { return p[0] % 10 != p[1] % 10; });
  ASSERT_GT(pairs.size(), 1000u);
  detail::DisjointSets serial(count);
  for (const auto& [a, b] : pairs) serial.unite(a, b);
  std::vector<std::uint32_t> numbers(count);
  for (std::uint32_t i = 0; i < count; ++i) numbers[i] = i;
  detail::SharedDisjointSets shared(numbers);
  {
    std::vector<std::jthread> threads;
    for (unsigned t = 0; t < 4; ++t)
      threads.emplace_back([&, t] {
        for (std::size_t i = 0; i < pairs.size(); ++i) {
          const auto& [a, b] = pairs[(t % 2 == 0 ? i : pairs.size() - 1 - i)];
          shared.unite(a, b);
        }
      });
  }
  for (std::uint32_t i = 0; i < count; ++i) ASSERT_EQ(shared.find(i), serial.find(i)) << i;
}

}  // namespace pgdr::test_boundary_side_by_side
