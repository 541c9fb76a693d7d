// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The Delaunay triangulation against its definition, and for independence of the order of insertion.
#include <gtest/gtest.h>

#include <set>

#include "cavity/delaunay.hpp"
#include "dimensions.hpp"
#include "point_sets.hpp"

namespace pgdr::test_cavity_delaunay {

constexpr std::uint64_t seed = 20261121;

template <class>
class DelaunayTest : public ::testing::Test {};
TYPED_TEST_SUITE(DelaunayTest, test::Dimensions);

/// Cells as sorted corner coordinates: comparable between meshes.
template <int D>
std::set<std::vector<std::array<double, D>>> cell_set(const Mesh<D>& mesh) {
  std::set<std::vector<std::array<double, D>>> cells;
  for (std::uint32_t i = 0; i < mesh.cell_bound(); ++i) {
    if (!mesh.alive(CellId{i}) || mesh.is_ghost(CellId{i})) continue;
    std::vector<std::array<double, D>> cell;
    for (const auto& p : mesh.simplex(CellId{i})) cell.push_back(p.x);
    std::sort(cell.begin(), cell.end());
    cells.insert(cell);
  }
  return cells;
}

template <int D>
void expect_links_sound(const Mesh<D>& mesh) {
  for (std::uint32_t i = 0; i < mesh.cell_bound(); ++i) {
    const CellId c{i};
    if (!mesh.alive(c)) continue;
    ASSERT_FALSE(mesh.marked(c));
    for (int f = 0; f <= D; ++f) {
      const Link link = mesh.cell(c).links[f];
      ASSERT_TRUE(link);
      ASSERT_TRUE(mesh.alive(link.cell()));
      ASSERT_EQ(mesh.cell(link.cell()).links[link.face()], Link(c, f));
      std::set<VertexId> mine(mesh.cell(c).vertices.begin(), mesh.cell(c).vertices.end());
      std::set<VertexId> other(mesh.cell(link.cell()).vertices.begin(), mesh.cell(link.cell()).vertices.end());
      mine.erase(mesh.cell(c).vertices[f]);
      other.erase(mesh.cell(link.cell()).vertices[link.face()]);
      ASSERT_EQ(mine, other);
    }
  }
}

TYPED_TEST(DelaunayTest, MeetsItsDefinition) {
  constexpr int D = TypeParam::value;
  for (const auto& set : test::point_sets<D>(seed)) {
    SCOPED_TRACE(set.name);
    Mesh<D> mesh;
    auto pools = mesh.make_pools();
    Delaunay<D> delaunay(mesh, pools);
    ASSERT_TRUE(delaunay.build(set.points));
    expect_links_sound<D>(mesh);
    std::set<VertexId> seen;
    for (std::uint32_t i = 0; i < mesh.cell_bound(); ++i) {
      const CellId c{i};
      if (!mesh.alive(c)) continue;
      const auto& v = mesh.cell(c).vertices;
      if (mesh.is_ghost(c)) {
        // Nothing lies beyond a hull face.
        for (const auto& p : set.points) {
          Simplex<D> s;
          for (int j = 0; j <= D; ++j) s[j] = v[j] == infinite_vertex ? p : mesh.point(v[j]);
          ASSERT_NE(orient<D>(s), Sign::positive);
        }
        continue;
      }
      seen.insert(v.begin(), v.end());
      const Simplex<D> s = mesh.simplex(c);
      ASSERT_EQ(orient<D>(s), Sign::positive);
      for (const auto& p : set.points)
        if (std::find(s.begin(), s.end(), p) == s.end()) {
          ASSERT_EQ(in_sphere_perturbed<D>(s, p), Sign::negative);
        }
    }
    EXPECT_EQ(seen.size(), set.points.size());
    for (std::size_t i = 0; i < set.points.size(); ++i) ASSERT_EQ(mesh.point(delaunay.vertices()[i]), set.points[i]);
  }
}

TYPED_TEST(DelaunayTest, DoesNotDependOnTheOrder) {
  constexpr int D = TypeParam::value;
  std::mt19937_64 random(seed);
  for (auto set : test::point_sets<D>(seed + 1)) {
    SCOPED_TRACE(set.name);
    Mesh<D> first;
    auto pools = first.make_pools();
    ASSERT_TRUE(Delaunay<D>(first, pools).build(set.points));
    for (int again = 0; again < 3; ++again) {
      // One simplex by build, the rest by single insertions in a random order.
      std::shuffle(set.points.begin(), set.points.end(), random);
      Mesh<D> second;
      auto pools2 = second.make_pools();
      Delaunay<D> delaunay(second, pools2);
      std::size_t n = D + 1;
      while (true) {
        Mesh<D> trial;
        auto trial_pools = trial.make_pools();
        if (Delaunay<D>(trial, trial_pools).build(std::span(set.points).first(n))) break;
        ++n;
      }
      ASSERT_TRUE(delaunay.build(std::span(set.points).first(n)));
      for (std::size_t i = n; i < set.points.size(); ++i)
        delaunay.insert(set.points[i], Home(EntityKind::volume, 0), delaunay.vertices()[0]);
      EXPECT_EQ(cell_set<D>(first), cell_set<D>(second));
    }
  }
}

TYPED_TEST(DelaunayTest, FlatSetsHaveNoCells) {
  constexpr int D = TypeParam::value;
  std::vector<Point<D>> points;
  for (int i = 0; i < 25; ++i) {
    Point<D> p{};
    p[0] = i % 5;
    p[1] = D == 3 ? i / 5 : 2 * (i % 5);
    if (D == 3 || i < 5) points.push_back(p);
  }
  Mesh<D> mesh;
  auto pools = mesh.make_pools();
  EXPECT_FALSE(Delaunay<D>(mesh, pools).build(points));
  EXPECT_FALSE(Delaunay<D>(mesh, pools).build(std::span(points).first(2)));
  EXPECT_FALSE(Delaunay<D>(mesh, pools).build({}));
}

TYPED_TEST(DelaunayTest, ExistingPointIsFoundAgain) {
  constexpr int D = TypeParam::value;
  const auto set = test::point_sets<D>(seed)[1];
  Mesh<D> mesh;
  auto pools = mesh.make_pools();
  Delaunay<D> delaunay(mesh, pools);
  ASSERT_TRUE(delaunay.build(set.points));
  const auto before = cell_set<D>(mesh);
  EXPECT_EQ(delaunay.insert(set.points[7], Home(EntityKind::volume, 0), delaunay.vertices()[0]), delaunay.vertices()[7]);
  EXPECT_EQ(cell_set<D>(mesh), before);
}

}  // namespace pgdr::test_cavity_delaunay
