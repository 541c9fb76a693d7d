// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The checker's own decisions: what rounding may explain, the volumes of an input.
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <random>

#include "check/bounds.hpp"
#include "dimensions.hpp"
#include "enclosed/input_volumes.hpp"
#include "given/cover.hpp"
#include "given/given_facet.hpp"
#include "given/segment_chain.hpp"
#include "numbers/exact_tests.hpp"
#include "pgdr/predicates.hpp"
#include "test_check_models.hpp"

namespace test_check_exact {

using namespace pgdr;
using namespace pgdr::checking;
using namespace pgdr::test;

// The bound of the change is sharp to first order: a violation of a hundredth of what a corner's move does is cancelled
// by a move of a hundredth, not by much less.
TEST(CheckExact, RoundingCancelsWhatItCanReach) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> coordinate(0, 1);
  for (int trial = 0; trial < 200; ++trial) {
    Simplex<3> s;
    for (auto& p : s)
      for (double& x : p.x) x = coordinate(random);
    if (orient<3>(s) != Sign::positive) std::swap(s[0], s[1]);
    // A point 2^-30 inside the sphere, beside a corner along the way to the centroid.
    Point3 p, centroid{};
    for (const auto& q : s)
      for (int i = 0; i < 3; ++i) centroid[i] += q[i] / 4;
    for (int i = 0; i < 3; ++i) p[i] = s[0][i] + 0x1p-30 * (centroid[i] - s[0][i]);
    if (in_sphere<3>(s, p) != Sign::positive) continue;
    std::array<double, 5> delta{};
    EXPECT_FALSE(rounding_cancels<3>(s, p, delta));
    delta[4] = 0x1p-30;
    EXPECT_TRUE(rounding_cancels<3>(s, p, delta));
    // The way out of the sphere is at most as long as the way back to the corner, which is on it.
    delta[4] = 0;
    delta[0] = 0x1p-30;
    EXPECT_TRUE(rounding_cancels<3>(s, p, delta));
    delta.fill(0x1p-80);
    EXPECT_FALSE(rounding_cancels<3>(s, p, delta));
  }
}

// What the long doubles decide is what the rationals do: of all moves of one point, those that are long enough are told apart
// from those that are not at one length, that of the first order.
TEST(CheckExact, RoundingCancelsFromOneLengthOn) {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> coordinate(-1, 1);
  for (int trial = 0; trial < 50; ++trial) {
    Simplex<3> s;
    Point3 p;
    for (auto& q : s)
      for (double& x : q.x) x = std::ldexp(coordinate(random), trial - 25);
    for (int i = 0; i < 3; ++i) p[i] = s[0][i] + 0x1p-30 * (s[1][i] - s[0][i]);
    const std::size_t moved = static_cast<std::size_t>(trial % 5);
    const auto cancels = [&](double length) {
      std::array<double, 5> delta{};
      delta[moved] = length;
      return rounding_cancels<3>(s, p, delta);
    };
    double low = 0, high = std::ldexp(1.0, trial - 25);
    ASSERT_TRUE(cancels(high));
    while (const double middle = low + (high - low) / 2) {
      if (middle == low || middle == high) break;
      (cancels(middle) ? high : low) = middle;
    }
    ASSERT_GT(low, 0);
    for (int k = 1; k <= 20; ++k) {
      EXPECT_FALSE(cancels(low * (1 - std::ldexp(1.0, -2 * k))));
      EXPECT_TRUE(cancels(high * (1 + std::ldexp(1.0, -2 * k))));
    }
    // Scaled by a power of two, everything is exactly the same.
    const auto scaled = [](Point3 q) {
      for (double& x : q.x) x = std::ldexp(x, -900);
      return q;
    };
    for (auto& q : s) q = scaled(q);
    p = scaled(p);
    EXPECT_FALSE(cancels(std::ldexp(low, -900)));
    EXPECT_TRUE(cancels(std::ldexp(high, -900)));
  }
}

TEST(CheckExact, RoundingAtTheLimitInThePlane) {
  // Unit circle about the origin; p = (1 - d, 0). With only p moving, out of the circle takes a move of d.
  const Simplex<2> s{{{{0, -1}}, {{0, 1}}, {{-1, 0}}}};
  const double d = 0x1p-40;
  const Point2 p{{1 - d, 0}};
  ASSERT_EQ(in_sphere<2>(s, p), Sign::positive);
  EXPECT_TRUE(rounding_cancels<2>(s, p, {0, 0, 0, d * 1.001}));
  EXPECT_FALSE(rounding_cancels<2>(s, p, {0, 0, 0, d * 0.999}));
}

TEST(CheckExact, OrderAlongALine) {
  std::vector<std::array<Point2, 2>> walls{{{{{3, -1}}, {{3, 1}}}}, {{{{1, -1}}, {{1, 1}}}}, {{{{2, 1}}, {{2, -1}}}}};
  EXPECT_EQ(order_along<2>({{0, 0}}, {{4, 0}}, walls), (std::vector<std::uint32_t>{1, 2, 0}));
  EXPECT_EQ(order_along<2>({{4, 0}}, {{0, 0}}, walls), (std::vector<std::uint32_t>{0, 2, 1}));
  walls.push_back({{{{0.5, -1}}, {{1.5, 1}}}});
  EXPECT_TRUE(order_along<2>({{0, 0}}, {{4, 0}}, walls).empty());
}

template <class Tag>
class CheckInput : public testing::Test {};
TYPED_TEST_SUITE(CheckInput, test::Dimensions);

/// As a Domain has them, without crossings.
template <int D>
VolumeWalls<D> walls_of(const Plc<D>& plc) {
  const Domain<D> domain(plc);
  VolumeWalls<D> walls;
  walls.points.assign(domain.points().begin(), domain.points().end());
  for (const DomainSegment& s : domain.segments())
    if constexpr (D == 2)
      walls.simplices.push_back(s.points);
    else
      walls.segments.push_back(s.points);
  if constexpr (D == 3)
    for (EntityId f = 0; f < domain.facets().size(); ++f)
      walls.simplices.insert(walls.simplices.end(), domain.triangles(f).begin(), domain.triangles(f).end());
  walls.holes = plc.holes;
  walls.regions = plc.regions;
  return walls;
}

template <int D>
Lattice<D> all(int x) {
  Lattice<D> i;
  i.fill(x);
  return i;
}

// Boxes inside each other touch nowhere: only lines tell which volume is between which.
TYPED_TEST(CheckInput, NestedBoxes) {
  constexpr int D = TypeParam::value;
  for (const auto& map : {straight<D>(), slanted<D>()}) {
    PlcMaker<D> maker(map);
    for (int i = 0; i < 4; ++i) maker.box(all<D>(3 * i), all<D>(30 - 3 * i));
    maker.plc.holes.push_back(map(all<D>(4)));
    maker.plc.regions.push_back({map(all<D>(15)), 5, 0.25});
    const InputVolumes<D> input(walls_of<D>(maker.plc), RegionMode::seeds);
    ASSERT_EQ(input.volumes().size(), 5u);
    const double cube = std::abs(signed_measure<D>(
                                     [&] {
                                       std::array<Point<D>, D> s;
                                       for (int k = 0; k < D; ++k) {
                                         auto corner = all<D>(0);
                                         corner[k] = 3;
                                         s[k] = map(corner);
                                       }
                                       return s;
                                     }(),
                                     map(all<D>(0)))
                                     .first);
    const auto at = [&](int i) { return *input.locate(map(all<D>(i))); };
    EXPECT_EQ(at(-1), 0u);
    double inner = std::pow(4, D);
    for (int i = 3; i >= 0; --i) {
      const Volume& v = input.volumes()[at(3 * i + 1)];
      const double whole = std::pow(10 - 2 * i, D);
      EXPECT_EQ(v.kept, i != 1);
      EXPECT_NEAR(v.measure, cube * (i == 3 ? whole : whole - inner), 1e-9 * cube);
      EXPECT_LT(v.measure_error, 1e-9 * cube);
      inner = whole;
    }
    EXPECT_EQ(input.volumes()[at(15)].seeds.size(), 1u);
    EXPECT_EQ(input.volumes()[at(15)].size, 0.25);
    EXPECT_FALSE(input.locate(map(all<D>(3))).has_value()) << "a corner of a box is on a wall";
  }
}

TEST(CheckInput3, PagesOfABook) {
  // k pages round one edge, closed by a lid, a bottom and a cover: k volumes. The angular order is all there is.
  for (const int k : {3, 4, 7, 16}) {
    Plc<3> plc;
    plc.points = {{{0, 0, 0}}, {{0, 0, 1}}};
    for (int i = 0; i < k; ++i)
      for (const double z : {0.0, 1.0}) {
        const double angle = 0.3 + 6.283185307179586 * i / k;
        plc.points.push_back({{std::cos(angle), std::sin(angle), z}});
      }
    const auto facet = [&](std::vector<std::uint32_t> p) {
      Plc<3>::Facet f;
      f.polygons.push_back(std::move(p));
      plc.facets.push_back(f);
    };
    for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(k); ++i) {
      const std::uint32_t a = 2 + 2 * i, b = 2 + 2 * ((i + 1) % static_cast<std::uint32_t>(k));
      facet({0, a, a + 1, 1});
      facet({a, b, b + 1, a + 1});
      facet({0, a, b});
      facet({1, a + 1, b + 1});
    }
    const InputVolumes<3> input(walls_of<3>(plc), RegionMode::seeds);
    EXPECT_EQ(input.volumes().size(), static_cast<std::size_t>(k) + 1);
    double sum = 0;
    for (const Volume& v : input.volumes()) sum += v.kept ? v.measure : 0;
    EXPECT_NEAR(sum, -input.volumes()[0].measure, 1e-12);
  }
}

TEST(CheckInput2, OpenCurvesEncloseNothing) {
  Plc<2> plc;
  plc.points = {{{0, 0}}, {{1, 0}}, {{1, 1}}, {{0, 1}}};
  plc.segments = {{{0, 1}, 0}, {{1, 2}, 0}, {{2, 3}, 0}};
  const InputVolumes<2> input(walls_of<2>(plc), RegionMode::seeds);
  EXPECT_EQ(input.volumes().size(), 1u);
  EXPECT_FALSE(input.wants(0));
}

// A polygon may be off its plane by far more than rounding. That its points are uncertain says rounding alone, or no violation
// beside it would count.
TEST(SlackOfVertices, OfABentFacetIsRoundingHoweverBentItIs) {
  Plc<3> plc;
  for (int i = 0; i < 8; ++i) plc.points.push_back({{double(i & 1), double(i >> 1 & 1), double(i >> 2 & 1)}});
  plc.points[7][2] = 1 + 0x1p-14;
  OutputMesh<3> mesh;
  mesh.points = plc.points;
  for (const auto& f :
       {std::array{0u, 1u, 3u}, {0u, 3u, 2u}, {0u, 1u, 5u}, {0u, 5u, 4u}, {0u, 2u, 6u}, {0u, 6u, 4u}, {4u, 5u, 7u}, {4u, 7u, 6u}})
    mesh.subfacets.push_back({f, 0});
  const auto slack = checking::slack_of_vertices<3>(mesh, 2);
  EXPECT_EQ(slack[0], 0);
  EXPECT_EQ(slack[3], 0) << "all that it lies on is parallel to axes";
  for (const std::size_t v : {4u, 5u, 6u, 7u}) EXPECT_EQ(slack[v], 2 * (1 + 0x1p-14) * 0x1p-52);
}

// The hull convhull_RWY_merged.stl of Debian's dart-doc, cut where it crosses itself: between two points 1.4e-14 apart a facet
// ends, 0.026 long. A subfacet there has a plane that rounding tilts, so that the far end of the facet is 1e-5 off it; near to
// the subfacet the facet is in the plane, and covers it.
TEST(CheckExact, ANeedleCoversItsTip) {
  const Point3 a{{1.0504975456681297e-14, -0.07900000363588333, -0.2927899956703186}}, b{{2.483991880459016e-14, a[1], a[2]}},
      far{{2.483812648287377e-14, -0.10500000417232513, -0.2927214503288269}},
      below{{6.756831795172333e-15, -0.07900000363593063, -0.2927899956703185}};
  const double reach = 5e-16;
  const PlaneFrame frame({a, b, below});
  const std::array<Point3, 3> needle{a, far, b};
  for (int turn = 0; turn < 3; ++turn) {
    const CoveringTriangle cover(frame, {needle[turn], needle[(turn + 1) % 3], needle[(turn + 2) % 3]}, reach, reach);
    for (int i = 1; i < 8; ++i) {
      Point3 x;
      for (int k = 0; k < 3; ++k) x[k] = (a[k] + b[k]) / 2 + i / 16.0 * (below[k] - (a[k] + b[k]) / 2);
      const auto place = frame.place(x);
      EXPECT_TRUE(cover.contains({{place[0], place[1]}})) << turn << ", " << i;
    }
    const auto out = frame.place(Point3{{(a[0] + b[0]) / 2, a[1] + 2e-15, a[2]}});
    EXPECT_FALSE(cover.contains({{out[0], out[1]}}));
  }
}

// What of a triangle across the plane is within a height of it: a strip between two levels.
TEST(CheckExact, ACrossingTriangleCoversAStrip) {
  const PlaneFrame frame({Point3{{0, 0, 0}}, Point3{{1, 0, 0}}, Point3{{0, 1, 0}}});
  const std::array<Point3, 3> across{Point3{{0, 0, -1}}, Point3{{4, 0, 1}}, Point3{{0, 4, -1}}};  // height x / 2 - 1
  for (int turn = 0; turn < 3; ++turn) {
    const CoveringTriangle cover(frame, {across[turn], across[(turn + 1) % 3], across[(turn + 2) % 3]}, 1e-9, 0.25);
    for (const auto& [x, within] : {std::pair(1.4, false), {1.6, true}, {2.4, true}, {2.6, false}}) {
      const auto place = frame.place(Point3{{x, 0.5, 0}});
      EXPECT_EQ(cover.contains({{place[0], place[1]}}), within) << x;
    }
  }
}

// From the origin to (4, 0, 0), points 0 and 3: two pieces, the edges of a neighbour that end beside it, and one that leads back
// to it.
TEST(CheckExact, ASegmentIsTheChainToItsOtherEnd) {
  const std::vector<Point3> points{{{0, 0, 0}}, {{1, 0, 0}}, {{1, 0.01, 0}}, {{4, 0, 0}}, {{3, 0.01, 0}}};
  using Ends = std::array<std::uint32_t, 2>;
  const auto chain = [&](const std::vector<Ends>& edges) {
    std::vector<NearEdge<3>> near;
    for (const Ends& e : edges) near.push_back({e, {points[e[0]], points[e[1]]}});
    std::vector<Ends> out;
    for (const std::uint32_t i : segment_chain<3>(near, {0, 3}, {points[0], points[3]})) out.push_back(edges[i]);
    std::ranges::sort(out);
    return out;
  };
  EXPECT_EQ(chain({{2, 0}, {3, 1}, {0, 1}, {2, 4}}), (std::vector<Ends>{{0, 1}, {3, 1}}));
  EXPECT_EQ(chain({{2, 0}, {3, 1}, {0, 1}, {2, 4}, {4, 3}}), (std::vector<Ends>{{0, 1}, {3, 1}}));
  EXPECT_EQ(chain({{2, 0}, {3, 1}, {2, 4}, {4, 3}}), (std::vector<Ends>{{2, 0}, {2, 4}, {4, 3}}));
  EXPECT_TRUE(chain({{2, 0}, {3, 1}}).empty());
}

// A cell of spheres cut by its faces, turned: loose edges, about a hole, that end 2^-60 inside of the facet's outline.
TEST(CheckExact, AHoleDoesNotLeakBesideTheOutline) {
  Plc<3> plc;
  for (const auto& [x, y] :
       {std::pair{0.0, 0.0}, {1.0, 0.0}, {1.0, 1.0}, {0.0, 1.0}, {0x1p-60, 0.25}, {0.25, 0.5}, {0x1p-60, 0.75}})
    plc.points.push_back({x, y, 0.0});
  plc.facets.push_back({{{0, 1, 2, 3}, {4, 5}, {5, 6}}, {{0.125, 0.5, 0.0}}, 0});
  std::vector<std::uint32_t> place(plc.points.size());
  std::iota(place.begin(), place.end(), 0u);
  const auto made = triangulate_given(plc, ExplicitEdges(plc, place), 0, 0x1p-50);
  EXPECT_FALSE(made.failed);
  double area = 0;
  for (const auto& t : made.triangles) {
    const Point3 &a = plc.points[t[0]], &b = plc.points[t[1]], &c = plc.points[t[2]];
    area += std::abs((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])) / 2;
  }
  EXPECT_NEAR(area, 1 - 0.0625, 1e-12);
}

}  // namespace test_check_exact
