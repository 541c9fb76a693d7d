// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Inputs with inner structure, with and without automatic regions; plain, turned and scaled. Labels against those
// written down beside the inputs, and all of it through the checker.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>

#include "parallel_support.hpp"
#include "pgdr/diagnosis.hpp"
#include "repair_plcs.hpp"
#include "structure_plcs.hpp"

namespace pgdr::test_boundary_structure {

using test::Structure;

template <int D>
bool holds(const OutputMesh<D>& mesh, std::size_t cell, const Point<D>& p) {
  Simplex<D> s;
  for (int i = 0; i <= D; ++i) s[i] = mesh.points[mesh.cells[cell][i]];
  for (int i = 0; i <= D; ++i) {
    Simplex<D> t = s;
    t[i] = p;
    if (orient<D>(t) == Sign::negative) return false;
  }
  return true;
}

/// 0 where there is no cell.
template <int D>
double label_at(const OutputMesh<D>& mesh, const Point<D>& p) {
  for (std::size_t c = 0; c < mesh.cells.size(); ++c)
    if (holds<D>(mesh, c, p)) return mesh.regions.empty() ? -1 : mesh.regions[c];
  return 0;
}

template <int D>
test::Outcome<D> refined(const Plc<D>& plc, RegionMode mode, const std::string& what, bool mended = true,
                         double size = INFINITY) {
  const Domain<D> domain(plc);
  EXPECT_EQ(diagnose(domain).error_count(), 0u) << what;
  RefineOptions<D> options;
  options.regions = mode;
  options.size = size;
  test::Outcome<D> out{refine<D>(domain, options), {}};
  CheckOptions<D> check_options;
  check_options.input = &plc;
  check_options.regions = mode;
  check_options.size = size;
  check_options.radius_edge_bound = options.radius_edge_bound;
  check_options.largest_cosine = out.result.optimization.claimed_cosine;
  check_options.delaunay = out.result.delaunay;
  check_options.reasons = &out.result.reasons;
  out.report = check<D>(out.result.mesh, check_options);
  EXPECT_EQ(out.result.stop, StopCause::finished) << what;
  EXPECT_LE(out.report.exit_code(), mended ? 1 : 6) << what << "\n" << test::findings(out.report);
  for (const auto& f : out.report.findings)
    EXPECT_TRUE(f.kind == CheckFinding::Kind::not_delaunay || f.kind == CheckFinding::Kind::bad_reason)
        << what << ' ' << f.message;
  return out;
}

using Motion = std::function<Point3(Point3)>;

/// The structure moved, points and probes alike.
Structure moved(Structure s, const Motion& motion) {
  for (Point3& p : s.plc.points) p = motion(p);
  for (Point3& p : s.plc.holes) p = motion(p);
  for (auto& r : s.plc.regions) r.point = motion(r.point);
  for (auto& f : s.plc.facets)
    for (Point3& p : f.holes) p = motion(p);
  for (auto& probe : s.probes) probe.at = motion(probe.at);
  return s;
}

Point3 oblique(Point3 p) {
  Plc<3> one;
  one.points = {p};
  return test::oblique(one).points[0];
}

Structure permuted(Structure s) {  // ids of points and facets in another order
  std::reverse(s.plc.facets.begin(), s.plc.facets.end());
  const auto last = static_cast<std::uint32_t>(s.plc.points.size() - 1);
  std::reverse(s.plc.points.begin(), s.plc.points.end());
  for (auto& f : s.plc.facets)
    for (auto& polygon : f.polygons)
      for (auto& v : polygon) v = last - v;
  for (auto& segment : s.plc.segments)
    for (auto& v : segment.points) v = last - v;
  return s;
}

std::vector<std::pair<std::string, Structure>> variants(const Structure& s) {
  std::vector<std::pair<std::string, Structure>> out{
      {"plain", s},
      {"permuted", permuted(s)},
      {"small", moved(s,
                      [](Point3 p) {
                        return Point3{{p[0] * 0x1p-40, p[1] * 0x1p-40, p[2] * 0x1p-40}};
                      })},
      {"oblique", moved(s, oblique)}};
  if (s.turns) out.emplace_back("turned", moved(s, [](Point3 p) { return test::turned(p, 1000); }));
  return out;
}

double span_of(const Plc<3>& plc) {
  double span = 0;
  for (const Point3& p : plc.points)
    for (const Point3& q : plc.points) span = std::max(span, squared_distance(p, q));
  return std::sqrt(span);
}

class Structures : public testing::TestWithParam<Structure> {};

TEST_P(Structures, AutomaticRegions) {
  for (const auto& [how, s] : variants(GetParam())) {
    const auto out = refined<3>(s.plc, RegionMode::automatic, how, s.mended);
    // A motion that turns changes the order of the labels, nothing else.
    const bool same_order = how == "plain" || how == "permuted" || how == "small";
    for (const auto& probe : s.probes) {
      const double label = label_at<3>(out.result.mesh, probe.at);
      if (same_order) {
        EXPECT_EQ(label, probe.label) << how << ' ' << probe.at[0] << ' ' << probe.at[1] << ' ' << probe.at[2];
      } else {
        EXPECT_EQ(label > 0, probe.label > 0) << how;
      }
    }
    std::vector<double> used = out.result.mesh.regions;
    std::sort(used.begin(), used.end());
    used.erase(std::unique(used.begin(), used.end()), used.end());
    for (std::size_t i = 0; i < used.size(); ++i) EXPECT_EQ(used[i], double(i + 1)) << how;
  }
}

TEST_P(Structures, AllThatIsEnclosedWithoutSeeds) {
  for (const auto& [how, s] : variants(GetParam())) {
    const auto out = refined<3>(s.plc, RegionMode::seeds, how, s.mended);
    EXPECT_TRUE(out.result.mesh.regions.empty());
    for (const auto& probe : s.probes)
      if (probe.label > 0) {
        EXPECT_EQ(label_at<3>(out.result.mesh, probe.at), -1) << how;
      }
  }
}

TEST_P(Structures, SameBytesForAnyThreads) {
  RefineOptions<3> options;
  options.regions = RegionMode::automatic;
  options.size = span_of(GetParam().plc) / 20;
  const test::AllowThreads allow(8);
  const auto first = refine<3>(GetParam().plc, test::with<3>(options, test::serial));
  for (const auto& runner : test::concurrent_runners)
    test::expect_same<3>(first, refine<3>(GetParam().plc, test::with<3>(options, runner)), runner.name);
}

// ---- seeds
// -----------------------------------------------------------------------------------------------------------

Plc<3> three_nested_boxes() {
  return test::boxes({{{{0, 0, 0}}, {{6, 6, 6}}}, {{{1, 1, 1}}, {{5, 5, 5}}}, {{{2, 2, 2}}, {{4, 4, 4}}}});
}
const Point3 outer{{0.5, 3, 3}}, middle{{1.5, 3, 3}}, inner{{3, 3, 3}};

TEST(Seeds, WinOverNesting) {
  struct Case {
    std::vector<Point3> holes;
    std::vector<RegionSeed<3>> regions;
    std::array<double, 3> automatic, all, seeds;
    std::ptrdiff_t warnings = 0;
  };
  const std::vector<Case> cases{
      {{}, {}, {1, 0, 2}, {1, 2, 3}, {-1, -1, -1}},
      {{outer}, {}, {0, 0, 1}, {0, 1, 2}, {0, -1, -1}},
      {{middle}, {}, {1, 0, 2}, {1, 0, 2}, {-1, 0, -1}},
      {{}, {{middle, 5, 0}}, {1, 5, 2}, {1, 5, 2}, {0, 5, 0}},
      {{}, {{outer, 1, 0}}, {1, 0, 2}, {1, 2, 3}, {1, 0, 0}},
      {{}, {{inner, 1, 0}}, {2, 0, 1}, {2, 3, 1}, {0, 0, 1}},
      {{}, {{inner, -2.5, 0}, {outer, 2, 0}}, {2, 0, -2.5}, {2, 1, -2.5}, {2, 0, -2.5}},
      {{inner}, {{{{3.5, 3, 3}}, 4, 0}}, {1, 0, 0}, {1, 2, 0}, {0, 0, 0}, 1},           // a hole wins over a region
      {{}, {{{{-1, 3, 3}}, 4, 0}, {inner, 3, 0}}, {1, 0, 3}, {1, 2, 3}, {0, 0, 3}, 1},  // outside
  };
  for (std::size_t i = 0; i < cases.size(); ++i) {
    SCOPED_TRACE(i);
    Plc<3> plc = three_nested_boxes();
    plc.holes = cases[i].holes;
    plc.regions = cases[i].regions;
    for (const auto& [mode, wanted] : {std::pair(RegionMode::automatic, cases[i].automatic),
                                       std::pair(RegionMode::all, cases[i].all), std::pair(RegionMode::seeds, cases[i].seeds)}) {
      SCOPED_TRACE(static_cast<int>(mode));
      const auto out = refined<3>(plc, mode, "mode");
      for (int k = 0; k < 3; ++k) {
        const auto& holes = cases[i].holes;
        const Point3 p = std::array{outer, middle, inner}[k];
        const bool hole = std::find(holes.begin(), holes.end(), p) != holes.end();
        if (mode == RegionMode::seeds && !hole && wanted[k] == 0) {
          bool found = false;  // label 0 is that of cells without seed
          for (std::size_t c = 0; c < out.result.mesh.cells.size(); ++c) found = found || holds<3>(out.result.mesh, c, p);
          EXPECT_TRUE(found);
        }
        EXPECT_EQ(label_at<3>(out.result.mesh, p), wanted[k]) << k;
      }
      const auto is_of_seeds = [](const Diagnostic& d) { return d.code == Errc::seed_on_boundary; };
      EXPECT_EQ(std::ranges::count_if(out.result.warnings, is_of_seeds), cases[i].warnings);
    }
  }
}

TEST(Seeds, SizesOfRegionsHoldInAutomaticMode) {
  Plc<3> plc = three_nested_boxes();
  plc.regions = {{middle, 7, 0.05}};
  const auto out = refined<3>(plc, RegionMode::automatic, "sizes");
  std::array<std::size_t, 8> cells{};
  for (const double label : out.result.mesh.regions) ++cells[static_cast<std::size_t>(label)];
  EXPECT_GT(cells[7], 56 / 0.05);
  EXPECT_EQ(cells[1] + cells[2] + cells[7], out.result.mesh.cells.size());
}

TEST(Seeds, NothingLeft) {
  Plc<3> plc = three_nested_boxes();
  plc.holes = {outer, middle, inner};
  for (const RegionMode mode : {RegionMode::seeds, RegionMode::automatic, RegionMode::all}) {
    RefineOptions<3> options;
    options.regions = mode;
    try {
      refine<3>(plc, options);
      ADD_FAILURE();
    } catch (const InputError& e) {
      EXPECT_EQ(e.code(), Errc::encloses_nothing);
      EXPECT_NE(e.diagnostic().message.find("hole seed"), std::string::npos);
    }
  }
}

// The first refused with a mesh that the checker did not agree with: the seed is on an edge of a triangle inside, in rounded
// Steiner points no more.
TEST(Seeds, OnWallsAreRefused) {
  Plc<3> plc = test::boxes({{{{0, 0, 0}}, {{2, 2, 2}}}});
  for (const Point3& p : {Point3{{0, 0, 0}}, Point3{{1, 1, 1}}, Point3{{2, 1, 0}}}) plc.points.push_back(p);
  const auto n = static_cast<std::uint32_t>(plc.points.size());
  plc.facets.push_back({{{n - 3, n - 2, n - 1}}, {}, 1});
  plc.source.file = "walls.poly";
  plc.source.hole_lines = {30};
  plc.source.region_lines = {40, 41};
  plc.first_index = 1;
  const auto refusal = [&](const Point3& p, bool hole, double scale) -> std::optional<Diagnostic> {
    Plc<3> with = plc;
    if (hole)
      with.holes = {p};
    else
      with.regions = {{{{0.5, 1.5, 1.5}}, 5, 0}, {p, 5, 0}};
    with = test::oblique(with);
    test::for_each_point(with, [&](Point3& q) {
      for (double& x : q.x) x *= scale;
    });
    try {
      RefineOptions<3> options;
      options.max_vertices = 200;
      refine<3>(with, options);
      return {};
    } catch (const InputError& e) {
      return e.diagnostic();
    }
  };
  for (const double scale : {1.0, 0x1p-700, 0x1p+700})
    for (const bool hole : {false, true}) {
      for (const Point3& p : {Point3{{0.25, 0.25, 0.25}}, Point3{{1, 0.75, 0.5}}, Point3{{2, 0.5, 0.5}}, Point3{{2, 2, 1}},
                              Point3{{1 + 0x1p-51, 0.75, 0.5}}}) {
        const auto d = refusal(p, hole, scale);
        ASSERT_TRUE(d) << p[0];
        EXPECT_EQ(d->code, Errc::seed_on_boundary);
        EXPECT_EQ(d->file, "walls.poly");
        EXPECT_EQ(d->line, hole ? 30u : 41u);
        EXPECT_EQ(d->ids, (std::vector<std::int64_t>{hole ? 1 : 2}));
      }
      EXPECT_EQ(refusal({{1, 0.75, 0.5 + 0x1p-40}}, false, scale), std::nullopt);
    }
}

// A polygon far from planar is the union of two triangles; a mesh that cut across their fold had another volume.
TEST(Facets, TheFoldOfABentOneIsKept) {
  Plc<3> plc = test::boxes({{{{0, 0, 0}}, {{1, 1, 1}}}});
  for (Point3& p : plc.points)
    if (p == Point3{{1, 1, 1}}) p[2] = 1.3;
  for (const double size : {0.1, 0.4}) {
    const auto out = refined<3>(plc, RegionMode::automatic, "bent", true, size);
    double volume = 0;
    for (const auto& c : out.result.mesh.cells) {
      const auto side = [&](int k, int i) { return out.result.mesh.points[c[k]][i % 3] - out.result.mesh.points[c[0]][i % 3]; };
      double det = 0;
      for (int i = 0; i < 3; ++i) det += side(1, i) * (side(2, i + 1) * side(3, i + 2) - side(2, i + 2) * side(3, i + 1));
      volume += std::abs(det) / 6;
    }
    EXPECT_TRUE(std::abs(volume - 1.05) < 1e-12 || std::abs(volume - 1.1) < 1e-12) << volume;
  }
}

TEST(Segments, LooseOnesOfAPolyFileKeepTheirMarkers) {
  Plc<3> plc = test::cube();
  plc.points.push_back({{0.25, 0.25, 0.5}});
  plc.points.push_back({{0.75, 0.5, 0.5}});
  plc.facets.insert(plc.facets.begin(), {{{8, 9}}, {}, 7});
  const auto [result, report] = test::refine_and_check<3>(plc, {});
  EXPECT_EQ(report.exit_code(), 0) << test::findings(report);
  double length = 0;
  for (const auto& s : result.mesh.subsegments)
    if (s.marker == 7)
      length += std::sqrt(squared_distance(result.mesh.points[s.vertices[0]], result.mesh.points[s.vertices[1]]));
  EXPECT_NEAR(length, std::sqrt(0.3125), 1e-12);
}

/// A loose segment that ends an ulp beside another, exactly as given. They do not touch, but no subsegment beside the end is as
/// it should be; what says so has the numbers of the input, which counts from 1 here, its file and its line.
TEST(Segments, WhatTheyPassByRoundingIsNamed) {
  Plc<3> plc;
  const Point3 low{{-29.250860471007904, 27.794698954978614, 21.101969518129124}};
  test::add_box(plc, low, {{low[0] + 1, low[1] + 1, low[2] + 1}});
  plc.points.insert(plc.points.end(), {{{-29.09984666586002, 27.993785972397003, 21.29186773108687}},
                                       {{-28.42054187646335, 28.652443625205716, 21.82074143548397}},
                                       {{-28.888352598413537, 28.19885178117923, 21.4565267363734}},
                                       {{-28.54940140865598, 28.294698954978614, 22.001969518129123}}});
  plc.segments = {{{8, 9}, 0}, {{10, 11}, 0}};
  plc.tolerance = 0;
  plc.first_index = 1;
  plc.source.file = "an_ulp.poly";
  for (std::uint32_t line = 2; line < 14; ++line) plc.source.point_lines.push_back(line);
  EXPECT_EQ(diagnose<3>(plc).error_count(), 0u);
  try {
    refine<3>(plc, {});
    FAIL();
  } catch (const InputError& e) {
    EXPECT_EQ(e.code(), Errc::entities_intersect);
    EXPECT_EQ(e.diagnostic().ids, (std::vector<std::int64_t>{9, 10, 11}));
    EXPECT_EQ(e.diagnostic().file, "an_ulp.poly");
    EXPECT_EQ(e.diagnostic().line, 10u);
    EXPECT_EQ(e.diagnostic().points.size(), 1u);
    EXPECT_NE(e.diagnostic().message.find("between points 9 and 10 passes through point 11"), std::string::npos) << e.what();
  }
}

TEST(Seeds, OpenSurfaceNamesItsBoundary) {
  Plc<3> plc = test::boxes({{{{0, 0, 0}}, {{2, 2, 2}}}});
  plc.facets.pop_back();  // z high
  test::append(plc, test::icosphere(0), 0.25, {{5, 5, 5}});
  plc.facets.pop_back();
  for (const RegionMode mode : {RegionMode::seeds, RegionMode::automatic}) {
    RefineOptions<3> options;
    options.regions = mode;
    try {
      refine<3>(plc, options);
      ADD_FAILURE();
    } catch (const InputError& e) {
      EXPECT_EQ(e.code(), Errc::encloses_nothing);
      EXPECT_EQ(e.diagnostic().ids, (std::vector<std::int64_t>{4, 5, 7, 6}));
      EXPECT_EQ(e.diagnostic().points.size(), 4u);
      EXPECT_NE(e.diagnostic().message.find("open boundaries: 2"), std::string::npos) << e.what();
    }
  }
}

// ---- the plane
// -------------------------------------------------------------------------------------------------------

TEST(Plane, NestedAndTouchingSquares) {
  Plc<2> plc;
  const auto square = [&](double low, double high, double y) {
    const auto b = static_cast<std::uint32_t>(plc.points.size());
    plc.points.insert(plc.points.end(), {{low, y + low}, {high, y + low}, {high, y + high}, {low, y + high}});
    for (std::uint32_t i = 0; i < 4; ++i) plc.segments.push_back({{b + i, b + (i + 1) % 4}, 1});
  };
  square(0, 9, 0);
  square(1, 8, 0);
  square(2, 7, 0);
  square(3, 6, 0);
  square(9, 10, 0);  // at a point of the first
  for (const bool turn : {false, true}) {
    const auto motion = [&](Point2 p) { return turn ? test::turned(p, 100) : p; };
    Plc<2> moved = plc;
    for (Point2& p : moved.points) p = motion(p);
    for (const bool divided : {false, true}) {
      if (divided) moved.segments.push_back({{12, 14}, 3});  // the innermost
      // Seen from the ring of the third square, both halves of the innermost are void.
      const auto out = refined<2>(moved, RegionMode::automatic, "plane");
      for (const auto& [p, solid] : {std::pair{Point2{{0.5, 4}}, true},
                                     {Point2{{1.5, 4}}, false},
                                     {Point2{{2.5, 4}}, true},
                                     {Point2{{4, 5}}, false},
                                     {Point2{{5, 4}}, false},
                                     {Point2{{9.5, 9.25}}, true}})
        EXPECT_EQ(label_at<2>(out.result.mesh, motion(p)) > 0, solid) << p[0] << ' ' << p[1];
      if (!turn) {
        EXPECT_EQ(label_at<2>(out.result.mesh, {{0.5, 4}}), 1);
        EXPECT_EQ(label_at<2>(out.result.mesh, {{2.5, 4}}), 2);
        EXPECT_EQ(label_at<2>(out.result.mesh, {{9.5, 9.25}}), 3);
      }
    }
  }
}

// Fine enough that edges at which bodies or voids touch are split.
TEST_P(Structures, Fine) {
  for (const auto& [how, s] : variants(GetParam()))
    if (how == "plain" || how == "turned") refined<3>(s.plc, RegionMode::automatic, how, s.mended, span_of(s.plc) / 16);
}

INSTANTIATE_TEST_SUITE_P(Inputs, Structures, testing::ValuesIn(test::all_structures()),
                         [](const auto& info) { return info.param.name; });

}  // namespace pgdr::test_boundary_structure
