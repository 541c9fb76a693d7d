// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The table of rule/insertion_rule.hpp, by hand.
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "rule/insertion_rule.hpp"

namespace pgdr::test_rule_insertion_rule {

/// Of side 4.
Domain<2> square() {
  Plc<2> plc;
  plc.points = {{{0, 0}}, {{4, 0}}, {{4, 4}}, {{0, 4}}};
  plc.segments = {{{0, 1}, 0}, {{1, 2}, 0}, {{2, 3}, 0}, {{3, 0}, 0}};
  return Domain<2>(plc);
}

/// The side that begins at point i.
EntityId side_at(const Domain<2>& domain, std::uint32_t i) {
  for (EntityId s = 0; s < domain.segments().size(); ++s) {
    const auto& ends = domain.segments()[s].points;
    if (std::max(ends[0], ends[1]) == std::max(i, (i + 1) % 4) && std::min(ends[0], ends[1]) == std::min(i, (i + 1) % 4))
      return s;
  }
  ADD_FAILURE() << i;
  return no_entity;
}

VertexRecord<2> inside(Point2 x, float radius) { return {x, Home(EntityKind::volume, 0), radius}; }
VertexRecord<2> on_segment(EntityId s, Point2 x, float radius) { return {x, Home(EntityKind::segment, s), radius}; }

TEST(InsertionRule, RelaxedLengthIsTheLesserRadiusIfThatIsMore) {
  const Domain<2> domain = square();
  const auto u = inside({{1, 1}}, 3);
  EXPECT_EQ(relaxed_length(domain, u, inside({{2, 1}}, 2)), 2);
  EXPECT_EQ(relaxed_length(domain, u, inside({{2, 1}}, 0.5f)), 1);
  EXPECT_EQ(relaxed_length(domain, u, inside({{3, 1}}, 2)), 2);
  EXPECT_EQ(relaxed_length(domain, u, on_segment(side_at(domain, 0), {{1, 0}}, 2)), 2);
  const float none = std::numeric_limits<float>::infinity();  // of input vertices
  EXPECT_EQ(relaxed_length(domain, inside({{1, 0}}, none), inside({{2, 0}}, none)), 1);
}

TEST(InsertionRule, RelaxedLengthOfEntitiesThatDoNotTouchIsTheirDistance) {
  const Domain<2> domain = square();
  const auto u = on_segment(side_at(domain, 0), {{1, 0}}, 9);
  EXPECT_EQ(relaxed_length(domain, u, on_segment(side_at(domain, 2), {{1, 4}}, 9)), 4);
  EXPECT_EQ(relaxed_length(domain, u, on_segment(side_at(domain, 1), {{4, 0.5}}, 9)), 9);
}

TEST(InsertionRule, DemandOfWhatIsEncroachedUpon) {
  const Domain<2> domain = square();
  const EntityRef side{EntityKind::segment, side_at(domain, 0)};
  const auto expect = [&](const VertexRecord<2>& q, double d, double h) {
    const Demand demand = encroachment_demand(domain, side, q);
    EXPECT_EQ(demand.d, d);
    EXPECT_EQ(demand.h, h);
  };
  expect({{{4, 4}}, Home(EntityKind::vertex, 2), std::numeric_limits<float>::infinity()}, 0, 0);
  expect(on_segment(side_at(domain, 2), {{1, 4}}, 3), 0, 0);
  expect(on_segment(side_at(domain, 1), {{4, 1}}, 3), 1.5, 3);
  expect(inside({{1, 1}}, 3), 1.5, 3);
}

TEST(InsertionRule, WhatLiesOnWhat) {
  const Domain<2> domain = square();
  const EntityRef side{EntityKind::segment, side_at(domain, 0)};
  EXPECT_TRUE(lies_on(domain, Home(EntityKind::segment, side_at(domain, 0)), side));
  EXPECT_TRUE(lies_on(domain, Home(EntityKind::vertex, 1), side));
  EXPECT_FALSE(lies_on(domain, Home(EntityKind::vertex, 2), side));
  EXPECT_FALSE(lies_on(domain, Home(EntityKind::segment, side_at(domain, 1)), side));
  EXPECT_FALSE(lies_on(domain, Home(EntityKind::volume, 0), side));
}

}  // namespace pgdr::test_rule_insertion_rule
