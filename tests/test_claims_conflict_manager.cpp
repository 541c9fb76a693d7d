// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The total order of a generation's visits, and that visits whose claims meet never run at once.
#include "claims/conflict_manager.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <map>
#include <memory>
#include <tuple>

#include "dimensions.hpp"
#include "graded_trees.hpp"
#include "pgdr/error.hpp"

namespace pgdr::test_claims_conflict_manager {

constexpr std::uint64_t seed = 20270302;

template <class>
class ConflictManagerTest : public ::testing::Test {};
TYPED_TEST_SUITE(ConflictManagerTest, test::Dimensions);

constexpr ClaimRule rules[] = {ClaimRule::boxes, ClaimRule::leaves};

/// By the rule of boxes inner nodes have visits, too.
template <int D>
std::vector<VisitRequest> random_requests(const Orthtree<D>& tree, ClaimRule rule, std::mt19937_64& random) {
  std::vector<VisitRequest> requests;
  for (std::uint32_t node = 0; node < tree.node_count(); ++node) {
    if (!tree.is_leaf(node) && (rule == ClaimRule::leaves || random() % 3 != 0)) continue;
    if (random() % 4 != 0) requests.push_back({node, 1, random() % 3});
    if (random() % 8 == 0) requests.push_back({node, 2, random() % 3});
    if (random() % 16 == 0) requests.push_back({node, 4, random() % 3});
  }
  const auto leaves = tree.leaves();
  requests.push_back({leaves.front(), whole_tree, 0});
  requests.push_back({leaves.back(), whole_tree, 1});
  std::shuffle(requests.begin(), requests.end(), random);
  return requests;
}

/// The centres of the leaves of a tree that is finer than the other one, which the visit's claim holds.
template <int D>
std::vector<std::size_t> claimed_points(const Visit<D>& visit, const Orthtree<D>& tree, const std::vector<Point<D>>& points) {
  const Claim<D> claim = visit.claim(tree);
  std::vector<std::size_t> claimed;
  for (std::size_t i = 0; i < points.size(); ++i)
    if (claim.contains(points[i])) claimed.push_back(i);
  return claimed;
}

/// A point in each quarter (2D) or eighth of each leaf.
template <int D>
std::vector<Point<D>> probes(const Orthtree<D>& tree) {
  std::vector<Point<D>> points;
  for (const auto leaf : tree.leaves())
    for (int c = 0; c < 1 << D; ++c) {
      Point<D> p = tree.centre(leaf);
      for (int i = 0; i < D; ++i) p[i] += (c >> i & 1 ? 0.25 : -0.25) * tree.side(leaf);
      points.push_back(p);
    }
  return points;
}

/// For each visit, which earlier ones must have ended before it starts.
std::vector<std::vector<bool>> reachability(const VisitGraph& graph) {
  std::vector<std::vector<bool>> before(graph.visits(), std::vector<bool>(graph.visits(), false));
  for (std::uint32_t v = 0; v < graph.visits(); ++v)
    for (const auto p : graph.predecessors(v)) {
      before[v][p] = true;
      for (std::uint32_t u = 0; u < p; ++u)
        if (before[p][u]) before[v][u] = true;
    }
  return before;
}

TYPED_TEST(ConflictManagerTest, VisitsThatConflictHaveAPath) {
  constexpr int D = TypeParam::value;
  std::mt19937_64 random(seed);
  for (const ClaimRule rule : rules)
    for (const std::uint32_t ordinary : {1u, 2u, 1u, 2u}) {
      const Orthtree<D> tree = trees::graded<D>(random, D == 2 ? 60 : 25);
      ConflictManager<D> manager(tree, rule, ordinary);
      const auto requests = random_requests(tree, rule, random);
      const Generation<D> generation = manager.plan(requests);
      ASSERT_EQ(generation.visits.size(), requests.size());
      ASSERT_EQ(generation.graph.visits(), requests.size());
      const auto before = reachability(generation.graph);
      for (std::uint32_t v = 0; v < generation.graph.visits(); ++v) {
        const auto predecessors = generation.graph.predecessors(v);
        for (std::size_t k = 0; k < predecessors.size(); ++k) {
          EXPECT_LT(predecessors[k], v);
          EXPECT_TRUE(k == 0 || predecessors[k - 1] < predecessors[k]) << "no edge twice";
          EXPECT_TRUE(meet(generation.visits[v], generation.visits[predecessors[k]])) << "no needless edge";
        }
        for (std::uint32_t u = 0; u < v; ++u)
          if (meet(generation.visits[u], generation.visits[v])) {
            EXPECT_TRUE(before[v][u]) << u << ' ' << v;
          }
      }
    }
}

TYPED_TEST(ConflictManagerTest, ClaimsAreTheBuffersOfTheirOrder) {
  constexpr int D = TypeParam::value;
  std::mt19937_64 random(seed + 1);
  Orthtree<D> tree = trees::graded<D>(random, D == 2 ? 40 : 15);
  for (const std::uint32_t ordinary : {1u, 2u}) {
    ConflictManager<D> manager(tree, ClaimRule::leaves, ordinary);
    for (int round = 0; round < 6; ++round) {  // the cache must notice the splits between rounds
      const Generation<D> generation = manager.plan(random_requests(tree, ClaimRule::leaves, random));
      for (const Visit<D>& visit : generation.visits) {
        const auto [leaf, order, number] = visit.request;
        const Claim<D> claim = visit.claim(tree);
        EXPECT_EQ(claim.node(), leaf);
        EXPECT_EQ(claim.whole(), order == whole_tree);
        if (order == whole_tree) continue;
        auto expected = trees::buffer(tree, leaf, order == 1 ? ordinary : order);
        expected.push_back(leaf);
        std::sort(expected.begin(), expected.end());
        EXPECT_EQ(visit.leaves, expected);
        for (const auto l : tree.leaves()) EXPECT_EQ(claim.holds(l), std::binary_search(expected.begin(), expected.end(), l));
      }
      const auto leaves = tree.leaves();
      for (int s = 0; s < round; ++s) tree.split(leaves[random() % leaves.size()]);
    }
  }
}

/// Do visits meet if and only if both claims hold some point?
TYPED_TEST(ConflictManagerTest, VisitsMeetWhereTheirClaimsDo) {
  constexpr int D = TypeParam::value;
  std::mt19937_64 random(seed + 5);
  for (const ClaimRule rule : rules) {
    const Orthtree<D> tree = trees::graded<D>(random, D == 2 ? 40 : 15);
    ConflictManager<D> manager(tree, rule);
    const Generation<D> generation = manager.plan(random_requests(tree, rule, random));
    const auto points = probes<D>(tree);
    std::vector<std::vector<std::size_t>> claimed;
    for (const Visit<D>& visit : generation.visits) claimed.push_back(claimed_points(visit, tree, points));
    for (std::size_t u = 0; u < claimed.size(); ++u)
      for (std::size_t v = 0; v < claimed.size(); ++v) {
        std::vector<std::size_t> both;
        std::set_intersection(claimed[u].begin(), claimed[u].end(), claimed[v].begin(), claimed[v].end(),
                              std::back_inserter(both));
        EXPECT_TRUE(both.empty() || meet(generation.visits[u], generation.visits[v]));
        EXPECT_TRUE(rule == ClaimRule::boxes || both.empty() != meet(generation.visits[u], generation.visits[v]));
      }
  }
}

TYPED_TEST(ConflictManagerTest, OrderIsByLevelVolumeGenerationColourPlace) {
  constexpr int D = TypeParam::value;
  std::mt19937_64 random(seed + 2);
  for (const ClaimRule rule : rules) {
    const Orthtree<D> tree = trees::graded<D>(random, 60);
    ConflictManager<D> manager(tree, rule);
    const Generation<D> generation = manager.plan(random_requests(tree, rule, random));
    const auto key = [&](const Visit<D>& v) {
      const auto [node, order, since] = v.request;
      const bool boxes = rule == ClaimRule::boxes;
      const std::uint32_t period = order == whole_tree ? 1 : boxes ? 3 : 2 * order + 1;
      return std::tuple(order, boxes && order > 1 ? tree.side(node) : -tree.side(node), since, tree.colour(node, period),
                        tree.morton(node));
    };
    for (std::size_t i = 1; i < generation.visits.size(); ++i)
      EXPECT_LT(key(generation.visits[i - 1]), key(generation.visits[i]));
    EXPECT_TRUE(generation.visits.back().whole());
  }
}

TYPED_TEST(ConflictManagerTest, PlanIsAFunctionOfBoxesAndRequests) {
  constexpr int D = TypeParam::value;
  std::mt19937_64 random(seed + 3);
  const Orthtree<D> a = trees::graded<D>(random, 50);
  const Orthtree<D> b = trees::split_otherwise<D>(a, random);
  for (const ClaimRule rule : rules) {
    auto requests = random_requests(a, rule, random);
    std::erase_if(requests, [&a](const VisitRequest& r) { return !a.is_leaf(r.node); });
    auto translated = requests;
    for (VisitRequest& r : translated) r.node = b.leaf_at(a.centre(r.node));
    std::shuffle(translated.begin(), translated.end(), random);
    ConflictManager<D> manager_a(a, rule), manager_b(b, rule);
    const Generation<D> of_a = manager_a.plan(requests), of_b = manager_b.plan(translated);
    ASSERT_EQ(of_a.visits.size(), of_b.visits.size());
    for (std::uint32_t v = 0; v < of_a.visits.size(); ++v) {
      EXPECT_EQ(a.box(of_a.visits[v].request.node), b.box(of_b.visits[v].request.node));
      EXPECT_EQ(of_a.visits[v].request.order, of_b.visits[v].request.order);
      EXPECT_EQ(of_a.visits[v].claim(a).inner(), of_b.visits[v].claim(b).inner());
      const auto p = of_a.graph.predecessors(v), q = of_b.graph.predecessors(v);
      EXPECT_TRUE(std::equal(p.begin(), p.end(), q.begin(), q.end()));
    }
  }
}

TYPED_TEST(ConflictManagerTest, VisitsOfTheSameColourRunTogether) {
  constexpr int D = TypeParam::value;
  const Orthtree<D> tree = trees::uniform<D>(D == 2 ? 5 : 4);
  for (const ClaimRule rule : rules) {
    ConflictManager<D> manager(tree, rule);
    std::vector<VisitRequest> requests;
    for (const auto leaf : tree.leaves()) requests.push_back({leaf, 1, 0});
    const Generation<D> generation = manager.plan(requests);
    const std::vector<double> unit(requests.size(), 1.0);
    EXPECT_LE(critical_path(generation.graph, unit), D == 2 ? 9 : 27) << "one step a colour";
  }
}

/// Leaves beside a much larger one need not wait for each other, unless whole leaves are claimed.
TYPED_TEST(ConflictManagerTest, FineLeavesBesideACoarseOneRunTogether) {
  constexpr int D = TypeParam::value;
  Orthtree<D> tree = trees::uniform<D>(1);
  const std::uint32_t low = tree.leaf_at(tree.box(0).low);
  for (int level = 0; level < 4; ++level)
    for (const auto leaf : tree.leaves())
      if (tree.box(leaf).high[0] == tree.box(low).high[0]) tree.split(leaf);
  std::vector<VisitRequest> requests;
  for (const auto leaf : tree.leaves())
    if (tree.level(leaf) > 1 && tree.box(leaf).high[0] == tree.box(low).high[0]) requests.push_back({leaf, 1, 0});
  const std::vector<double> unit(requests.size(), 1.0);
  ConflictManager<D> boxes(tree, ClaimRule::boxes), leaves(tree, ClaimRule::leaves);
  EXPECT_LE(critical_path(boxes.plan(requests).graph, unit), D == 2 ? 3 : 9) << "one step a colour";
  EXPECT_GE(critical_path(leaves.plan(requests).graph, unit), static_cast<double>(requests.size()) / (1 << (D - 1)));
}

TYPED_TEST(ConflictManagerTest, RefusesWhatCannotBeVisited) {
  constexpr int D = TypeParam::value;
  const Orthtree<D> tree = trees::uniform<D>(2);
  ConflictManager<D> manager(tree);
  const std::uint32_t leaf = tree.leaves().front();
  const auto plan = [&](std::vector<VisitRequest> requests) { return manager.plan(requests).visits.size(); };
  EXPECT_EQ(plan({}), 0u);
  EXPECT_EQ(plan({{leaf, 1, 0}, {leaf, 2, 0}, {leaf, whole_tree, 0}}), 3u);
  EXPECT_THROW(plan({{leaf, 1, 0}, {leaf, 1, 5}}), ResourceError);
  EXPECT_EQ(plan({{0, 1, 0}}), 1u) << "an inner node has a box";
  ConflictManager<D> of_leaves(tree, ClaimRule::leaves);
  EXPECT_THROW(of_leaves.plan(std::vector<VisitRequest>{{0, 1, 0}}), ResourceError);
  EXPECT_THROW(plan({{tree.node_count(), 1, 0}}), ResourceError);
  EXPECT_THROW(plan({{leaf, 0, 0}}), ResourceError);
}

TYPED_TEST(ConflictManagerTest, PointsHaveOneWriterAtATime) {
  constexpr int D = TypeParam::value;
  std::mt19937_64 random(seed + 4);
  const Orthtree<D> tree = trees::graded<D>(random, D == 2 ? 200 : 60);
  for (const ClaimRule rule : rules) {
    ConflictManager<D> manager(tree, rule);
    const Generation<D> generation = manager.plan(random_requests(tree, rule, random));
    // Plain writes: a thread sanitizer reports whatever the graph leaves unordered.
    const auto points = probes<D>(tree);
    std::vector<std::uint64_t> history(points.size(), 0), expected(points.size(), 0);
    const auto visit = [&](std::vector<std::uint64_t>& of, std::uint32_t v) {
      for (const std::size_t i : claimed_points(generation.visits[v], tree, points)) of[i] = of[i] * 6364136223846793005u + v + 1;
    };
    run_serial(generation.graph, [&](std::uint32_t v) { visit(expected, v); });
    const VisitRun run = run_threads(
        generation.graph, [&](std::uint32_t v) { visit(history, v); }, 4);
    EXPECT_TRUE(run.complete());
    EXPECT_EQ(history, expected) << "any order that the graph allows gives the same";
  }
}

}  // namespace pgdr::test_claims_conflict_manager
