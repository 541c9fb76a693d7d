// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// What ranks hold of a mesh beside brute force, in small random cases: who holds a point, by the boxes of all nodes; which cells
// stay at the cut, and what their links are; the mesh that one rank puts together in the end; the table that finds them.
#include <gtest/gtest.h>

#include <limits>
#include <map>
#include <set>

#include "cut_meshes.hpp"
#include "dimensions.hpp"
#include "ranks/id_table.hpp"

namespace pgdr::test::test_ranks_held {

using detail::CellWriter;
using detail::HeldMesh;
using detail::IdTable;
using detail::SentPoints;
using detail::Territory;

/// The ranks that have a node of the cut's level whose box, grown by half its side and without end at the root's border, holds p.
template <int D>
std::set<int> holders(const OwnedTree<D>& owned, const Point<D>& p) {
  const Orthtree<D>& tree = owned.tree;
  const auto root = tree.box(Orthtree<D>::root);
  std::set<int> ranks;
  for (std::size_t n = 0; n < owned.nodes.size(); ++n) {
    const auto box = tree.box(owned.nodes[n]);
    const double half = tree.side(owned.nodes[n]) / 2;
    bool is_in = true;
    for (int i = 0; i < D; ++i) {
      const double inside = std::clamp(p[i], root.low[i], std::nextafter(root.high[i], root.low[i]));
      is_in = is_in && inside >= box.low[i] - half && inside < box.high[i] + half;
    }
    if (is_in) ranks.insert(owned.owners[n]);
  }
  return ranks;
}

/// Anywhere, also far beyond the root; half of them on borders of halves of nodes.
template <int D>
Point<D> any_point(const OwnedTree<D>& owned, std::mt19937_64& random) {
  const auto root = owned.tree.box(Orthtree<D>::root);
  const std::uint64_t steps = std::uint64_t{2} << owned.tree.level(owned.nodes[0]);
  Point<D> p;
  for (int i = 0; i < D; ++i) {
    const double side = root.high[i] - root.low[i];
    p[i] = root.low[i] + side * (std::uniform_real_distribution<double>(-0.2, 1.2)(random));
    if (random() % 2 == 0) p[i] = owned.tree.border(i, random() % (steps + 1) * (owned.tree.extent(Orthtree<D>::root) / steps));
    if (random() % 50 == 0) p[i] = random() % 2 ? 1e300 : -1e300;
  }
  return p;
}

template <class D>
class Held : public testing::Test {};
TYPED_TEST_SUITE(Held, Dimensions);

TYPED_TEST(Held, WhoHoldsAPointIsSaidByTheBoxesOfNodes) {
  constexpr int D = TypeParam::value;
  std::mt19937_64 random(5);
  for (const int level : {1, 2, 3})
    for (const int ranks : {1, 2, 3, 7}) {
      const OwnedTree<D> owned(level, ranks, random());
      const int rank = static_cast<int>(random() % static_cast<unsigned>(ranks));
      const Territory<D> territory = owned.territory(rank);
      EXPECT_EQ(territory.level(), level);
      std::set<int> neighbours;
      for (int time = 0; time < 300; ++time) {
        const Point<D> p = any_point(owned, random);
        const std::set<int> expected = holders(owned, p);
        const auto zone = territory.zone(p);
        const auto found = territory.holders(zone);
        ASSERT_EQ(std::vector<int>(found.begin(), found.end()), std::vector<int>(expected.begin(), expected.end()));
        EXPECT_EQ(territory.holds(zone), expected.count(rank) == 1);
        for (int r = 0; r < ranks; ++r) EXPECT_EQ(territory.holds(zone, r), expected.count(r) == 1);
        EXPECT_EQ(territory.is_shared(zone), expected.size() > expected.count(rank));
        const auto node = std::find(owned.nodes.begin(), owned.nodes.end(), owned.tree.leaf_at(p)) - owned.nodes.begin();
        EXPECT_EQ(territory.owner(zone), owned.owners[static_cast<std::size_t>(node)]);
        if (expected.count(rank)) neighbours.insert(expected.begin(), expected.end());
      }
      neighbours.erase(rank);
      for (const int r : neighbours)
        EXPECT_TRUE(std::binary_search(territory.neighbours().begin(), territory.neighbours().end(), r)) << r;
      for (const int r : territory.neighbours()) {  // as it is of theirs
        const std::vector<int> theirs = owned.territory(r).neighbours();
        EXPECT_TRUE(std::binary_search(theirs.begin(), theirs.end(), rank)) << r;
      }
    }
}

TYPED_TEST(Held, NodesAndBoxesBelongToWhoHoldsTheirPoints) {
  constexpr int D = TypeParam::value;
  std::mt19937_64 random(6);
  for (int time = 0; time < 20; ++time) {
    OwnedTree<D> owned(2, 3, random());
    const Territory<D> territory = owned.territory(1);
    const std::vector<double> weights(owned.nodes.size(), 1.0);
    const std::vector<double> held = territory.held_of(owned.nodes, weights);
    std::vector<double> expected(3);
    const double half = owned.tree.side(owned.nodes[0]) / 2;
    for (const auto node : owned.nodes) {
      bool is_shared = false;
      for (unsigned corner = 0; corner < 1u << D; ++corner) {
        Point<D> p = owned.tree.centre(node);  // of a half, along each axis
        for (int i = 0; i < D; ++i) p[i] += (corner >> i & 1 ? 0.5 : -0.5) * half;
        const std::set<int> ranks = holders(owned, p);
        for (const int r : ranks) expected[static_cast<std::size_t>(r)] += 1.0 / (1u << D);
        is_shared = is_shared || ranks.size() > ranks.count(1);
      }
      EXPECT_EQ(territory.is_shared(GridBox<D>::grown(owned.tree, node, 0)), is_shared);
    }
    EXPECT_EQ(held, expected);
    const auto parent = owned.nodes[random() % owned.nodes.size()];
    const auto first = owned.tree.split(parent);
    for (int k = 0; k < Orthtree<D>::children; ++k)
      EXPECT_EQ(territory.owner(first + static_cast<unsigned>(k)), territory.owner(parent));
    EXPECT_EQ(territory.owner(owned.tree.parent(parent)), -1);
  }
}

/// The cells beyond the faces of each cell, as Link says them: by points, in the order of the cell's vertices.
template <int D>
using Neighbours = std::map<SentPoints<D>, std::array<SentPoints<D>, D + 1>>;
constexpr double hull = 1e9, missing = 2e9;  // the first coordinate of what is no cell

template <int D>
Neighbours<D> neighbours_of(const Mesh<D>& mesh) {
  Neighbours<D> all;
  for (const CellId c : cells_of(mesh)) {
    auto& beyond = all[detail::points_of(mesh, c)];
    for (std::size_t f = 0; f <= D; ++f) {
      const Link link = mesh.cell(c).links[f];
      beyond[f] = {};
      if (link)
        beyond[f] = detail::points_of(mesh, link.cell());
      else
        beyond[f][0][0] = link == Link::not_held() ? missing : hull;
    }
  }
  return all;
}

/// The cells of `all` with a vertex that the rank holds, and their neighbours among these.
template <int D>
Neighbours<D> held_of(const OwnedTree<D>& owned, int rank, const Neighbours<D>& all) {
  Neighbours<D> held = all;
  const auto is_held = [&](const SentPoints<D>& points) {
    return std::any_of(points.begin(), points.end(), [&](const auto& p) { return holders(owned, Point<D>{p}).count(rank) > 0; });
  };
  std::erase_if(held, [&](const auto& cell) { return !is_held(cell.first); });
  for (auto& [cell, beyond] : held)
    for (auto& other : beyond)
      if (other[0][0] != hull && !is_held(other)) {
        other = {};
        other[0][0] = missing;
      }
  return held;
}

/// Do others hold all of these points?
template <int D>
bool is_named(const OwnedTree<D>& owned, int rank, const SentPoints<D>& points) {
  return std::all_of(points.begin(), points.end(), [&](const auto& p) {
    const std::set<int> ranks = holders(owned, Point<D>{p});
    return ranks.size() > ranks.count(rank);
  });
}

template <int D>
struct Shape {
  int level, ranks, pairs;
  std::uint64_t seed;
};
template <int D>
std::vector<Shape<D>> shapes() {
  std::vector<Shape<D>> all;
  for (const std::uint64_t seed : {1, 2, 3, 4})
    for (const int ranks : {2, 3, 5}) all.push_back({seed % 2 ? 2 : 3, ranks, D == 2 ? 200 : 150, seed});
  return all;
}

TYPED_TEST(Held, TheCutLeavesTheCellsWithAVertexThatTheRankHolds) {
  constexpr int D = TypeParam::value;
  for (const Shape<D>& shape : shapes<D>()) {
    const OwnedTree<D> owned(shape.level, shape.ranks, shape.seed);
    const WholeMesh<D> whole(shape.pairs, shape.seed);
    const Neighbours<D> all = neighbours_of(whole.mesh);
    std::map<SentPoints<D>, int> owners;
    for (int rank = 0; rank < shape.ranks; ++rank) {
      const CutMesh<D> cut(owned, rank, shape.pairs, shape.seed);
      EXPECT_TRUE(neighbours_of(cut.part.mesh) == held_of<D>(owned, rank, all));
      for (const CellId c : cells_of(cut.part.mesh)) {
        const SentPoints<D> points = detail::points_of(cut.part.mesh, c);
        if (cut.held.is_own(c)) owners[points] += 1;
        const CellId found = cut.held.find(points);
        EXPECT_TRUE(found == c || (found == no_cell && !is_named<D>(owned, rank, points)));
      }
    }
    EXPECT_EQ(owners.size(), all.size());
    EXPECT_TRUE(std::all_of(owners.begin(), owners.end(), [](const auto& o) { return o.second == 1; }));
  }
}

/// Once the nodes have been split claims reach half as far: each rank drops what it does not hold any more.
TYPED_TEST(Held, AHalvedLatticeLeavesTheCellsThatTheRankStillHolds) {
  constexpr int D = TypeParam::value;
  for (const Shape<D>& shape : shapes<D>()) {
    if (shape.level > 2) continue;  // brute force looks at all nodes
    const OwnedTree<D> owned(shape.level, shape.ranks, shape.seed);
    const Neighbours<D> all = neighbours_of(WholeMesh<D>(shape.pairs, shape.seed).mesh);
    for (int rank = 0; rank < shape.ranks; ++rank) {
      CutMesh<D> cut(owned, rank, shape.pairs, shape.seed);
      const std::size_t before = cells_of(cut.part.mesh).size();
      const OwnedTree<D> finer = owned.halved();
      const Territory<D> next = Territory<D>(finer.tree, owned.nodes, owned.owners, shape.ranks, rank).of_next_level();
      EXPECT_EQ(next.level(), cut.territory.level() + 1);
      cut.held.shrink(next);
      EXPECT_TRUE(neighbours_of(cut.part.mesh) == held_of<D>(finer, rank, all));
      EXPECT_LE(cells_of(cut.part.mesh).size(), before);
      for (const CellId c : cells_of(cut.part.mesh)) {
        const SentPoints<D> points = detail::points_of(cut.part.mesh, c);
        if (is_named<D>(finer, rank, points)) {
          EXPECT_EQ(cut.held.find(points), c);
        }
      }
    }
  }
}

TYPED_TEST(Held, TheFirstRankPutsTheWholeMeshTogether) {
  constexpr int D = TypeParam::value;
  for (const Shape<D>& shape : shapes<D>()) {
    const OwnedTree<D> owned(shape.level, shape.ranks, shape.seed);
    const WholeMesh<D> whole(shape.pairs, shape.seed);
    CutMesh<D> first(owned, 0, shape.pairs, shape.seed);
    const std::size_t before = cells_of(first.part.mesh).size();
    for (int rank = 1; rank < shape.ranks; ++rank) {
      detail::MessageWriter message;
      CutMesh<D>(owned, rank, shape.pairs, shape.seed).held.own_beyond(0).put(message);
      const Bytes bytes = message.take();
      detail::MessageReader reader(bytes);
      first.held.add(detail::SentCells<D>::get(reader));
      reader.require_end();
    }
    EXPECT_LT(before, cells_of(whole.mesh).size());
    first.held.find_all();
    first.held.complete();
    EXPECT_TRUE(neighbours_of(first.part.mesh) == neighbours_of(whole.mesh));
    for (const CellId c : cells_of(first.part.mesh)) {
      EXPECT_EQ(first.held.find(detail::points_of(first.part.mesh, c)), c);
      for (int f = 0; f <= D; ++f) {
        if (const Link link = first.part.mesh.cell(c).links[static_cast<std::size_t>(f)]; link) {
          EXPECT_EQ(first.part.mesh.cell(link.cell()).links[static_cast<std::size_t>(link.face())], Link(c, f));
        }
      }
    }
  }
}

/// Without the cells of one rank no mesh comes of it.
TYPED_TEST(Held, AMissingPartIsAnError) {
  constexpr int D = TypeParam::value;
  const OwnedTree<D> owned(2, 3, 2);
  CutMesh<D> first(owned, 0, 150, 2);
  CutMesh<D> second(owned, 1, 150, 2);
  first.held.add(second.held.own_beyond(0));
  EXPECT_THROW(first.held.complete(), ResourceError);
}

/// Many with one hash, put in and taken out at random.
TEST(IdTables, FindWhatASetHas) {
  std::mt19937_64 random(3);
  for (const std::uint32_t hashes : {1u, 5u, 64u, 100000u}) {
    const auto hash_of = [&](std::uint32_t id) { return static_cast<std::uint32_t>(id % hashes * 0x9e3779b9u); };
    IdTable table;
    std::set<std::uint32_t> expected;
    for (int time = 0; time < 3000; ++time) {
      const auto id = static_cast<std::uint32_t>(random() % 400);
      const auto is = [id](std::uint32_t other) { return other == id; };
      EXPECT_EQ(table.find(hash_of(id), is), expected.count(id) ? id : IdTable::none);
      if (time % 1500 < 900 ? random() % 3 > 0 : random() % 3 == 0) {
        if (expected.insert(id).second) table.insert(hash_of(id), id);
      } else {
        EXPECT_EQ(table.erase(hash_of(id), id), expected.erase(id) == 1);
      }
    }
    for (std::uint32_t id = 0; id < 400; ++id)
      EXPECT_EQ(table.find(hash_of(id), [id](std::uint32_t o) { return o == id; }) == id, expected.count(id) == 1);
    table.clear();
    EXPECT_EQ(table.find(0, [](std::uint32_t) { return true; }), IdTable::none);
    EXPECT_FALSE(table.erase(0, 0));
  }
}

}  // namespace pgdr::test::test_ranks_held
