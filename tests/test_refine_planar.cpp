// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Planar straight line graphs from the triangulation of their segments to the refined mesh.
#include <gtest/gtest.h>

#include <filesystem>

#include "given_names.hpp"
#include "models_folder.hpp"
#include "parallel_support.hpp"
#include "pgdr/convex_hull.hpp"
#include "pgdr/io.hpp"
#include "pgdr/quality.hpp"
#include "pgdr/selectors.hpp"
#include "planar_plcs.hpp"
#include "space/spatial_order.hpp"

namespace pgdr::test_refine_planar {

using namespace test;

double bound_of(double degrees) { return 1 / (2 * std::sin(degrees * std::numbers::pi / 180)); }

RefineOptions<2> to_angle(double degrees) {
  RefineOptions<2> options;
  options.radius_edge_bound = bound_of(degrees);
  return options;
}

RefineOptions<2> unrefined() {
  RefineOptions<2> options;
  options.refine = false;
  return options;
}

/// The triangles by their corners' coordinates, for comparison of triangulations of the same points in another order.
std::vector<std::array<Point2, 3>> triangles(const OutputMesh<2>& mesh) {
  std::vector<std::array<Point2, 3>> all;
  for (const auto& c : mesh.cells) {
    std::array<Point2, 3> t{mesh.points[c[0]], mesh.points[c[1]], mesh.points[c[2]]};
    std::sort(t.begin(), t.end(), lex_less<2>);
    all.push_back(t);
  }
  std::sort(all.begin(), all.end(), [](const auto& a, const auto& b) {
    return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end(), lex_less<2>);
  });
  return all;
}

template <class Random>
Plc<2> in_other_order(const Plc<2>& plc, Random& random) {
  std::vector<std::uint32_t> place(plc.points.size());
  for (std::uint32_t i = 0; i < place.size(); ++i) place[i] = i;
  std::shuffle(place.begin(), place.end(), random);
  Plc<2> other = plc;
  for (std::size_t i = 0; i < place.size(); ++i) other.points[place[i]] = plc.points[i];
  for (auto& s : other.segments) {
    for (auto& v : s.points) v = place[v];
    if (random() & 1) std::swap(s.points[0], s.points[1]);
  }
  std::shuffle(other.segments.begin(), other.segments.end(), random);
  return other;
}

/// No point is added, the segments are edges, and every other edge is locally Delaunay: the checker says so.
void expect_constrained_delaunay(const Plc<2>& plc, std::uint64_t seed) {
  CheckOptions<2> options;
  const Domain<2> domain(plc);
  options.input = &plc;
  options.delaunay = true;
  const auto result = refine<2>(domain, unrefined());
  EXPECT_EQ(result.mesh.points.size(), domain.points().size());
  EXPECT_EQ(result.mesh.subsegments.size(), domain.segments().size());
  const CheckReport report = check<2>(result.mesh, options);
  EXPECT_EQ(report.exit_code(), 0) << "seed " << seed << "\n" << findings(report);
  EXPECT_EQ(report.not_delaunay_rounding, 0u) << "seed " << seed;
  Random random(seed);
  for (int k = 0; k < 3; ++k) {
    const auto again = refine<2>(in_other_order(plc, random), unrefined());
    EXPECT_EQ(triangles(result.mesh), triangles(again.mesh)) << "seed " << seed << " depends on the order";
  }
}

TEST(ConstrainedDelaunay, RandomPoints) {
  for (std::uint64_t seed = 1; seed <= 40; ++seed) expect_constrained_delaunay(random_graph(60, 80, 0, seed), seed);
  expect_constrained_delaunay(random_graph(1500, 800, 0, 41), 41);
}

TEST(ConstrainedDelaunay, GridsFullOfCocircularPoints) {
  for (std::uint64_t seed = 1; seed <= 40; ++seed) expect_constrained_delaunay(random_graph(60, 80, 12, seed), seed);
  expect_constrained_delaunay(random_graph(1000, 600, 40, 41), 41);
}

TEST(ConstrainedDelaunay, OneSegmentThroughAll) {
  Plc<2> plc = random_graph(400, 0, 0, 7);
  const auto first = static_cast<std::uint32_t>(plc.points.size());
  plc.points.insert(plc.points.end(), {{{-0.5, 0.5000001}}, {{1.5, 0.5000002}}});
  add_segment(plc, first, first + 1);
  expect_constrained_delaunay(plc, 7);
}

/// Segments whose one end lies beside a crossed one: their polygons have edges that dangle, and vertices twice.
TEST(ConstrainedDelaunay, DanglingEdgesBesideASegment) {
  Plc<2> plc;
  add_square(plc, -10, 10);
  plc.points.insert(plc.points.end(), {{{-9, 0}}, {{9, 0}}});
  add_segment(plc, 4, 5);
  for (std::uint32_t i = 0; i < 30; ++i) {
    const double x = -8 + 0.5 * i, sign = i % 2 ? -1 : 1;
    plc.points.insert(plc.points.end(), {{{x, sign * (3 + i % 5)}}, {{x + 0.1, sign * (0.05 + 0.02 * (i % 7))}}});
    add_segment(plc, 6 + 2 * i, 7 + 2 * i);
  }
  expect_constrained_delaunay(plc, 3);
}

TEST(ConstrainedDelaunay, HairyPolygonsAndFans) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    expect_constrained_delaunay(hairy_polygon(200, seed), seed);
    expect_constrained_delaunay(fan(60, 1.5, seed), seed);
  }
}

TEST(ConstrainedDelaunay, WhatCrossesIsRefusedByName) {
  Plc<2> plc;
  add_square(plc, 0, 4);
  plc.points.insert(plc.points.end(), {{{1, 1}}, {{3, 3}}, {{1, 3}}, {{3, 1}}});
  add_segment(plc, 4, 5);
  add_segment(plc, 6, 7);
  try {
    refine<2>(plc, unrefined());
    FAIL();
  } catch (const InputError& e) {
    EXPECT_EQ(e.code(), Errc::entities_intersect);
    EXPECT_EQ(e.diagnostic().ids, (std::vector<std::int64_t>{4, 5, 6, 7}));
  }
}

/// Checked, reproducible, and no angle smaller than theory allows beside the least angle of the input (Miller, Pav,
/// Walkington 2003), nor larger than the bound allows. Returns how many triangles stayed poor.
std::size_t expect_refined(const Plc<2>& plc, double degrees, const std::string& what) {
  const auto result = expect_reproducible<2>(plc, to_angle(degrees), what + " to " + std::to_string(degrees));
  const double phi = std::min(least_angle(plc), 60.0) * std::numbers::pi / 180;
  const double beside = std::atan(std::sin(phi) / (2 - std::cos(phi))) * 180 / std::numbers::pi;
  const QualitySummary quality = summarize_quality<2>(result.mesh);
  EXPECT_GE(quality.min_angle_deg, std::min(degrees, beside) * (1 - 1e-6)) << what;
  EXPECT_GE(result.reasons.size(), result.poor_left) << what;
  for (const PoorReason& reason : result.reasons) EXPECT_EQ(reason.code, PoorReason::Code::small_angle) << what;
  return result.poor_left;
}

TEST(PlanarRefinement, GraphsWithSmallAngles) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    EXPECT_GT(expect_refined(fan(5, 11, seed), 20.7, "a fan"), 0u);
    EXPECT_GT(expect_refined(fan(2, 1, seed), 20.7, "a needle"), 0u);
  }
  expect_refined(fan(3, 31, 4), 30, "a wide fan");
}

/// A point inside a wedge of a thousandth of a degree, beside the end of a shorter segment: what is small there does not go
/// on along the wedge, which would take 1e5 triangles for each of its width.
TEST(PlanarRefinement, SmallFeaturesDoNotFillAWedge) {
  Plc<2> plc;
  add_square(plc, -3, 3);
  plc.points.insert(plc.points.end(),
                    {{{0, 0}}, {{1, 1.5e-5}}, {{1, 3.2e-5}}, {{0.55, 2.5e-5}}, {{1, 6.5e-5}}, {{1, 9.4e-5}}, {{1, 8.5e-5}}});
  for (const std::uint32_t end : {5u, 6u, 7u, 8u, 9u}) add_segment(plc, 4, end);
  for (const double degrees : {5.0, 20.7, 28.0}) {
    const auto result = expect_reproducible<2>(plc, to_angle(degrees), "wedge to " + std::to_string(degrees));
    EXPECT_LT(result.mesh.cells.size(), 2000u);
  }
}

/// The end of a segment an ulp beside another: map data (municipalities of es-atlas, reduced) whose coordinates a program scaled.
/// Circumcentres between them are rounded onto vertices; one was inserted over and over, as the error bounds of its circumradius
/// are of no use there. And what doubles have no room for was not taken for a reason.
TEST(PlanarRefinement, EndsAnUlpBesideASegment) {
  Plc<2> plc;
  plc.points = {{{-2.5365339968886893, 36.95989212008301}}, {{-2.559025211590159, 36.93081083040164}},
                {{-2.646740948925892, 36.94696710244685}},  {{-2.5725199404110413, 36.917885812765476}},
                {{-2.462312988373837, 36.972817137719176}}, {{-2.4645621098439836, 36.9986671729915}},
                {{-2.6332462201050113, 36.95504523846945}}, {{-2.5500287257095717, 36.93081083040164}},
                {{-2.547779604239423, 36.945351475242326}}, {{-2.511793660717071, 36.967970256105616}}};
  for (const auto& [a, b] : {std::pair(0u, 1u), {4u, 5u}, {2u, 6u}, {3u, 7u}, {8u, 9u}}) add_segment(plc, a, b);
  plc = with_convex_hull(plc);
  const auto result = expect_reproducible<2>(plc, to_angle(20.7), "no ulp");
  EXPECT_LT(result.mesh.cells.size(), 100u);
  EXPECT_EQ(result.repairs.size(), 1u);
  plc.tolerance = 0;
  for (const double degrees : {20.7, 30.0}) expect_reproducible<2>(plc, to_angle(degrees), "an ulp");
}

TEST(PlanarRefinement, EveryInputEnds) {
  const std::vector<Runner> some{{"threads 2", Executor::threads, 2}, {"threads 8", Executor::threads, 8}};
  for (const double degrees : {20.7, 30.0}) {
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
      expect_reproducible<2>(random_graph(40, 40, 0, seed), to_angle(degrees), "random", some);
      expect_reproducible<2>(random_graph(40, 40, 9, seed), to_angle(degrees), "on a grid", some);
      expect_reproducible<2>(turned(random_graph(40, 40, 9, seed)), to_angle(degrees), "on a turned grid", some);
    }
    expect_reproducible<2>(hairy_polygon(60, 5), to_angle(degrees), "hairy", some);
    expect_reproducible<2>(fan(40, 0.5, 6), to_angle(degrees), "a narrow fan", some);
  }
}

TEST(PlanarRefinement, ScalesWithTheInput) {
  const Plc<2> plc = fan(4, 13, 9);
  const auto result = refine<2>(plc, to_angle(25)), large = refine<2>(scaled<2>(plc, 1024), to_angle(25));
  ASSERT_EQ(result.mesh.cells, large.mesh.cells);
  for (std::size_t i = 0; i < result.mesh.points.size(); ++i)
    for (int k = 0; k < 2; ++k) EXPECT_EQ(1024 * result.mesh.points[i][k], large.mesh.points[i][k]);
}

/// The points of a grid, in the order of their keys, are a path of single steps.
TEST(HilbertCurve, GoesFromNeighbourToNeighbour) {
  for (const int side : {2, 4, 64, 256}) {
    std::vector<Point2> points;
    for (int x = 0; x < side; ++x)
      for (int y = 0; y < side; ++y) points.push_back({{static_cast<double>(x), static_cast<double>(y)}});
    const HilbertCurve<2> curve(points);
    std::sort(points.begin(), points.end(), [&](const Point2& a, const Point2& b) { return curve.key(a) < curve.key(b); });
    for (std::size_t i = 1; i < points.size(); ++i) ASSERT_EQ(squared_distance(points[i - 1], points[i]), 1) << side << " " << i;
  }
}

TEST(HilbertCurve, InSpaceToo) {
  for (const int side : {2, 4, 32}) {
    std::vector<Point3> points;
    for (int i = 0; i < side * side * side; ++i)
      points.push_back({{double(i % side), double(i / side % side), double(i / side / side)}});
    const HilbertCurve<3> curve(points);
    std::sort(points.begin(), points.end(), [&](const Point3& a, const Point3& b) { return curve.key(a) < curve.key(b); });
    for (std::size_t i = 1; i < points.size(); ++i) ASSERT_EQ(squared_distance(points[i - 1], points[i]), 1) << side << " " << i;
  }
}

/// Tables 2.1 and 2.2 of the dissertation on models that look like its own: triangles by selector.
struct Counts {
  const char* model;
  double degrees;
  std::size_t circumcenters, off_centers;  ///< those of Triangle 1.6, without a bound on the area
};

class LookAlikes : public testing::TestWithParam<Counts> {};

Plc<2> look_alike(const std::string& model) { return read_plc<2>(std::string(PGDR_TEST_MODELS "/planar/") + model + ".poly"); }

/// Refined, reproducibly; every bound is met but by a few elements above 25 degrees (the optimised points).
double triangles_made(const Plc<2>& plc, RefineOptions<2> options, const PointSelector<2>& selector, const std::string& what) {
  options.selector = selector;
  if (selector) options.disk.type = DiskType::type1;
  const auto result = expect_reproducible<2>(plc, options, what, {{"threads 2", Executor::threads, 2}});
  EXPECT_TRUE(result.size_met);
  if (!selector || options.radius_edge_bound > bound_of(25.5)) {
    EXPECT_EQ(result.poor_left, 0u) << what;
  }
  EXPECT_LE(result.poor_left, 3u) << what;
  testing::Test::RecordProperty(what.substr(what.find(", ") + 2), static_cast<int>(result.mesh.cells.size()));
  return static_cast<double>(result.mesh.cells.size());
}

/// Circumcentres at most a tenth above Triangle's circumcentres, off-centres 15 % above its off-centres.
TEST_P(LookAlikes, AsFewTrianglesAsTriangle) {
  const auto& [model, degrees, triangle_circumcenters, triangle_off_centers] = GetParam();
  const Plc<2> plc = look_alike(model);
  const std::string name = std::string(model) + " at " + std::to_string(degrees) + ", ";
  const double circumcenters = triangles_made(plc, to_angle(degrees), {}, name + "circumcenters");
  const double off_centers = triangles_made(plc, to_angle(degrees), off_center<2>(), name + "off_centers");
  const double optimized = triangles_made(plc, to_angle(degrees), pgdr::optimized<2>(), name + "optimized");
  EXPECT_LE(circumcenters, 1.1 * static_cast<double>(triangle_circumcenters));
  EXPECT_LE(off_centers, 1.15 * static_cast<double>(triangle_off_centers));
  EXPECT_LE(optimized, (circumcenters < 1000 ? 1.05 : 1.02) * circumcenters + 5);
  if (degrees == 30 && (std::string(model) == "pipe_like" || std::string(model) == "cylinder_like")) {
    EXPECT_LT(optimized, circumcenters);
  }
}

INSTANTIATE_TEST_SUITE_P(All, LookAlikes,
                         testing::Values(Counts{"cylinder_like", 10, 190, 157}, Counts{"cylinder_like", 20, 305, 235},
                                         Counts{"cylinder_like", 25, 466, 297}, Counts{"cylinder_like", 30, 847, 556},
                                         Counts{"pipe_like", 10, 4964, 4902}, Counts{"pipe_like", 20, 8368, 7376},
                                         Counts{"pipe_like", 25, 11754, 11068}, Counts{"pipe_like", 30, 16880, 15032},
                                         Counts{"key_like", 10, 80, 82}, Counts{"key_like", 20, 136, 130},
                                         Counts{"key_like", 25, 157, 145}, Counts{"key_like", 30, 189, 191},
                                         Counts{"square1000", 10, 2412, 2336}, Counts{"square1000", 20, 3781, 3311},
                                         Counts{"square1000", 25, 5371, 4178}, Counts{"square1000", 30, 10567, 5932}),
                         [](const auto& info) {
                           return std::string(info.param.model) + "_" + std::to_string(static_cast<int>(info.param.degrees));
                         });

/// Where an area bound decides, the selector does not matter: the optimised points make no more triangles.
TEST(LookAlikesOfBoundedArea, OptimizedIsNoLarger) {
  for (const auto& [model, area] : {std::pair("pipe_like", 10.0), std::pair("cylinder_like", 0.1)})
    for (const double degrees : {10.0, 20.0, 30.0}) {
      const Plc<2> plc = look_alike(model);
      RefineOptions<2> options = to_angle(degrees);
      options.size = area;
      const std::string name = std::string(model) + " at " + std::to_string(degrees) + ", ";
      const double circumcenters = triangles_made(plc, options, {}, name + "circumcenters");
      EXPECT_LE(triangles_made(plc, options, off_center<2>(), name + "off_centers"), 1.02 * circumcenters);
      EXPECT_LE(triangles_made(plc, options, pgdr::optimized<2>(), name + "optimized"), 1.02 * circumcenters);
    }
}

void expect_boundary_kept(const Plc<2>& plc, RefineOptions<2> options, const std::string& what) {
  options.keep_boundary = true;
  const auto result = expect_reproducible<2>(plc, options, what);
  EXPECT_EQ(result.mesh.subsegments.size(), Domain<2>(plc).segments().size()) << what;
  EXPECT_GT(result.statistics.insertions_committed, 0u) << what;
}

TEST(KeptBoundary, NoPointOnAnySegment) {
  RefineOptions<2> sized = to_angle(20.7);
  sized.size = 0.02;
  expect_boundary_kept(square_with_hole(), sized, "square");
  expect_boundary_kept(turned(square_with_hole()), sized, "turned square");
  expect_boundary_kept(random_graph(40, 30, 0, 3), to_angle(20.7), "random");
  expect_boundary_kept(fan(6, 9, 3), sized, "fan");
  expect_boundary_kept(hairy_polygon(80, 3), to_angle(20.7), "hairy");
}

TEST(KeptBoundary, LongSidesExcuseLittle) {
  Plc<2> plc;
  add_square(plc, 0, 1);
  RefineOptions<2> options = to_angle(20.7);
  options.size = 0.001;
  options.keep_boundary = true;
  const auto [result, report] = refine_and_check<2>(plc, options);
  EXPECT_LE(report.exit_code(), 1) << findings(report);
  EXPECT_EQ(result.mesh.subsegments.size(), 4u);
  EXPECT_GT(result.mesh.cells.size(), 500u);  // the inside is refined as it would be
  EXPECT_GE(result.poor_left, 4u);            // each side has one
  EXPECT_EQ(result.reasons.size(), result.poor_left);
  for (const PoorReason& reason : result.reasons) EXPECT_EQ(reason.code, PoorReason::Code::kept_boundary);
}

/// A reason that the boundary was kept does not hold where it was not, or elsewhere.
TEST(KeptBoundary, ReasonsAreVerified) {
  Plc<2> plc;
  add_square(plc, 0, 8);
  const Domain<2> domain(plc);
  RefineOptions<2> options = to_angle(20.7);
  options.size = 0.5;
  options.keep_boundary = true;
  RefineResult<2> result = refine<2>(domain, options);
  ASSERT_FALSE(result.reasons.empty());
  CheckOptions<2> check_options;
  check_options.input = &plc;
  check_options.radius_edge_bound = options.radius_edge_bound;
  check_options.size = options.size;
  check_options.delaunay = true;
  check_options.reasons = &result.reasons;
  EXPECT_EQ(check<2>(result.mesh, check_options).exit_code(), 1);
  for (PoorReason& reason : result.reasons) reason.entities[0].ends[1] = {4, 4, 0};  // no segment
  EXPECT_EQ(check<2>(result.mesh, check_options).exit_code(), 6);
  options.keep_boundary = false;
  options.radius_edge_bound = 10;
  options.size = {};
  options.size = 8.0;
  result = refine<2>(domain, options);
  check_options.radius_edge_bound = 0.1;  // all cells are over this
  std::vector<PoorReason> claims;
  for (std::uint32_t c = 0; c < result.mesh.cells.size(); ++c)
    claims.push_back({c, PoorReason::Code::kept_boundary, {test::named_segment<2>({{0, 0}}, {{8, 0}}), {}}, 0});
  check_options.reasons = &claims;
  ASSERT_GT(result.mesh.subsegments.size(), 4u);
  EXPECT_EQ(check<2>(result.mesh, check_options).exit_code(), 6);
}

/// Segments with one marker are kept, the others are split.
TEST(KeptBoundary, ByPart) {
  Plc<2> plc;
  add_square(plc, 0, 1);
  for (std::size_t s = 0; s < 4; ++s) plc.segments[s].marker = static_cast<int>(s) + 1;
  RefineOptions<2> options = to_angle(20.7);
  options.size = 0.01;
  options.kept_markers = {2};
  EXPECT_THROW(refine<2>(plc, options), UsageError);
  options.keep_boundary = true;
  const auto [result, report] = refine_and_check<2>(plc, options);
  EXPECT_LE(report.exit_code(), 1) << findings(report);
  std::array<std::size_t, 5> pieces{};
  for (const auto& s : result.mesh.subsegments) ++pieces[static_cast<std::size_t>(s.marker)];
  EXPECT_EQ(pieces[2], 1u);
  for (const std::size_t m : {1u, 3u, 4u}) EXPECT_GT(pieces[m], 2u);
}

TEST(BeyondTheory, IsWarnedOf) {
  const auto codes = [](const RefineResult<2>& r) {
    std::vector<Errc> c;
    for (const Diagnostic& d : r.warnings) c.push_back(d.code);
    return c;
  };
  EXPECT_TRUE(codes(refine<2>(square_with_hole(), to_angle(20.7))).empty());
  EXPECT_EQ(codes(refine<2>(square_with_hole(), to_angle(30))), std::vector{Errc::beyond_theory});
}

/// Every valid .poly in the folder pslg of the real models is meshed to both angles, checked, and the same for all threads, as
/// it is, turned, scaled and shifted; every other one is refused with names.
TEST(PlanarModels, OfTheCollection) {
  const auto is_valid = [](const Plc<2>& plc) {
    try {
      static_cast<void>(refine<2>(plc, unrefined()));
      return true;
    } catch (const InputError& e) {
      EXPECT_FALSE(std::string(e.what()).empty());
      EXPECT_TRUE(!e.diagnostic().ids.empty() || e.code() == Errc::encloses_nothing) << e.what();
      return false;
    }
  };
  std::size_t meshed = 0, refused = 0;
  for (const auto& file : std::filesystem::directory_iterator(models_folder() / "pslg")) {
    if (file.path().extension() != ".poly") continue;
    const std::string name = file.path().filename().string();
    const Plc<2> plc = read_plc<2>(file.path());
    ++(is_valid(plc) ? meshed : refused);
    if (!is_valid(plc)) continue;
    // Segments that overlap do so no more when they are turned and rounded.
    const Plc<2> about_the_origin = turned(plc, 0), far = turned(plc, 1e5);
    for (const double degrees : {20.7, 30.0}) {
      expect_reproducible<2>(plc, to_angle(degrees), name, eight_threads);
      expect_reproducible<2>(scaled<2>(plc, 1e-6), to_angle(degrees), name + ", small", eight_threads);
      expect_reproducible<2>(scaled<2>(plc, 1e6), to_angle(degrees), name + ", large", eight_threads);
      if (is_valid(about_the_origin))
        expect_reproducible<2>(about_the_origin, to_angle(degrees), name + ", turned", eight_threads);
      if (is_valid(far)) expect_reproducible<2>(far, to_angle(degrees), name + ", far", eight_threads);
    }
  }
  EXPECT_GE(meshed, 2u);
  EXPECT_GT(meshed, 4 * refused);
}

}  // namespace pgdr::test_refine_planar
