// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// What a Domain repairs without changing the geometry, kind by kind: that it says so, and that a mesh comes out which
// passes the checker; plain and moved exactly. And what it does not repair.
#include <gtest/gtest.h>

#include <algorithm>

#include "domain_plcs.hpp"
#include "pgdr/check.hpp"
#include "pgdr/diagnosis.hpp"
#include "pgdr/refine.hpp"
#include "repair_plcs.hpp"

namespace pgdr::test_input_repairs {

using test::box;
using test::moved;
using test::triangulated;
using Ids = std::vector<std::int64_t>;

template <int D>
Ids repaired(const Plc<D>& plc, Errc code) {
  const Domain<D> domain(plc);
  for (const Diagnostic& d : domain.repairs())
    if (d.code == code) return d.ids;
  return {};
}

template <int D>
void expect_meshed(const Plc<D>& plc) {
  for (const auto& [by, exponent, offset] : {std::tuple{0, 0, 0.0}, {1, 0, 0.0}, {2, -30, 0.0}, {0, 12, 0.375}, {1, 40, -3.25}}) {
    const Plc<D> given = moved(exponent == 12 ? test::oblique(plc) : plc, by, exponent, offset);
    const Domain<D> domain(given);
    EXPECT_EQ(diagnose(domain).error_count(), 0u);
    const RefineOptions<D> options;
    const auto result = refine<D>(domain, options);
    EXPECT_EQ(result.stop, StopCause::finished);
    CheckOptions<D> check_options;
    check_options.input = &given;
    check_options.tolerance = domain.tolerance();
    check_options.radius_edge_bound = options.radius_edge_bound;
    check_options.largest_cosine = result.optimization.claimed_cosine;
    check_options.delaunay = result.delaunay;
    check_options.reasons = &result.reasons;
    const CheckReport report = check<D>(result.mesh, check_options);
    EXPECT_LE(report.exit_code(), 1);
    for (const auto& f : report.findings) ADD_FAILURE() << f.message;
    EXPECT_EQ(result.repairs.size(), domain.repairs().size());
  }
}

std::uint32_t add(Plc<3>& plc, const Point3& p) {
  plc.points.push_back(p);
  return static_cast<std::uint32_t>(plc.points.size() - 1);
}

TEST(Repairs, SegmentsOfNoLength) {
  Plc<2> ring;  // closed twice, and once from a point to itself
  ring.points = {{0, 0}, {4, 0}, {0, 3}, {0, 0}};
  ring.segments = {{{0, 1}, 1}, {{1, 2}, 2}, {{2, 3}, 3}, {{3, 0}, 4}, {{1, 1}, 5}};
  const Domain<2> triangle(ring);
  ASSERT_EQ(triangle.segments().size(), 3u);
  ASSERT_EQ(triangle.repairs().size(), 2u);
  EXPECT_EQ(triangle.repairs()[0].ids, (Ids{3, 0}));  // the point
  EXPECT_EQ(triangle.repairs()[1].code, Errc::degenerate_segment);
  EXPECT_EQ(triangle.repairs()[1].ids, (Ids{3, 3, 0, 4, 1, 1}));
  expect_meshed(ring);

  Plc<3> solid =
      box();  // one from a point to itself, one that is a facet, as TetGen's files have them, between points at one place
  const std::uint32_t first = add(solid, {0.5, 0.5, 0.5}), second = add(solid, {0.5, 0.5, 0.5});
  solid.segments = {{{0, 0}, 1}};
  solid.facets.push_back({{{first, second}}, {}, 2});
  const auto facet = static_cast<std::int64_t>(solid.facets.size() - 1);
  const Domain<3> d(solid);
  EXPECT_EQ(d.segments().size(), 12u);
  ASSERT_EQ(d.repairs().size(), 2u);
  EXPECT_EQ(d.repairs()[1].ids, (Ids{0, 0, 0, facet, first, second}));
  expect_meshed(solid);

  ring.segments = {{{1, 1}, 0}, {{0, 3}, 0}};  // all that is left is points
  EXPECT_EQ(diagnose(ring)[Finding::encloses_nothing].count, 1u);
}

TEST(Repairs, APointInsideAnEdge) {
  for (Plc<3> plc : {box(), triangulated(box())}) {
    add(plc, {1, 0, 0});
    EXPECT_EQ(repaired(plc, Errc::point_on_segment), (Ids{8, 0, 1}));
    const Domain<3> d(plc);
    EXPECT_EQ(d.facets().size(), 6u);
    EXPECT_EQ(d.segments().size(), 13u);
    EXPECT_EQ(d.facets_of_segment(test::find_segment(d, 0, 8)).size(), 2u);
    expect_meshed(plc);
  }
}

// Of a polygon, on an edge of the same facet: a point, the end of a segment, a corner of a hole, of an island, a spike.
TEST(Repairs, APointOfAFacetOnItsOwnEdge) {
  for (const int kind : {0, 1, 2, 3, 4, 5}) {
    SCOPED_TRACE(kind);
    Plc<3> plc = box();
    const auto m = add(plc, {1, 0, 0}), inner = add(plc, {1, 0.5, 0}), other = add(plc, {1.5, 0.5, 0});
    auto& floor = plc.facets[0];
    if (kind == 0) floor.polygons.push_back({m});
    if (kind == 1) floor.polygons.push_back({m, inner});
    if (kind == 2 || kind == 3) floor.polygons.push_back({m, other, inner});
    if (kind == 2) {  // the hole is closed by a facet of its own
      floor.holes = {{1.2, 0.3, 0}};
      plc.facets.push_back({{{m, other, inner}}, {}, 7});
    }
    if (kind == 4) floor.polygons.push_back({m, 1});        // a segment along the edge
    if (kind == 5) floor.polygons[0] = {0, 3, 2, 1, m, 1};  // there and back
    const Ids ids = repaired(plc, Errc::point_on_segment);
    EXPECT_EQ(ids, (Ids{8, 0, 1}));
    const Domain<3> d(plc);
    EXPECT_EQ(d.facets().size(), kind == 2 ? 7u : 6u);
    EXPECT_TRUE(test::has_segment(d, 0, m));
    EXPECT_TRUE(test::has_segment(d, m, 1));
    EXPECT_FALSE(test::has_segment(d, 0, 1));
    expect_meshed(plc);
  }
}

// The front is two rectangles; the bottom, the lid and the sides do not know.
TEST(Repairs, TJunctionsOfFacets) {
  Plc<3> plc = box();
  const auto a = add(plc, {1, 0, 0}), b = add(plc, {1, 0, 3});
  plc.facets[2].polygons[0] = {0, a, b, 4};
  plc.facets.push_back({{{a, 1, 5, b}}, {}, 0});
  EXPECT_EQ(repaired(plc, Errc::point_on_segment), (Ids{8, 0, 1, 9, 4, 5}));
  EXPECT_EQ(Domain<3>(plc).facets().size(), 6u);  // the two are one again
  expect_meshed(plc);
  plc.facets[2].marker = 3;
  EXPECT_EQ(Domain<3>(plc).facets().size(), 7u);
  expect_meshed(plc);
}

TEST(Repairs, PiecesOfASegmentKeepItsMarker) {
  Plc<3> plc = box();
  plc.first_index = 1;
  for (const double z : {2.0, 1.0}) add(plc, {0, 0, z});
  plc.segments = {{{4, 0}, 5}, {{9, 8}, 6}};
  const Domain<3> d(plc);
  EXPECT_EQ(std::ranges::count(d.segments(), 5, &DomainSegment::marker), 3);
  EXPECT_EQ(std::ranges::count(d.segments(), 0u, &DomainSegment::input), 3);
  EXPECT_EQ(repaired(plc, Errc::point_on_segment), (Ids{9, 1, 5, 10, 1, 5}));
  EXPECT_EQ(d.warnings().size(), 1u);  // two markers on one piece
  expect_meshed(plc);
}

TEST(Repairs, APointInsideAFacet) {
  for (Plc<3> plc : {box(), triangulated(box())}) {
    add(plc, {1.25, 0.25, 3});
    const auto foot = add(plc, {0.5, 0.5, 3}), top = add(plc, {0.5, 0.5, 1});  // the end of a segment
    plc.segments.push_back({{foot, top}, 0});
    const Domain<3> d(plc);
    EXPECT_EQ(repaired(plc, Errc::point_on_facet).size(), 4u);
    EXPECT_EQ(d.facet_points(1).size(), 6u);
    expect_meshed(plc);
  }
}

TEST(Repairs, DegenerateTriangles) {
  Plc<3> plc = triangulated(box());
  const auto m = add(plc, {1, 0, 0});
  plc.facets.push_back({{{0, m, 1}}, {}, 0});
  plc.facets.push_back({{{0, 0, 4}}, {}, 0});
  plc.facets.push_back({{{6, 6, 6}}, {}, 0});
  EXPECT_EQ(repaired(plc, Errc::degenerate_facet), (Ids{12, 13, 14}));
  EXPECT_EQ(repaired(plc, Errc::point_on_segment), (Ids{8, 0, 1}));
  expect_meshed(plc);
}

// As a body of revolution with corners on its axis has them, in the files of some programs: no edge of others covers them.
TEST(Repairs, FacetsWithoutAnAreaInTheInside) {
  for (const std::vector<std::uint32_t>& polygon : std::vector<std::vector<std::uint32_t>>{{0, 0, 6},      // two points
                                                                                           {0, 6, 0, 6},   //
                                                                                           {0, 8, 6},      // on a line
                                                                                           {0, 8, 6, 8},   //
                                                                                           {8, 6, 0},      //
                                                                                           {9, 10, 9}}) {  // on an axis
    Plc<3> plc = triangulated(box());
    for (std::uint32_t k = 0; k < 3; ++k) add(plc, {k == 0 ? 1.0 : 0.5 + 0.5 * k, 0.5, k == 0 ? 1.5 : 1.0});
    plc.facets.push_back({{polygon}, {}, 0});
    EXPECT_EQ(repaired(plc, Errc::degenerate_facet), (Ids{12}));
    const Domain<3> d(plc);
    EXPECT_EQ(d.points().size(), 11u);
    EXPECT_EQ(d.facets().size(), 6u);
    EXPECT_FALSE(test::has_segment(d, 0, 6));
    expect_meshed(plc);
  }
}

TEST(Repairs, SegmentsAcrossCoplanarTriangles) {
  Plc<3> plc = triangulated(box());
  plc.segments = {{{1, 3}, 4}, {{5, 7}, 4}};
  EXPECT_EQ(Domain<3>(plc).facets().size(), 6u);  // bottom and lid are each one facet, which they divide
  expect_meshed(plc);
  plc.segments = {{{0, 2}, 4}, {{4, 6}, 4}};
  EXPECT_EQ(diagnose(plc).error_count(), 0u);
  expect_meshed(plc);
  plc.segments.push_back({{1, 3}, 4});  // they cross
  EXPECT_GT(diagnose(plc).error_count(), 0u);
  EXPECT_THROW(require_no_errors(Domain<3>(plc)), InputError);
}

TEST(Repairs, AWallOnAFloorOfTriangles) {
  for (Plc<3> plc : {box(), triangulated(box())}) {
    const auto a = add(plc, {0.25, 0.75, 0}), b = add(plc, {1.75, 0.125, 0}), c = add(plc, {1, 0.5, 2});
    plc.facets.push_back({{{a, b, c}}, {}, 2});
    const Domain<3> d(plc);
    EXPECT_TRUE(test::has_segment(d, a, b));
    EXPECT_EQ(d.facets_of_segment(test::find_segment(d, a, b)).size(), 2u);
    EXPECT_EQ(d.facets().size(), 7u);
    expect_meshed(plc);
  }
}

// Segments that enclose a part of a facet which does not touch its rim.
TEST(Repairs, ATriangleOfSegmentsOnAFloor) {
  for (Plc<3> plc : {box(), triangulated(box())}) {
    const auto a = add(plc, {0.25, 0.75, 0}), b = add(plc, {1.75, 0.125, 0}), c = add(plc, {1.75, 0.75, 0});
    plc.segments = {{{a, b}, 1}, {{b, c}, 1}, {{c, a}, 1}};
    EXPECT_EQ(Domain<3>(plc).facets().size(), 6u);
    expect_meshed(plc);
  }
}

TEST(Repairs, Plane) {
  Plc<2> plc;
  plc.points = {{0, 0}, {2, 0}, {2, 2}, {0, 2}, {1, 0}, {1, 2}, {1, 0}, {1, 1}};
  plc.segments = {{{0, 1}, 1}, {{1, 2}, 2}, {{2, 3}, 3}, {{3, 0}, 4}, {{6, 5}, 5}, {{0, 4}, 1}};
  EXPECT_EQ(repaired(plc, Errc::point_on_segment), (Ids{4, 0, 1, 5, 2, 3, 7, 4, 5}));
  const Domain<2> d(plc);
  EXPECT_EQ(d.segments().size(), 8u);
  EXPECT_EQ(std::ranges::count(d.segments(), 5, &DomainSegment::marker), 2);
  expect_meshed(plc);
}

}  // namespace pgdr::test_input_repairs
