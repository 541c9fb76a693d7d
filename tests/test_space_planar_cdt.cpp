// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The planar triangulation against its definition: no visible point in any circle, all constraints present, one result
// whatever the order and the names of the points; its answers to impossible requests; insertion and its record.
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <set>

#include "oracles.hpp"
#include "pgdr/predicates.hpp"
#include "space/planar_cdt.hpp"

namespace pgdr::detail::test_space_planar_cdt {

using oracle::Rational;

struct Plane {  // carries (u, w) to a point of a plane that is exactly representable for small integers
  int axis;
  bool slanted;
  Point3 operator()(double u, double w) const {
    Point3 p;
    p[(axis + 1) % 3] = u;
    p[(axis + 2) % 3] = w;
    p[axis] = slanted ? 3 + u - 0.5 * w : -2;
    return p;
  }
};

const std::vector<Plane> planes{{0, false}, {1, false}, {2, false}, {0, true}, {1, true}, {2, true}};

struct Uv {
  double u, w;
  bool operator<(const Uv& o) const { return u != o.u ? u < o.u : w < o.w; }
};

// Distinct points of several kinds: random, a grid, a few circles with all their ties, many on common lines.
std::vector<std::vector<Uv>> families(std::mt19937_64& random) {
  const auto below = [&](int n) { return static_cast<double>(random() % static_cast<unsigned>(n)); };
  std::vector<std::set<Uv>> sets(5);
  for (int k = 0; k < 40; ++k) {
    sets[0].insert({below(1 << 20), below(1 << 20)});
    sets[1].insert({below(6), below(6)});
    sets[3].insert({below(40), below(3)});
  }
  for (const auto& [x, y] : {std::pair{25, 0}, {7, 24}, {15, 20}, {20, 15}, {24, 7}, {0, 25}})
    for (const int r : {1, 2})
      for (const int s : {-1, 1})
        for (const int t : {-1, 1}) sets[2].insert({static_cast<double>(s * r * x), static_cast<double>(t * r * y)});
  sets[2].insert({0, 0});
  for (int i = 0; i < 20; ++i) sets[4].insert({static_cast<double>(i), i == 7 ? 1.0 : 0.0});
  std::vector<std::vector<Uv>> out;
  for (const auto& s : sets) out.emplace_back(s.begin(), s.end());
  return out;
}

std::vector<Point3> placed(const std::vector<Uv>& uv, const Plane& plane) {
  std::vector<Point3> points;
  for (const Uv& p : uv) points.push_back(plane(p.u, p.w));
  return points;
}

std::vector<std::uint32_t> all_of(const std::vector<Point3>& points) {
  std::vector<std::uint32_t> v(points.size());
  std::iota(v.begin(), v.end(), 0u);
  return v;
}

// As corner points, each triangle and the list in a fixed order: what was triangulated, whatever the names.
std::vector<std::array<Point3, 3>> shape(const PlanarTriangulation& t, const std::vector<Point3>& points) {
  std::vector<std::array<Point3, 3>> out;
  const auto less = [](const Point3& a, const Point3& b) { return lex_less(a, b); };
  for (const auto& [a, b, c] : t.triangles()) {
    std::array<Point3, 3> corners{points[a], points[b], points[c]};
    std::sort(corners.begin(), corners.end(), less);
    out.push_back(corners);
  }
  std::sort(out.begin(), out.end(), [&](const auto& a, const auto& b) {
    return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end(), less);
  });
  return out;
}

Rational doubled_area(const PlanarTriangulation& t, const std::vector<Point3>& points) {
  Rational sum = 0;
  const int u = (t.axis() + 1) % 3, w = (t.axis() + 2) % 3;
  const auto term = [&](const Point3& p, const Point3& q) { return Rational(p[u]) * q[w] - Rational(p[w]) * q[u]; };
  for (const auto& [a, b, c] : t.triangles())
    sum += term(points[a], points[b]) + term(points[b], points[c]) + term(points[c], points[a]);
  return sum;
}

// Constraints that fit, of `tries` random ones.
std::vector<PlanarEdge> random_constraints(const std::vector<Point3>& points, int axis, int tries, std::mt19937_64& random) {
  PlanarTriangulation t;
  std::vector<PlanarEdge> edges;
  const auto v = all_of(points);
  for (int k = 0; k < tries; ++k) {
    const auto n = static_cast<std::uint32_t>(points.size());
    edges.push_back({static_cast<std::uint32_t>(random() % n), static_cast<std::uint32_t>(random() % n)});
    if (!t.build(points, v, edges, axis)) edges.pop_back();
  }
  return edges;
}

class PlanarCdt : public testing::Test {
 protected:
  std::mt19937_64 random{oracle::seed()};
};

TEST_F(PlanarCdt, NoPointInAnyCircle) {
  for (const auto& uv : families(random))
    for (const Plane& plane : planes) {
      const auto points = placed(uv, plane);
      PlanarTriangulation t;
      ASSERT_TRUE(t.build(points, all_of(points), {}, plane.axis));
      ASSERT_TRUE(t.is_valid());
      std::set<std::uint32_t> seen;
      for (const auto& tri : t.triangles()) {
        seen.insert(tri.begin(), tri.end());
        for (std::uint32_t v = 0; v < points.size(); ++v) {
          if (v == tri[0] || v == tri[1] || v == tri[2]) continue;
          ASSERT_EQ(in_circle_perturbed(points[tri[0]], points[tri[1]], points[tri[2]], points[v], plane.axis), Sign::negative);
        }
      }
      EXPECT_EQ(seen.size(), points.size());
    }
}

TEST_F(PlanarCdt, OneResultWhateverOrderAndNames) {
  for (const auto& uv : families(random))
    for (const Plane& plane : planes) {
      const auto points = placed(uv, plane);
      const auto edges = random_constraints(points, plane.axis, 12, random);
      PlanarTriangulation t;
      ASSERT_TRUE(t.build(points, all_of(points), edges, plane.axis));
      ASSERT_TRUE(t.is_valid());
      for (int turn = 0; turn < 10; ++turn) {
        auto name = all_of(points);
        std::shuffle(name.begin(), name.end(), random);
        std::vector<Point3> renamed(points.size());
        for (std::size_t v = 0; v < points.size(); ++v) renamed[name[v]] = points[v];
        auto turned = edges;
        for (auto& e : turned) e = {name[e[1]], name[e[0]]};
        std::shuffle(turned.begin(), turned.end(), random);
        auto order = all_of(points);
        std::shuffle(order.begin(), order.end(), random);
        PlanarTriangulation s;
        ASSERT_TRUE(s.build(renamed, order, turned, plane.axis));
        ASSERT_EQ(shape(s, renamed), shape(t, points));
      }
    }
}

TEST_F(PlanarCdt, ConstraintsArePresentAndNothingIsLost) {
  int edges_forced = 0;
  for (int turn = 0; turn < 100; ++turn)
    for (const auto& uv : families(random)) {
      const Plane& plane = planes[static_cast<std::size_t>(turn) % planes.size()];
      const auto points = placed(uv, plane);
      PlanarTriangulation plain, t;
      ASSERT_TRUE(plain.build(points, all_of(points), {}, plane.axis));
      const auto edges = random_constraints(points, plane.axis, 25, random);
      ASSERT_TRUE(t.build(points, all_of(points), edges, plane.axis));
      ASSERT_TRUE(t.is_valid());
      EXPECT_EQ(doubled_area(t, points), doubled_area(plain, points));
      for (const auto& [a, b] : edges) {
        if (a == b) continue;
        EXPECT_TRUE(t.is_constraint(a, b));
        edges_forced += !plain.has_edge(a, b);
      }
      EXPECT_EQ(t.triangles().size(), plain.triangles().size());
    }
  EXPECT_GT(edges_forced, 100);
}

// A comb of constraints whose free ends point at a line that then is forced through them: chains with dangling edges.
TEST_F(PlanarCdt, ForcedEdgesPassDanglingOnes) {
  for (const Plane& plane : planes) {
    std::vector<Point3> points;
    std::vector<PlanarEdge> edges;
    points.push_back(plane(-10, 0));
    points.push_back(plane(50, 0));
    for (int i = 0; i < 12; ++i) {
      const double s = i % 2 == 0 ? 1 : -1;
      points.push_back(plane(3 * i, s * 20));
      points.push_back(plane(3 * i + 1, s * (1 + i % 5)));
      const auto n = static_cast<std::uint32_t>(points.size());
      edges.push_back({n - 2, n - 1});
    }
    edges.push_back({0, 1});
    PlanarTriangulation t;
    ASSERT_TRUE(t.build(points, all_of(points), edges, plane.axis));
    EXPECT_TRUE(t.is_valid());
    for (const auto& [a, b] : edges) EXPECT_TRUE(t.is_constraint(a, b));
  }
}

TEST_F(PlanarCdt, SaysWhatIsImpossible) {
  const Plane plane{1, true};
  const std::vector<Point3> points{plane(0, 0), plane(4, 0), plane(4, 4), plane(0, 4), plane(2, 2), plane(8, 8)};
  const std::vector<std::uint32_t> line{0, 4, 2}, square{0, 1, 2, 3}, all{0, 1, 2, 3, 4, 5};
  PlanarTriangulation t;
  EXPECT_EQ(t.build(points, line, {}, 1).status, PlanarStatus::collinear);
  EXPECT_EQ(t.build(points, std::vector<std::uint32_t>{0, 1}, {}, 1).status, PlanarStatus::collinear);
  PlanarResult r = t.build(points, square, std::vector<PlanarEdge>{{0, 2}, {1, 3}}, 1);
  EXPECT_EQ(r.status, PlanarStatus::edges_cross);
  EXPECT_EQ(r.edge, (PlanarEdge{1, 3}));
  EXPECT_EQ((std::set{r.other[0], r.other[1]}), (std::set{0u, 2u}));
  EXPECT_EQ(t.vertex_count(), 0u);
  r = t.build(points, all, std::vector<PlanarEdge>{{1, 3}}, 1);
  EXPECT_EQ(r.status, PlanarStatus::point_on_edge);
  EXPECT_EQ(r.other[0], 4u);
  r = t.build(points, all, std::vector<PlanarEdge>{{5, 4}}, 1);
  EXPECT_EQ(r.status, PlanarStatus::point_on_edge);
  EXPECT_EQ(r.other[0], 2u);
  EXPECT_EQ(t.build(points, square, std::vector<PlanarEdge>{{0, 9}}, 1).status, PlanarStatus::no_such_edge);
  // (2, 2) and a point right behind it.
  std::vector<Point3> stacked = points;
  stacked.push_back(points[4]);
  stacked.back()[1] += 1;
  r = t.build(stacked, std::vector<std::uint32_t>{0, 1, 2, 3, 4, 6}, {}, 1);
  EXPECT_EQ(r.status, PlanarStatus::coincident);
  EXPECT_EQ((std::set{r.edge[0], r.edge[1]}), (std::set{4u, 6u}));
}

// A square ring with a loose edge in it.
struct Ring {
  Plane plane;
  std::vector<Point3> points;
  std::vector<PlanarEdge> edges;
  explicit Ring(Plane p) : plane(p) {
    for (const double r : {8.0, 2.0})
      for (const auto& [u, w] : {std::pair{-r, -r}, {r, -r}, {r, r}, {-r, r}}) points.push_back(plane(u, w));
    points.push_back(plane(4, 5));
    points.push_back(plane(6, 5));
    for (std::uint32_t k = 0; k < 4; ++k) {
      edges.push_back({k, (k + 1) % 4});
      edges.push_back({4 + k, 4 + (k + 1) % 4});
    }
    edges.push_back({8, 9});
  }
};

TEST_F(PlanarCdt, DomainsByCarvingAndByKeeping) {
  for (const Plane& plane : planes) {
    const Ring ring(plane);
    PlanarTriangulation t;
    ASSERT_TRUE(t.build(ring.points, all_of(ring.points), ring.edges, plane.axis));
    t.carve_outside();
    EXPECT_EQ(doubled_area(t, ring.points), 2 * 256);
    EXPECT_EQ(t.carve_hole(plane(2, 0)).status, PlanarStatus::on_constraint);
    EXPECT_EQ(t.carve_hole(plane(8, 8)).status, PlanarStatus::on_constraint);
    EXPECT_EQ(t.carve_hole(plane(9, 0)).status, PlanarStatus::outside);
    EXPECT_TRUE(t.carve_hole(plane(0.5, 0.25)));
    EXPECT_EQ(t.carve_hole(plane(0.5, 0.25)).status, PlanarStatus::outside);
    EXPECT_EQ(doubled_area(t, ring.points), 2 * 240);
    EXPECT_TRUE(t.is_valid());
    const auto before = shape(t, ring.points);
    // The same by its sides. Counter-clockwise in the projection.
    t.keep_left_of(std::vector<PlanarEdge>{{0, 1}});
    EXPECT_EQ(shape(t, ring.points), before);
    t.keep_left_of(std::vector<PlanarEdge>{{4, 5}, {1, 3}});
    EXPECT_EQ(doubled_area(t, ring.points), 2 * 16);
  }
}

TEST_F(PlanarCdt, ConstrainKeepsToTheDomain) {
  for (const Plane& plane : planes) {
    const Ring ring(plane);
    PlanarTriangulation t;
    ASSERT_TRUE(t.build(ring.points, all_of(ring.points), ring.edges, plane.axis));
    t.carve_outside();
    ASSERT_TRUE(t.carve_hole(plane(0, 0)));
    EXPECT_EQ(t.constrain(4, 6).status, PlanarStatus::outside);
    EXPECT_EQ(t.constrain(0, 2).status, PlanarStatus::point_on_edge);  // the corners of the hole are on the diagonal
    EXPECT_EQ(t.constrain(0, 8).status, PlanarStatus::edges_cross);
    EXPECT_EQ(t.constrain(0, 77).status, PlanarStatus::no_such_edge);
    EXPECT_TRUE(t.constrain(1, 8));
    EXPECT_TRUE(t.is_constraint(8, 1));
    EXPECT_TRUE(t.is_valid());
    EXPECT_EQ(doubled_area(t, ring.points), 2 * 240);
  }
}

}  // namespace pgdr::detail::test_space_planar_cdt
