// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Surfaces that are kept as they are, triangle by triangle.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <random>
#include <set>

#include "domain_plcs.hpp"
#include "given_names.hpp"
#include "output/simplices.hpp"
#include "parallel_support.hpp"
#include "pgdr/kept_edges.hpp"
#include "pgdr/predicates.hpp"

namespace pgdr::test_kept_surfaces {

using namespace test;
using Corners = std::array<Point3, 3>;

Corners ordered(Corners c) {
  std::sort(c.begin(), c.end(), lex_less<3>);
  return c;
}

struct LexLess {
  bool operator()(const Corners& a, const Corners& b) const {
    return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end(), lex_less<3>);
  }
};
using Triangles = std::set<Corners, LexLess>;

/// The facets of three corners with one of these markers; with none: all.
Triangles given(const Plc<3>& plc, const std::vector<int>& markers = {}) {
  Triangles all;
  for (const auto& f : plc.facets)
    if (markers.empty() || std::find(markers.begin(), markers.end(), f.marker) != markers.end())
      all.insert(ordered({plc.points[f.polygons[0][0]], plc.points[f.polygons[0][1]], plc.points[f.polygons[0][2]]}));
  return all;
}

Triangles subfacets(const OutputMesh<3>& mesh, const std::vector<int>& markers = {}) {
  Triangles all;
  for (const auto& s : mesh.subfacets)
    if (markers.empty() || std::find(markers.begin(), markers.end(), s.marker) != markers.end())
      all.insert(ordered({mesh.points[s.vertices[0]], mesh.points[s.vertices[1]], mesh.points[s.vertices[2]]}));
  return all;
}

CheckReport checked(const Plc<3>& plc, const RefineOptions<3>& options, const RefineResult<3>& result) {
  CheckOptions<3> c;
  c.input = &plc;
  c.tolerance = result.tolerance;
  if (options.refine) c.radius_edge_bound = options.radius_edge_bound;
  if (options.refine) c.size = options.size;
  c.largest_cosine = result.optimization.claimed_cosine;
  c.delaunay = result.delaunay;
  c.reasons = &result.reasons;
  c.keep_boundary = options.keep_boundary;
  c.kept_markers = options.kept_markers;
  return check<3>(result.mesh, c);
}

RefineResult<3> kept(const Plc<3>& plc, RefineOptions<3> options = {}) {
  options.keep_boundary = true;
  RefineResult<3> result = refine<3>(plc, with<3>(options, serial));
  const CheckReport report = checked(plc, options, result);
  EXPECT_LE(report.exit_code(), 1) << findings(report);
  EXPECT_EQ(subfacets(result.mesh, options.kept_markers), given(plc, options.kept_markers));
  EXPECT_EQ(result.statistics.boundary_points, 0u);
  return result;
}

/// Of six corners, whose upper triangle is turned against the lower one, and whose sides are folded inwards: no edge between
/// corners that is not on the surface lies inside, so that it has no cells without a point more (Schoenhardt 1928).
Plc<3> twisted_prism() {
  Plc<3> plc;
  for (int k = 0; k < 6; ++k) {
    const double a = 2 * std::numbers::pi * (k % 3) / 3 + (k < 3 ? 0 : 0.5);
    plc.points.push_back({{std::cos(a), std::sin(a), k < 3 ? 0.0 : 1.0}});
  }
  add_polygon(plc, {0, 2, 1});
  add_polygon(plc, {3, 4, 5});
  for (Index k = 0; k < 3; ++k) {
    const Index l = (k + 1) % 3;
    add_polygon(plc, {k, l, l + 3});
    add_polygon(plc, {k, l + 3, k + 3});
  }
  return plc;
}

/// Two boxes one on the other, of triangles; the facet between them has marker 7.
Plc<3> boxes_with_wall() { return triangulated(two_region_cube()); }

TEST(KeptSurface, EveryTriangleIsOneSubfacet) {
  const std::pair<const char*, Plc<3>> models[] = {
      {"cube", triangles_of(cube())},           {"l_block", triangles_of(l_block())},
      {"u_block", triangles_of(u_block())},     {"plate_with_hole", triangles_of(plate_with_hole())},
      {"pipe", triangles_of(pipe(24, 0.7, 1))}, {"block_with_cavity", triangles_of(block_with_cavity())},
      {"two regions", boxes_with_wall()},       {"icosphere", icosphere(2)}};
  for (const auto& [name, plc] : models) {
    const testing::ScopedTrace trace(__FILE__, __LINE__, name);
    RefineOptions<3> sized;
    sized.size = 0.3;
    for (const RefineOptions<3>& options : {RefineOptions<3>(), sized}) {
      kept(plc, options);
      for (const double angle : {0.7, 1.9}) kept(turned(plc, angle), options);
    }
  }
}

TEST(KeptSurface, WithoutTheOptimiserAndWithoutRefinement) {
  RefineOptions<3> options;
  options.min_dihedral = 0;
  kept(triangles_of(l_block()), options);
  kept(turned(triangles_of(plate_with_hole())), options);
  options.min_dihedral.reset();
  options.refine = false;
  kept(triangles_of(l_block()), options);
  kept(turned(triangles_of(plate_with_hole())), options);
}

TEST(KeptSurface, TwistedPrismTakesAPointInside) {
  for (const Plc<3>& plc : {twisted_prism(), turned(twisted_prism()), turned(twisted_prism(), 2.2)}) {
    RefineOptions<3> unrefined;
    unrefined.refine = false;
    const RefineResult<3> result = kept(plc, unrefined);
    EXPECT_GE(result.statistics.inner_points, 1u);
    EXPECT_EQ(result.mesh.points.size(), 6 + result.statistics.inner_points);
    kept(plc);
  }
}

TEST(KeptSurface, TheSameForAnyNumberOfThreads) {
  for (const Plc<3>& plc : {turned(triangles_of(plate_with_hole())), turned(icosphere(2)), turned(twisted_prism())}) {
    const AllowThreads allow(8);
    RefineOptions<3> options;
    options.keep_boundary = true;
    options.size = 0.15;
    const RefineResult<3> first = refine<3>(plc, with<3>(options, serial));
    for (const Runner& runner : concurrent_runners) expect_same<3>(first, refine<3>(plc, with<3>(options, runner)), runner.name);
  }
}

/// Each poor cell has a reason, and those beside the surface that it was kept.
TEST(KeptSurface, ReasonsNameWhatWasKept) {
  const Plc<3> plc = triangles_of(cube());
  RefineOptions<3> options;
  options.keep_boundary = true;
  options.size = 0.1;
  RefineResult<3> result = refine<3>(plc, options);
  EXPECT_FALSE(result.size_met);
  ASSERT_GT(result.poor_left, 0u);
  EXPECT_EQ(result.reasons.size(), result.poor_left);
  std::size_t named = 0;
  for (const PoorReason& r : result.reasons) named += r.code == PoorReason::Code::kept_boundary;
  EXPECT_GT(named, 0u);
  const CheckReport report = checked(plc, options, result);
  EXPECT_EQ(report.exit_code(), 1) << findings(report);
  for (PoorReason& r : result.reasons)
    if (r.code == PoorReason::Code::kept_boundary) r.entities[0] = {EntityKind::facet, 4711, {}};
  EXPECT_EQ(checked(plc, options, result).exit_code(), 6);
}

/// A reason that the boundary was kept does not hold where it has points of its own.
TEST(KeptSurface, ReasonsDoNotHoldWhereNothingWasKept) {
  const Plc<3> plc = triangles_of(cube());
  RefineOptions<3> options;
  options.size = 0.3;
  RefineResult<3> result = refine<3>(plc, options);
  std::vector<PoorReason> claims;
  for (std::uint32_t c = 0; c < result.mesh.cells.size(); ++c)
    claims.push_back({c, PoorReason::Code::kept_boundary, {GivenEntity{EntityKind::facet, 0, {}}, {}}, 0});
  result.reasons = claims;
  options.radius_edge_bound = 0.1;  // all cells are over this
  EXPECT_EQ(checked(plc, options, result).count(CheckFinding::Kind::bad_reason), result.mesh.cells.size());
}

/// Cells between a coarse kept surface and finer ones inside have no edge on it. What takes a cell over the ratio away, a point
/// at its circumcentre or its off-centre, would have to split a kept triangle: check verifies of that triangle that it would.
TEST(KeptSurface, ReasonsOfCellsBehindWhatWasKept) {
  const auto doubled = [](Plc<3> plc) {
    for (Point3& p : plc.points)
      for (double& x : p.x) x *= 2;
    return plc;
  };
  RefineOptions<3> options;
  options.size = 0.15;
  options.keep_boundary = true;
  const Plc<3> model = triangles_of(doubled(cube()));
  RefineResult<3> result = kept(model, options);
  const OutputMesh<3>& mesh = result.mesh;
  const std::uint64_t unexplained = checked(model, options, result).unexplained;
  EXPECT_EQ(unexplained, result.optimization.unexplained);
  EXPECT_LE(unexplained, mesh.cells.size() / 100);
  std::set<std::uint32_t> on_boundary;
  for (const auto& f : mesh.subfacets) on_boundary.insert(f.vertices.begin(), f.vertices.end());
  std::uint64_t behind = 0;
  for (PoorReason& r : result.reasons) {
    const auto& cell = mesh.cells[r.cell];
    const Simplex<3> s = corners_of(mesh, r.cell);
    const auto on_it = std::count_if(cell.begin(), cell.end(), [&](std::uint32_t v) { return on_boundary.contains(v); });
    if (r.code != PoorReason::Code::kept_boundary || on_it > 1) continue;
    if (dihedral_within(s, result.optimization.claimed_cosine)) continue;
    EXPECT_FALSE(radius_edge_within<3>(s, options.radius_edge_bound));
    ++behind;
    r.entities[0].facet = (r.entities[0].facet + 6) % 12;  // that on another side, or of another plane
  }
  EXPECT_GT(behind, unexplained);
  const CheckReport falsified = checked(model, options, result);
  EXPECT_GE(falsified.unexplained + falsified.count(CheckFinding::Kind::bad_reason), unexplained + behind / 2);
}

TEST(KeptSurface, TheCheckerFindsWhatWasNotKept) {
  const Plc<3> plc = triangles_of(cube());
  RefineOptions<3> options;
  options.size = 0.3;
  const RefineResult<3> result = refine<3>(plc, options);
  EXPECT_LE(checked(plc, options, result).exit_code(), 1);
  options.keep_boundary = true;
  const CheckReport report = checked(plc, options, result);
  EXPECT_EQ(report.exit_code(), 6);
  EXPECT_EQ(report.finding_count, report.count(CheckFinding::Kind::boundary_not_kept));
  EXPECT_GE(report.finding_count, 12u);
  // Without points of its own, but with the other diagonals.
  RefineOptions<3> unrefined;
  unrefined.refine = false;
  unrefined.keep_boundary = true;
  Plc<3> flipped = plc;
  for (std::size_t f = 0; f + 1 < flipped.facets.size(); f += 2) {
    std::vector<Index> all;
    for (const std::size_t k : {f, f + 1})
      for (const Index v : flipped.facets[k].polygons[0]) all.push_back(v);
    auto &a = flipped.facets[f].polygons[0], &b = flipped.facets[f + 1].polygons[0];
    const auto tip = [](const std::vector<Index>& t, const std::vector<Index>& other) {
      return std::find_if(t.begin(), t.end(), [&](Index v) { return std::find(other.begin(), other.end(), v) == other.end(); });
    };
    const auto at = tip(a, b);
    ASSERT_NE(at, a.end());
    std::rotate(a.begin(), a.begin() + (at - a.begin()), a.end());
    const Index x = a[0], p = a[1], q = a[2], y = *tip(b, a);
    a = {x, p, y};
    b = {x, y, q};
  }
  const RefineResult<3> other = kept(flipped, unrefined);
  const CheckReport diagonals = checked(plc, unrefined, other);
  EXPECT_EQ(diagonals.count(CheckFinding::Kind::boundary_not_kept), 12u) << findings(diagonals);
}

TEST(KeptSurface, ByPart) {
  Plc<3> plc = triangulated(cube());
  RefineOptions<3> options;
  options.size = 0.2;
  options.kept_markers = {1, 6};
  EXPECT_THROW(refine<3>(plc, options), UsageError);
  for (const Plc<3>& model : {plc, turned(plc)}) {
    const RefineResult<3> result = kept(model, options);
    EXPECT_GT(subfacets(result.mesh, {2}).size(), 10u);  // which is refined as always
  }
}

/// Two bodies that are meshed apart, with other sizes, have the triangles between them in common to the last bit.
TEST(KeptSurface, BodiesFitTogether) {
  const Plc<3> both = turned(icosphere(2));
  Plc<3> around = both;
  const Plc<3> shell = triangulated(cube());
  const auto base = static_cast<Index>(around.points.size());
  for (const Point3& p : shell.points) around.points.push_back({{8 * p[0] - 4, 8 * p[1] - 4, 8 * p[2] - 4}});
  for (auto f : shell.facets) {
    for (Index& v : f.polygons[0]) v += base;
    around.facets.push_back(f);
  }
  around.holes.push_back({{1.25, 0, 0}});
  RefineOptions<3> fine;
  fine.size = 0.1;
  const RefineResult<3> inside = kept(both, fine), outside = kept(around);
  const Triangles a = subfacets(inside.mesh), b = subfacets(outside.mesh);
  EXPECT_EQ(a.size(), 320u);
  EXPECT_TRUE(std::includes(b.begin(), b.end(), a.begin(), a.end(), LexLess()));
}

TEST(KeptSurface, PolygonsAreTriangulatedOnce) {
  RefineOptions<3> options;
  options.keep_boundary = true;
  options.size = 0.2;
  for (const Plc<3>& plc : {l_block(), turned(l_block())}) {
    const RefineResult<3> result = refine<3>(plc, options);
    EXPECT_LE(checked(plc, options, result).exit_code(), 1) << findings(checked(plc, options, result));
    EXPECT_EQ(result.mesh.subfacets.size(), 20u);
  }
}

/// A box whose top is divided into rectangles, each of two triangles, by this diagonal (2: by turns).
Plc<3> box_with_rectangles(int diagonal) {
  Plc<3> plc;
  const std::array<double, 5> x{0, 1, 2.1, 3.3, 4.6}, y{0, 1.2, 2.1, 3.4, 4.2};
  const auto at = [](std::size_t i, std::size_t k) { return static_cast<Index>(5 * k + i); };
  for (const double v : y)
    for (const double u : x) plc.points.push_back({{u, v, 3}});
  for (std::size_t k = 0; k < 4; ++k)
    for (std::size_t i = 0; i < 4; ++i) {
      const std::array<Index, 4> c{at(i, k), at(i + 1, k), at(i + 1, k + 1), at(i, k + 1)};
      const bool first = diagonal == 2 ? (i + k) % 2 == 0 : diagonal == 0;
      add_polygon(plc, first ? std::vector{c[0], c[1], c[2]} : std::vector{c[0], c[1], c[3]});
      add_polygon(plc, first ? std::vector{c[0], c[2], c[3]} : std::vector{c[1], c[2], c[3]});
    }
  for (const Point3& p : {Point3{{0, 0, 0}}, Point3{{4.6, 0, 0}}, Point3{{4.6, 4.2, 0}}, Point3{{0, 4.2, 0}}})
    plc.points.push_back(p);
  add_polygon(plc, {28, 27, 26, 25});
  add_polygon(plc, {25, 26, 4, 3, 2, 1, 0});
  add_polygon(plc, {26, 27, 24, 19, 14, 9, 4});
  add_polygon(plc, {27, 28, 20, 21, 22, 23, 24});
  add_polygon(plc, {28, 25, 0, 5, 10, 15, 20});
  return plc;
}

/// The corners of a rectangle lie on a circle: either diagonal is Delaunay, so that no point has to come and go for that which is
/// given. (hole_in_hexahedron took 1.8 times as long as without the flag.) A point that was withdrawn would leave the mesh not
/// Delaunay, as far as the run knows.
TEST(KeptSurface, DiagonalsOfRectanglesNeedNoPoints) {
  for (const int diagonal : {0, 1, 2}) {
    const Plc<3> plc = box_with_rectangles(diagonal);
    RefineOptions<3> options;
    options.keep_boundary = true;
    options.refine = false;
    const RefineResult<3> unrefined = refine<3>(plc, options);
    EXPECT_TRUE(unrefined.delaunay);
    EXPECT_EQ(unrefined.mesh.points.size(), plc.points.size());
    const CheckReport report = checked(plc, options, unrefined);
    EXPECT_EQ(report.exit_code(), 0) << findings(report);
    options.refine = true;
    options.size = 0.8;
    const RefineResult<3> refined = refine<3>(plc, with<3>(options, serial));
    const CheckReport of_refined = checked(plc, options, refined);
    EXPECT_LE(of_refined.exit_code(), 1) << findings(of_refined);
    EXPECT_EQ(refined.statistics.boundary_points, 0u);
  }
}

/// Random bricks of a grid with uneven spacing, which touch along edges and in corners; each of their sides has a random
/// diagonal.
Plc<3> random_bricks(unsigned seed) {
  std::mt19937 random(seed);
  const std::array<double, 6> at{0, 1, 2.25, 3, 4.5, 5.25};
  std::set<std::array<int, 3>> bricks;
  for (int i = 0; i < 24; ++i) {
    std::array<int, 3> brick;
    for (int& x : brick) x = static_cast<int>(random() % 4);
    bricks.insert(brick);
  }
  Plc<3> plc;
  std::map<std::array<int, 3>, Index> known;
  for (const auto& brick : bricks)
    for (std::size_t axis = 0; axis < 3; ++axis)
      for (const int side : {0, 1}) {
        auto beyond = brick;
        beyond[axis] += side == 1 ? 1 : -1;
        if (bricks.contains(beyond)) continue;
        std::array<Index, 4> q;
        for (std::size_t k = 0; k < 4; ++k) {
          auto corner = brick;
          corner[axis] += side;
          corner[(axis + 1) % 3] += k == 1 || k == 2 ? 1 : 0;
          corner[(axis + 2) % 3] += k >= 2 ? 1 : 0;
          const auto [found, is_new] = known.try_emplace(corner, static_cast<Index>(plc.points.size()));
          const auto place = [&](std::size_t i) { return at[static_cast<std::size_t>(corner[i])]; };
          if (is_new) plc.points.push_back({{place(0), place(1), place(2)}});
          q[k] = found->second;
        }
        const std::size_t first = random() % 2;
        add_polygon(plc, {q[first], q[first + 1], q[(first + 2) % 4]});
        add_polygon(plc, {q[first], q[(first + 2) % 4], q[(first + 3) % 4]});
      }
  return plc;
}

TEST(KeptSurface, BricksThatTouch) {
  for (unsigned seed = 0; seed < 30; ++seed) {
    const testing::ScopedTrace trace(__FILE__, __LINE__, seed);
    kept(random_bricks(seed));
  }
}

TEST(KeptSurface, EdgesAreAddedOnce) {
  Plc<3> plc = triangles_of(cube());
  plc.segments.push_back({{0, 1}, 5});
  const Plc<3> with = with_kept_edges(plc, {});
  EXPECT_EQ(with.segments.size(), 18u);
  EXPECT_EQ(with.segments[0].marker, 5);
  EXPECT_EQ(with_kept_edges(with, {}).segments.size(), 18u);
  EXPECT_EQ(with_kept_edges(plc, {9}).segments.size(), 1u);
  plc.facets[0].polygons[0][0] = 99;
  EXPECT_EQ(with_kept_edges(plc, {}).segments.size(), 1u);
}

}  // namespace pgdr::test_kept_surfaces
