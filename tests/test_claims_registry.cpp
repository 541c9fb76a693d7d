// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// What debug builds ask while leaves are visited: that no two visits hold one leaf.
#include "claims/claim_registry.hpp"

#include <gtest/gtest.h>

namespace pgdr::test_claims_registry {

TEST(ClaimRegistry, NoTwoHoldOneLeaf) {
  Orthtree<2> tree({{0, 0}}, {{1, 1}});
  for (int level = 0; level < 3; ++level)
    for (const auto leaf : tree.leaves()) tree.split(leaf);
  detail::ClaimRegistry<2> registry;
  registry.reset(tree.node_count());
  const auto leaves = tree.leaves();  // in Morton order: the first and the last are far apart
  const auto claim = [&](std::uint32_t leaf) { return Claim<2>(tree, leaf, tree.buffer(leaf), 1); };
  const Claim<2> first = claim(leaves.front()), beside = claim(leaves[1]), far = claim(leaves.back());
  const Claim<2> all = Claim<2>::whole(tree, leaves.front());
  EXPECT_TRUE(registry.enter(first));
  EXPECT_TRUE(registry.enter(far));
  EXPECT_TRUE(registry.leave(far));
  EXPECT_TRUE(registry.leave(first));
  EXPECT_TRUE(registry.enter(all));
  EXPECT_TRUE(registry.leave(all));
  EXPECT_TRUE(registry.enter(first));
  EXPECT_FALSE(registry.enter(all));
  EXPECT_TRUE(registry.leave(all));
  EXPECT_FALSE(registry.enter(beside));
}

}  // namespace pgdr::test_claims_registry
