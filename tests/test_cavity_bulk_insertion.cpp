// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Points triangulated side by side: the same mesh, slot by slot, whatever runs at once, and the cells that single insertions
// make.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <stop_token>

#include "allow_threads.hpp"
#include "cavity/delaunay.hpp"
#include "pgdr/refine_options.hpp"
#include "point_sets.hpp"
#include "visits/run_pieces.hpp"

namespace pgdr::test_cavity_bulk_insertion {

constexpr std::uint64_t seed = 20261126;

/// Point sets so large that most of their points go in side by side.
template <int D>
std::vector<test::PointSet<D>> large_point_sets(int count) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> unit(0, 1);
  std::normal_distribution<double> normal;
  std::vector<test::PointSet<D>> sets{
      {"random", {}}, {"grid", {}}, {"wavy sphere in a box", {}}, {"cospherical", {}}, {"in line", {}}};
  const int side = static_cast<int>(std::pow(count, 1.0 / D));
  for (int i = 0; i < count; ++i) {
    Point<D> p, on_grid, on_sphere, in_line{};
    double norm2 = 0;
    for (int a = 0, k = i; a < D; ++a, k /= side) {
      p[a] = unit(random);
      on_grid[a] = k % side;
      on_sphere[a] = normal(random);
      norm2 += on_sphere[a] * on_sphere[a];
    }
    in_line[0] = i;
    const double wave = 1 + 0.1 * std::sin(7 * on_sphere[0] / std::sqrt(norm2));
    Point<D> wavy;
    for (int a = 0; a < D; ++a) {
      on_sphere[a] /= std::sqrt(norm2);
      wavy[a] = on_sphere[a] * wave;
    }
    sets[0].points.push_back(p);
    sets[1].points.push_back(on_grid);
    sets[2].points.push_back(wavy);
    sets[3].points.push_back(on_sphere);
    sets[4].points.push_back(in_line);
  }
  for (int corner = 0; corner < 1 << D; ++corner) {
    Point<D> p;
    for (int a = 0; a < D; ++a) p[a] = corner >> a & 1 ? 9 : -9;
    sets[2].points.push_back(p);
  }
  for (int a = 1; a < D; ++a) {
    Point<D> off{};
    off[a] = 1;
    sets[4].points.push_back(off);
  }
  for (auto& set : sets) test::make_distinct<D>(set.points, random);
  return sets;
}

/// What is in every slot, and what is known of every vertex.
template <int D>
std::vector<std::uint32_t> contents(const Mesh<D>& mesh, const Delaunay<D>& delaunay) {
  std::vector<std::uint32_t> all;
  for (std::uint32_t i = 0; i < mesh.cell_bound(); ++i) {
    if (!mesh.alive(CellId{i})) continue;
    all.push_back(i);
    for (const VertexId v : mesh.cell(CellId{i}).vertices) all.push_back(index(v));
    for (const Link link : mesh.cell(CellId{i}).links) all.push_back(link.code);
  }
  for (const VertexId v : delaunay.vertices()) {
    all.push_back(index(v));
    all.push_back(index(delaunay.cell_at(v)));
  }
  return all;
}

/// The cells but for ghosts, each with its vertices in order.
template <int D>
std::vector<std::array<Point<D>, D + 1>> cells(const Mesh<D>& mesh) {
  std::vector<std::array<Point<D>, D + 1>> all;
  for (std::uint32_t i = 0; i < mesh.cell_bound(); ++i) {
    if (!mesh.alive(CellId{i}) || mesh.is_ghost(CellId{i})) continue;
    auto simplex = mesh.simplex(CellId{i});
    std::sort(simplex.begin(), simplex.end(), lex_less<D>);
    all.push_back(simplex);
  }
  std::sort(all.begin(), all.end(), [](const auto& a, const auto& b) {
    return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end(), lex_less<D>);
  });
  return all;
}

template <int D>
void expect_links_and_hints(const Mesh<D>& mesh, const Delaunay<D>& delaunay) {
  for (std::uint32_t i = 0; i < mesh.cell_bound(); ++i) {
    if (!mesh.alive(CellId{i})) continue;
    ASSERT_FALSE(mesh.marked(CellId{i}));
    for (int f = 0; f <= D; ++f) {
      const Link link = mesh.cell(CellId{i}).links[f];
      ASSERT_TRUE(link && mesh.alive(link.cell()));
      ASSERT_EQ(mesh.cell(link.cell()).links[link.face()], Link(CellId{i}, f));
    }
  }
  for (const VertexId v : delaunay.vertices()) {
    const auto& corners = mesh.cell(delaunay.cell_at(v)).vertices;
    ASSERT_NE(std::find(corners.begin(), corners.end(), v), corners.end());
  }
}

template <int D>
void expect_the_same_everywhere(int count) {
  for (const auto& set : large_point_sets<D>(count)) {
    SCOPED_TRACE(set.name);
    Mesh<D> mesh;
    auto pools = mesh.make_pools();
    Delaunay<D> delaunay(mesh, pools);
    ASSERT_TRUE(delaunay.build(set.points));
    expect_links_and_hints<D>(mesh, delaunay);
    const auto first = contents<D>(mesh, delaunay);
    for (const Executor executor : {Executor::serial, Executor::shuffled, Executor::threads, Executor::flow_graph})
      for (const int threads : {1, 2, 8}) {
        if (executor == Executor::flow_graph && !PGDR_TEST_TBB) continue;  // it reports what it does not see inside oneTBB
        ScheduleOptions options;
        options.executor = executor;
        options.threads = threads;
        detail::RunClock clock(detail::RunClock::Clock::now());
        Mesh<D> again;
        auto its_pools = again.make_pools();
        Delaunay<D> its_delaunay(again, its_pools);
        ASSERT_TRUE(its_delaunay.build(set.points, detail::RunPieces(options, clock)));
        ASSERT_EQ(first, contents<D>(again, its_delaunay)) << static_cast<int>(executor) << ' ' << threads;
      }
  }
}

TEST(ParallelTriangulation, IsTheSameForAllThreads2D) { expect_the_same_everywhere<2>(6000); }
TEST(ParallelTriangulation, IsTheSameForAllThreads3D) { expect_the_same_everywhere<3>(6000); }

template <int D>
void expect_what_single_insertions_make(int count) {
  for (const auto& set : large_point_sets<D>(count)) {
    SCOPED_TRACE(set.name);
    Mesh<D> mesh, other;
    auto pools = mesh.make_pools(), its_pools = other.make_pools();
    Delaunay<D> delaunay(mesh, pools), its_delaunay(other, its_pools);
    ASSERT_TRUE(delaunay.build(set.points));
    std::size_t first = set.points.size() / 8;  // few enough to go in one after the other
    while (!its_delaunay.build(std::span(set.points).first(first))) first = set.points.size();
    for (std::size_t i = first; i < set.points.size(); ++i)
      its_delaunay.insert(set.points[i], Home(EntityKind::volume, 0), its_delaunay.vertices()[0]);
    EXPECT_EQ(cells<D>(mesh), cells<D>(other));
  }
}

TEST(BulkInsertion, MakesTheCellsOfSingleInsertions2D) { expect_what_single_insertions_make<2>(5000); }
TEST(BulkInsertion, MakesTheCellsOfSingleInsertions3D) { expect_what_single_insertions_make<3>(5000); }

TEST(BulkInsertion, PointsThatCoincideAreAnError) {
  auto points = large_point_sets<3>(6000)[0].points;
  points.push_back(points[17]);
  Mesh<3> mesh;
  auto pools = mesh.make_pools();
  Delaunay<3> delaunay(mesh, pools);
  EXPECT_THROW(delaunay.build(points), ResourceError);
}

/// Requests a stop in a piece.
class StoppingPieces final : public detail::Pieces {
 public:
  explicit StoppingPieces(std::size_t last) : last_(last) {}
  void run(std::size_t count, const std::function<void(std::size_t)>& piece) const override {
    for (std::size_t i = 0; i < count; ++i) {
      if (++ran_ == last_) stop_.request_stop();
      piece(i);
    }
  }
  bool is_parallel() const override { return false; }
  std::stop_token token() const { return stop_.get_token(); }
  std::size_t ran() const { return ran_; }

 private:
  std::size_t last_;
  mutable std::size_t ran_ = 0;
  mutable std::stop_source stop_;
};

/// Wherever it is stopped, there is a triangulation of some of the points, and it ends well.
TEST(BulkInsertion, EndsEarlyOnceItIsStopped) {
  const auto points = large_point_sets<3>(6000)[0].points;
  Mesh<3> whole;
  auto whole_pools = whole.make_pools();
  const StoppingPieces never(std::numeric_limits<std::size_t>::max());
  ASSERT_TRUE(Delaunay<3>(whole, whole_pools).build(points, never));
  ASSERT_GT(never.ran(), 100u) << "points go in side by side";
  for (const std::size_t last : {std::size_t{1}, never.ran() / 4, never.ran() / 2, never.ran() - 1}) {
    const StoppingPieces pieces(last);
    Mesh<3> mesh;
    auto pools = mesh.make_pools();
    Delaunay<3> delaunay(mesh, pools);
    EXPECT_TRUE(delaunay.build(points, pieces, pieces.token()));
    std::size_t cells = 0, all = 0;
    for (std::uint32_t i = 0; i < mesh.cell_bound(); ++i) cells += mesh.alive(CellId{i});
    for (std::uint32_t i = 0; i < whole.cell_bound(); ++i) all += whole.alive(CellId{i});
    EXPECT_LT(cells, all) << "stopped in piece " << last << " of " << never.ran();
  }
}

/// A few points, however many are left for the last round.
template <int D>
void expect_all_of_few() {
  std::mt19937_64 random(D);
  for (int count = D + 1; count < 40; ++count) {
    std::vector<Point<D>> points(static_cast<std::size_t>(count));
    for (Point<D>& p : points)
      for (int i = 0; i < D; ++i) p[i] = std::ldexp(static_cast<double>(random() >> 11), -53);
    Mesh<D> mesh;
    auto pools = mesh.make_pools();
    Delaunay<D> delaunay(mesh, pools);
    ASSERT_TRUE(delaunay.build(points));
    for (const VertexId v : delaunay.vertices()) EXPECT_NE(delaunay.cell_at(v), no_cell) << count;
  }
}

TEST(BulkInsertion, AllOfFewPointsGoIn) {
  expect_all_of_few<2>();
  expect_all_of_few<3>();
}

}  // namespace pgdr::test_cavity_bulk_insertion
