// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// What is done to planar straight line graphs on request: crossings resolved, the convex hull added.
#include "pgdr/convex_hull.hpp"
#include "pgdr/planar_plc.hpp"

#include <gtest/gtest.h>

#include <numeric>

#include "pgdr/diagnosis.hpp"
#include "planar_plcs.hpp"
#include "refined_models.hpp"

namespace pgdr::test_input_planar_plc {

using namespace test;

/// Segments between random points, that cross as they come; on a grid, many pass through others' ends or overlap.
Plc<2> tangle(std::uint32_t segments, int grid, std::uint64_t seed) {
  Random random(seed);
  Plc<2> plc;
  add_square(plc, -1, 2);
  for (std::uint32_t i = 0; i < segments; ++i) {
    for (int end = 0; end < 2; ++end) {
      Point2 p{{uniform(random), uniform(random)}};
      if (grid > 0)
        for (double& x : p.x) x = std::floor(x * grid) / grid;
      plc.points.push_back(p);
    }
    if (plc.points.end()[-1] == plc.points.end()[-2]) {
      plc.points.resize(plc.points.size() - 2);
      continue;
    }
    add_segment(plc, static_cast<std::uint32_t>(plc.points.size() - 2), static_cast<std::uint32_t>(plc.points.size() - 1),
                static_cast<int>(i) + 2);
  }
  return plc;
}

double distance_from(const Point2& a, const Point2& b, const Point2& x) {
  const double along = ((x[0] - a[0]) * (b[0] - a[0]) + (x[1] - a[1]) * (b[1] - a[1])) / squared_distance(a, b);
  const double t = std::clamp(along, 0.0, 1.0);
  return std::sqrt(squared_distance(x, Point2{{a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1])}}));
}

/// Nothing crosses any more, points of the input are where they were, pieces of a marker make up its segment.
void expect_resolved(const Plc<2>& plc, const std::string& what) {
  std::vector<Diagnostic> repairs;
  const Plc<2> out = resolve_crossings(plc, repairs);
  EXPECT_EQ(diagnose<2>(out).error_count(), 0u) << what;
  ASSERT_GE(out.points.size(), plc.points.size());
  EXPECT_TRUE(std::equal(plc.points.begin(), plc.points.end(), out.points.begin())) << what;
  std::size_t next = 0;
  for (const auto& s : plc.segments) {
    const Point2 &a = plc.points[s.points[0]], &b = plc.points[s.points[1]];
    Point2 at = a;
    while (next < out.segments.size() && at != b) {
      const auto& piece = out.segments[next++];
      EXPECT_EQ(piece.marker, s.marker) << what;
      EXPECT_EQ(out.points[piece.points[0]], at) << what;
      at = out.points[piece.points[1]];
      EXPECT_LE(distance_from(a, b, at), 0x1p-46)
          << what;  // coordinates up to 2: 8 ulps of 2^-51, up to four times that in a crowd
    }
    EXPECT_EQ(at, b) << what;
  }
  EXPECT_EQ(next, out.segments.size()) << what;
  std::vector<Diagnostic> none;
  const Plc<2> again = resolve_crossings(out, none);
  EXPECT_TRUE(none.empty()) << what;
  EXPECT_EQ(again.points, out.points) << what;
}

TEST(ResolveCrossings, Tangles) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    expect_resolved(tangle(40, 0, seed), "seed " + std::to_string(seed));
    expect_resolved(tangle(40, 8, seed), "grid, seed " + std::to_string(seed));
    expect_resolved(tangle(30, 3, seed), "coarse grid, seed " + std::to_string(seed));
  }
  expect_resolved(tangle(300, 0, 21), "large");
}

/// Lines through nearly one point, whose crossings are ulps apart: rounding makes new crossings, and points coincide.
TEST(ResolveCrossings, NearlyOnePoint) {
  for (const double spread : {0.0, 0x1p-52, 0x1p-48, 0x1p-40})
    for (std::uint64_t seed = 1; seed <= 10; ++seed) {
      Random random(seed);
      Plc<2> plc;
      add_square(plc, -2, 2);
      for (std::uint32_t i = 0; i < 40; ++i) {
        const double angle = std::numbers::pi * i / 40, c = std::cos(angle), s = std::sin(angle);
        const double x = 0.3 + spread * uniform(random), y = 0.7 + spread * uniform(random);
        plc.points.insert(plc.points.end(), {{{x - c, y - s}}, {{x + c, y + s}}});
        add_segment(plc, 4 + 2 * i, 5 + 2 * i, static_cast<int>(i) + 2);
      }
      expect_resolved(plc, "spread " + std::to_string(spread) + ", seed " + std::to_string(seed));
    }
}

/// Segments that are nearly parallel: an ulp across moves their crossing far along.
TEST(ResolveCrossings, NearlyParallel) {
  Plc<2> plc;
  add_square(plc, -1, 2);
  for (std::uint32_t i = 0; i < 12; ++i) {
    const double up = i * 0x1p-51;
    plc.points.insert(plc.points.end(), {{{0, 1 + up}}, {{1, 1.25 - up}}});
    add_segment(plc, 4 + 2 * i, 5 + 2 * i, static_cast<int>(i) + 2);
  }
  std::vector<Diagnostic> repairs;
  EXPECT_EQ(diagnose<2>(resolve_crossings(plc, repairs)).error_count(), 0u);
}

TEST(ResolveCrossings, IsReportedByNumbersOfTheInput) {
  Plc<2> plc;
  plc.first_index = 1;
  plc.points = {{{0, 0}}, {{2, 2}}, {{0, 2}}, {{2, 0}}};
  add_segment(plc, 0, 1, 5);
  add_segment(plc, 2, 3, 6);
  std::vector<Diagnostic> repairs;
  const Plc<2> out = resolve_crossings(plc, repairs);
  ASSERT_EQ(repairs.size(), 1u);
  EXPECT_EQ(repairs[0].code, Errc::entities_intersect);
  EXPECT_EQ(repairs[0].ids, (std::vector<std::int64_t>{1, 2}));
  ASSERT_EQ(repairs[0].points.size(), 1u);
  EXPECT_EQ(repairs[0].points[0], (std::array<double, 3>{1, 1, 0}));
  EXPECT_EQ(out.points.size(), 5u);
  EXPECT_EQ(out.segments.size(), 4u);
}

TEST(ResolveCrossings, SegmentsOfNoLengthAreDropped) {
  Plc<2> plc;
  plc.first_index = 1;
  plc.points = {{{0, 0}}, {{2, 2}}, {{0, 2}}, {{2, 0}}, {{0, 0}}};
  add_segment(plc, 0, 1, 5);
  add_segment(plc, 2, 3, 6);
  add_segment(plc, 4, 0, 7);
  add_segment(plc, 2, 2, 8);
  std::vector<Diagnostic> repairs;
  EXPECT_EQ(resolve_crossings(plc, repairs).segments.size(), 4u);
  ASSERT_EQ(repairs.size(), 2u);
  EXPECT_EQ(repairs[0].code, Errc::degenerate_segment);
  EXPECT_EQ(repairs[0].ids, (std::vector<std::int64_t>{3, 5, 1, 4, 3, 3}));
}

/// Touching and overlapping is left to Domain, which adds no point.
TEST(ResolveCrossings, WhatTouchesIsLeftAlone) {
  Plc<2> plc;
  add_square(plc, 0, 4);
  plc.points.insert(plc.points.end(), {{{2, 0}}, {{2, 3}}, {{1, 4}}, {{3, 4}}});
  add_segment(plc, 4, 5);
  add_segment(plc, 6, 7);
  std::vector<Diagnostic> repairs;
  EXPECT_EQ(resolve_crossings(plc, repairs).segments.size(), plc.segments.size());
  EXPECT_TRUE(repairs.empty());
}

/// Roads that end on others, in a file that keeps no point on a slanted one: the ends are up to four ulps off. That is no
/// crossing, unless something else is.
TEST(ResolveCrossings, SegmentsGoThroughPointsThatTheyNearlyMeet) {
  Random random(7);
  Plc<2> plc;
  add_square(plc, -1, 2);
  plc.points.insert(plc.points.end(), {{{0.1, 0.2}}, {{0.9, 0.7}}});
  add_segment(plc, 4, 5, 7);
  for (int i = 1; i <= 20; ++i) {
    const double t = (i + 0.3) / 21, off = (uniform(random) - 0.5) * 0x1p-50;
    plc.points.insert(plc.points.end(), {{{0.1 + 0.8 * t - off, 0.2 + 0.5 * t + off}}, {{0.2 + 0.8 * t, 0.1 + 0.5 * t}}});
    add_segment(plc, 4 + 2 * i, 5 + 2 * i, 8);
  }
  std::vector<Diagnostic> repairs;
  EXPECT_EQ(resolve_crossings(plc, repairs).segments.size(), plc.segments.size());
  EXPECT_TRUE(repairs.empty());
  EXPECT_EQ(refine<2>(plc, {}).poor_left, 0u);
  plc.points.insert(plc.points.end(), {{{0.1, 1.2}}, {{0.9, 1.7}}, {{0.1, 1.7}}, {{0.9, 1.2}}});
  const auto last = static_cast<std::uint32_t>(plc.points.size());
  add_segment(plc, last - 4, last - 3, 9);
  add_segment(plc, last - 2, last - 1, 9);
  const Plc<2> out = resolve_crossings(plc, repairs);
  EXPECT_EQ(out.points.size(), plc.points.size() + 1);
  EXPECT_EQ(out.segments.size(), plc.segments.size() + 22);
  ASSERT_EQ(repairs.size(), 2u);
  EXPECT_EQ(repairs[0].code, Errc::point_on_segment);
  EXPECT_EQ(repairs[0].ids.size(), 3 * 20u);
  EXPECT_EQ(refine<2>(out, {}).poor_left, 0u);
}

/// What a Domain refuses comes back as it is.
TEST(ResolveCrossings, OfInvalidInput) {
  Plc<2> plc;
  add_square(plc, 0, 4);
  add_segment(plc, 0, 99);
  std::vector<Diagnostic> repairs;
  EXPECT_EQ(resolve_crossings(plc, repairs).segments.size(), 5u);
  EXPECT_EQ(with_convex_hull(plc).segments.size(), 5u);
  EXPECT_THROW(Domain<2>{resolve_crossings(plc, repairs)}, InputError);
}

TEST(ResolveCrossings, ScalesByPowersOfTwo) {
  const Plc<2> plc = tangle(30, 0, 3);
  std::vector<Diagnostic> repairs;
  const Plc<2> out = resolve_crossings(plc, repairs);
  for (const double factor : {0x1p-400, 0x1p-3, 0x1p500}) {
    const Plc<2> other = resolve_crossings(scaled<2>(plc, factor), repairs);
    ASSERT_EQ(other.points.size(), out.points.size());
    for (std::size_t i = 0; i < out.points.size(); ++i)
      for (int k = 0; k < 2; ++k) EXPECT_EQ(other.points[i][k], factor * out.points[i][k]);
  }
}

TEST(ResolveCrossings, IsMeshed) {
  std::vector<Diagnostic> repairs;
  for (const Plc<2>& plc : {tangle(25, 0, 5), tangle(25, 8, 5)}) {
    const auto [result, report] = refine_and_check<2>(resolve_crossings(plc, repairs), {});
    EXPECT_EQ(result.stop, StopCause::finished);
    EXPECT_LE(report.exit_code(), 1) << findings(report);
  }
}

/// Two segments of one line overlap, one of them passes through a loose point, and another segment crosses them at a point
/// that is rounded: split there first, their pieces would leave each other by an ulp, with slivers all along between.
TEST(ResolveCrossings, WhatTouchesIsSplitBefore) {
  Plc<2> plc;
  plc.points = {{{0, 0}}, {{9, 3}}, {{3, 1}}, {{6, 2}}, {{4, 1}}, {{5, 3}}, {{7.5, 2.5}}};
  add_segment(plc, 0, 1);
  add_segment(plc, 2, 3);
  add_segment(plc, 4, 5);
  plc.first_index = 1;
  std::vector<Diagnostic> repairs;
  const Plc<2> out = resolve_crossings(plc, repairs);
  ASSERT_EQ(repairs.size(), 2u);
  EXPECT_EQ(repairs[0].code, Errc::point_on_segment);
  EXPECT_EQ(repairs[0].ids, (std::vector<std::int64_t>{3, 1, 2, 4, 1, 2, 7, 1, 2}));
  EXPECT_EQ(repairs[1].code, Errc::entities_intersect);
  ASSERT_EQ(out.points.size(), 8u);
  std::set<std::array<std::uint32_t, 2>> edges;
  for (const auto& s : out.segments) edges.insert({std::min(s.points[0], s.points[1]), std::max(s.points[0], s.points[1])});
  EXPECT_EQ(edges, (std::set<std::array<std::uint32_t, 2>>{{0, 2}, {2, 7}, {3, 7}, {3, 6}, {1, 6}, {4, 7}, {5, 7}}));
  const auto [result, report] = refine_and_check<2>(with_convex_hull(out), {});
  EXPECT_LE(report.exit_code(), 1) << findings(report);
  EXPECT_LT(result.mesh.cells.size(), 500u);
}

/// Bundles of segments nearly of one line, by rounding, cross ever anew, at ever more places, if each crossing is rounded
/// by itself.
TEST(ResolveCrossings, BundlesComeToAnEnd) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    Random random(seed);
    Plc<2> plc;
    add_square(plc, -1.2e9, 1.2e9);
    const double unit = 16576771.999842852;
    for (int i = 0; i < 60; ++i) {
      const double place = 0.5 * (static_cast<double>(below(random, 7)) - 3);
      for (int end = 0; end < 2; ++end) {
        const double at = static_cast<double>(below(random, 9)) - 9 * (1 - end) + 0.5;
        plc.points.push_back({{(0.1 * at + place) * unit, 0.3 * at * unit}});
      }
      const auto last = static_cast<std::uint32_t>(plc.points.size());
      add_segment(plc, last - 2, last - 1);
    }
    std::vector<Diagnostic> repairs;
    const Plc<2> out = resolve_crossings(plc, repairs);
    EXPECT_LT(out.points.size(), plc.points.size() + 1000) << "seed " << seed;
    RefineOptions<2> options;
    options.refine = false;
    options.radius_edge_bound = 1e18;
    const auto [result, report] = refine_and_check<2>(out, options);
    EXPECT_LE(report.exit_code(), 1) << findings(report);
  }
}

/// The edges of a graph, by the coordinates of their ends.
std::vector<std::array<double, 4>> edges_of(const Plc<2>& plc) {
  std::vector<std::array<double, 4>> edges;
  for (const auto& s : plc.segments) {
    Point2 a = plc.points[s.points[0]], b = plc.points[s.points[1]];
    if (lex_less(b, a)) std::swap(a, b);
    edges.push_back({a[0], a[1], b[0], b[1]});
  }
  std::sort(edges.begin(), edges.end());
  return edges;
}

/// A crossing near a point that is there becomes that point; and the third of three lines passes through that of two.
TEST(ResolveCrossings, CrossingsJoinWhatIsWithinTheTolerance) {
  Plc<2> plc;
  plc.points = {{{0, 0}}, {{2, 2}}, {{0, 2}}, {{2, 0}}, {{1.0005, 1}}};
  add_segment(plc, 0, 1);
  add_segment(plc, 2, 3);
  std::vector<Diagnostic> repairs;
  plc.tolerance = 1e-3;
  EXPECT_EQ(resolve_crossings(plc, repairs).points.size(), 5u);
  plc.tolerance = 1e-4;  // not even twice that
  EXPECT_EQ(resolve_crossings(plc, repairs).points.size(), 6u);
  plc.points[4] = {{0.9, 0.0001}};
  plc.points.push_back({{1.1, 2}});
  add_segment(plc, 4, 5);
  plc.tolerance = 1e-3;
  const Plc<2> out = resolve_crossings(plc, repairs);
  EXPECT_EQ(out.points.size(), 7u);
  EXPECT_EQ(out.segments.size(), 6u);
}

/// Whatever the tolerance, what comes of it does not depend on the order of points and segments, and once is enough.
TEST(ResolveCrossings, InAnyOrder) {
  for (const double tolerance : {0.0, 1e-9, 0.003, 0.01})
    for (std::uint64_t seed = 1; seed <= 10; ++seed) {
      Plc<2> plc = tangle(30, 0, seed);
      plc.tolerance = tolerance;
      std::vector<Diagnostic> repairs, again;
      const Plc<2> out = resolve_crossings(plc, repairs);
      resolve_crossings(out, again);
      EXPECT_TRUE(again.empty()) << tolerance << ", seed " << seed;
      Random random(seed);
      std::vector<std::uint32_t> place(plc.points.size());
      std::iota(place.begin(), place.end(), 0);
      std::shuffle(place.begin(), place.end(), random);
      Plc<2> other = plc;
      for (std::size_t i = 0; i < place.size(); ++i) other.points[place[i]] = plc.points[i];
      for (auto& s : other.segments) s = {{place[s.points[1]], place[s.points[0]]}, s.marker};
      std::shuffle(other.segments.begin(), other.segments.end(), random);
      EXPECT_EQ(edges_of(resolve_crossings(other, repairs)), edges_of(out)) << tolerance << ", seed " << seed;
    }
}

/// Points of a side that rounding has put beside it are on it.
TEST(ConvexHull, GoesThroughPointsThatItNearlyMeets) {
  Random random(5);
  for (int k = 0; k < 20; ++k) {
    const double angle = uniform(random), c = std::cos(angle), s = std::sin(angle);
    Plc<2> plc;
    for (int i = 0; i < 36; ++i) {
      const double x = i % 6, y = i / 6;
      plc.points.push_back({{47 + c * x - s * y, 8 + s * x + c * y}});
    }
    EXPECT_EQ(with_convex_hull(plc).segments.size(), 20u) << angle;
    plc.tolerance = 0;
    EXPECT_LE(with_convex_hull(plc).segments.size(), 20u) << angle;
  }
}

/// The hull's edges are those with all points on one side, or on them.
TEST(ConvexHull, AgainstAllPairs) {
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    Random random(seed);
    Plc<2> plc;
    for (int i = 0; i < 30; ++i)
      plc.points.push_back({{static_cast<double>(below(random, 7)), static_cast<double>(below(random, 7))}});
    const Plc<2> out = with_convex_hull(plc);
    std::set<std::pair<Point2, Point2>, bool (*)(const std::pair<Point2, Point2>&, const std::pair<Point2, Point2>&)> wanted(
        [](const auto& s, const auto& t) {
          return s.first == t.first ? lex_less(s.second, t.second) : lex_less(s.first, t.first);
        });
    auto found = wanted;
    for (std::uint32_t a = 0; a < plc.points.size(); ++a)
      for (std::uint32_t b = 0; b < plc.points.size(); ++b) {
        bool is_edge = lex_less(plc.points[a], plc.points[b]), left = false, right = false;
        for (std::uint32_t v = 0; is_edge && v < plc.points.size(); ++v) {
          const Sign side = orient2d(plc.points[a], plc.points[b], plc.points[v]);
          left = left || side == Sign::positive;
          right = right || side == Sign::negative;
          is_edge = !(left && right) && !is_inside(plc.points, a, b, v);
        }
        if (is_edge) wanted.emplace(plc.points[a], plc.points[b]);
      }
    for (const auto& s : out.segments) {
      Point2 a = plc.points[s.points[0]], b = plc.points[s.points[1]];
      if (lex_less(b, a)) std::swap(a, b);
      EXPECT_TRUE(found.emplace(a, b).second) << "seed " << seed << ": twice";
    }
    EXPECT_TRUE(std::equal(found.begin(), found.end(), wanted.begin(), wanted.end())) << "seed " << seed;
  }
}

TEST(ConvexHull, SegmentsOfTheInputAreKept) {
  Plc<2> plc;
  add_square(plc, 0, 1, 9);
  plc.segments.resize(2);
  const Plc<2> out = with_convex_hull(plc);
  ASSERT_EQ(out.segments.size(), 4u);
  EXPECT_EQ(out.segments[0].marker, 9);
  EXPECT_EQ(out.segments[2].marker, 0);
  const auto [result, report] = refine_and_check<2>(out, {});
  EXPECT_EQ(report.exit_code(), 0) << findings(report);
}

}  // namespace pgdr::test_input_planar_plc
