// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Surfaces with openings: pipes, boxes without lids, plates with holes. What encloses something once they are closed is known.
#include <gtest/gtest.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <numeric>
#include <random>
#include <set>
#include <string>

#include "allow_threads.hpp"
#include "cube_bodies.hpp"
#include "pgdr/bodies.hpp"
#include "pgdr/diagnosis.hpp"
#include "pgdr/joined_plc.hpp"
#include "pgdr/openings.hpp"
#include "pgdr/surface_counts.hpp"

namespace pgdr {
namespace {

using test::Body;
using test::box;

/// A wall of n quadrilaterals about the z axis, from z = low to z = high, as triangles.
void add_pipe(Plc<3>& plc, int n, double radius, double low, double high, bool outwards, int marker = 0) {
  const auto base = static_cast<std::uint32_t>(plc.points.size());
  for (int k = 0; k < n; ++k) {
    const double angle = 2 * std::numbers::pi * k / n;
    for (const double z : {low, high}) plc.points.push_back({{radius * std::cos(angle), radius * std::sin(angle), z}});
  }
  for (int k = 0; k < n; ++k) {
    const auto at = [&](int i, int side) { return base + static_cast<std::uint32_t>(2 * (i % n) + side); };
    std::vector<std::uint32_t> a{at(k, 0), at(k + 1, 0), at(k + 1, 1)}, b{at(k, 0), at(k + 1, 1), at(k, 1)};
    for (auto* t : {&a, &b}) {
      if (!outwards) std::reverse(t->begin(), t->end());
      plc.facets.push_back({{*t}, {}, marker});
    }
  }
}

/// The area within a regular polygon of n corners.
double disc(int n, double radius) { return n * radius * radius * std::sin(2 * std::numbers::pi / n) / 2; }

struct Closed {
  Plc<3> plc;
  std::vector<Diagnostic> openings;
};

Closed closed(const Plc<3>& plc) {
  Closed c;
  c.plc = close_planar_openings(plc, c.openings);
  EXPECT_EQ(c.plc.facets.size(), plc.facets.size() + c.openings.size());
  for (std::size_t f = 0; f < plc.facets.size(); ++f) EXPECT_EQ(c.plc.facets[f].polygons, plc.facets[f].polygons);
  return c;
}

/// Volumes of the regions of its bodies, in order of size; also certifies that nothing crosses, and no surface is open.
std::vector<double> volumes(const Plc<3>& plc) {
  EXPECT_EQ(diagnose(plc).error_count(), 0u);
  EXPECT_EQ(surface_counts(Domain<3>(plc)).open_loops, 0u);
  std::vector<double> found;
  for (const BodyRegion& r : with_bodies(plc, BodyMode::united).regions) found.push_back(r.volume);
  std::ranges::sort(found);
  return found;
}

/// By some angle about some axis, and moved.
Plc<3> turned(Plc<3> plc, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  double q[4], n = 0;
  for (double& x : q) {
    x = normal(random);
    n += x * x;
  }
  for (double& x : q) x /= std::sqrt(n);
  const auto [w, x, y, z] = q;
  const double rows[3][3] = {{1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)},
                             {2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)},
                             {2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)}};
  for (Point3& p : plc.points) {
    Point3 t;
    for (int i = 0; i < 3; ++i) t[i] = rows[i][0] * p[0] + rows[i][1] * p[1] + rows[i][2] * p[2] + 3;
    p = t;
  }
  return plc;
}

/// The same surface, with its points and facets in another order, and corners of facets begun elsewhere.
Plc<3> shuffled(const Plc<3>& plc, unsigned seed) {
  std::mt19937 random(seed);
  std::vector<std::uint32_t> place(plc.points.size());
  std::iota(place.begin(), place.end(), 0u);
  std::ranges::shuffle(place, random);
  Plc<3> other = plc;
  for (std::size_t i = 0; i < place.size(); ++i) other.points[place[i]] = plc.points[i];
  for (auto& f : other.facets)
    for (auto& polygon : f.polygons) {
      for (auto& v : polygon) v = place[v];
      std::rotate(polygon.begin(), polygon.begin() + random() % polygon.size(), polygon.end());
    }
  std::ranges::shuffle(other.facets, random);
  return other;
}

TEST(PlanarOpenings, EndsOfAPipe) {
  Plc<3> pipe;
  add_pipe(pipe, 24, 2, -1, 4, true, 7);
  for (const Plc<3>& plc : {pipe, turned(pipe, 1), turned(pipe, 2)}) {
    EXPECT_EQ(diagnose(plc)[Finding::encloses_nothing].count, 1u);
    const Closed c = closed(plc);
    ASSERT_EQ(c.openings.size(), 2u);
    const auto all = volumes(c.plc);
    ASSERT_EQ(all.size(), 1u);
    EXPECT_NEAR(all[0], 5 * disc(24, 2), 1e-9);
    EXPECT_EQ(c.plc.facets[48].marker, 1);
    EXPECT_EQ(c.plc.facets[49].marker, 2);
    EXPECT_EQ(c.plc.names.markers, (std::map<int, std::string>{{1, "closed_opening_1"}, {2, "closed_opening_2"}}));
    EXPECT_EQ(diagnose(c.plc)[Finding::inconsistent_orientation].count, 0u) << "the lids go on in the direction of the wall";
    for (const Diagnostic& d : c.openings) {
      EXPECT_EQ(d.code, Errc::open_boundary);
      EXPECT_EQ(d.ids.size(), 24u);
      EXPECT_EQ(d.points.size(), 24u);
    }
    EXPECT_NE(c.openings[0].message.find("24 edges"), std::string::npos) << c.openings[0].message;
    EXPECT_NE(c.openings[1].message.find("of marker 2 (closed_opening_2)"), std::string::npos) << c.openings[1].message;
    const Closed again = closed(c.plc);
    EXPECT_TRUE(again.openings.empty()) << "nothing is left to close";
  }
}

TEST(PlanarOpenings, WallOfAPipeAndPipeInPipe) {
  Plc<3> wall;
  add_pipe(wall, 24, 2, 0, 3, true);
  Plc<3> pipes = wall;
  add_pipe(wall, 16, 1, 0, 3, false);
  add_pipe(pipes, 16, 1, 0, 3, true);
  for (unsigned seed = 0; seed < 3; ++seed) {
    const Closed ring = closed(seed == 0 ? wall : turned(wall, seed));
    ASSERT_EQ(ring.openings.size(), 2u);
    EXPECT_EQ(ring.plc.facets.back().polygons.size(), 2u);
    EXPECT_EQ(ring.plc.facets.back().holes.size(), 1u);
    EXPECT_EQ(ring.openings[0].ids.size(), 40u);
    EXPECT_NE(ring.openings[0].message.find(", around 16 edges"), std::string::npos) << ring.openings[0].message;
    const auto of_ring = volumes(ring.plc);
    ASSERT_EQ(of_ring.size(), 1u);
    EXPECT_NEAR(of_ring[0], 3 * (disc(24, 2) - disc(16, 1)), 1e-9);

    const Closed both = closed(seed == 0 ? pipes : turned(pipes, seed));
    EXPECT_EQ(both.openings.size(), 4u) << "the ring and the disc, at both ends";
    const auto of_both = volumes(both.plc);
    ASSERT_EQ(of_both.size(), 1u);
    EXPECT_NEAR(of_both[0], 3 * disc(24, 2), 1e-9);
    EXPECT_EQ(diagnose(both.plc).error_count(), 0u);
  }
}

TEST(PlanarOpenings, NestedLoopsWithoutADirectionTakeTurns) {
  Plc<3> plc;
  for (const double radius : {4.0, 3.0, 2.0, 1.0}) add_pipe(plc, 12, radius, 0, 1, radius > 2);
  for (const std::size_t f : {0u, 1u})  // one at each end
    std::reverse(plc.facets[f].polygons[0].begin(), plc.facets[f].polygons[0].end());
  const Closed c = closed(plc);
  ASSERT_EQ(c.openings.size(), 4u);
  for (std::size_t f = plc.facets.size(); f < c.plc.facets.size(); ++f) EXPECT_EQ(c.plc.facets[f].polygons.size(), 2u);
  EXPECT_NEAR(volumes(c.plc).back(), disc(12, 4) - disc(12, 3), 1e-9);
}

TEST(PlanarOpenings, BoxesWithoutLids) {
  for (const std::size_t missing : {0u, 3u, 5u}) {
    Plc<3> plc = test::surfaces({box({0, 0, 0}, {2, 2, 2})});
    // All squares of one side: two triangles each, of facets whose corners have one coordinate in common.
    const int axis = static_cast<int>(missing) / 2;
    const double level = missing % 2 == 0 ? 0 : 2;
    std::erase_if(plc.facets, [&](const auto& f) {
      return std::ranges::all_of(f.polygons[0], [&](std::uint32_t v) { return plc.points[v][axis] == level; });
    });
    plc.facet_bodies.resize(plc.facets.size());
    ASSERT_EQ(plc.facets.size(), 40u);
    const Closed c = closed(plc);
    ASSERT_EQ(c.openings.size(), 1u);
    EXPECT_EQ(c.plc.facet_bodies.size(), c.plc.facets.size());
    EXPECT_EQ(volumes(c.plc), std::vector<double>{8});
  }
}

TEST(PlanarOpenings, WhatIsBentOrFlatStaysOpen) {
  Plc<3> corner = test::surfaces({box({0, 0, 0}, {1, 1, 1})});  // without two sides that have an edge in common
  std::erase_if(corner.facets, [&](const auto& f) {
    return std::ranges::all_of(f.polygons[0], [&](std::uint32_t v) { return corner.points[v][0] == 1; }) ||
           std::ranges::all_of(f.polygons[0], [&](std::uint32_t v) { return corner.points[v][1] == 1; });
  });
  corner.facet_bodies.clear();
  EXPECT_TRUE(closed(corner).openings.empty());

  Plc<3> sheet;  // what has its loops as its rim is in the way
  sheet.points = {{{0, 0, 0}}, {{4, 0, 0}}, {{4, 4, 0}}, {{0, 4, 0}}, {{1, 1, 0}},
                  {{2, 1, 0}}, {{2, 2, 0}}, {{1, 2, 0}}, {{0, 0, 4}}};
  sheet.facets = {{{{0, 3, 2, 1}, {4, 5, 6, 7}}, {{{1.5, 1.5, 0}}}, 0}};
  EXPECT_TRUE(closed(sheet).openings.empty());
  for (const auto& polygon : {std::vector<std::uint32_t>{0, 1, 8}, {1, 2, 8}, {2, 3, 8}, {3, 0, 8}})
    sheet.facets.push_back({{polygon}, {}, 0});  // a pyramid on it: the hole in it is an opening now
  const Closed c = closed(sheet);
  ASSERT_EQ(c.openings.size(), 1u);
  EXPECT_EQ(c.openings[0].ids.size(), 4u);
  EXPECT_EQ(c.openings[0].points[0], (std::array<double, 3>{1, 1, 0}));
  EXPECT_NEAR(volumes(c.plc).at(0), 64.0 / 3, 1e-12);
}

TEST(PlanarOpenings, WithinTheTolerance) {
  Plc<3> pipe;
  add_pipe(pipe, 12, 1, 0, 1, true);
  std::mt19937 random(5);
  std::uniform_real_distribution<double> off(-1e-4, 1e-4);
  for (Point3& p : pipe.points) p[2] += off(random);
  EXPECT_TRUE(closed(pipe).openings.empty());
  pipe.tolerance = 3e-4;
  const Closed c = closed(pipe);
  EXPECT_EQ(c.openings.size(), 2u);
  EXPECT_NEAR(volumes(c.plc).at(0), disc(12, 1), 1e-3);
  pipe.tolerance = 1e-6;
  EXPECT_TRUE(closed(pipe).openings.empty());
}

TEST(PlanarOpenings, TJunctionsOnTheRim) {
  Plc<3> plc;  // a box without a lid, one wall of which ends in two triangles more than the floor's edge says
  plc.points = {{{0, 0, 0}}, {{2, 0, 0}}, {{2, 2, 0}}, {{0, 2, 0}}, {{0, 0, 1}},
                {{2, 0, 1}}, {{2, 2, 1}}, {{0, 2, 1}}, {{1, 0, 1}}};
  plc.facets = {{{{0, 3, 2, 1}}, {}, 1},
                {{{0, 1, 5, 8, 4}}, {}, 2},
                {{{1, 2, 6, 5}}, {}, 3},
                {{{2, 3, 7, 6}}, {}, 4},
                {{{3, 0, 4, 7}}, {}, 6}};
  const Closed c = closed(plc);
  ASSERT_EQ(c.openings.size(), 1u);
  EXPECT_EQ(c.openings[0].ids.size(), 5u);
  EXPECT_EQ(c.plc.facets.back().marker, 5) << "the least that is free";
  EXPECT_EQ(volumes(c.plc), std::vector<double>{4});
}

TEST(PlanarOpenings, LoopsThatTouchAtAPoint) {
  // Two openings of one side of a box that have a corner in common.
  Plc<3> plc = test::surfaces({box({0, 0, 0}, {2, 2, 1})});
  std::erase_if(plc.facets, [&](const auto& f) {
    double x = 0, y = 0;
    for (const std::uint32_t v : f.polygons[0]) {
      if (plc.points[v][2] != 1) return false;
      x += plc.points[v][0] / 3;
      y += plc.points[v][1] / 3;
    }
    return (x < 1) == (y < 1);
  });
  plc.facet_bodies.clear();
  const Closed c = closed(plc);
  ASSERT_EQ(c.openings.size(), 2u);
  EXPECT_EQ(volumes(c.plc), std::vector<double>{4});
}

/// The body, without some of the squares of its surface that look up at some height; how many of these are left out.
std::size_t add_opened(Plc<3>& plc, const Body& cubes, int height, std::mt19937& random) {
  std::size_t missing = 0;
  for (const test::Cube& c : cubes)
    for (int axis = 0; axis < 3; ++axis)
      for (const int step : {-1, 1}) {
        test::Cube next = c, low = c;
        next[static_cast<std::size_t>(axis)] += step;
        if (step == 1) low = next;
        if (cubes.contains(next)) continue;
        const bool is_open = axis == 2 && step == 1 && next[2] == height && random() % 2 == 0;
        missing += is_open;
        if (!is_open) test::add_square(plc, low, axis, step == 1, 0);
      }
  return missing;
}

TEST(PlanarOpenings, RandomOpeningsOfBodiesOfCubes) {
  std::mt19937 random(3);
  int with_openings = 0, all_closed = 0;
  for (int run = 0; run < 300; ++run) {
    const Body cubes = box({0, 0, 0}, {3, 3, 2});
    Plc<3> plc;
    const std::size_t missing = add_opened(plc, cubes, 2, random);
    plc.facet_bodies.clear();
    if (run % 2 == 1) plc = turned(plc, static_cast<unsigned>(run));
    const Closed c = closed(plc);
    EXPECT_EQ(diagnose(c.plc)[Finding::facets_overlap].count, 0u);
    EXPECT_EQ(diagnose(c.plc)[Finding::facets_cross].count, 0u);
    double area = 0;
    for (const Diagnostic& d : c.openings) area += std::stod(d.message.substr(d.message.rfind(' ') + 1));
    with_openings += missing > 0 ? 1 : 0;
    if (surface_counts(Domain<3>(c.plc)).open_loops > 0) continue;  // loops with two points in common are not told apart
    ++all_closed;
    EXPECT_NEAR(area, static_cast<double>(missing), 1e-9) << run;
    EXPECT_NEAR(volumes(c.plc).at(0), 18, 1e-9) << run;
  }
  EXPECT_GT(with_openings, 250);
  EXPECT_GT(all_closed, 150);
}

TEST(PlanarOpenings, FilesAndNames) {
  Plc<3> a, b;
  add_pipe(a, 8, 1, 0, 1, true, 3);
  add_pipe(b, 8, 1, 2, 3, true, 3);
  a.names.markers[3] = "closed_opening_2";
  a.source.file = "a.stl";
  b.source.file = "b.stl";
  const std::array inputs{a, b};
  const Plc<3> plc = joined<3>(inputs);
  const Closed c = closed(plc);
  ASSERT_EQ(c.openings.size(), 4u);
  std::set<std::string> names;
  std::set<int> markers;
  for (const auto& f : c.plc.facets) markers.insert(f.marker);
  for (const auto& [marker, name] : c.plc.names.markers) names.insert(name);
  EXPECT_EQ(markers.size(), 6u);
  EXPECT_EQ(names.size(), 6u);
  EXPECT_TRUE(names.contains("closed_opening_5")) << "one of them has a name already";
  for (std::size_t f = plc.facets.size(); f < c.plc.facets.size(); ++f)
    EXPECT_EQ(c.plc.facet_bodies[f], c.plc.points[c.plc.facets[f].polygons[0][0]][2] < 1.5 ? 0u : 1u);
}

TEST(PlanarOpenings, OrderAndThreadsSayNothing) {
  Plc<3> plc;
  for (const double z : {0.0, 5.0, 9.0}) {
    add_pipe(plc, 20, 2, z, z + 3, true);
    add_pipe(plc, 10, 1, z, z + 3, false);
  }
  test::AllowThreads allow(4);
  std::vector<std::vector<std::array<double, 3>>> first;
  for (unsigned seed = 0; seed < 4; ++seed)
    for (const int threads : {1, 4}) {
      Closed c;
      tbb::task_arena(threads).execute([&] { c = closed(seed == 0 ? plc : shuffled(plc, seed)); });
      ASSERT_EQ(c.openings.size(), 6u);
      std::vector<std::vector<std::array<double, 3>>> found;
      for (const Diagnostic& d : c.openings) found.push_back(d.points);
      if (first.empty()) first = found;
      EXPECT_EQ(found, first) << seed;
    }
}

TEST(PlanarOpenings, WhatADomainRefusesComesBack) {
  Plc<3> plc;
  add_pipe(plc, 8, 1, 0, 1, true);
  plc.points[0][0] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(closed(plc).openings.empty());
  std::stop_source stop;
  stop.request_stop();
  std::vector<Diagnostic> openings;
  plc.points[0][0] = 1;
  EXPECT_THROW(close_planar_openings(plc, openings, stop.get_token()), CancelledError);
}

}  // namespace
}  // namespace pgdr
