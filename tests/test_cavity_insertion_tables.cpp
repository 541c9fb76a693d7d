// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// What an insertion asks often, in the quick way and in the plain one.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <random>
#include <set>
#include <vector>

#include "cavity/delaunay.hpp"
#include "mesh/key_set.hpp"
#include "mesh/visit_area.hpp"
#include "numbers/simplex_shapes.hpp"
#include "rule/cell_bounds.hpp"

namespace pgdr::test_cavity_insertion_tables {

TEST(SmallNumbers, AreOfOneIdEach) {
  std::mt19937 random(7);
  SmallNumbers numbers;
  for (const std::uint32_t step : {1u, 2u, 64u, 512u, 1u << 26}) {  // among them ids that all want the same place
    numbers.reset();
    std::map<std::uint32_t, std::uint32_t> given;
    std::set<std::uint32_t> taken;
    while (given.size() < SmallNumbers::most) {
      const std::uint32_t id = step * (random() % 100) + 3;
      EXPECT_EQ(numbers.has(id), given.count(id) == 1);
      const std::uint32_t number = numbers.of(id);
      ASSERT_LT(number, SmallNumbers::bound);
      const auto [at, is_new] = given.try_emplace(id, number);
      EXPECT_EQ(at->second, number);
      EXPECT_EQ(taken.insert(number).second, is_new);
    }
  }
}

TEST(PairTable, FindsPartnersAndForgetsThem) {
  std::mt19937 random(8);
  PairTable table;
  for (const std::uint32_t pairs : {1u, 20u, 60u, 3000u}) {
    table.reserve(pairs);
    std::map<std::size_t, std::vector<std::uint32_t>> values;  // by slot
    std::size_t firsts = 0;
    for (std::uint32_t i = 0; i < pairs; ++i) {
      const std::size_t slot = table.slot_of(0x9e3779b97f4a7c15u * random());
      for (const std::uint32_t value : {2 * i, 2 * i + 1}) {
        firsts += table.add(slot, value) ? 1 : 0;
        values[slot].push_back(value);
      }
    }
    EXPECT_EQ(firsts, values.size());
    for (const auto& [slot, all] : values) {
      EXPECT_EQ(table.is_pair(slot), all.size() == 2);
      if (all.size() == 2) {
        EXPECT_EQ(table.partner(slot, all[0]), all[1]);
      }
      table.clear(slot);
      EXPECT_FALSE(table.is_pair(slot));
    }
  }
}

template <int D>
void expect_even_corners() {
  for (int face = 0; face <= D; ++face) {
    std::vector<int> all(face_corners<D>[face].begin(), face_corners<D>[face].end());
    all.push_back(face);
    int exchanges = 0;
    for (std::size_t i = 0; i < all.size(); ++i)
      for (std::size_t j = 0; j < i; ++j) exchanges += all[j] > all[i] ? 1 : 0;
    EXPECT_EQ(exchanges % 2, 0) << face;
    std::sort(all.begin(), all.end());
    for (int i = 0; i <= D; ++i) EXPECT_EQ(all[i], i);
  }
}
TEST(FaceCorners, AreAnEvenPermutationWithTheOppositeOne) {
  expect_even_corners<2>();
  expect_even_corners<3>();
}

/// Random points, some of them on a grid, and the cells between them.
template <int D>
struct Scattered {
  Mesh<D> mesh;
  typename Mesh<D>::Pools pools = mesh.make_pools();
  std::vector<CellId> cells;

  Scattered() {
    std::mt19937 random(9);
    std::set<Point<D>, bool (*)(const Point<D>&, const Point<D>&)> points(lex_less<D>);
    while (points.size() < 400) {
      Point<D> p;
      const bool on_grid = random() % 2 == 0;
      for (double& x : p.x) x = on_grid ? random() % 8 / 8.0 : random() / 4294967296.0;
      points.insert(p);
    }
    Delaunay<D> delaunay(mesh, pools);
    delaunay.build(std::vector<Point<D>>(points.begin(), points.end()));
    for (std::uint32_t i = 0; i < mesh.cell_bound(); ++i)
      if (mesh.alive(CellId{i}) && !mesh.is_ghost(CellId{i})) cells.push_back(CellId{i});
  }
  CellShape shape(CellId c) const {
    const Simplex<D> s = mesh.simplex(c);
    SimplexBlock<D> block;
    for (std::size_t lane = 0; lane < shape_lanes; ++lane)
      for (int i = 0; i <= D; ++i) block.set(lane, i, s[i]);
    ShapeBlock<D> out;
    simplex_shapes<D>({&block, 1}, {&out, 1});
    const auto [low, high] = mesh.squared_radius_bounds(c);
    return {out.shortest_edge_squared[0], low, high, out.det[0], out.det_error[0]};
  }
};

template <int D>
void expect_quick_answers() {
  const Scattered<D> s;
  using Answer = typename QuickBounds<D>::Answer;
  std::map<Answer, std::size_t> answers;
  for (const double size : {1e-4, 1e-3, 0.01, 0.06, 0.125, std::sqrt(3.0) / 16, 0.5, CellBounds<D>::infinity})
    for (const double ratio : {1.0, std::sqrt(2.0) / 2, 2.0, CellBounds<D>::infinity}) {
      CellBounds<D> bounds;
      bounds.radius_edge_bound = ratio;
      if (size < CellBounds<D>::infinity) bounds.size = size;
      const QuickBounds<D> quick(bounds);
      for (const CellId c : s.cells) {
        const CellShape shape = s.shape(c);
        const Answer answer = quick.look(shape);
        const CellVerdict verdict = bounds.test(s.mesh, c, shape);
        if (answer == Answer::within) {
          EXPECT_FALSE(verdict);
        }
        if (answer == Answer::over_size) {
          EXPECT_EQ(quick.over_size(shape), verdict.over_size);
          EXPECT_GE(verdict.over_size, 1u);
        }
        ++answers[answer];
      }
    }
  EXPECT_GT(answers[Answer::within], 1000u);
  EXPECT_GT(answers[Answer::over_size], 1000u);
  EXPECT_LT(answers[Answer::unknown], answers[Answer::within] + answers[Answer::over_size]);
}
TEST(QuickBounds, DecideAsTheBoundsDo2D) { expect_quick_answers<2>(); }
TEST(QuickBounds, DecideAsTheBoundsDo3D) { expect_quick_answers<3>(); }

TEST(QuickBounds, KnowNothingWhereSizesVary) {
  const Scattered<3> s;
  CellBounds<3> varying, by_region, by_volume;
  varying.size = [](const Point3& p) { return 0.1 + p[0]; };
  by_region.region_size = {SizingField<3>(0.1)};
  by_volume.max_measure = 1e-3;
  for (const CellBounds<3>& bounds : {varying, by_region, by_volume})
    EXPECT_EQ(QuickBounds<3>(bounds).look(s.shape(s.cells[0])), QuickBounds<3>::Answer::unknown);
}

/// Claims a box and nothing else.
struct BoxArea : VisitArea<3> {
  BoxArea(const Point3& low, const Point3& high) {
    home_low = inner_low = low;
    home_high = inner_high = high;
  }
  bool claimed(const Point3&) const override { return false; }
  std::uint32_t node_of(const Point3&, double) const override { return 0; }
};

TEST(VisitArea, CellsInConflictNoLargerThanThePointIsDeepAreOwned) {
  const Scattered<3> s;
  const BoxArea area({{0.125, 0.25, 0.125}}, {{0.875, 0.875, 0.75}});
  std::size_t quick = 0;
  for (const CellId at : s.cells) {
    const Point3& p = s.mesh.center(at);
    const double depth = area.squared_depth(p);
    EXPECT_EQ(depth > 0, p[0] > 0.125 && p[0] < 0.875 && p[1] > 0.25 && p[1] < 0.875 && p[2] > 0.125 && p[2] < 0.75);
    for (const CellId c : s.cells)
      if (s.mesh.conflicts(c, p) && 4 * s.mesh.squared_radius_bounds(c).second < depth) {
        EXPECT_TRUE(area.owns(s.mesh, s.mesh.cell(c).vertices));
        ++quick;
      }
  }
  EXPECT_GT(quick, 100u);
}

}  // namespace pgdr::test_cavity_insertion_tables
