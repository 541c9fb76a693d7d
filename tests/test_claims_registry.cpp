// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// What debug builds ask while nodes are visited: that the claims of no two visits that run meet.
#include "claims/claim_registry.hpp"

#include <gtest/gtest.h>

namespace pgdr::test_claims_registry {

TEST(ClaimRegistry, NoTwoClaimsMeet) {
  Orthtree<2> tree({{0, 0}}, {{1, 1}});
  for (int level = 0; level < 3; ++level)
    for (const auto leaf : tree.leaves()) tree.split(leaf);
  const auto leaves = tree.leaves();  // in Morton order: the first and the last are far apart
  for (const ClaimRule rule : {ClaimRule::boxes, ClaimRule::leaves}) {
    ConflictManager<2> manager(tree, rule);
    const Visit<2> first = manager.visit_of({leaves.front(), 1, 0}), beside = manager.visit_of({leaves[1], 1, 0});
    const Visit<2> far = manager.visit_of({leaves.back(), 1, 0}), all = manager.visit_of({Orthtree<2>::root, whole_tree, 0});
    detail::ClaimRegistry<2> registry;
    EXPECT_TRUE(registry.enter(first));
    EXPECT_TRUE(registry.enter(far));
    registry.leave(far);
    registry.leave(first);
    EXPECT_TRUE(registry.enter(all));
    registry.leave(all);
    EXPECT_TRUE(registry.enter(first));
    EXPECT_FALSE(registry.enter(all));
    registry.leave(all);
    EXPECT_FALSE(registry.enter(beside));
  }
}

}  // namespace pgdr::test_claims_registry
