// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Which edges and triangles are in a mesh, after every few insertions, against all of its cells. (A sphere of 222 meridians took
// 544 rounds of recovery, each of which looked at all 150,000 segments and all cells: five seconds of six.)
#include <gtest/gtest.h>

#include <deque>
#include <random>
#include <set>

#include "boundary/present_simplices.hpp"
#include "cavity/delaunay.hpp"
#include "space/make_set.hpp"

namespace pgdr::test_boundary_present_simplices {

template <std::size_t K>
struct Wanted {
  std::array<VertexId, K> vertices;
  EntityId owner;
  CellId seen = detail::never_asked;
};

/// The edges, or the triangles, of all cells; ghosts included.
template <std::size_t K>
std::set<std::array<VertexId, K>> all_of(const Mesh<3>& mesh) {
  std::set<std::array<VertexId, K>> all;
  for (std::uint32_t i = 0; i < mesh.cell_bound(); ++i) {
    if (!mesh.alive(CellId{i})) continue;
    const auto& v = mesh.cell(CellId{i}).vertices;
    for (unsigned chosen = 0; chosen < 16; ++chosen) {
      std::vector<VertexId> some;
      for (unsigned k = 0; k < 4; ++k)
        if (chosen >> k & 1) some.push_back(v[k]);
      if (some.size() != K) continue;
      std::sort(some.begin(), some.end());
      std::array<VertexId, K> simplex;
      std::copy(some.begin(), some.end(), simplex.begin());
      all.insert(simplex);
    }
  }
  return all;
}

Point3 random_point(std::mt19937& random) {
  Point3 p;
  for (double& x : p.x) x = 0x1p-32 * static_cast<double>(random());
  return p;
}

template <std::size_t K>
void expect_as_all_cells_say(std::uint32_t seed) {
  std::mt19937 random(seed);
  Mesh<3> mesh;
  auto pools = mesh.make_pools();
  Delaunay<3> delaunay(mesh, pools);
  std::vector<Point3> points;
  for (int i = 0; i < 60; ++i) points.push_back(random_point(random));
  ASSERT_TRUE(delaunay.build(points));
  std::vector<VertexId> vertices = delaunay.vertices();
  detail::PresentSimplices<K> present(mesh);
  delaunay.tell_changes(present.changed());

  std::deque<Wanted<K>> wanted;  // which stay where they are
  std::vector<EntityId> look_again;
  const auto want = [&](EntityId owner) {
    Wanted<K> w{.vertices = {}, .owner = owner};
    const CellId c = delaunay.cell_at(vertices[random() % vertices.size()]);
    const unsigned first = random() % 4;
    for (unsigned k = 0; k < K; ++k) w.vertices[k] = mesh.cell(c).vertices[(first + k) % 4];
    if (random() % 2) w.vertices[0] = vertices[random() % vertices.size()];
    std::sort(w.vertices.begin(), w.vertices.end());
    if (w.vertices[K - 1] == infinite_vertex || std::adjacent_find(w.vertices.begin(), w.vertices.end()) != w.vertices.end())
      return;
    wanted.push_back(w);
    look_again.push_back(owner);
  };
  for (EntityId owner = 0; owner < 200; ++owner)
    for (int i = 0; i < 4; ++i) want(owner);
  std::size_t there = 0, lost = 0;
  for (int look = 0; look < 60; ++look) {
    std::vector<EntityId> due = present.take_due();
    due.insert(due.end(), look_again.begin(), look_again.end());
    detail::make_set(due);
    const auto ask_for = [&](EntityId owner, const auto& ask) {
      for (auto& w : wanted)
        if (w.owner == owner) ask(w.vertices, w.seen);
    };
    present.look(due, ask_for, detail::Bulk(false));
    look_again.clear();
    const auto all = all_of<K>(mesh);
    for (const auto& w : wanted) {
      const bool is_there = all.contains(w.vertices);
      ASSERT_EQ(w.seen != detail::not_seen, is_there) << look;
      if (is_there)
        ASSERT_TRUE(detail::has_corners(mesh, w.seen, w.vertices)) << look;
      else
        look_again.push_back(w.owner);
      there += is_there;
      lost += !is_there;
    }
    for (int i = 0; i < 5; ++i)
      vertices.push_back(delaunay.insert(random_point(random), Home(EntityKind::volume, no_entity), vertices[0]));
    for (int i = 0; i < 10; ++i) want(random() % 200);
  }
  EXPECT_GT(there, 100u);
  EXPECT_GT(lost, 100u);
}

TEST(PresentSimplices, EdgesAsAllCellsSay) {
  for (std::uint32_t seed = 0; seed < 4; ++seed) expect_as_all_cells_say<2>(seed);
}

TEST(PresentSimplices, TrianglesAsAllCellsSay) {
  for (std::uint32_t seed = 0; seed < 4; ++seed) expect_as_all_cells_say<3>(seed);
}

}  // namespace pgdr::test_boundary_present_simplices
