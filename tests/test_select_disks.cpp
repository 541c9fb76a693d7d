// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Radii of the selection disks: the formulas of both types in both dimensions, and where there is no disk.
#include <gtest/gtest.h>

#include "dimensions.hpp"
#include "pgdr/point_selector.hpp"

namespace pgdr::test_select_disks {

template <class Dimension>
class Disks : public testing::Test {};
TYPED_TEST_SUITE(Disks, test::Dimensions);

template <int D>
PoorElement<D> poor_element(double radius, double shortest, double bound) {
  PoorElement<D> e;
  e.circumcenter.x.fill(7);
  e.circumradius = radius;
  e.shortest_edge = shortest;
  e.radius_edge_bound = bound;
  e.over_radius_edge = true;
  return e;
}

constexpr double k_of(int d) { return d == 2 ? 1.4142135623730951 : 2; }

TYPED_TEST(Disks, RadiiOfBothTypes) {
  constexpr int D = TypeParam::value;
  constexpr double k = k_of(D);
  const PoorElement<D> e = poor_element<D>(10, 2, 4);
  const auto radius = [&](DiskOptions o) { return selection_disk<D>(e, o).radius; };
  EXPECT_EQ(radius({DiskType::type1}), 10 - k * 2);
  EXPECT_EQ(radius({DiskType::type2}), 10 * (1 - k / 4));
  EXPECT_EQ(radius({DiskType::type2, 0.75}), 2.5);
  EXPECT_EQ(radius({DiskType::type2, 1}), 0);
  EXPECT_EQ(selection_disk<D>(e, {}).center, e.circumcenter);
  EXPECT_EQ(radius({}), radius({DiskType::type2}));
}

// Type II lies in type I wherever the element is poor (r > bound * l).
TYPED_TEST(Disks, TypeTwoLiesInTypeOne) {
  constexpr int D = TypeParam::value;
  for (const double bound : {2.0, 2.5, 4.0, 100.0})
    for (const double ratio : {1.001, 2.0, 50.0}) {
      const PoorElement<D> e = poor_element<D>(bound * ratio, 1, bound);
      EXPECT_LE(selection_disk<D>(e, {DiskType::type2}).radius, selection_disk<D>(e, {DiskType::type1}).radius);
    }
}

TYPED_TEST(Disks, NoDiskWithoutATheorem) {
  constexpr int D = TypeParam::value;
  for (const DiskType type : {DiskType::type1, DiskType::type2}) {
    PoorElement<D> big = poor_element<D>(10, 9, 4);
    big.over_radius_edge = false;
    EXPECT_EQ(selection_disk<D>(big, {type}).radius, 0);
    EXPECT_EQ(selection_disk<D>(big, {type}).center, big.circumcenter);
  }
  EXPECT_EQ(selection_disk<D>(poor_element<D>(10, 1, 0.99 * k_of(D)), {DiskType::type2}).radius, 0);
  EXPECT_EQ(selection_disk<D>(poor_element<D>(1, 0.99, 0.5), {DiskType::type1}).radius, 0);
  EXPECT_EQ(selection_disk<D>(poor_element<D>(10, 1, k_of(D)), {DiskType::type2}).radius, 0);
  EXPECT_GT(selection_disk<D>(poor_element<D>(10, 1, k_of(D)), {DiskType::type1}).radius, 0);
  // That of type I does not depend on the bound: the insertion rule sees to the end of the run.
  EXPECT_EQ(selection_disk<D>(poor_element<D>(10, 1, 0.5), {DiskType::type1}).radius, 10 - k_of(D));
}

TYPED_TEST(Disks, ScaleWithTheElement) {
  constexpr int D = TypeParam::value;
  for (const DiskType type : {DiskType::type1, DiskType::type2})
    EXPECT_EQ(selection_disk<D>(poor_element<D>(0x1.8p-80, 0x1.3p-82, 3), {type}).radius,
              0x1p-80 * selection_disk<D>(poor_element<D>(1.5, 0x1.3p-2, 3), {type}).radius);
}

}  // namespace pgdr::test_select_disks
