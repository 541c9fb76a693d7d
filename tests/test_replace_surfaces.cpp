// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// What another surface within a tolerance keeps, and what it may change.
#include <gtest/gtest.h>
#include <tbb/task_arena.h>

#include <numbers>
#include <numeric>
#include <random>

#include "model_plcs.hpp"
#include "numbers/vectors.hpp"
#include "pgdr/diagnosis.hpp"
#include "pgdr/surface.hpp"
#include "pgdr/surface_counts.hpp"
#include "structure_plcs.hpp"
#include "surface_distances.hpp"

namespace pgdr::test_replace_surfaces {

using test::Index;

ReplacedSurface replaced(const Plc<3>& plc, double tolerance) {
  SurfaceOptions options;
  options.tolerance = tolerance;
  return replace_surface(plc, options);
}

/// Whatever is asked: no findings, the same counts, no sample beyond the tolerance. @returns the larger of the sampled distances
double check(const Plc<3>& given, const Plc<3>& other, double tolerance, int steps = 6) {
  EXPECT_EQ(diagnose(Domain<3>(other)).error_count(), 0u);
  EXPECT_EQ(surface_counts(Domain<3>(other)), surface_counts(Domain<3>(given)));
  const double to = test::sampled_distance(other, given, steps), from = test::sampled_distance(given, other, steps);
  EXPECT_LE(to, tolerance);
  EXPECT_LE(from, tolerance);
  return std::max(to, from);
}

/// A height over each point of a grid, as the top of a block; sides and bottom are one polygon each.
Plc<3> relief(int n, const std::function<double(double, double)>& height) {
  Plc<3> plc;
  const auto number = [n](int i, int j) { return static_cast<Index>(j * (n + 1) + i); };
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i) plc.points.push_back({{double(i) / n, double(j) / n, height(double(i) / n, double(j) / n)}});
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      test::add_polygon(plc, {number(i, j), number(i + 1, j), number(i + 1, j + 1)}, 1);
      test::add_polygon(plc, {number(i, j), number(i + 1, j + 1), number(i, j + 1)}, 1);
    }
  const Index base = static_cast<Index>(plc.points.size());
  for (const auto& [x, y] : {std::pair{0.0, 0.0}, {1.0, 0.0}, {1.0, 1.0}, {0.0, 1.0}}) plc.points.push_back({{x, y, -1}});
  test::add_polygon(plc, {base + 3, base + 2, base + 1, base}, 2);
  const std::array<std::array<int, 4>, 4> walk{{{0, 0, 1, 0}, {n, 0, 0, 1}, {n, n, -1, 0}, {0, n, 0, -1}}};
  for (Index side = 0; side < 4; ++side) {
    std::vector<Index> polygon{base + side, base + (side + 1) % 4};
    const auto& [i, j, di, dj] = walk[side];
    for (int k = n; k >= 0; --k) polygon.push_back(number(i + k * di, j + k * dj));
    test::add_polygon(plc, polygon, 2);
  }
  return plc;
}

double highest(const Plc<3>& plc) {
  double top = -1;
  for (const Point3& p : plc.points) top = std::max(top, p[2]);
  return top;
}

TEST(ReplaceSurface, NothingToDoNothingDone) {
  for (const Plc<3>& plc : {test::cube(), test::l_block(), test::plate_with_hole(), test::icosphere(2)}) {
    const ReplacedSurface out = replaced(plc, 1e-4);
    const SurfaceReport& r = out.report;
    EXPECT_EQ(r.contracted + r.flipped + r.moved + r.split, 0u);
    EXPECT_EQ(out.plc.facets.size(), plc.facets.size());
    auto given = plc.points, points = out.plc.points;
    for (auto* list : {&given, &points}) std::sort(list->begin(), list->end(), lex_less<3>);
    EXPECT_EQ(given, points);
  }
}

TEST(ReplaceSurface, ScansGetCoarse) {
  for (const double shift : {0.0, 1000.0}) {
    const Plc<3> plc = test::turned(test::icosphere(3), shift);
    for (const double e : {0.03, 0.01}) {
      const ReplacedSurface out = replaced(plc, e);
      EXPECT_LT(out.report.triangles[1], plc.facets.size() * (e > 0.01 ? 0.4 : 0.9));
      EXPECT_GT(check(plc, out.plc, e, 2), e / 2);  // what may be used is used
      EXPECT_GE(out.report.smallest_corner[1], 15);
    }
  }
}

/// A fin far thinner than the tolerance, twice as high: its tip would be too far from the surface without it.
TEST(ReplaceSurface, FinsStay) {
  const auto fin = [](double height) {
    return relief(20, [height](double x, double y) { return std::fabs(x - 0.5) < 0.01 && y > 0.44 && y < 0.56 ? height : 0.0; });
  };
  const double e = 0.01;
  const Plc<3> low = fin(0.7 * e), high = fin(2 * e);
  const ReplacedSurface of_low = replaced(low, e), of_high = replaced(high, e);
  check(low, of_low.plc, e);
  check(high, of_high.plc, e);
  EXPECT_GE(highest(of_high.plc), e);
  EXPECT_LT(of_low.report.triangles[1], of_high.report.triangles[1]);
}

/// A void below a bump that would go: the surface may not jump over it.
TEST(ReplaceSurface, NothingIsJumpedOver) {
  const double e = 0.02;
  Plc<3> plc = relief(
      10, [e](double x, double y) { return std::fabs(x - 0.5) < 0.01 && std::fabs(y - 0.5) < 0.01 ? 0.98 * e : 0.0; });
  const ReplacedSurface alone = replaced(plc, e);
  EXPECT_LT(alone.report.triangles[1], 30u);  // the bump goes
  Plc<3> ball = test::icosphere(1);
  for (auto& f : ball.facets) f.marker = 5;
  test::append(plc, ball, e / 20, {{0.5, 0.5, 0.5 * e}});
  const ReplacedSurface out = replaced(plc, e);
  check(plc, out.plc, e);
  EXPECT_GT(out.report.refused.swept, 0u);
  EXPECT_GT(highest(out.plc), 0.6 * e);  // the top of the ball is at 0.55 e
}

TEST(ReplaceSurface, TopologyStays) {
  const Plc<3> small = test::scaled(test::icosphere(0), 0.5);  // larger than itself is the tolerance
  const ReplacedSurface out = replaced(small, 2);
  check(small, out.plc, 2);
  EXPECT_GE(out.report.triangles[1], 4u);
  for (const test::Structure& s : test::touching_structures()) {
    SCOPED_TRACE(s.name);
    const ReplacedSurface touching = replaced(s.plc, 0.02);
    check(s.plc, touching.plc, 0.02);
  }
}

/// A block with faces of many triangles: its corners and edges are what stays.
TEST(ReplaceSurface, CreasesStay) {
  Plc<3> plc;
  const int n = 6;
  std::map<std::array<int, 3>, Index> numbers;
  const auto number = [&](std::array<int, 3> at) {
    const auto [it, fresh] = numbers.emplace(at, static_cast<Index>(plc.points.size()));
    if (fresh) plc.points.push_back({{double(at[0]) / n, double(at[1]) / n, double(at[2]) / n}});
    return it->second;
  };
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (const int level : {0, n})
      for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
          const auto at = [&](int u, int v) {
            std::array<int, 3> p{};
            p[axis] = level;
            p[(axis + 1) % 3] = u;
            p[(axis + 2) % 3] = v;
            return number(p);
          };
          test::add_polygon(plc, {at(i, j), at(i + 1, j), at(i + 1, j + 1)});
          test::add_polygon(plc, {at(i, j), at(i + 1, j + 1), at(i, j + 1)});
        }
  for (const double shift : {0.0, 1000.0}) {
    const Plc<3> given = test::turned(plc, shift);
    const ReplacedSurface out = replaced(given, 1e-3);
    check(given, out.plc, 1e-3, 2);
    EXPECT_EQ(out.report.creases, 12u * n);
    EXPECT_EQ(out.plc.facets.size(), 6u);
    for (const std::array<int, 3>& corner : {std::array{0, 0, 0}, {n, 0, 0}, {0, n, 0}, {n, n, n}}) {
      const Point3& p = given.points[numbers.at(corner)];
      EXPECT_NE(std::find(out.plc.points.begin(), out.plc.points.end(), p), out.plc.points.end());
    }
  }
}

/// A stripe of another marker, thinner than the tolerance, and two halves of others.
TEST(ReplaceSurface, MarkersStay) {
  Plc<3> plc = relief(24, [](double x, double y) { return 0.05 * std::sin(3 * x) * std::cos(2 * y); });
  for (auto& f : plc.facets) {
    if (f.marker != 1) continue;
    double x = 0;
    for (const Index v : f.polygons[0]) x += plc.points[v][0] / 3;
    f.marker = x < 0.5 ? 11 : x < 0.5 + 1.0 / 24 ? 12 : 13;
  }
  const double e = 0.05;
  const ReplacedSurface out = replaced(plc, e);
  check(plc, out.plc, e, 2);
  EXPECT_LT(out.report.triangles[1], 400u);
}

/// A surface without sharp corners gets none, whatever the tolerance.
TEST(ReplaceSurface, GoodCornersStayGood) {
  const Plc<3> plc = relief(16, [](double x, double y) { return 0.1 * std::sin(7 * x) * std::sin(5 * y + x); });
  for (const double e : {0.0003, 0.003, 0.03}) {
    const ReplacedSurface out = replaced(plc, e);
    check(plc, out.plc, e, 3);
    EXPECT_GE(out.report.smallest_corner[1], std::min(15.0, out.report.smallest_corner[0])) << e;
  }
}

// A plate with a rounded corner: two sides of it are one flat group, whose corners move along the curves above and below. What
// was bent by a millionth of the diagonal stayed a group, however small it was, and the mesher took it for triangles: without a
// small corner as given 5,080 cells were left over a bound, of a printer's platform as many.
TEST(ReplaceSurface, FlatGroupsAreFacets) {
  constexpr int sides = 356;
  constexpr double radius = 5, length = 310;
  std::vector<Point2> outline{{{0, 0}}, {{length, 0}}, {{length, length}}};
  for (int k = 0; k <= sides; ++k) {
    const double angle = std::numbers::pi / 2 * k / sides;
    outline.push_back({{radius - radius * std::sin(angle), length - radius + radius * std::cos(angle)}});
  }
  const auto made = replaced(test::prism(outline, 3), 0.4384);
  EXPECT_EQ(made.report.sharp_triangles[1], 0u);
  const Domain<3> domain(made.plc);
  EXPECT_TRUE(std::ranges::none_of(domain.warnings(), [](const Diagnostic& d) { return d.code == Errc::bent_facet; }));
}

// Two dents that touch at a point: what is around them is one facet, as it was. It was handed on as triangles, whose corners
// nobody had counted.
TEST(ReplaceSurface, RimsMayTouchThemselves) {
  Plc<3> given;
  test::add_box(given, {{0, 0, 0}}, {{8, 8, 4}});
  Plc<3>::Facet& top = given.facets.back();
  std::vector<std::vector<Index>> dents;
  for (const double from : {2.0, 4.0}) {
    dents.emplace_back();
    for (const auto& [x, y] : {std::pair{0.0, 0.0}, {2.0, 0.0}, {2.0, 2.0}, {0.0, 2.0}}) {
      const Point3 p{{from + x, from + y, 4}};
      const auto at = std::ranges::find(given.points, p);
      dents.back().push_back(at == given.points.end() ? test::add_point(given, p)
                                                      : static_cast<Index>(at - given.points.begin()));
    }
    top.polygons.push_back(dents.back());
    top.holes.push_back({{from + 1, from + 1, 4}});
  }
  for (const auto& dent : dents) {
    const Point3& p = given.points[dent[0]];
    const Index deepest = test::add_point(given, {{p[0] + 1, p[1] + 1, 2}});
    for (std::size_t k = 0; k < 4; ++k) test::add_polygon(given, {dent[k], dent[(k + 1) % 4], deepest}, 0);
  }
  const auto made = replaced(given, 0.01);
  EXPECT_EQ(std::ranges::count_if(made.plc.facets, [](const auto& f) { return f.holes.size() == 2; }), 1);
  EXPECT_EQ(made.plc.facets.size(), given.facets.size());
  check(given, made.plc, 0.01);
}

// A point inside of a facet that is bent there by less than counts. It came as a point of no facet, beside the polygon by as
// much, and cells were as thin. With a marker it is to stay: the polygon has it.
TEST(ReplaceSurface, PointsInsideOfPolygons) {
  for (const int marker : {0, 5}) {
    Plc<3> given;
    test::add_box(given, {{0, 0, 0}}, {{2, 2, 2}});
    const auto top = given.facets.back().polygons[0];
    given.facets.pop_back();
    const Index middle = test::add_point(given, {{1, 1, 2 + 1e-7}});
    for (std::size_t k = 0; k < 4; ++k) test::add_polygon(given, {top[k], top[(k + 1) % 4], middle}, 0);
    given.point_markers.assign(given.points.size(), 0);
    given.point_markers[middle] = marker;
    SurfaceOptions options;
    options.tolerance = 0.01;
    options.size = [](const Point3&) { return 0.6; };  // so that it is not contracted
    const Plc<3> made = replace_surface(given, options).plc;
    EXPECT_EQ(made.facets.size(), 6u);
    EXPECT_EQ(made.points.size(), marker == 0 ? 8u : 9u);
    EXPECT_EQ(std::ranges::count_if(made.facets, [](const auto& f) { return f.polygons.back().size() == 1; }),
              marker == 0 ? 0 : 1);
  }
}

/// The same for any order of points, facets and corners.
TEST(ReplaceSurface, NumbersAreNoMatter) {
  const Plc<3> given = relief(12, [](double x, double y) { return 0.1 * std::sin(7 * x) * std::sin(5 * y + x); });
  const ReplacedSurface first = replaced(given, 0.003);
  std::mt19937 random(7);
  for (int round = 0; round < 3; ++round) {
    Plc<3> plc = given;
    std::vector<Index> place(plc.points.size());
    std::iota(place.begin(), place.end(), 0u);
    std::shuffle(place.begin(), place.end(), random);
    for (std::size_t i = 0; i < place.size(); ++i) plc.points[place[i]] = given.points[i];
    for (auto& f : plc.facets)
      for (auto& polygon : f.polygons) {
        for (Index& v : polygon) v = place[v];
        if (polygon.size() == 3) std::rotate(polygon.begin(), polygon.begin() + round, polygon.end());
      }
    std::shuffle(plc.facets.begin(), plc.facets.end(), random);
    const ReplacedSurface out = replaced(plc, 0.003);
    EXPECT_EQ(out.plc.points, first.plc.points);
    ASSERT_EQ(out.plc.facets.size(), first.plc.facets.size());
    for (std::size_t f = 0; f < out.plc.facets.size(); ++f) EXPECT_EQ(out.plc.facets[f].polygons, first.plc.facets[f].polygons);
    EXPECT_EQ(out.report.refused.angle, first.report.refused.angle);
  }
}

/// Ended after any change, what is there is valid. (The size is asked for each new edge: so the token is requested amid the
/// work.)
TEST(ReplaceSurface, CanBeEndedAnywhere) {
  const Plc<3> plc = relief(10, [](double x, double y) { return 0.1 * std::sin(7 * x) * std::sin(5 * y + x); });
  const double e = 0.01;
  int asked = 0;
  const auto run = [&](int last) {
    std::stop_source source;
    SurfaceOptions options;
    options.tolerance = e;
    options.stop = source.get_token();
    asked = 0;
    options.size = [&](const Point3&) {
      if (++asked == last) source.request_stop();
      return 1e9;
    };
    return replace_surface(plc, options);
  };
  EXPECT_FALSE(run(0).report.stopped);
  const int all = asked;
  ASSERT_GT(all, 1000);
  for (const int last : {1, all / 8, all / 3, all / 2, all * 3 / 4}) {
    const ReplacedSurface out = run(last);
    EXPECT_TRUE(out.report.stopped) << last;
    check(plc, out.plc, e, 2);
  }
}

/// Trials that threads make ahead are settled in the order of one thread, and made anew where a change before them has touched
/// what they read. A rough block of needles on which changes of all kinds are made beside each other.
TEST(ReplaceSurface, AnyNumberOfThreads) {
  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> off(-0.006, 0.006);
  Plc<3> plc = relief(40, [&](double x, double y) { return 0.1 * std::sin(7 * x) * std::sin(5 * y + x) + off(random); });
  for (Point3& p : plc.points) p[0] *= 0.25;
  SurfaceOptions options;
  options.tolerance = 0.01;
  options.wanted_corner = 38;
  const auto made_by = [&](int threads) {
    return tbb::task_arena(threads).execute([&] { return replace_surface(plc, options); });
  };
  const ReplacedSurface one = made_by(1);
  const SurfaceReport& r = one.report;
  EXPECT_GT(r.contracted, 500u);
  EXPECT_GT(std::min({r.flipped, r.moved, r.split}), 20u) << r.flipped << ' ' << r.moved << ' ' << r.split;
  for (const int threads : {2, 8}) {
    const ReplacedSurface other = made_by(threads);
    EXPECT_EQ(other.plc.points, one.plc.points) << threads;
    ASSERT_EQ(other.plc.facets.size(), one.plc.facets.size()) << threads;
    for (std::size_t f = 0; f < one.plc.facets.size(); ++f) EXPECT_EQ(other.plc.facets[f].polygons, one.plc.facets[f].polygons);
    EXPECT_EQ(other.facet_of_input, one.facet_of_input) << threads;
    const SurfaceReport& o = other.report;
    EXPECT_EQ(std::tie(o.contracted, o.flipped, o.moved, o.split), std::tie(r.contracted, r.flipped, r.moved, r.split));
    EXPECT_EQ(std::tie(o.refused.angle, o.refused.fold, o.refused.distance, o.refused.meets, o.refused.gap, o.refused.swept),
              std::tie(r.refused.angle, r.refused.fold, r.refused.distance, r.refused.meets, r.refused.gap, r.refused.swept));
    EXPECT_EQ(std::tie(o.to_given, o.from_given, o.farthest_point), std::tie(r.to_given, r.from_given, r.farthest_point));
  }
}

/// A rough block whose triangles are needles.
Plc<3> rough_needles(double roughness) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> off(-roughness, roughness);
  Plc<3> plc = relief(24, [&](double, double) { return off(random); });
  for (Point3& p : plc.points) p[0] *= 0.125;
  return plc;
}

/// What is expected of the triangles with the marker 1: one cell a corner, and two for each unit of its cotangent.
double expected_cells(const Plc<3>& plc) {
  double sum = 0;
  for (const auto& f : plc.facets) {
    if (f.marker != 1 || f.polygons[0].size() != 3) continue;
    for (std::size_t i = 0; i < 3; ++i) {
      const auto corner = [&](std::size_t k) { return plc.points[f.polygons[0][(i + k) % 3]]; };
      const auto u = detail::difference(corner(1), corner(0)), v = detail::difference(corner(2), corner(0)),
                 n = detail::cross(u, v);
      sum += 1 + 2 * std::max(0.0, std::min(32.0, detail::dot(u, v) / std::sqrt(detail::dot(n, n))));
    }
  }
  return sum;
}

/// Splits that let nothing be cured are taken back, to the last bit: far below the heights of needles nothing can be.
TEST(ReplaceSurface, SplitsInVainAreTakenBack) {
  const Plc<3> plc = rough_needles(0.02);
  const ReplacedSurface out = replaced(plc, 1e-6);
  const SurfaceReport& r = out.report;
  EXPECT_GT(r.refused.cells, 100u);
  EXPECT_EQ(r.contracted + r.flipped + r.moved + r.split, 0u);
  EXPECT_EQ(r.triangles[1], r.triangles[0]);
  auto given = plc.points, points = out.plc.points;
  for (auto* list : {&given, &points}) std::sort(list->begin(), list->end(), lex_less<3>);
  EXPECT_EQ(given, points);
}

/// Splits that stay make needles go, and fewer cells expect.
TEST(ReplaceSurface, SplitsPay) {
  const Plc<3> plc = rough_needles(0.003);
  const ReplacedSurface out = replaced(plc, 0.003);
  const SurfaceReport& r = out.report;
  EXPECT_GT(r.split, 10u);
  ASSERT_GT(r.sharp_triangles[0], 500u);
  EXPECT_LT(r.sharp_triangles[1], r.sharp_triangles[0] / 5);
  EXPECT_LT(expected_cells(out.plc), expected_cells(plc));
  check(plc, out.plc, 0.003, 2);
}

/// Edges of triangles with the marker 1 that have an obtuse corner opposite of them: its vertex is in the edge's diametral ball.
std::size_t obtuse_corners(const Plc<3>& plc) {
  std::size_t count = 0;
  for (const auto& f : plc.facets) {
    if (f.marker != 1 || f.polygons[0].size() != 3) continue;
    for (std::size_t i = 0; i < 3; ++i) {
      const auto corner = [&](std::size_t k) { return plc.points[f.polygons[0][(i + k) % 3]]; };
      count += detail::dot(detail::difference(corner(1), corner(0)), detail::difference(corner(2), corner(0))) < 0;
    }
  }
  return count;
}

/// An edge that will get a point goes where that makes fewer cells expect, though all corners are as wanted: with the other
/// diagonals no triangle of this grid is obtuse.
TEST(ReplaceSurface, EdgesThatWouldGetPoints) {
  Plc<3> plc = relief(16, [](double x, double y) { return 0.05 * std::sin(6 * x) * std::cos(5 * y); });
  for (Point3& p : plc.points) p[0] += 0.4 * p[1];
  const ReplacedSurface out = replaced(plc, 0.002);
  ASSERT_GT(obtuse_corners(plc), 500u);
  EXPECT_LT(obtuse_corners(out.plc), obtuse_corners(plc) / 10);
  check(plc, out.plc, 0.002, 2);
}

/// No edge gets longer than twice the size that is wished for.
TEST(ReplaceSurface, SizesLimit) {
  const Plc<3> plc = test::icosphere(3);
  SurfaceOptions options;
  options.tolerance = 0.05;
  options.size = [](const Point3& p) { return p[2] > 0 ? 0.15 : 1e9; };
  const ReplacedSurface out = replace_surface(plc, options);
  std::array<std::size_t, 2> halves{};
  for (const auto& f : out.plc.facets)
    for (std::size_t i = 0; i < 3; ++i) {
      const Point3 &a = out.plc.points[f.polygons[0][i]], &b = out.plc.points[f.polygons[0][(i + 1) % 3]];
      if (a[2] > 0 || b[2] > 0) {
        EXPECT_LE(std::sqrt(squared_distance(a, b)), 0.3);
      }
      ++halves[a[2] > 0 ? 1 : 0];
    }
  EXPECT_GT(halves[1], halves[0] * 3 / 2);
}

TEST(ReplaceSurface, WhatIsRefused) {
  const auto code = [](const Plc<3>& plc, const SurfaceOptions& options) {
    try {
      replace_surface(plc, options);
    } catch (const Error& e) {
      return e.code();
    }
    return Errc::internal;
  };
  SurfaceOptions options;
  EXPECT_EQ(code(test::cube(), options), Errc::bad_option);  // no tolerance
  options.tolerance = 0.01;
  Plc<3> plc = test::cube();
  plc.tolerance = 0.001;
  EXPECT_EQ(code(plc, options), Errc::bad_option);
  plc = test::cube();
  plc.regions = {{{{0.5, 0.5, 0.005}}, 1, 0}};
  EXPECT_EQ(code(plc, options), Errc::seed_on_boundary);
  plc.regions[0].point[2] = 0.5;
  EXPECT_EQ(code(plc, options), Errc::internal);  // not refused
  options.feature_angle = 181;
  EXPECT_EQ(code(plc, options), Errc::bad_option);
}

/// Attributes of points as given, and linear where they are new; markers of points stay with these, in place.
TEST(ReplaceSurface, PointsKeepTheirData) {
  Plc<3> plc = relief(12, [](double x, double y) { return 0.1 * std::sin(7 * x) * std::sin(5 * y + x); });
  for (const Point3& p : plc.points) plc.point_attributes.push_back(2 * p[0] + 3 * p[1] - p[2]);
  plc.point_markers.assign(plc.points.size(), 0);
  plc.point_markers[40] = 5;
  const ReplacedSurface out = replaced(plc, 0.01);
  ASSERT_EQ(out.plc.point_attributes.size(), out.plc.points.size());
  std::size_t marked = 0;
  for (std::size_t i = 0; i < out.plc.points.size(); ++i) {
    const Point3& p = out.plc.points[i];
    EXPECT_NEAR(out.plc.point_attributes[i], 2 * p[0] + 3 * p[1] - p[2], 0.05);
    if (out.plc.point_markers[i] != 5) continue;
    ++marked;
    EXPECT_EQ(p, plc.points[40]);
  }
  EXPECT_EQ(marked, 1u);
  ASSERT_EQ(out.facet_of_input.size(), out.plc.facets.size());
  for (std::size_t f = 0; f < out.plc.facets.size(); ++f)
    EXPECT_EQ(plc.facets[out.facet_of_input[f]].marker, out.plc.facets[f].marker);
}

// A point of no facet may stand on one, which has it in its triangles then (hellbot_magna.obj, the bed of a printer).
TEST(ReplaceSurface, PointsOfNoFacetStay) {
  Plc<3> plc = relief(12, [](double, double) { return 0; });
  const Point3 on_top = plc.points[5 * 13 + 6], loose{on_top[0] + 0.013, on_top[1] + 0.017, on_top[2]};
  plc.points.push_back(loose);
  const ReplacedSurface out = replaced(plc, 0.05);
  EXPECT_LT(out.plc.points.size(), plc.points.size());
  EXPECT_EQ(std::ranges::count(out.plc.points, loose), 1);
}

}  // namespace pgdr::test_replace_surfaces
