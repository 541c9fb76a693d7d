// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Points within the tolerance: points that files write with different digits. The story: an STL file of a demo of gmsh whose
// corners differ by 1e-16 from one triangle to the next was refused for facets that intersect, without a word about why.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "domain_plcs.hpp"
#include "pgdr/check.hpp"
#include "pgdr/diagnosis.hpp"
#include "pgdr/refine.hpp"
#include "planar_plcs.hpp"
#include "refined_models.hpp"
#include "repair_plcs.hpp"

namespace pgdr::test_input_merge_points {

using test::below;
using test::box;
using test::moved;
using test::Random;
using test::triangulated;
using test::uniform;

template <int D>
Point<D> near(const Point<D>& p, double noise, Random& random) {
  Point<D> q = p;
  for (double& x : q.x) x += noise * (2 * uniform(random) - 1);
  return q;
}

/// Every triangle with corners of its own, each off by at most `noise` in each coordinate.
Plc<3> soup(const Plc<3>& plc, double noise) {
  Random random(5);
  Plc<3> out;
  for (const auto& f : plc.facets) {
    const auto n = static_cast<std::uint32_t>(out.points.size());
    for (const std::uint32_t v : f.polygons[0]) out.points.push_back(near(plc.points[v], noise, random));
    out.facets.push_back({{{n, n + 1, n + 2}}, {}, f.marker});
  }
  return out;
}

std::size_t count_of(const std::vector<Diagnostic>& repairs, Errc code) {
  const auto at = std::ranges::find(repairs, code, &Diagnostic::code);
  return at == repairs.end() ? 0 : at->ids.size() / 2;
}

template <int D>
void expect_meshed(const Plc<D>& plc, double volume) {
  const RefineOptions<D> options;
  const auto result = refine<D>(plc, options);
  CheckOptions<D> check_options;
  check_options.input = &plc;
  check_options.tolerance = result.tolerance;
  check_options.radius_edge_bound = options.radius_edge_bound;
  check_options.largest_cosine = result.optimization.claimed_cosine;
  check_options.delaunay = result.delaunay;
  check_options.reasons = &result.reasons;
  const CheckReport report = check<D>(result.mesh, check_options);
  EXPECT_LE(report.exit_code(), 1);
  for (const auto& f : report.findings) ADD_FAILURE() << f.message;
  EXPECT_NEAR(test::volume_of<D>(result.mesh) / volume, 1, 1e-7);
}

TEST(MergePoints, ASoupOfTriangles) {
  for (const auto& [by, exponent, offset] : {std::tuple{0, 0, 0.0}, {1, 40, -3.25}, {2, -300, 0.0}}) {
    Plc<3> plc = moved(soup(triangulated(box()), 1e-10), by, exponent, offset);
    const Diagnosis<3> before = diagnose(plc);
    EXPECT_EQ(before[Finding::near_points].count, 36u - 8);
    EXPECT_GE(before[Finding::open_boundary].count, 1u);
    plc.tolerance = std::ldexp(1e-9, exponent);
    const Domain<3> d(plc);
    EXPECT_EQ(d.points().size(), 8u);
    EXPECT_EQ(count_of(d.repairs(), Errc::near_points), 28u);
    const Diagnosis<3> after = diagnose(d);
    EXPECT_EQ(after.error_count(), 0u);
    EXPECT_EQ(after[Finding::open_boundary].count, 0u);
    EXPECT_EQ(after[Finding::near_points].count, 0u);
    expect_meshed(plc, std::ldexp(6.0, 3 * exponent));
  }
}

// What the diagnosis gives as measure is what it takes.
TEST(MergePoints, ByTheMeasureOfTheDiagnosis) {
  Plc<3> plc = soup(triangulated(box()), 1e-8);
  const Diagnosis<3> diagnosis = diagnose(plc, {.most_listed = 3});
  const auto& found = diagnosis[Finding::near_points];
  EXPECT_EQ(found.count, 28u);
  ASSERT_EQ(found.listed.size(), 3u);
  EXPECT_EQ(found.listed[0].what.ids.size(), 2u);
  EXPECT_GT(found.listed[0].measure, found.listed[1].measure);
  const double measure = found.listed[0].measure;
  EXPECT_GT(measure, 1e-10);
  plc.tolerance = measure * (1 + 1e-9);
  EXPECT_EQ(Domain<3>(plc).points().size(), 8u);
}

/// Of each point the first of its group: the connected components of "within the distance", but for those wider than twice it.
template <int D>
std::vector<std::uint32_t> by_brute_force(const std::vector<Point<D>>& points, double distance) {
  const auto n = static_cast<std::uint32_t>(points.size());
  std::vector<std::uint32_t> group(n);
  std::iota(group.begin(), group.end(), 0u);
  for (bool changed = true; std::exchange(changed, false);)
    for (std::uint32_t v = 0; v < n; ++v)
      for (std::uint32_t w = 0; w < n; ++w)
        if (group[w] < group[v] && std::sqrt(squared_distance(points[v], points[w])) <= distance) {
          group[v] = group[w];
          changed = true;
        }
  std::vector<std::uint32_t> out(group);
  for (std::uint32_t v = 0; v < n; ++v)
    for (std::uint32_t w = 0; w < n; ++w)
      if (group[v] == group[w] && std::sqrt(squared_distance(points[v], points[w])) > 2 * distance)
        for (std::uint32_t u = 0; u < n; ++u)
          if (group[u] == group[v]) out[u] = static_cast<std::uint32_t>(std::ranges::find(points, points[u]) - points.begin());
  return out;
}

// Clusters, chains of points each near enough to the next, repeated points; the largest coordinate is 1.
template <int D>
void compare_with_brute_force() {
  Random random(17);
  for (int round = 0; round < 60; ++round) {
    const double distance = std::ldexp(1.0, -7 - static_cast<int>(below(random, 30)));
    Plc<D> plc;
    Point<D> far;
    for (double& x : far.x) x = 1;
    plc.points.push_back(far);
    for (int k = 0; k < 300; ++k) {
      const auto& other = plc.points[below(random, plc.points.size())];
      Point<D> p;
      switch (below(random, 4)) {
        case 0:
          for (double& x : p.x) x = 2 * uniform(random) - 1;
          break;
        case 1: p = other; break;
        default: p = near(other, distance * (round % 2 == 0 ? 1 : 0.25), random);
      }
      for (double& x : p.x) x = std::clamp(x, -1.0, 1.0);
      plc.points.push_back(p);
    }
    plc.tolerance = distance;
    plc.is_coarse = true;
    std::vector<Diagnostic> refused;
    const Domain<D> d = Domain<D>::without_invalid(plc, refused);
    std::vector<std::uint32_t> first;
    for (const std::uint32_t v : d.point_of_input()) first.push_back(d.input_of_point()[v]);
    EXPECT_EQ(first, by_brute_force(plc.points, distance)) << round;
    double farthest = 0;
    for (std::size_t i = 0; i < plc.points.size(); ++i)
      farthest = std::max(farthest, std::sqrt(squared_distance(plc.points[i], d.points()[d.point_of_input()[i]])));
    EXPECT_LE(farthest, 2 * distance);
    EXPECT_EQ(d.largest_move(), farthest);
  }
}
TEST(MergePoints, AreThoseOfBruteForce2D) { compare_with_brute_force<2>(); }
TEST(MergePoints, AreThoseOfBruteForce3D) { compare_with_brute_force<3>(); }

// A side with a corner cut off by a needle, and a loose segment of two near points: nothing is left of them.
TEST(MergePoints, WhatCollapsesGoes) {
  Plc<3> plc = triangulated(box());
  const auto n = static_cast<std::uint32_t>(plc.points.size());
  plc.points.push_back({2 - 1e-9, 0, 0});  // beside point 1
  for (auto& f : plc.facets)               // the bottom, z = 0, has it instead, and a needle in the gap
    if (std::ranges::all_of(f.polygons[0], [&](std::uint32_t v) { return plc.points[v][2] == 0; }))
      std::ranges::replace(f.polygons[0], 1u, n);
  plc.facets.push_back({{{n, 2, 1}}, {}, 0});
  plc.facets.push_back({{{0, n, 1}}, {}, 0});
  plc.points.push_back({1, 0.5, 1.5});
  plc.points.push_back({1, 0.5, 1.5 + 1e-10});
  plc.segments.push_back({{n + 1, n + 2}, 3});
  plc.tolerance = 1e-8;
  const Domain<3> d(plc);
  EXPECT_EQ(d.points().size(), 9u);
  EXPECT_EQ(d.facets().size(), 6u);
  EXPECT_EQ(d.segments().size(), 12u);
  const auto& repairs = d.repairs();
  const auto flat = std::ranges::find(repairs, Errc::degenerate_facet, &Diagnostic::code);
  ASSERT_NE(flat, repairs.end());
  EXPECT_EQ(flat->ids, (std::vector<std::int64_t>{12, 13}));
  const auto gone = std::ranges::find(repairs, Errc::degenerate_segment, &Diagnostic::code);
  ASSERT_NE(gone, repairs.end());
  EXPECT_EQ(gone->ids, (std::vector<std::int64_t>{0, n + 1, n + 2}));
  expect_meshed(plc, 6);
}

TEST(MergePoints, InThePlane) {
  Plc<2> plc;
  Random random(3);
  const std::vector<Point2> corner{{0, 0}, {2, 0}, {2, 1}, {0, 1}};
  for (std::uint32_t i = 0; i < 4; ++i) {
    plc.points.push_back(near(corner[i], 1e-9, random));
    plc.points.push_back(near(corner[(i + 1) % 4], 1e-9, random));
    plc.segments.push_back({{2 * i, 2 * i + 1}, 1});
  }
  EXPECT_EQ(diagnose(plc)[Finding::near_points].count, 4u);
  plc.tolerance = 1e-8;
  const Domain<2> d(plc);
  EXPECT_EQ(d.points().size(), 4u);
  expect_meshed(plc, 2);
}

// By default what rounding moved, and nothing else.
TEST(MergePoints, TheDefault) {
  Plc<3> plc = soup(triangulated(box()), 2e-16);
  EXPECT_EQ(Domain<3>(plc).points().size(), 8u);
  plc.tolerance = 0;
  std::vector<Diagnostic> refused;
  EXPECT_GT(Domain<3>::without_invalid(plc, refused).points().size(), 20u);
  refused.clear();
  EXPECT_GT(Domain<3>::without_invalid(soup(triangulated(box()), 1e-13), refused).points().size(), 20u);
  EXPECT_EQ(rounding_tolerance(box()), 0x1p-48) << "8 ulps of 3";
  Plc<3> floats = box();
  floats.are_floats = true;
  EXPECT_EQ(rounding_tolerance(floats), 0x1p-21) << "2 ulps of a float";
  for (Point3& p : floats.points) p[0] += 1e6;
  EXPECT_EQ(rounding_tolerance(floats), std::ldexp(8.0, 19 - 52)) << "floats have no shape so far from the origin";
  EXPECT_EQ(rounding_tolerance(Plc<3>{}), 0);
  EXPECT_EQ(diagnose(soup(triangulated(box()), 0.001))[Finding::near_points].count, 0u);
  EXPECT_EQ(diagnose(box())[Finding::near_points].count, 0u);
}

TEST(MergePoints, OtherDistancesAreRefused) {
  for (const double within : {-1e-9, 0.011, std::numeric_limits<double>::infinity(), std::numeric_limits<double>::quiet_NaN()}) {
    Plc<3> plc = box();
    plc.tolerance = within;
    EXPECT_THROW(Domain<3>{plc}, UsageError) << within;
    plc.is_coarse = true;
    if (within > 0 && within < 1)
      EXPECT_EQ(Domain<3>(plc).points().size(), 8u);
    else
      EXPECT_THROW(Domain<3>{plc}, UsageError) << within;
  }
}

// Three points in a row, each within the tolerance of the next: which two are one?
TEST(MergePoints, AmbiguousGroups) {
  Plc<2> plc;
  plc.points = {{0, 0}, {1, 0}, {1, 1}, {0, 1}, {0.5, 0.5}, {0.5 + 9e-4, 0.5}, {0.5 + 18e-4, 0.5}, {0.5 + 27e-4, 0.5}};
  for (std::uint32_t i = 0; i < 4; ++i) plc.segments.push_back({{i, (i + 1) % 4}, 0});
  plc.tolerance = 1e-3;
  try {
    const Domain<2> d(plc);
    ADD_FAILURE();
  } catch (const InputError& e) {
    EXPECT_EQ(e.code(), Errc::ambiguous);
    EXPECT_EQ(e.diagnostic().ids, (std::vector<std::int64_t>{4, 7}));
  }
  plc.points.pop_back();
  EXPECT_EQ(Domain<2>(plc).points().size(), 5u) << "no wider than twice the tolerance";
  for (const auto& order : {std::array{4, 5, 6}, {6, 5, 4}, {5, 4, 6}}) {
    Plc<2> permuted = plc;
    for (std::size_t k = 0; k < 3; ++k) permuted.points[4 + k] = plc.points[static_cast<std::size_t>(order[k])];
    EXPECT_EQ(Domain<2>(permuted).points()[4], plc.points[4]) << "the place of a group does not depend on the order";
  }
}

/// As floats, with what a program may have computed for each zero.
Plc<3> with_noise_for_zeros(Plc<3> plc, double noise) {
  Random random(7);
  for (Point3& p : plc.points)
    for (double& x : p.x) x = static_cast<float>(x == 0 ? noise * (2 * uniform(random) - 1) : x + 0.1);
  plc.are_floats = true;
  return plc;
}

// Five parts of robots, four tables of printers and a demo of gmsh were refused for walls that intersect, 1e-17 wide; a hull with
// twelve such edges had 34 million cells when it was stopped.
TEST(MergePoints, FloatsOfWhatWasComputedForZero) {
  const Plc<3> plc = with_noise_for_zeros(soup(triangulated(box()), 0), 3e-15);
  Plc<3> apart = plc;
  apart.tolerance = 0;
  EXPECT_GE(diagnose(apart).error_count(), 1u);
  const Domain<3> d(plc);
  EXPECT_EQ(d.points().size(), 8u);
  EXPECT_EQ(d.facets().size(), 6u);
  EXPECT_EQ(count_of(d.repairs(), Errc::near_points), 36u - 8 - 4) << "the corner without a zero is the same in five triangles";
  expect_meshed(plc, 2.1 * 1.1 * 3.1);
}

// Of a sheet that is thinner than the rounding of floats nothing is left, which is said.
TEST(MergePoints, ASheetOfFloats) {
  Plc<3> sheet = triangulated(box());
  for (Point3& p : sheet.points)
    p = {{static_cast<float>(p[0] + 0.1), static_cast<float>(p[1] + 0.1), static_cast<float>(p[2] * 1e-17)}};
  sheet.are_floats = true;
  EXPECT_GE(diagnose(sheet).error_count(), 1u);
}

}  // namespace pgdr::test_input_merge_points
