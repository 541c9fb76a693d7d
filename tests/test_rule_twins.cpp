// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Needles: triangles whose corner is next to the opposite side. A side of one is split next to the points of the other, not in
// its middle. (Whole meshes of needles: tests/regressions/needle*.)
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "parallel_support.hpp"
#include "rule/twins.hpp"

namespace pgdr::test_rule_twins {

/// A body 2 high whose top is a fan of needles, `angle` apart, about one corner, no two of them coplanar.
Plc<3> body_with_fan(int needles, double angle) {
  Plc<3> plc;
  std::vector<Point2> rim{{{0, 0}}, {{0.9, -0.4}}};
  for (int i = 0; i <= needles; ++i) rim.push_back({{235 * std::cos(i * angle), 235 * std::sin(i * angle)}});
  rim.push_back({{0.8, 0.6}});
  const auto n = static_cast<std::uint32_t>(rim.size());
  for (std::uint32_t i = 0; i < n; ++i) plc.points.push_back({{rim[i][0], rim[i][1], -2}});
  for (std::uint32_t i = 0; i < n; ++i) plc.points.push_back({{rim[i][0], rim[i][1], i % 2 == 0 ? 1e-4 * i : 2e-4}});
  Plc<3>::Facet bottom{{{}}, {}, 0};
  for (std::uint32_t i = 0; i < n; ++i) bottom.polygons[0].push_back(i);
  plc.facets.push_back(bottom);
  for (std::uint32_t i = 0; i < n; ++i) plc.facets.push_back({{{i, (i + 1) % n, n + (i + 1) % n, n + i}}, {}, 0});
  for (std::uint32_t i = 1; i + 1 < n; ++i) plc.facets.push_back({{{n, n + i, n + i + 1}}, {}, 0});
  return plc;
}

/// From beds of printers, where the recovery went on to 2e-6 of the needles' length: each
/// side of a needle was split next to the points of its neighbours, not as far from the apex as they were.
TEST(Twins, OfAFanAreNotSplitTowardsTheirApex) {
  const Plc<3> plc = body_with_fan(10, 0.0033);
  RefineOptions<3> options;
  options.refine = false;
  options.radius_edge_bound = std::numeric_limits<double>::infinity();  // of the checker
  options.max_vertices = 20000;
  const RefineResult<3> recovered = test::expect_reproducible<3>(plc, options, "fan", test::two_if_quick);
  const Point3 apex = plc.points[plc.points.size() / 2];
  const auto near = [&](const Point3& x) { return squared_distance(x, apex) < 0.1 * 0.1; };
  EXPECT_EQ(std::count_if(recovered.mesh.points.begin(), recovered.mesh.points.end(), near), 1);
}

/// Two segments from one point at an angle of 0.001, of 8 and 5.
Domain<3> two_segments() {
  Plc<3> plc;
  plc.points = {{{0, 0, 0}}, {{8, 0, 0}}, {{5 * std::cos(0.001), 5 * std::sin(0.001), 0}}};
  plc.segments = {{{0, 1}, 0}, {{0, 2}, 0}};
  // A tetrahedron about them, as a domain needs a volume.
  for (const Point3& p : {Point3{{-20, -20, -20}}, Point3{{60, -20, -20}}, Point3{{-20, 60, -20}}, Point3{{-20, -20, 60}}})
    plc.points.push_back(p);
  plc.facets = {{{{3, 4, 5}}, {}, 0}, {{{3, 4, 6}}, {}, 0}, {{{3, 5, 6}}, {}, 0}, {{{4, 5, 6}}, {}, 0}};
  return Domain<3>(plc);
}

EntityId segment_between(const Domain<3>& domain, std::uint32_t a, std::uint32_t b) {
  const auto segments = domain.segments();
  const auto at = std::find_if(segments.begin(), segments.end(), [&](const DomainSegment& s) {
    return std::pair(std::min(s.points[0], s.points[1]), std::max(s.points[0], s.points[1])) == std::pair(a, b);
  });
  return static_cast<EntityId>(at - segments.begin());
}

TEST(TwinPlaces, IsAsFarFromTheCommonEndOrNextToAnInputVertex) {
  const Domain<3> domain = two_segments();
  const EntityId s = segment_between(domain, 0, 1), other = segment_between(domain, 0, 2);
  const auto on_other = [&](double radius) {
    return VertexRecord<3>{{{radius * std::cos(0.001), radius * std::sin(0.001), 0}}, Home(EntityKind::segment, other), 1};
  };
  TwinPlaces places(domain, s, 0, 1, Beside::as_far);
  EXPECT_FALSE(places.best());
  places.look_at(on_other(1));  // too near to the end of the piece
  EXPECT_FALSE(places.best());
  places.look_at(on_other(3));
  ASSERT_TRUE(places.best());
  EXPECT_DOUBLE_EQ(places.best()->x[0], 3);
  EXPECT_EQ(places.best()->apex, domain.segments()[s].points[0]);
  EXPECT_TRUE(is_twin(domain, s, *places.best(), on_other(3)));
  EXPECT_TRUE(is_twin(domain, s, *places.best(), on_other(3.00001)));
  EXPECT_FALSE(is_twin(domain, s, *places.best(), on_other(3.001)));
  EXPECT_FALSE(is_twin(domain, s, *places.best(), {{{3, 0, 0}}, Home(EntityKind::segment, s), 1}));
  places.look_at(on_other(4.5));  // nearer to the middle
  EXPECT_DOUBLE_EQ(places.best()->x[0], 4.5);
  TwinPlaces nearest(domain, s, 0.125, 1, Beside::nearest);
  nearest.look_at(on_other(3));
  ASSERT_TRUE(nearest.best());
  EXPECT_DOUBLE_EQ(nearest.best()->x[0], 3 * std::cos(0.001));
  EXPECT_TRUE(is_twin(domain, s, *nearest.best(), on_other(3)));
  TwinPlaces at_end(domain, s, 0, 0.75, Beside::nearest);
  at_end.look_at(on_other(3));
  ASSERT_TRUE(at_end.best());
  EXPECT_DOUBLE_EQ(at_end.best()->x[0], 3);

  TwinPlaces next_to_input(domain, s, 0, 1, Beside::as_far);
  next_to_input.look_at({domain.points()[2], Home(EntityKind::vertex, 2), 1});
  ASSERT_TRUE(next_to_input.best());
  EXPECT_DOUBLE_EQ(next_to_input.best()->x[0], domain.points()[2][0]);
  EXPECT_EQ(next_to_input.best()->apex, no_entity);

  TwinPlaces far_from_all(domain, s, 0, 1, Beside::as_far);
  far_from_all.look_at({{{4, 0.5, 0}}, Home(EntityKind::vertex, 2), 1});  // a twelfth of the piece away
  far_from_all.look_at({{{4, 0.001, 0}}, Home(EntityKind::volume, 0), 1});
  EXPECT_FALSE(far_from_all.best());
}

}  // namespace pgdr::test_rule_twins
