// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The tree against the definitions on its boxes, in trees of any grading; and what a claim says it holds.
#include "tree/orthtree.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>

#include "claims/claim.hpp"
#include "claims/placement.hpp"
#include "dimensions.hpp"
#include "graded_trees.hpp"
#include "pgdr/error.hpp"

namespace pgdr::test_tree_orthtree {

constexpr std::uint64_t seed = 20270301;
constexpr double infinity = std::numeric_limits<double>::infinity();

template <class>
class OrthtreeTest : public ::testing::Test {};
TYPED_TEST_SUITE(OrthtreeTest, test::Dimensions);

template <int D>
Point<D> random_point(std::mt19937_64& random, double low, double high) {
  std::uniform_real_distribution<double> uniform(low, high);
  Point<D> p;
  for (int i = 0; i < D; ++i) p[i] = uniform(random);
  return p;
}

template <int D>
trees::Set<D> set_of(const std::vector<std::uint32_t>& nodes) {
  EXPECT_TRUE(std::is_sorted(nodes.begin(), nodes.end()));
  const trees::Set<D> set(nodes.begin(), nodes.end());
  EXPECT_EQ(set.size(), nodes.size());
  return set;
}

TYPED_TEST(OrthtreeTest, NodesGoByTheirBoxesWhateverTheOrderOfSplits) {
  constexpr int D = TypeParam::value;
  std::mt19937_64 random(seed);
  for (int trial = 0; trial < 20; ++trial) {
    const Orthtree<D> tree = trees::graded<D>(random, trial * 5), other = trees::split_otherwise<D>(tree, random);
    using Place = std::pair<std::uint64_t, int>;  // of the low corner, and how deep: parents first
    const auto places = [](const Orthtree<D>& of) {
      std::vector<Place> all;
      of.for_each_node([&](std::uint32_t node) { all.emplace_back(of.morton(node), of.level(node)); });
      return all;
    };
    const std::vector<Place> found = places(tree);
    EXPECT_EQ(found.size(), tree.node_count());
    EXPECT_EQ(std::adjacent_find(found.begin(), found.end(), std::greater_equal<>()), found.end());
    EXPECT_EQ(places(other), found);
  }
}

TYPED_TEST(OrthtreeTest, RootIsALargerCubeWithAnotherCentre) {
  constexpr int D = TypeParam::value;
  std::mt19937_64 random(seed);
  std::uniform_int_distribution<int> exponent(-40, 40);
  for (int trial = 0; trial < 2000; ++trial) {
    Point<D> low = random_point<D>(random, -1, 1), high = low;
    const double shift = trial % 3 == 0 ? std::ldexp(1.0, exponent(random)) : 0;
    for (int i = 0; i < D; ++i) {
      low[i] += shift;
      high[i] = low[i] + std::ldexp(trial % 5 == 0 && i == 0 ? 0.0 : 1.0, exponent(random) / 8);
    }
    const Orthtree<D> tree(low, high);
    const auto box = tree.box(0);
    const double sixteenths = std::ldexp(tree.side(0), 4 - std::ilogb(tree.side(0)));
    EXPECT_EQ(sixteenths, std::floor(sixteenths)) << "five bits";
    for (int i = 0; i < D; ++i) {
      EXPECT_LT(box.low[i], low[i]);
      EXPECT_GT(box.high[i], high[i]);
      EXPECT_NE(tree.centre(0)[i], low[i] + (high[i] - low[i]) / 2);
      if (shift == 0) {
        EXPECT_EQ(box.high[i] - box.low[i], tree.side(0)) << "exact doubles";
      }
    }
  }
}

TYPED_TEST(OrthtreeTest, ScalesExactly) {
  constexpr int D = TypeParam::value;
  std::mt19937_64 random(seed + 1);
  for (const int k : {-300, -7, 1, 12, 400}) {
    const Point<D> low = random_point<D>(random, -3, -1), high = random_point<D>(random, 1, 2);
    Point<D> scaled_low, scaled_high;
    for (int i = 0; i < D; ++i) scaled_low[i] = std::ldexp(low[i], k), scaled_high[i] = std::ldexp(high[i], k);
    Orthtree<D> a(low, high), b(scaled_low, scaled_high);
    for (int s = 0; s < 200; ++s) {
      Point<D> p = random_point<D>(random, -3, 2), q;
      for (int i = 0; i < D; ++i) q[i] = std::ldexp(p[i], k);
      ASSERT_EQ(a.leaf_at(p), b.leaf_at(q));
      a.split(a.leaf_at(p));
      b.split(b.leaf_at(q));
    }
    ASSERT_EQ(a.node_count(), b.node_count());
    for (std::uint32_t n = 0; n < a.node_count(); ++n)
      for (int i = 0; i < D; ++i) {
        ASSERT_EQ(std::ldexp(a.box(n).low[i], k), b.box(n).low[i]);
        ASSERT_EQ(std::ldexp(a.centre(n)[i], k), b.centre(n)[i]);
      }
  }
}

TYPED_TEST(OrthtreeTest, DyadicFractionsOfTheBoxAreNoBorders) {
  constexpr int D = TypeParam::value;
  for (const double centre : {0.0, 0.5, 3.0})
    for (const double half : {0.5, 1.0, 5.0}) {
      Point<D> low, high;
      for (int i = 0; i < D; ++i) low[i] = centre - half, high[i] = centre + half;
      const Orthtree<D> tree(low, high);
      // Borders of the leaves of level 10, and the 64ths of the box.
      for (int i = 0; i < D; ++i)
        for (int n = 0; n <= 64; ++n) {
          const double u = (low[i] + n * (2 * half) / 64 - tree.box(0).low[i]) / tree.side(0) * 1024;
          EXPECT_GT(std::fabs(u - std::round(u)), 1e-3);
        }
    }
}

TYPED_TEST(OrthtreeTest, RefusesABoxThatHasNoTree) {
  constexpr int D = TypeParam::value;
  const auto make = [](double l, double h) {
    Point<D> low, high;
    low.x.fill(l);
    high.x.fill(h);
    return Orthtree<D>(low, high);
  };
  EXPECT_THROW(make(0, infinity), InputError);
  EXPECT_THROW(make(std::nan(""), 1), InputError);
  EXPECT_THROW(make(0, std::nan("")), InputError);
  EXPECT_THROW(make(1, 0), InputError);
  EXPECT_THROW(make(-1e308, 1e308), InputError);
  for (const double x : {0.0, -0.0, 1.0, 5e-324, -1e300, 1e-310}) {
    const Orthtree<D> tree = make(x, x);
    EXPECT_LT(tree.box(0).low[0], x);
    EXPECT_GT(tree.box(0).high[0], x);
  }
}

TYPED_TEST(OrthtreeTest, EveryPointHasOneLeaf) {
  constexpr int D = TypeParam::value;
  std::mt19937_64 random(seed + 2);
  for (int trial = 0; trial < 10; ++trial) {
    const Orthtree<D> tree = trees::graded<D>(random, 40);
    const auto leaves = tree.leaves();
    EXPECT_EQ(leaves.size(), tree.leaf_count());
    const auto root = tree.box(0);
    for (int s = 0; s < 500; ++s) {
      Point<D> p = random_point<D>(random, -2, 3);
      if (s % 4 == 0) p = tree.box(leaves[random() % leaves.size()]).low;  // on borders: the leaf above has them
      Point<D> inside = p;
      for (int i = 0; i < D; ++i) inside[i] = std::clamp(p[i], root.low[i], std::nextafter(root.high[i], -infinity));
      int found = 0;
      for (const auto leaf : leaves)
        if (tree.box(leaf).contains(inside)) {
          ++found;
          EXPECT_EQ(tree.leaf_at(p), leaf);
        }
      EXPECT_EQ(found, 1);
    }
    Point<D> odd;
    for (const double x : {std::nan(""), infinity, -infinity}) {
      odd.x.fill(x);
      EXPECT_TRUE(tree.is_leaf(tree.leaf_at(odd)));
    }
  }
}

TYPED_TEST(OrthtreeTest, ChildrenTileTheirParent) {
  constexpr int D = TypeParam::value;
  std::mt19937_64 random(seed + 3);
  Orthtree<D> tree = trees::graded<D>(random, 60);
  EXPECT_EQ(tree.parent(0), Orthtree<D>::none);
  EXPECT_EQ(tree.split(0), Orthtree<D>::none) << "no leaf";
  for (std::uint32_t n = 0; n < tree.node_count(); ++n) {
    if (tree.is_leaf(n)) continue;
    const auto box = tree.box(n);
    for (unsigned c = 0; c < Orthtree<D>::children; ++c) {
      const std::uint32_t child = tree.first_child(n) + c;
      EXPECT_EQ(tree.parent(child), n);
      EXPECT_EQ(tree.level(child), tree.level(n) + 1);
      for (int i = 0; i < D; ++i) {
        EXPECT_EQ(tree.box(child).low[i], c >> i & 1 ? tree.centre(n)[i] : box.low[i]);
        EXPECT_EQ(tree.box(child).high[i], c >> i & 1 ? box.high[i] : tree.centre(n)[i]);
      }
    }
  }
}

TYPED_TEST(OrthtreeTest, DepthEndsWhereItMust) {
  constexpr int D = TypeParam::value;
  Orthtree<D> tree = trees::over_unit_cube<D>();
  Point<D> p;
  p.x.fill(0.3);
  int depth = 0;
  while (tree.split(tree.leaf_at(p)) != Orthtree<D>::none) ++depth;
  EXPECT_EQ(depth, Orthtree<D>::max_level);
  EXPECT_TRUE(tree.box(tree.leaf_at(p)).contains(p));
  const auto leaves = tree.leaves();
  for (std::size_t i = 1; i < leaves.size(); ++i) EXPECT_LT(tree.morton(leaves[i - 1]), tree.morton(leaves[i]));

  // Far from the origin the doubles end first.
  Point<D> low, high;
  low.x.fill(std::ldexp(1.0, 50));
  high.x.fill(std::ldexp(1.0, 50) + 1);
  Orthtree<D> coarse(low, high);
  depth = 0;
  while (coarse.split(coarse.leaf_at(low)) != Orthtree<D>::none) ++depth;
  EXPECT_LT(depth, 6);
  EXPECT_TRUE(coarse.box(coarse.leaf_at(low)).contains(low));
}

TYPED_TEST(OrthtreeTest, OrderAndBoxesDoNotDependOnTheOrderOfSplits) {
  constexpr int D = TypeParam::value;
  std::mt19937_64 random(seed + 4);
  const Orthtree<D> a = trees::graded<D>(random, 60);
  const Orthtree<D> b = trees::split_otherwise<D>(a, random);
  const auto in_a = a.leaves(), in_b = b.leaves();
  ASSERT_EQ(in_a.size(), in_b.size());
  EXPECT_NE(in_a, in_b) << "the numbers of the nodes may differ, and do here";
  for (std::size_t i = 0; i < in_a.size(); ++i) {
    EXPECT_EQ(a.box(in_a[i]), b.box(in_b[i]));
    EXPECT_EQ(a.morton(in_a[i]), b.morton(in_b[i]));
    EXPECT_EQ(a.colour(in_a[i]), b.colour(in_b[i]));
    if (i > 0) {
      EXPECT_LT(a.morton(in_a[i - 1]), a.morton(in_a[i]));
    }
  }
}

TYPED_TEST(OrthtreeTest, NeighboursAndBuffersAreThoseOfTheDefinitions) {
  constexpr int D = TypeParam::value;
  std::mt19937_64 random(seed + 5);
  std::size_t beyond_touching = 0;
  for (int trial = 0; trial < (D == 2 ? 12 : 5); ++trial) {
    const Orthtree<D> tree = trees::graded<D>(random, D == 2 ? 40 : 16);
    const trees::Boxes<D> boxes(tree);
    std::map<std::uint32_t, trees::Set<D>> buffers;
    for (const auto leaf : boxes.leaves) {
      for (int axis = 0; axis < D; ++axis)
        for (int side = 0; side < 2; ++side) {
          trees::Set<D> expected;
          for (const auto other : boxes.leaves)
            if (boxes.beyond(leaf, other, axis, side)) expected.insert(other);
          std::vector<std::uint32_t> found;
          tree.append_face_neighbours(leaf, axis, side, found);
          std::sort(found.begin(), found.end());
          EXPECT_EQ(set_of<D>(found), expected);
        }
      buffers[leaf] = boxes.buffer(leaf);
      EXPECT_EQ(set_of<D>(tree.buffer(leaf)), buffers[leaf]);
      EXPECT_FALSE(buffers[leaf].contains(leaf));
      for (const auto other : boxes.leaves) {
        if (other != leaf && boxes.touch(leaf, other)) {
          EXPECT_TRUE(buffers[leaf].contains(other));
        }
        beyond_touching += buffers[leaf].contains(other) && !boxes.touch(leaf, other);
      }
    }
    for (const auto leaf : boxes.leaves)
      for (const auto other : buffers[leaf]) EXPECT_TRUE(buffers[other].contains(leaf)) << "symmetric";
  }
  EXPECT_GT(beyond_touching, 0u) << "the trees were too tame to tell BUF from the leaves that touch";
}

TYPED_TEST(OrthtreeTest, ASplitChangesTheBuffersThatHoldTheLeafAndNoOthers) {
  constexpr int D = TypeParam::value;
  std::mt19937_64 random(seed + 6);
  Orthtree<D> tree = trees::graded<D>(random, 20);
  for (int s = 0; s < 10; ++s) {
    const auto before = tree.leaves();
    std::map<std::uint32_t, std::vector<std::uint32_t>> buffers;
    for (const auto leaf : before) buffers[leaf] = tree.buffer(leaf);
    const auto victim = before[random() % before.size()];
    if (tree.split(victim) == Orthtree<D>::none) continue;
    for (const auto leaf : before) {
      if (leaf == victim) continue;
      const auto& zone = buffers[leaf];
      const bool held = std::binary_search(zone.begin(), zone.end(), victim);
      EXPECT_EQ(held, tree.buffer(leaf) != zone);
    }
  }
}

TYPED_TEST(OrthtreeTest, EqualColoursOfAUniformTreeHaveDisjointClaims) {
  constexpr int D = TypeParam::value;
  for (const std::uint32_t order : {1u, 2u}) {
    const Orthtree<D> tree = trees::uniform<D>(D == 2 ? 5 : 3);
    std::map<std::uint64_t, trees::Set<D>> claimed;  // by colour
    std::map<std::uint64_t, std::size_t> claimed_size;
    for (const auto leaf : tree.leaves()) {
      const std::uint64_t colour = tree.colour(leaf, 2 * order + 1);
      auto zone = trees::buffer(tree, leaf, order);
      zone.push_back(leaf);
      claimed[colour].insert(zone.begin(), zone.end());
      claimed_size[colour] += zone.size();
    }
    EXPECT_EQ(claimed.size(), static_cast<std::size_t>(std::pow(2 * order + 1, D)));
    for (const auto& [colour, set] : claimed) EXPECT_EQ(set.size(), claimed_size[colour]);
  }
}

TYPED_TEST(OrthtreeTest, ClaimsHoldWhatTheySay) {
  constexpr int D = TypeParam::value;
  std::mt19937_64 random(seed + 7);
  std::size_t grown = 0, infinite = 0;
  for (int trial = 0; trial < 5; ++trial) {
    const Orthtree<D> tree = trees::graded<D>(random, D == 2 ? 60 : 20);
    const trees::Boxes<D> boxes(tree);
    const auto root = tree.box(0);
    for (const auto leaf : boxes.leaves)
      for (const std::uint32_t order : {1u, 2u, 4u}) {
        const auto zone = trees::buffer(tree, leaf, order);
        trees::Set<D> expected(zone.begin(), zone.end());
        expected.insert(leaf);
        const Claim<D> claim = Claim<D>::of_leaves(tree, leaf, {expected.begin(), expected.end()}, order);
        for (const auto other : boxes.leaves) EXPECT_EQ(claim.holds(other), expected.contains(other));

        // Exactly: no leaf outside the claim meets the interior of the inner box; the leaf itself lies in it.
        const auto& inner = claim.inner();
        for (const auto other : boxes.leaves) {
          bool meets = true;
          for (int i = 0; i < D; ++i) {
            const bool clamped_low = boxes.box[other].low[i] == root.low[i];
            const bool clamped_high = boxes.box[other].high[i] == root.high[i];
            const double low = clamped_low ? -infinity : boxes.box[other].low[i];
            const double high = clamped_high ? infinity : boxes.box[other].high[i];
            meets = meets && low < inner.high[i] && inner.low[i] < high;
          }
          EXPECT_TRUE(!meets || expected.contains(other));
        }
        for (int i = 0; i < D; ++i) {
          EXPECT_LE(inner.low[i], boxes.box[leaf].low[i]);
          EXPECT_GE(inner.high[i], boxes.box[leaf].high[i]);
          EXPECT_TRUE(inner.low[i] < boxes.box[leaf].low[i]) << "grown, or at the root's border";
          EXPECT_TRUE(inner.high[i] > boxes.box[leaf].high[i]);
          grown += inner.low[i] < boxes.box[leaf].low[i];
          infinite += inner.low[i] == -infinity;
        }
        for (int s = 0; s < 10; ++s) {
          const Point<D> p = random_point<D>(random, -1, 2);
          EXPECT_EQ(claim.contains(p), expected.contains(tree.leaf_at(p)));
        }
      }
    const Claim<D> whole = Claim<D>::whole(tree, boxes.leaves[0]);
    EXPECT_TRUE(whole.whole());
    EXPECT_TRUE(whole.contains(random_point<D>(random, -9, 9)));
    Point<D> nan;
    nan.x.fill(std::nan(""));
    EXPECT_TRUE(whole.contains(nan));
  }
  EXPECT_GT(grown, infinite);
  EXPECT_GT(infinite, 0u);
}

/// The box of a node, grown by its side, holds the points that it says, and the nodes that lie in it.
TYPED_TEST(OrthtreeTest, BoxesAreGrownByTheirSide) {
  constexpr int D = TypeParam::value;
  std::mt19937_64 random(seed + 8);
  const Orthtree<D> tree = trees::graded<D>(random, D == 2 ? 60 : 20);
  const auto root = tree.box(0);
  for (std::uint32_t node = 1; node < tree.node_count(); ++node)
    for (const std::uint64_t sides : {std::uint64_t{0}, std::uint64_t{1}, std::uint64_t{3}, ~std::uint64_t{0}}) {
      const auto grid = GridBox<D>::around(tree, node, sides);
      const Claim<D> claim = Claim<D>::of_box(tree, node, grid);
      const auto box = tree.box(node);
      for (int s = 0; s < 20; ++s) {
        const Point<D> p = random_point<D>(random, -1, 2);
        bool inside = true;
        for (int i = 0; i < D; ++i) {
          const double reach = static_cast<double>(sides) * tree.side(node);
          const double low = box.low[i] - reach, high = box.high[i] + reach;
          inside = inside && (p[i] >= low || low <= root.low[i]) && (p[i] < high || high >= root.high[i]);
        }
        EXPECT_EQ(claim.contains(p), inside);
      }
      for (std::uint32_t other = 0; other < tree.node_count(); ++other) {
        const auto b = GridBox<D>::around(tree, other, 0);
        EXPECT_EQ(claim.holds(other), grid.holds(b));
        EXPECT_EQ(grid.meets(b), b.meets(grid));
        EXPECT_TRUE(!claim.holds(other) || (claim.contains(tree.centre(other)) && grid.meets(b)));
      }
    }
}

/// Every element belongs to one node: the smallest around its place whose side is large enough.
TYPED_TEST(OrthtreeTest, ElementsBelongToTheSmallestNodeThatIsLargeEnough) {
  constexpr int D = TypeParam::value;
  std::mt19937_64 random(seed + 9);
  const Orthtree<D> tree = trees::graded<D>(random, 60);
  const double share = 0.5;
  const Placement<D> by_boxes(tree, ClaimRule::boxes, share), by_leaves(tree, ClaimRule::leaves, share);
  std::size_t inner = 0;
  for (int k = 0; k < 2000; ++k) {
    const Point<D> p = random_point<D>(random, -0.5, 1.5);
    const double radius = std::ldexp(1.0, -static_cast<int>(random() % 12));
    EXPECT_EQ(by_leaves.node_of(p, radius), tree.leaf_at(p));
    const auto node = by_boxes.node_of(p, radius);
    inner += !tree.is_leaf(node);
    EXPECT_TRUE(node == Orthtree<D>::root || radius <= share * tree.side(node));
    EXPECT_TRUE(tree.is_leaf(node) || radius > share * tree.side(tree.child_at(node, p)));
    EXPECT_TRUE(radius > by_boxes.radius_below(node) && radius <= by_boxes.most_radius(node));
    for (auto at = tree.leaf_at(p); at != node; at = tree.parent(at))
      EXPECT_FALSE(radius > by_boxes.radius_below(at) && radius <= by_boxes.most_radius(at)) << "of one node alone";
  }
  EXPECT_GT(inner, 100u);
}

TYPED_TEST(OrthtreeTest, InAUniformTreeTheInnerBoxIsTheWholeClaim) {
  constexpr int D = TypeParam::value;
  const Orthtree<D> tree = trees::uniform<D>(D == 2 ? 4 : 3);
  for (const auto leaf : tree.leaves())
    for (const std::uint32_t order : {1u, 2u}) {
      auto leaves = trees::buffer(tree, leaf, order);
      leaves.insert(std::lower_bound(leaves.begin(), leaves.end(), leaf), leaf);
      const Claim<D> claim = Claim<D>::of_leaves(tree, leaf, leaves, order);
      std::size_t held = 0;
      for (const auto other : tree.leaves()) held += claim.inner().contains(tree.centre(other));
      EXPECT_EQ(held, leaves.size());
      const Claim<D> box = Claim<D>::of_box(tree, leaf, GridBox<D>::around(tree, leaf, order));
      EXPECT_EQ(box.inner(), claim.inner()) << "both rules claim the same";
    }
}

}  // namespace pgdr::test_tree_orthtree
