// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Vertices added to a planar triangulation: the record of triangles created and destroyed, agreement with a
// construction from scratch, and points of edges that are off them by their rounding.
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <set>

#include "oracles.hpp"
#include "pgdr/predicates.hpp"
#include "space/planar_cdt.hpp"

namespace pgdr::detail::test_space_planar_insert {

using Triangles = std::set<PlanarTriangle>;

PlanarTriangle canonical(PlanarTriangle t) {
  std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
  return t;
}

Triangles all_triangles(const PlanarTriangulation& t) {
  Triangles out;
  for (const auto& tri : t.triangles()) out.insert(canonical(tri));
  return out;
}

// The set after a change, from the set before it.
void replay(Triangles& set, const PlanarChange& change) {
  for (const auto& t : change.destroyed) EXPECT_EQ(set.erase(canonical(t)), 1u);
  for (const auto& t : change.created) EXPECT_TRUE(set.insert(canonical(t)).second);
}

std::vector<std::uint32_t> all_of(const std::vector<Point3>& points) {
  std::vector<std::uint32_t> v(points.size());
  std::iota(v.begin(), v.end(), 0u);
  return v;
}

class PlanarInsert : public testing::Test {
 protected:
  std::mt19937_64 random{oracle::seed()};
  double below(int n) { return static_cast<double>(random() % static_cast<unsigned>(n)); }
};

TEST_F(PlanarInsert, GivesTheTriangulationOfAllPoints) {
  for (int turn = 0; turn < 60; ++turn) {
    const int axis = turn % 3, u = (axis + 1) % 3, w = (axis + 2) % 3;
    const bool slanted = turn % 2 == 0;
    const auto point = [&](double x, double y) {
      Point3 p;
      p[u] = x;
      p[w] = y;
      p[axis] = slanted ? 2 * x - y : 1;
      return p;
    };
    std::vector<Point3> points{point(0, 0), point(16, 0), point(16, 16), point(0, 16), point(4, 4), point(12, 9)};
    std::vector<PlanarEdge> edges{{0, 1}, {1, 2}, {2, 3}, {3, 0}, {4, 5}};
    PlanarTriangulation t;
    ASSERT_TRUE(t.build(points, all_of(points), edges, axis));
    t.carve_outside();
    Triangles known = all_triangles(t);
    for (int k = 0; k < 40; ++k) {
      const Point3 p = point(below(19) - 1, below(17));
      PlanarChange change;
      const auto id = static_cast<std::uint32_t>(points.size());
      PlanarResult r = t.insert(id, p, &change);
      if (r.status == PlanarStatus::on_constraint) {
        const PlanarEdge e = r.edge;
        ASSERT_TRUE(t.is_constraint(e[0], e[1]));
        r = t.split_edge(e[0], e[1], id, p, &change);
        ASSERT_TRUE(r);
        edges.erase(std::find_if(edges.begin(), edges.end(),
                                 [&](const PlanarEdge& f) { return std::minmax(e[0], e[1]) == std::minmax(f[0], f[1]); }));
        edges.push_back({e[0], id});
        edges.push_back({id, e[1]});
      }
      if (!r) {
        ASSERT_EQ(r.status, p[u] < 0 || p[u] > 16 ? PlanarStatus::outside : PlanarStatus::coincident);
        ASSERT_FALSE(t.has_vertex(id));
        continue;
      }
      points.push_back(p);
      replay(known, change);
      ASSERT_EQ(known, all_triangles(t));
      ASSERT_TRUE(t.is_valid());
    }
    PlanarTriangulation s;
    ASSERT_TRUE(s.build(points, all_of(points), edges, axis));
    s.carve_outside();
    EXPECT_EQ(all_triangles(s), known);
  }
}

// A polygon in a generic plane, corners rounded, refined many times at rounded midpoints of its edges and at rounded
// points inside: all triangles stay positive, every piece of every edge stays there.
TEST_F(PlanarInsert, RoundedPointsOfAGenericPlane) {
  std::uniform_real_distribution<double> unit(-1, 1);
  int splits = 0, inserted = 0;
  for (int turn = 0; turn < 40; ++turn) {
    double e[2][3], origin[3];
    for (auto& v : e)
      for (double& x : v) x = unit(random);
    for (double& x : origin) x = (turn % 4 == 0 ? 1000 : 1) * unit(random);
    const double n[3] = {e[0][1] * e[1][2] - e[0][2] * e[1][1], e[0][2] * e[1][0] - e[0][0] * e[1][2],
                         e[0][0] * e[1][1] - e[0][1] * e[1][0]};
    int axis = 0;
    for (int i = 1; i < 3; ++i)
      if (std::fabs(n[i]) > std::fabs(n[axis])) axis = i;
    const auto point = [&](double a, double b) {
      Point3 p;
      for (int i = 0; i < 3; ++i) p[i] = origin[i] + a * e[0][i] + b * e[1][i];
      return p;
    };
    std::vector<Point3> points{point(0, 0), point(1, 0), point(1, 1), point(0.5, 0.001), point(0, 1)};
    std::vector<PlanarEdge> edges{{0, 1}, {1, 2}, {2, 3}, {3, 4}, {4, 0}};
    PlanarTriangulation t;
    ASSERT_TRUE(t.build(points, all_of(points), edges, axis));
    t.carve_outside();
    Triangles known = all_triangles(t);
    for (int k = 0; k < 300; ++k) {
      const auto id = static_cast<std::uint32_t>(points.size());
      PlanarChange change;
      const std::size_t which = random() % edges.size();
      const auto [a, b] = edges[which];
      Point3 p;
      PlanarResult r;
      if (k % 3 != 0) {
        for (int i = 0; i < 3; ++i) p[i] = 0.5 * points[a][i] + 0.5 * points[b][i];
        r = t.split_edge(a, b, id, p, &change);
        ASSERT_TRUE(r || r.status == PlanarStatus::inverted);
        if (r) edges[which] = {a, id};
        if (r) edges.push_back({id, b});
        splits += r.status == PlanarStatus::ok;
      } else {
        p = point(std::fabs(unit(random)), std::fabs(unit(random)));
        r = t.insert(id, p, &change);
        inserted += r.status == PlanarStatus::ok;
      }
      if (r) points.push_back(p);
      if (r) replay(known, change);
      ASSERT_TRUE(t.is_valid(false));
    }
    EXPECT_EQ(known, all_triangles(t));
    for (const auto& [a, b] : edges) ASSERT_TRUE(t.is_constraint(a, b));
  }
  EXPECT_GT(splits, 40 * 190);
  EXPECT_GT(inserted, 40 * 40);
}

// The point of the edge 0-1 lies beyond the flat triangle behind it: its neighbour is taken in, where no constraint is
// in the way.
TEST_F(PlanarInsert, APointOffItsEdgeTurnsNothingOver) {
  const std::vector<Point3> points{{0, 0, 0}, {8, 0, 0}, {4, 4, 0}, {6, -0.125, 0}, {4, -4, 0}};
  const Point3 off{3.5, -0.25, 0};
  std::vector<PlanarEdge> edges{{0, 1}, {0, 4}, {4, 1}, {1, 2}, {2, 0}};
  PlanarTriangulation t;
  ASSERT_TRUE(t.build(points, all_of(points), edges, 2));
  t.carve_outside();
  PlanarChange change;
  Triangles known = all_triangles(t);
  ASSERT_TRUE(t.split_edge(0, 1, 5, off, &change));
  replay(known, change);
  EXPECT_EQ(known, all_triangles(t));
  EXPECT_TRUE(t.is_valid());
  EXPECT_TRUE(t.is_constraint(0, 5) && t.is_constraint(5, 1));
  EXPECT_EQ(t.triangles().size(), 6u);

  edges.push_back({0, 3});
  ASSERT_TRUE(t.build(points, all_of(points), edges, 2));
  t.carve_outside();
  const Triangles before = all_triangles(t);
  EXPECT_EQ(t.split_edge(1, 0, 5, off).status, PlanarStatus::inverted);
  EXPECT_EQ(all_triangles(t), before);
  EXPECT_TRUE(t.is_valid());
  EXPECT_EQ(t.split_edge(2, 4, 5, off).status, PlanarStatus::no_such_edge);
  EXPECT_EQ(t.split_edge(2, 9, 5, off).status, PlanarStatus::no_such_edge);
}

// An edge of the hull, split by a point some way inside or outside.
TEST_F(PlanarInsert, HullEdgesMayBulge) {
  for (const double bulge : {-0.25, 0.0, 0.25}) {
    const std::vector<Point3> points{{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}};
    const std::vector<PlanarEdge> edges{{0, 1}, {1, 2}, {2, 3}, {3, 0}};
    PlanarTriangulation t;
    ASSERT_TRUE(t.build(points, all_of(points), edges, 2));
    t.carve_outside();
    Triangles known = all_triangles(t);
    PlanarChange change;
    std::uint32_t id = 4;
    for (const auto& [a, b, x] : {std::tuple{0u, 1u, 2.0}, {0u, 4u, 1.0}, {4u, 1u, 3.0}}) {
      ASSERT_TRUE(t.split_edge(a, b, id++, {x, bulge, 0}, &change));
      replay(known, change);
      ASSERT_EQ(known, all_triangles(t));
      ASSERT_TRUE(t.is_valid());
    }
    EXPECT_EQ(t.triangles().size(), 5u);  // what lies between the pieces and the new hull is not in the domain
  }
}

TEST_F(PlanarInsert, ManyPoints) {
  std::uniform_real_distribution<double> unit(0, 1);
  std::vector<Point3> points;
  for (int k = 0; k < 100000; ++k) points.push_back({unit(random), unit(random), 0});
  PlanarTriangulation t;
  ASSERT_TRUE(t.build(points, all_of(points), {}, 2));
  EXPECT_TRUE(t.is_valid());
}

}  // namespace pgdr::detail::test_space_planar_insert
