// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Points computed on segments and facets, against rationals: how far they are from the exact line and plane, in ulps of
// the entity's largest coordinate; exactness along the axes; scaling. And the angles at which entities touch.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "domain_plcs.hpp"
#include "input/entities.hpp"
#include "oracles.hpp"
#include "pgdr/domain.hpp"
#include "pgdr/predicates.hpp"

namespace pgdr::test_input_point_on_entity {

using oracle::Rational;
using test::find_segment;
using Vector = std::array<Rational, 3>;

Vector minus(const Point3& a, const Point3& b) { return {Rational(a[0]) - b[0], Rational(a[1]) - b[1], Rational(a[2]) - b[2]}; }
Rational dot(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Vector cross(const Vector& a, const Vector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

double ulp(double magnitude) { return std::ldexp(1.0, std::ilogb(magnitude) - 52); }

// Squared distances, exactly.
Rational from_line(const Point3& p, const Point3& a, const Point3& b) {
  const Vector d = minus(b, a), n = cross(d, minus(p, a));
  return dot(n, n) / dot(d, d);
}
Rational from_plane(const Point3& p, const Point3& a, const Point3& b, const Point3& c) {
  const Vector n = cross(minus(b, a), minus(c, a));
  const Rational h = dot(n, minus(p, a));
  return h * h / dot(n, n);
}

// A facet abc, of any shape and place, with a fourth point to make a volume.
Plc<3> triangle(const Point3& a, const Point3& b, const Point3& c) {
  Plc<3> plc;
  plc.points = {a, b, c, {a[0] + 3, a[1] - 2, a[2] + 5}, {a[0] - 4, a[1] + 7, a[2] + 6}};
  plc.facets.push_back({{{0, 1, 2}}, {}, 0});
  return plc;
}

class PointOnEntity : public testing::Test {
 protected:
  std::mt19937_64 random{oracle::seed()};
  std::uniform_real_distribution<double> unit{-1, 1};
  Point3 anywhere(double scale, const Point3& shift = {}) {
    Point3 p;
    for (int i = 0; i < 3; ++i) p[i] = shift[i] + scale * unit(random);
    return p;
  }
};

TEST_F(PointOnEntity, WithinAnUlpOfLineAndPlane) {
  Rational worst_line = 0, worst_plane = 0;
  for (int turn = 0; turn < 3000; ++turn) {
    const Point3 shift = turn % 3 == 0 ? Point3{} : anywhere(std::ldexp(1, turn % 12));
    const double scale = std::ldexp(1, turn % 7 - 3);
    const Domain<3> d(triangle(anywhere(scale, shift), anywhere(scale, shift), anywhere(scale, shift)));
    const auto p = d.points();
    const EntityId s = static_cast<EntityId>(turn % 3);
    const auto [a, b] = d.segments()[s].points;
    const double t = 0.5 + 0.5 * unit(random);
    const Point3 x = point_on_segment(d, s, t);
    const Rational line_unit = ulp(d.segment_magnitude(s));
    worst_line = std::max<Rational>(worst_line, from_line(x, p[a], p[b]) / (line_unit * line_unit));
    const double length = std::sqrt(squared_distance(p[a], p[b]));
    EXPECT_NEAR(segment_parameter(d, s, x), t, 4 * ulp(d.segment_magnitude(s)) / length);

    Point3 y;  // somewhere about the triangle
    const double u = 0.5 + 0.5 * unit(random), v = (1 - u) * (0.5 + 0.5 * unit(random)), h = scale * unit(random);
    for (int i = 0; i < 3; ++i) y[i] = p[0][i] + u * (p[1][i] - p[0][i]) + v * (p[2][i] - p[0][i]) + (turn % 2) * h;
    const Point3 z = point_on_facet(d, 0, y);  // with h it may be outside of the triangle, and larger
    const double largest = std::max({d.facet_magnitude(0), std::fabs(z[0]), std::fabs(z[1]), std::fabs(z[2])});
    const Rational plane_unit = ulp(largest);
    worst_plane = std::max<Rational>(worst_plane, from_plane(z, p[0], p[1], p[2]) / (plane_unit * plane_unit));
    // Orthogonally: what was taken away is along the normal, but for the rounding.
    const Vector n = cross(minus(p[1], p[0]), minus(p[2], p[0])), moved = minus(z, y);
    const Vector off = cross(n, moved);
    EXPECT_LE(CGAL::to_double(Rational(dot(off, off) / dot(n, n))), std::pow(4 * ulp(d.facet_magnitude(0) + scale), 2));
  }
  EXPECT_LE(worst_line, 1);
  EXPECT_LE(worst_plane, 1);
}

// Half an ulp a coordinate is what rounding costs; double-double adds nothing to it that can be seen.
TEST_F(PointOnEntity, RoundedOnce) {
  for (int turn = 0; turn < 2000; ++turn) {
    const Domain<3> d(triangle(anywhere(1), anywhere(1), anywhere(1)));
    const auto [a, b] = d.segments()[0].points;
    const double t = 0.5 + 0.5 * unit(random);
    const Point3 x = point_on_segment(d, 0, t);
    for (int i = 0; i < 3; ++i) {
      const Rational p(d.points()[a][i]), q(d.points()[b][i]);
      const Rational exact = p + Rational(t) * (q - p), error = abs(Rational(x[i]) - exact);
      EXPECT_LE(error, abs(Rational(std::nextafter(x[i], 9.0)) - exact));
      EXPECT_LE(error, abs(Rational(std::nextafter(x[i], -9.0)) - exact));
    }
  }
}

TEST_F(PointOnEntity, ExactAlongTheAxes) {
  const Domain<3> d(test::box());
  for (EntityId s = 0; s < d.segments().size(); ++s) {
    const Point3 &a = d.points()[d.segments()[s].points[0]], &b = d.points()[d.segments()[s].points[1]];
    for (int k = 1; k < 20; ++k) {
      const Point3 x = point_on_segment(d, s, k / 20.3);
      EXPECT_TRUE(collinear(a, b, x));
      EXPECT_TRUE(lex_less(a, x) && lex_less(x, b));
    }
  }
  for (EntityId f = 0; f < d.facets().size(); ++f)
    for (int k = 0; k < 100; ++k) {
      const Point3 x = point_on_facet(d, f, anywhere(4));
      const auto& t = d.triangles(f)[0];
      EXPECT_EQ(orient3d(d.points()[t[0]], d.points()[t[1]], d.points()[t[2]], x), Sign::zero);
    }
  // A plane parallel to one axis: that coordinate stays.
  const Domain<3> slope(triangle({0, 0, 0}, {3, 1, 0}, {0, 0, 7}));
  const Point3 x = point_on_facet(slope, 0, {1, 1, 1.0 / 3});
  EXPECT_EQ(x[2], 1.0 / 3);
}

TEST_F(PointOnEntity, ScalesByPowersOfTwo) {
  for (int turn = 0; turn < 200; ++turn) {
    const std::array<Point3, 3> corner{anywhere(1), anywhere(1), anywhere(1)};
    const Point3 y = anywhere(1);
    const double t = 0.5 + 0.5 * unit(random);
    const auto points = [&](int k) {
      const auto up = [&](Point3 p) {
        for (double& c : p.x) c = std::ldexp(c, k);
        return p;
      };
      Plc<3> plc = triangle(corner[0], corner[1], corner[2]);
      for (auto& p : plc.points) p = up(p);
      const Domain<3> d(plc);
      std::array<Point3, 2> out{point_on_segment(d, 0, t), point_on_facet(d, 0, up(y))};
      for (auto& p : out)
        for (double& c : p.x) c = std::ldexp(c, -k);
      return out;
    };
    const auto plain = points(0);
    for (const int k : {-400, -100, 100, 400, 800, 1000}) EXPECT_EQ(points(k), plain);
  }
}

// The fourth corner of the quadrilateral is off the plane of the others: x goes to the plane of the triangle under it.
TEST_F(PointOnEntity, BentFacet) {
  Plc<3> plc = test::box();
  plc.points[6][2] = 3 + 0x1p-13;
  const Domain<3> d(plc);
  ASSERT_FALSE(d.facets()[1].planar);
  EXPECT_NEAR(d.facets()[1].planarity_defect, 0x1p-13, 0x1p-16);
  const auto triangles = d.triangles(1);
  ASSERT_EQ(triangles.size(), 2u);
  const auto p = d.points();
  for (const auto& t : triangles) {
    Point3 x;
    for (int i = 0; i < 3; ++i) x[i] = 0.25 * p[t[0]][i] + 0.5 * p[t[1]][i] + 0.25 * p[t[2]][i];
    const Point3 y = point_on_facet(d, 1, x);
    EXPECT_LE(from_plane(y, p[t[0]], p[t[1]], p[t[2]]), Rational(ulp(3) * ulp(3)));
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(x[i], y[i], 1e-15);
  }
  const Point3 outside = point_on_facet(d, 1, {-1, 0.4, 3});
  EXPECT_LT(outside[0], -0.5);
}

TEST_F(PointOnEntity, Plane2) {
  Plc<2> plc;
  plc.points = {{0, 0}, {1, 3}, {-2, 5}};
  plc.segments = {{{0, 1}, 0}, {{1, 2}, 0}};
  const Domain<2> d(plc);
  const EntityId s = find_segment(d, 0, 1);
  EXPECT_EQ(point_on_segment(d, s, 0.5), (Point2{0.5, 1.5}));
  EXPECT_EQ(segment_parameter(d, s, Point2{0.25, 0.75}), 0.25);
  EXPECT_EQ(segment_parameter(d, s, Point2{5, 5}), 1);
  EXPECT_EQ(segment_parameter(d, s, Point2{-5, 5}), 1);
  EXPECT_EQ(segment_parameter(d, s, Point2{-5, -5}), 0);
}

constexpr EntityRef segment(EntityId s) { return {EntityKind::segment, s}; }
constexpr EntityRef facet(EntityId f) { return {EntityKind::facet, f}; }
constexpr EntityRef vertex(std::uint32_t v) { return {EntityKind::vertex, v}; }

TEST(EntityAngle, BoxIsRectangular) {
  const Domain<3> d(test::box());
  for (EntityId f = 0; f < 6; ++f)
    for (EntityId g = 0; g < 6; ++g) {
      const bool opposite = (f < 2 && g < 2) || (f >= 2 && g >= 2 && (f ^ g) == 6);
      EXPECT_EQ(entity_angle(d, facet(f), facet(g)), f == g || opposite ? 180 : 90);
      EXPECT_EQ(entities_touch(d, facet(f), facet(g)), f == g || !opposite);
    }
  const EntityId s = find_segment(d, 0, 1), t = find_segment(d, 1, 2), u = find_segment(d, 6, 7);
  EXPECT_EQ(entity_angle(d, segment(s), segment(t)), 90);
  EXPECT_EQ(entity_angle(d, segment(s), segment(u)), 180);
  EXPECT_EQ(entity_angle(d, segment(s), segment(s)), 180);
  EXPECT_EQ(entity_angle(d, segment(s), facet(0)), 180);  // part of it
  EXPECT_EQ(entity_angle(d, facet(3), segment(s)), 90);
  EXPECT_TRUE(entities_touch(d, segment(s), facet(0)));
  EXPECT_FALSE(entities_touch(d, segment(s), facet(1)));
  EXPECT_TRUE(entities_touch(d, vertex(0), facet(0)));
  EXPECT_TRUE(entities_touch(d, segment(s), vertex(1)));
  EXPECT_FALSE(entities_touch(d, segment(s), vertex(2)));
  EXPECT_FALSE(entities_touch(d, vertex(3), vertex(2)));
  EXPECT_FALSE(entities_touch(d, facet(0), {}));
  EXPECT_EQ(entity_angle(d, facet(0), {}), 180);
}

/// Pairs of facets with many points are looked up, others are compared point by point: plates whose top has 50 more points along
/// each of two edges, which the walls there have too.
TEST(Domain, FacetsWithManyPointsTouchWhereTheyShareOne) {
  Plc<3> plc;
  constexpr std::uint32_t more = 50;
  std::vector<Point2> rim;
  for (std::uint32_t i = 0; i <= more; ++i) rim.push_back({{static_cast<double>(i), 0}});
  rim.push_back({{more, 10}});
  for (std::uint32_t i = 0; i <= more; ++i) rim.push_back({{static_cast<double>(more - i), 20}});
  const auto n = static_cast<std::uint32_t>(rim.size());
  for (const double z : {0., 1.})
    for (const Point2& p : rim) plc.points.push_back({{p[0], p[1], z}});
  for (const std::uint32_t first : {0u, n}) {
    plc.facets.push_back({{{}}, {}, 0});
    for (std::uint32_t i = 0; i < n; ++i) plc.facets.back().polygons[0].push_back(first + i);
  }
  for (std::uint32_t i = 0; i < n; ++i) plc.facets.push_back({{{i, (i + 1) % n, n + (i + 1) % n, n + i}}, {}, 0});
  const Domain<3> d(plc);
  std::size_t large = 0;
  for (EntityId f = 0; f < d.facets().size(); ++f) {
    large += d.facet_points(f).size() > more ? 1 : 0;
    for (EntityId g = 0; g < d.facets().size(); ++g) {
      const auto a = d.facet_points(f), b = d.facet_points(g);
      std::vector<std::uint32_t> common;
      std::set_intersection(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(common));
      EXPECT_EQ(d.facets_touch(f, g), !common.empty()) << f << " " << g;
    }
  }
  EXPECT_EQ(large, 4u);  // top, bottom and two walls
}

TEST(EntityAngle, KnownAngles) {
  Plc<3> plc;
  // A triangle in z = 0, one at 30 degrees on its edge 0-1, one that shares point 0 alone, and a loose segment.
  const double h = std::tan(std::acos(-1) / 6);
  plc.points = {{0, 0, 0}, {4, 0, 0}, {2, 3, 0}, {2, 3, 3 * h}, {-1, -1, 0}, {-1, -1, 2}, {1, 1, std::sqrt(2.0)}};
  for (const auto& t : {std::vector<std::uint32_t>{0, 1, 2}, {0, 1, 3}, {0, 4, 5}}) plc.facets.push_back({{t}, {}, 0});
  plc.segments.push_back({{0, 6}, 0});
  const Domain<3> d(plc);
  EXPECT_NEAR(entity_angle(d, facet(0), facet(1)), 30, 1e-12);
  const EntityId loose = find_segment(d, 0, 6);
  EXPECT_NEAR(entity_angle(d, segment(loose), facet(0)), 45, 1e-12);  // its shadow falls into the triangle
  const double c = std::acos(-1 / std::sqrt(2.0)) * 180 / std::acos(-1);
  EXPECT_NEAR(entity_angle(d, facet(0), facet(2)), std::acos(-1 / std::sqrt(6.0)) * 180 / std::acos(-1), 1e-12);
  EXPECT_NEAR(entity_angle(d, segment(find_segment(d, 0, 1)), segment(find_segment(d, 0, 4))), c, 1e-12);
  EXPECT_EQ(entity_angle(d, segment(find_segment(d, 4, 5)), facet(0)), 180);
}

// 60 and 90 degrees of turned corners: as the exact predicates say.
TEST(EntityAngle, AgreesWithTheExactTests) {
  std::mt19937_64 random(oracle::seed());
  for (int turn = 0; turn < 500; ++turn) {
    Plc<2> plc;
    const auto near = [&](double x) { return x * (1 + (static_cast<double>(random() % 9) - 4) * 0x1p-52); };
    const double a = 1e-3 * static_cast<double>(random() % 6000), step = std::acos(-1) / (turn % 2 == 0 ? 3 : 2);
    plc.points = {{0, 0}, {near(std::cos(a)), near(std::sin(a))}, {near(std::cos(a + step)), near(std::sin(a + step))}};
    if (turn % 5 == 0) plc.points[2] = {-plc.points[1][1], plc.points[1][0]};
    plc.segments = {{{0, 1}, 0}, {{0, 2}, 0}};
    const Domain<2> d(plc);
    const double angle = entity_angle(d, segment(0), segment(1));
    EXPECT_EQ(angle < 60, angle_below_60(plc.points[0], plc.points[1], plc.points[2]));
    EXPECT_EQ(angle < 90, angle_below_90(plc.points[0], plc.points[1], plc.points[2]));
  }
}

}  // namespace pgdr::test_input_point_on_entity
