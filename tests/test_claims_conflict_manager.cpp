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

template <int D>
std::vector<VisitRequest> random_requests(const Orthtree<D>& tree, std::mt19937_64& random) {
  std::vector<VisitRequest> requests;
  for (const auto leaf : tree.leaves()) {
    if (random() % 4 != 0) requests.push_back({leaf, 1, random() % 3});
    if (random() % 8 == 0) requests.push_back({leaf, 2, random() % 3});
    if (random() % 16 == 0) requests.push_back({leaf, 4, random() % 3});
  }
  const auto leaves = tree.leaves();
  requests.push_back({leaves.front(), whole_tree, 0});
  requests.push_back({leaves.back(), whole_tree, 1});
  std::shuffle(requests.begin(), requests.end(), random);
  return requests;
}

template <int D>
bool meet(const Visit<D>& a, const Visit<D>& b) {
  if (a.leaves.empty() || b.leaves.empty()) return true;
  return std::any_of(a.leaves.begin(), a.leaves.end(),
                     [&](auto leaf) { return std::binary_search(b.leaves.begin(), b.leaves.end(), leaf); });
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
  for (const std::uint32_t ordinary : {1u, 2u})
    for (int trial = 0; trial < 4; ++trial) {
      const Orthtree<D> tree = trees::graded<D>(random, D == 2 ? 60 : 25);
      ConflictManager<D> manager(tree, ordinary);
      const auto requests = random_requests(tree, random);
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
    ConflictManager<D> manager(tree, ordinary);
    for (int round = 0; round < 6; ++round) {  // the cache must notice the splits between rounds
      const Generation<D> generation = manager.plan(random_requests(tree, random));
      for (const Visit<D>& visit : generation.visits) {
        const auto [leaf, order, number] = visit.request;
        const Claim<D> claim = visit.claim(tree);
        EXPECT_EQ(claim.leaf(), leaf);
        EXPECT_EQ(claim.whole(), order == whole_tree);
        if (order == whole_tree) continue;
        auto expected = tree.buffer(leaf, order == 1 ? ordinary : order);
        expected.push_back(leaf);
        std::sort(expected.begin(), expected.end());
        EXPECT_EQ(claim.leaves(), expected);
        for (const auto l : tree.leaves())
          EXPECT_EQ(claim.contains_leaf(l), std::binary_search(expected.begin(), expected.end(), l));
      }
      const auto leaves = tree.leaves();
      for (int s = 0; s < round; ++s) tree.split(leaves[random() % leaves.size()]);
    }
  }
}

TYPED_TEST(ConflictManagerTest, OrderIsByLevelVolumeGenerationColourPlace) {
  constexpr int D = TypeParam::value;
  std::mt19937_64 random(seed + 2);
  const Orthtree<D> tree = trees::graded<D>(random, 60);
  ConflictManager<D> manager(tree);
  const Generation<D> generation = manager.plan(random_requests(tree, random));
  const auto key = [&](const Visit<D>& v) {
    const std::uint32_t period = v.request.order == whole_tree ? 1 : 2 * v.request.order + 1;
    return std::tuple(v.request.order, -tree.side(v.request.leaf), v.request.generation, tree.colour(v.request.leaf, period),
                      tree.morton(v.request.leaf));
  };
  for (std::size_t i = 1; i < generation.visits.size(); ++i) EXPECT_LT(key(generation.visits[i - 1]), key(generation.visits[i]));
  EXPECT_TRUE(generation.visits.back().leaves.empty());
}

TYPED_TEST(ConflictManagerTest, PlanIsAFunctionOfBoxesAndRequests) {
  constexpr int D = TypeParam::value;
  std::mt19937_64 random(seed + 3);
  const Orthtree<D> a = trees::graded<D>(random, 50);
  const Orthtree<D> b = trees::split_otherwise<D>(a, random);
  auto requests = random_requests(a, random);
  auto translated = requests;
  for (VisitRequest& r : translated) r.leaf = b.leaf_at(a.centre(r.leaf));
  std::shuffle(translated.begin(), translated.end(), random);
  ConflictManager<D> manager_a(a), manager_b(b);
  const Generation<D> of_a = manager_a.plan(requests), of_b = manager_b.plan(translated);
  ASSERT_EQ(of_a.visits.size(), of_b.visits.size());
  for (std::uint32_t v = 0; v < of_a.visits.size(); ++v) {
    EXPECT_EQ(a.box(of_a.visits[v].request.leaf), b.box(of_b.visits[v].request.leaf));
    EXPECT_EQ(of_a.visits[v].request.order, of_b.visits[v].request.order);
    EXPECT_EQ(of_a.visits[v].claim(a).inner(), of_b.visits[v].claim(b).inner());
    const auto p = of_a.graph.predecessors(v), q = of_b.graph.predecessors(v);
    EXPECT_TRUE(std::equal(p.begin(), p.end(), q.begin(), q.end()));
  }
}

TYPED_TEST(ConflictManagerTest, VisitsOfTheSameColourRunTogether) {
  constexpr int D = TypeParam::value;
  const Orthtree<D> tree = trees::uniform<D>(D == 2 ? 5 : 4);
  ConflictManager<D> manager(tree);
  std::vector<VisitRequest> requests;
  for (const auto leaf : tree.leaves()) requests.push_back({leaf, 1, 0});
  const Generation<D> generation = manager.plan(requests);
  const std::vector<double> unit(requests.size(), 1.0);
  EXPECT_LE(critical_path(generation.graph, unit), D == 2 ? 9 : 27) << "one step a colour";
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
  EXPECT_THROW(plan({{0, 1, 0}}), ResourceError);
  EXPECT_THROW(plan({{tree.node_count(), 1, 0}}), ResourceError);
  EXPECT_THROW(plan({{leaf, 0, 0}}), ResourceError);
}

TYPED_TEST(ConflictManagerTest, LeavesHaveOneWriterAtATime) {
  constexpr int D = TypeParam::value;
  std::mt19937_64 random(seed + 4);
  const Orthtree<D> tree = trees::graded<D>(random, D == 2 ? 200 : 60);
  ConflictManager<D> manager(tree);
  const Generation<D> generation = manager.plan(random_requests(tree, random));
  // Plain writes: a thread sanitizer reports whatever the graph leaves unordered.
  std::vector<std::uint64_t> history(tree.node_count(), 0), expected(tree.node_count(), 0);
  const auto leaves = tree.leaves();
  const auto visit = [&](std::vector<std::uint64_t>& of, std::uint32_t v) {
    const auto& claimed = generation.visits[v].leaves;
    for (const auto leaf : claimed.empty() ? leaves : claimed) of[leaf] = of[leaf] * 6364136223846793005u + v + 1;
  };
  run_serial(generation.graph, [&](std::uint32_t v) { visit(expected, v); });
  const VisitRun run = run_threads(
      generation.graph, [&](std::uint32_t v) { visit(history, v); }, 4);
  EXPECT_TRUE(run.complete());
  EXPECT_EQ(history, expected) << "any order that the graph allows gives the same";
}

}  // namespace pgdr::test_claims_conflict_manager
