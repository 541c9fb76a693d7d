// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Diagnosis: a case of each kind, with its ids, lines and places; also turned and scaled.
#include "pgdr/diagnosis.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "allow_threads.hpp"
#include "domain_plcs.hpp"
#include "pgdr/refine.hpp"

#if PGDR_TEST_TBB
#include <tbb/task_arena.h>
#include <tbb/task_group.h>
#endif

namespace pgdr::test_diagnose_findings {

using test::box;
using test::numbered;
using test::triangulated;
using test::turned;
using Ids = std::vector<std::int64_t>;

// Adds a triangle of new points.
std::uint32_t add_triangle(Plc<3>& plc, const Point3& a, const Point3& b, const Point3& c) {
  const auto n = static_cast<std::uint32_t>(plc.points.size());
  plc.points.insert(plc.points.end(), {a, b, c});
  plc.facets.push_back({{{n, n + 1, n + 2}}, {}, 0});
  return n;
}

std::uint64_t others(const Diagnosis<3>& d, Finding kind) { return d.error_count() - d[kind].count; }

double distance(const std::array<double, 3>& a, const std::array<double, 3>& b) {
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

TEST(Diagnosis, ABoxHasNothing) {
  for (const Plc<3>& plc : {box(), triangulated(box()), test::plate_with_pentagon()}) {
    const Diagnosis<3> d = diagnose(plc);
    EXPECT_EQ(d.error_count(), 0u);
    for (const Finding kind :
         {Finding::open_boundary, Finding::non_manifold_edge, Finding::non_manifold_point, Finding::unreferenced_point,
          Finding::duplicate_point, Finding::segments_below_60, Finding::facets_below_90, Finding::segment_facet_below_90})
      EXPECT_EQ(d[kind].count, 0u) << name(kind);
    EXPECT_EQ(diagnose(turned(plc)).error_count(), 0u);
    EXPECT_NO_THROW(require_no_errors(Domain<3>(plc)));
  }
}

TEST(Diagnosis, FacetsThatCross) {
  Plc<3> plc = numbered(box());
  add_triangle(plc, {1, -1, 1}, {1, 0.5, 1}, {1, 0.5, 2});  // through the front, y = 0, from z = 1 to 5/3
  for (const double factor : {1.0, 0x1p-30, 0x1p40}) {
    Plc<3> scaled = plc;
    for (Point3& p : scaled.points)
      for (double& x : p.x) x *= factor;
    const Diagnosis<3> d = diagnose(scaled);
    const FindingList& found = d[Finding::facets_cross];
    ASSERT_EQ(found.count, 1u);
    EXPECT_EQ(others(d, Finding::facets_cross), 0u);
    const Diagnostic& what = found.listed.at(0).what;
    EXPECT_EQ(what.code, Errc::entities_intersect);
    EXPECT_EQ(what.ids, (Ids{3, 7}));
    EXPECT_EQ(what.line, 502u);
    EXPECT_EQ(what.file, "box.poly");
    ASSERT_EQ(what.points.size(), 2u);
    EXPECT_EQ(what.points[0], (std::array<double, 3>{factor, 0, factor}));
    EXPECT_LE(distance(what.points[1], {factor, 0, factor * 5 / 3}), 1e-15 * factor);
  }
  EXPECT_EQ(diagnose(turned(plc))[Finding::facets_cross].listed.at(0).what.ids, (Ids{3, 7}));
}

TEST(Diagnosis, FacetsThatOverlap) {
  Plc<3> plc = box();
  add_triangle(plc, {0.5, 0.25, 0}, {1.5, 0.25, 0}, {1, 0.75, 0});  // in the bottom: subdivided
  EXPECT_EQ(diagnose(plc).error_count(), 0u);
  plc = box();
  plc.facets.push_back({{{0, 1, 2}}, {}, 0});  // half of the bottom, with its points
  Diagnosis<3> d = diagnose(plc);
  EXPECT_EQ(d.error_count(), 0u);
  plc = box();
  plc.facets.push_back({{{1, 2, 3, 0}}, {}, 0});  // all of it: repaired
  d = diagnose(plc);
  EXPECT_EQ(d.error_count(), 0u);
  EXPECT_EQ(d[Finding::repeated_facet].listed.at(0).what.ids, (Ids{6, 0}));
}

TEST(Diagnosis, Segments) {
  Plc<3> plc = numbered(box());
  plc.points.insert(plc.points.end(), {{1, -1, 1}, {1, 2, 1}, {1, 0.5, 0.5}, {1, 0.5, 2}, {1, 0.5, 1}});
  plc.segments = {{{8, 9}, 0}};
  Diagnosis<3> d = diagnose(plc);  // point 13 splits it, front and back crossed
  EXPECT_EQ(d[Finding::segment_crosses_facet].count, 2u);
  const Diagnostic& first = d[Finding::segment_crosses_facet].listed.at(0).what;
  EXPECT_EQ(first.ids, (Ids{9, 13, 3}));
  EXPECT_EQ(first.line, 300u);
  EXPECT_EQ(first.points.at(0), (std::array<double, 3>{1, 0, 1}));
  EXPECT_EQ(d[Finding::point_on_segment].count, 0u);
  EXPECT_EQ(d[Finding::unreferenced_point].count, 2u);
  plc.points[8] = {0.5, 0.5, 1};
  plc.points[9] = {1.5, 0.5, 1};
  plc.points.pop_back();
  plc.segments.push_back({{10, 11}, 0});  // the two cross
  d = diagnose(plc);
  EXPECT_EQ(d.error_count(), 1u);
  EXPECT_EQ(d[Finding::segments_cross].listed.at(0).what.ids, (Ids{9, 10, 11, 12}));
  EXPECT_EQ(d[Finding::segments_cross].listed.at(0).what.points, (std::vector<std::array<double, 3>>{{1, 0.5, 1}}));
}

TEST(Diagnosis, PointsOnEntitiesAreRepaired) {
  Plc<3> plc = numbered(triangulated(box()));
  plc.points.insert(plc.points.end(), {{1, 0.25, 0}, {2, 0, 1}, {0.5, 0.25, 3}, {1, 0.5, 1}});  // the third on a diagonal
  const Diagnosis<3> d = diagnose(plc);
  EXPECT_EQ(d.error_count(), 0u);
  EXPECT_EQ(d[Finding::unreferenced_point].count, 1u);
  plc = numbered(box());
  plc.points.push_back({1, 0.5, 3});
  EXPECT_EQ(diagnose(plc)[Finding::unreferenced_point].count, 0u);
  plc.facets[1].polygons.push_back({8});
  EXPECT_TRUE(Domain<3>(plc).repairs().empty());
}

TEST(Diagnosis, OpenBoundary) {
  Plc<3> plc = numbered(box());
  plc.facets.erase(plc.facets.begin() + 1);  // the lid
  Diagnosis<3> d = diagnose(plc);
  ASSERT_EQ(d[Finding::open_boundary].count, 1u);
  EXPECT_EQ(d[Finding::open_boundary].listed.at(0).what.ids, (Ids{5, 6, 7, 8}));
  EXPECT_EQ(d[Finding::open_boundary].listed.at(0).measure, 6);
  EXPECT_EQ(d[Finding::encloses_nothing].count, 1u);
  EXPECT_EQ(d[Finding::encloses_nothing].listed.at(0).what.ids, (Ids{5, 6, 7, 8}));
  plc.facets.erase(plc.facets.begin());  // the bottom
  EXPECT_EQ(diagnose(plc)[Finding::open_boundary].count, 2u);
  plc = box();
  add_triangle(plc, {0.5, 0.5, 1}, {1, 0.5, 1}, {1, 0.5, 2});  // inside, dangling
  d = diagnose(plc);
  EXPECT_EQ(d.error_count(), 0u);
  EXPECT_EQ(d[Finding::open_boundary].listed.at(0).what.ids, (Ids{8, 9, 10}));

  Plc<2> flat;
  flat.points = {{0, 0}, {1, 0}, {1, 1}, {3, 3}};
  flat.segments = {{{0, 1}, 0}, {{1, 2}, 0}, {{2, 0}, 0}, {{2, 3}, 0}};
  EXPECT_EQ(diagnose(flat).error_count(), 0u);
  EXPECT_EQ(diagnose(flat)[Finding::open_boundary].listed.at(0).what.ids, (Ids{3}));
  flat.segments.pop_back();
  flat.segments.pop_back();
  EXPECT_EQ(diagnose(flat)[Finding::encloses_nothing].count, 1u);
}

TEST(Diagnosis, NotManifold) {
  Plc<3> plc = numbered(box());
  Plc<3> both = plc;
  for (const Point3& p : plc.points) both.points.push_back({p[0] + 2, p[1] + 1, p[2]});
  for (const auto& f : plc.facets) {
    auto polygon = f.polygons[0];
    for (auto& v : polygon) v += 8;
    both.facets.push_back({{polygon}, {}, 0});
  }
  Diagnosis<3> d = diagnose(both);  // an edge in common, (2, 1, 0) - (2, 1, 3)
  EXPECT_EQ(d.error_count(), 0u);
  ASSERT_EQ(d[Finding::non_manifold_edge].count, 1u);
  EXPECT_EQ(d[Finding::non_manifold_edge].listed.at(0).what.ids, (Ids{3, 7, 4, 5, 9, 12}));
  EXPECT_EQ(d[Finding::non_manifold_point].count, 0u);
  EXPECT_EQ(d[Finding::duplicate_point].listed.at(0).what.ids, (Ids{9, 3}));
  for (std::size_t i = 8; i < 16; ++i) both.points[i][2] += 3;
  d = diagnose(both);  // a point, (2, 1, 3)
  EXPECT_EQ(d[Finding::non_manifold_edge].count, 0u);
  ASSERT_EQ(d[Finding::non_manifold_point].count, 1u);
  EXPECT_EQ(d[Finding::non_manifold_point].listed.at(0).what.ids, (Ids{7}));
}

TEST(Diagnosis, Orientation) {
  Plc<3> plc = triangulated(box());
  EXPECT_EQ(diagnose(plc)[Finding::inconsistent_orientation].count, 4u);  // its bottom and top point up both
  for (std::size_t k = 0; k < 2; ++k) std::swap(plc.facets[k].polygons[0][1], plc.facets[k].polygons[0][2]);
  EXPECT_EQ(diagnose(plc)[Finding::inconsistent_orientation].count, 0u);
  EXPECT_EQ(diagnose(turned(plc))[Finding::inconsistent_orientation].count, 0u);
  std::swap(plc.facets[5].polygons[0][0], plc.facets[5].polygons[0][1]);
  const Diagnosis<3> d = diagnose(plc);
  EXPECT_EQ(d[Finding::inconsistent_orientation].count, 3u);
  EXPECT_EQ(d.error_count(), 0u);
  plc = box();
  std::reverse(plc.facets[0].polygons[0].begin(), plc.facets[0].polygons[0].end());
  EXPECT_EQ(diagnose(plc)[Finding::inconsistent_orientation].count, 0u);
  EXPECT_EQ(diagnose(turned(plc))[Finding::inconsistent_orientation].count, 0u);
}

TEST(Diagnosis, Angles) {
  Plc<3> plc;  // a wedge: 20 degrees at the edge x = y = 0
  const double c = std::cos(std::acos(-1.0) / 9), s = std::sin(std::acos(-1.0) / 9);
  plc.points = {{0, 0, 0}, {1, 0, 0}, {c, s, 0}, {0, 0, 1}, {1, 0, 1}, {c, s, 1}};
  plc.facets = {{{{0, 1, 2}}}, {{{3, 4, 5}}}, {{{0, 1, 4, 3}}}, {{{1, 2, 5, 4}}}, {{{2, 0, 3, 5}}}};
  const Diagnosis<3> d = diagnose(plc);
  EXPECT_EQ(d.error_count(), 0u);
  ASSERT_EQ(d[Finding::segments_below_60].count, 2u);
  EXPECT_NEAR(d[Finding::segments_below_60].listed.at(0).measure, 20, 1e-12);
  EXPECT_EQ(d[Finding::segments_below_60].listed.at(0).what.ids.at(0) % 3, 0);
  ASSERT_EQ(d[Finding::facets_below_90].count, 3u);
  EXPECT_NEAR(d[Finding::facets_below_90].listed.at(0).measure, 20, 1e-12);
  EXPECT_EQ(d[Finding::facets_below_90].listed.at(0).what.ids, (Ids{2, 4, 0, 3}));
  EXPECT_NEAR(d[Finding::facets_below_90].listed.at(1).measure, 80, 1e-12);
  EXPECT_GE(d[Finding::segment_facet_below_90].count, 6u);
  EXPECT_NEAR(d[Finding::segment_facet_below_90].listed.at(0).measure, 20, 1e-12);
}

TEST(Diagnosis, CountsAllAndListsAFew) {
  Plc<3> plc = box();
  for (int k = 0; k < 50; ++k) add_triangle(plc, {1, -1, 0.01 * k + 1}, {1, 0.5, 0.01 * k + 1}, {1.5, 0.5, 0.01 * k + 1});
  Diagnosis<3> d = diagnose(plc);
  EXPECT_EQ(d[Finding::facets_cross].count, 50u);
  EXPECT_EQ(d[Finding::facets_cross].listed.size(), 20u);
  EXPECT_EQ(d.errors().size(), 20u);
  EXPECT_EQ(diagnose(plc, {.most_listed = 3}).errors().size(), 3u);
  try {
    refine(plc, RefineOptions<3>{});
    FAIL() << "meshed";
  } catch (const InputError& e) {
    EXPECT_EQ(e.code(), Errc::entities_intersect);
    EXPECT_EQ(e.diagnostic().ids, (Ids{2, 6}));
    EXPECT_NE(e.diagnostic().message.find("the first of 50"), std::string::npos) << e.what();
  }
}

TEST(Diagnosis, AllThatADomainRefuses) {
  Plc<3> plc = numbered(box());
  plc.points.insert(plc.points.end(), {{1, 1, 1}, {2, 2, 2}, {3, 3, 3}});
  plc.facets.push_back({{{8, 9, 10}, {8, 9, 10}}, {}, 0});
  plc.facets.push_back({{{0, 6}, {6, 0}}, {}, 0});
  plc.facets.push_back({{{4, 6, 5, 7}}, {}, 0});
  const Diagnosis<3> d = diagnose(plc);
  ASSERT_EQ(d[Finding::invalid_entity].count, 3u);
  EXPECT_EQ(d[Finding::invalid_entity].listed[0].what.code, Errc::degenerate_facet);
  EXPECT_EQ(d[Finding::invalid_entity].listed[0].what.ids.at(0), 7);
  EXPECT_EQ(d[Finding::invalid_entity].listed[1].what.ids.at(0), 8);
  EXPECT_EQ(d[Finding::invalid_entity].listed[2].what.code, Errc::self_crossing_facet);
  plc.facets[0].polygons[0][0] = 99;
  plc.points[0][1] = std::nan("");
  EXPECT_EQ(diagnose(plc)[Finding::invalid_entity].count, 2u);
  EXPECT_GT(diagnose(Plc<3>{}).error_count(), 0u);
  EXPECT_GT(diagnose(Plc<2>{}).error_count(), 0u);
}

// Two bumpy tori through each other; every sixth facet is turned over, so that there is more to list.
Plc<3> crossing_tori(std::uint32_t side) {
  constexpr double pi = 3.14159265358979323846;
  Plc<3> plc;
  for (const double shift : {0.0, 0.91})
    for (std::uint32_t i = 0; i < side; ++i)
      for (std::uint32_t j = 0; j < side; ++j) {
        const double u = 2 * pi * i / side, v = 2 * pi * j / side, r = 0.4 + 0.03 * std::sin(5 * u) * std::cos(3 * v + u);
        plc.points.push_back({shift + (1 + r * std::cos(v)) * std::cos(u), (1 + r * std::cos(v)) * std::sin(u), r * std::sin(v)});
      }
  for (std::uint32_t k = 0; k < 2 * side * side; ++k) {
    const std::uint32_t first = k / (side * side) * side * side, i = k / side % side, j = k % side;
    const auto at = [&](std::uint32_t di, std::uint32_t dj) { return first + (i + di) % side * side + (j + dj) % side; };
    plc.facets.push_back({{{at(0, 0), at(1, 0), at(1, 1)}}, {}, 0});
    if (k % 3 == 0)
      plc.facets.push_back({{{at(0, 0), at(0, 1), at(1, 1)}}, {}, 0});
    else
      plc.facets.push_back({{{at(0, 0), at(1, 1), at(0, 1)}}, {}, 0});
  }
  return plc;
}

std::string in_words(const Diagnosis<3>& d) {
  std::string words;
  for (std::size_t k = 0; k < finding_kinds; ++k) {
    words += std::to_string(d.found[k].count);
    for (const FindingList::Item& item : d.found[k].listed)
      words += "; " + item.what.message + " " + std::to_string(item.measure);
    words += '\n';
  }
  return words;
}

#if PGDR_TEST_TBB
TEST(Diagnosis, IsTheSameForAnyNumberOfThreads) {
  const test::AllowThreads allow(8);
  const Plc<3> plc = crossing_tori(100);  // 40,000 triangles: all loops run in several parts
  std::string one;
  for (const int threads : {1, 2, 8}) {
    tbb::task_arena arena(threads);
    Diagnosis<3> d;
    arena.execute([&] {
      ASSERT_EQ(tbb::this_task_arena::max_concurrency(), threads);
      d = diagnose(plc);
    });
    EXPECT_GT(d[Finding::facets_cross].count, 500u);
    EXPECT_GT(d[Finding::inconsistent_orientation].count, 5000u);
    EXPECT_GT(d[Finding::segments_below_60].count, 10000u);
    if (threads == 1) one = in_words(d);
    EXPECT_EQ(in_words(d), one) << threads;
  }
}

// Somebody cancels the tasks that the diagnosis is part of: it would find nothing in what is not looked at any more.
TEST(Diagnosis, IsWholeThoughTheTasksOfTheCallerAreCancelled) {
  const test::AllowThreads allow(2);
  const Plc<3> plc = crossing_tori(100);
  tbb::task_arena arena(2);
  Diagnosis<3> d;
  arena.execute([&] {
    tbb::task_group group;
    group.run_and_wait([&] {
      group.cancel();
      d = diagnose(plc);
    });
  });
  EXPECT_EQ(in_words(d), in_words(diagnose(plc)));
}
#endif

// The error named one crossing, and how many more there were; its diagnostics had that one alone.
TEST(Findings, AreAllInTheError) {
  Plc<2> plc;
  plc.points = {{{0, 0}}, {{7, 0}}, {{7, 7}}, {{0, 7}}};
  for (std::uint32_t i = 0; i < 4; ++i) plc.segments.push_back({{i, (i + 1) % 4}, 0});
  for (int i = 0; i < 6; ++i) {
    const auto k = static_cast<std::uint32_t>(plc.points.size());
    for (const auto& [x, y] : {std::pair{0.5, 1.0}, {0.5, 6.0}, {0.2, 3.0}, {0.8, 3.0}}) plc.points.push_back({{i + x, y}});
    plc.segments.push_back({{k, k + 1}, 0});
    plc.segments.push_back({{k + 2, k + 3}, 0});
  }
  try {
    require_no_errors(Domain<2>(plc));
    FAIL();
  } catch (const DiagnosedError& e) {
    EXPECT_NE(e.diagnostic().message.find("the first of 6"), std::string::npos);
    EXPECT_EQ(e.diagnostics().size(), 6u);
  }
}

TEST(Findings, InvalidEntitiesAreAllInTheError) {
  Plc<3> plc = test::box();
  for (int k = 0; k < 3; ++k) plc.facets.push_back({{{0, 0, 1}, {1, 1, 2}}, {}, 0});
  try {
    const Domain<3> domain(plc);
    FAIL();
  } catch (const InputError& e) {
    EXPECT_EQ(e.code(), Errc::degenerate_facet);
    EXPECT_EQ(e.diagnostics().size(), 3u);
  }
}

}  // namespace pgdr::test_diagnose_findings
