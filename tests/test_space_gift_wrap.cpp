// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Gift wrapping against the Delaunay triangulation, where that is the answer, and where there is no answer.
#include "space/gift_wrap.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <random>

#include "cavity/delaunay.hpp"
#include "pgdr/predicates.hpp"

namespace pgdr::test_space_gift_wrap {

using Cells = std::vector<GiftWrap::Cell>;
using Faces = std::vector<GiftWrap::Face>;

Cells delaunay_cells(const std::vector<Point3>& points) {
  Mesh<3> mesh;
  auto pools = mesh.make_pools();
  Delaunay<3> delaunay(mesh, pools);
  EXPECT_TRUE(delaunay.build(points));
  std::map<VertexId, GiftWrap::Index> number;
  for (std::size_t i = 0; i < points.size(); ++i) number[delaunay.vertices()[i]] = static_cast<GiftWrap::Index>(i);
  Cells cells;
  for (std::uint32_t i = 0; i < mesh.cell_bound(); ++i) {
    const CellId c{i};
    if (!mesh.alive(c) || mesh.is_ghost(c)) continue;
    const auto& v = mesh.cell(c).vertices;
    cells.push_back({number[v[0]], number[v[1]], number[v[2]], number[v[3]]});
  }
  return cells;
}

Faces rim_of(const Cells& cells) {
  std::map<GiftWrap::Face, int> seen;
  for (const auto& c : cells)
    for (int i = 0; i < 4; ++i) seen[GiftWrap::face_of(c, i)] = 1;
  Faces rim;
  for (const auto& [f, n] : seen)
    if (!seen.contains(GiftWrap::turned_over(f))) rim.push_back(f);
  return rim;
}

Cells sorted(Cells cells) {
  for (auto& c : cells) std::sort(c.begin(), c.end());
  std::sort(cells.begin(), cells.end());
  return cells;
}

/// Generic points, or points of a small grid with many on common spheres.
std::vector<Point3> some_points(int n, bool on_grid, unsigned seed) {
  std::mt19937 random(seed);
  std::vector<Point3> points;
  while (static_cast<int>(points.size()) < n) {
    Point3 p;
    for (int i = 0; i < 3; ++i) p[i] = on_grid ? static_cast<double>(random() % 4) : random() * 0x1p-32;
    if (std::find(points.begin(), points.end(), p) == points.end()) points.push_back(p);
  }
  return points;
}

TEST(GiftWrap, FindsTheDelaunayTriangulationInEveryOrder) {
  for (unsigned seed = 0; seed < 40; ++seed) {
    const auto points = some_points(24, seed % 2 == 0, seed);
    const Cells cells = delaunay_cells(points);
    Faces front = rim_of(cells);
    std::mt19937 random(seed);
    std::shuffle(front.begin(), front.end(), random);
    GiftWrap wrap;
    ASSERT_TRUE(wrap.fill(points, front, 1000)) << seed;
    EXPECT_EQ(sorted(wrap.cells()), sorted(cells)) << seed;
  }
}

TEST(GiftWrap, KeepsWallsInsideTheRegion) {
  for (unsigned seed = 0; seed < 40; ++seed) {
    const auto points = some_points(24, seed % 2 == 0, seed);
    const Cells cells = delaunay_cells(points);
    Faces front = rim_of(cells);
    const std::size_t outer = front.size();
    for (std::size_t c = 0; c < cells.size() && front.size() < outer + 6; c += 7) {
      const GiftWrap::Face f = GiftWrap::face_of(cells[c], 2), back = GiftWrap::turned_over(f);
      if (std::find(front.begin(), front.end(), f) == front.end()) front.insert(front.end(), {f, back});
    }
    GiftWrap wrap;
    ASSERT_TRUE(wrap.fill(points, front, 1000)) << seed;
    EXPECT_EQ(sorted(wrap.cells()), sorted(cells)) << seed;
  }
}

/// A prism whose top is turned by 30 degrees, the diagonals of its sides pushed in or out.
Faces twisted_prism(bool reflex, std::vector<Point3>& points) {
  points.clear();
  for (int i = 0; i < 6; ++i) {
    const double angle = std::numbers::pi * (i % 3 * 2.0 / 3 + (i < 3 ? 0 : 1.0 / 6));
    points.push_back({{std::cos(angle), std::sin(angle), i < 3 ? -0.5 : 0.5}});
  }
  Faces front = {{0, 1, 2}, {3, 4, 5}};
  for (GiftWrap::Index i = 0; i < 3; ++i) {
    const auto j = static_cast<GiftWrap::Index>((i + 1) % 3);
    const auto a = i, b = j, c = static_cast<GiftWrap::Index>(j + 3), d = static_cast<GiftWrap::Index>(i + 3);
    if (reflex) {
      front.insert(front.end(), {{a, b, c}, {a, c, d}});
    } else {
      front.insert(front.end(), {{a, b, d}, {b, c, d}});
    }
  }
  const Point3 middle{};
  for (auto& f : front)
    if (orient3d(points[f[0]], points[f[1]], points[f[2]], middle) == Sign::negative) std::swap(f[1], f[2]);
  return front;
}

TEST(GiftWrap, GetsStuckWhereThereIsNoTriangulation) {
  std::vector<Point3> points;
  GiftWrap wrap;
  int filled = 0;
  for (const bool reflex : {false, true}) {
    const Faces front = twisted_prism(reflex, points);
    filled += wrap.fill(points, front, 100);
  }
  EXPECT_EQ(filled, 1);  // the convex one; the other is Schoenhardt's
}

TEST(GiftWrap, GivesUpAtItsLimit) {
  const auto points = some_points(24, false, 1);
  const Cells cells = delaunay_cells(points);
  GiftWrap wrap;
  EXPECT_FALSE(wrap.fill(points, rim_of(cells), cells.size() - 1));
  EXPECT_TRUE(wrap.fill(points, rim_of(cells), cells.size()));
}

TEST(GiftWrap, EndsWhenItIsToldTo) {
  const auto points = some_points(24, false, 1);
  const Cells cells = delaunay_cells(points);
  GiftWrap wrap;
  std::size_t asked = 0;
  EXPECT_FALSE(wrap.fill(points, rim_of(cells), cells.size(), [&] { return ++asked == 5; }));
  EXPECT_EQ(asked, 5u);
  EXPECT_TRUE(wrap.fill(points, rim_of(cells), cells.size(), [] { return false; }));
}

}  // namespace pgdr::test_space_gift_wrap
