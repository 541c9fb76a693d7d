// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Refinement with selectors: checked meshes, the same bytes for any threads, and what a selector is told about the mesh
// against the mesh itself.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <random>
#include <set>
#include <string>

#include "meeting.hpp"
#include "parallel_support.hpp"
#include "pgdr/quality.hpp"
#include "pgdr/selectors.hpp"
#include "sanitized.hpp"
#include "scattered_models.hpp"

namespace pgdr::test_refine_selectors {

using test::box_with_pairs;
using test::expect_reproducible;
using test::refine_and_check;

template <int D>
struct NamedSelector {
  const char* name;
  PointSelector<D> selector;
};

/// On the rim of the disk, in a direction hashed from the element: as far from the centre as is allowed.
template <int D>
Point<D> on_the_rim(const PoorElement<D>& e) {
  if (!(e.disk.radius > 0)) return e.circumcenter;
  int i = static_cast<int>(std::fmod(1e6 * std::abs(e.circumcenter[0] / e.circumradius), 2 * D));
  Point<D> p = e.disk.center;
  p[i / 2] += (i % 2 ? 1 : -1) * 0.999 * e.disk.radius;
  return p;
}

/// The circumcentre, and seven points about it, mostly inside the circumsphere, in directions hashed from the element.
template <int D>
SelectedPoints<D> hashed_points(const PoorElement<D>& e) {
  SelectedPoints<D> points(e.circumcenter);
  std::mt19937_64 random(static_cast<std::uint64_t>(1e6 * std::abs(e.circumcenter[0] / e.circumradius)));
  while (points.size() < SelectedPoints<D>::most) {
    Point<D> p = e.circumcenter;
    for (int k = 0; k < D; ++k) p[k] += e.circumradius * (static_cast<double>(random() >> 11) * 0x1p-52 - 1);
    points.push_back(p);
  }
  return points;
}

template <int D>
std::vector<NamedSelector<D>> selectors() {
  return {{"off_center", off_center<D>()},
          {"optimized", optimized<D>(40)},
          {"sliver_avoiding", sliver_avoiding<D>(8)},
          {"random", randomized<D>(3)},
          {"rim", on_the_rim<D>},
          {"several", hashed_points<D>},
          {"asking", [](const PoorElement<D>& e, Neighborhood<D>& n) {
             const Point<D> p = on_the_rim<D>(e);
             const Preview<D> a = n.measure(p), b = n.count(e.circumcenter);
             return a.good - a.poor < b.good - b.poor ? p : e.circumcenter;
           }}};
}

template <class Dimension>
class SelectorsRefine : public testing::Test {};
template <int D>
using Dim = std::integral_constant<int, D>;
using Dimensions = testing::Types<Dim<2>, Dim<3>>;
TYPED_TEST_SUITE(SelectorsRefine, Dimensions);

using test::sanitized;

TYPED_TEST(SelectorsRefine, SameBytesForAnyThreads) {
  constexpr int D = TypeParam::value;
  std::uint64_t all_set_aside = 0;
  for (const auto& [name, selector] : selectors<D>())
    for (const bool is_turned : {false, true}) {
      if (sanitized && !is_turned) continue;
      const Plc<D> box = box_with_pairs<D>(D == 2 ? 100 : 12, 0.002, 5);
      const Plc<D> plc = is_turned ? test::turned<D>(box) : box;
      RefineOptions<D> options;
      options.selector = selector;
      options.disk.type = DiskType::type1;
      options.schedule.floor = 5;
      std::uint64_t set_aside = 0;
      for (const double ratio : {0.5, 1.5}) {
        if (sanitized && ratio > 1) continue;
        options.schedule.split_ratio = ratio;
        const auto result = expect_reproducible<D>(plc, options, std::string(name) + (is_turned ? ", turned" : ""),
                                                   sanitized ? test::eight_threads : test::concurrent_runners);
        EXPECT_EQ(result.poor_left, 0u) << name;
        EXPECT_EQ(result.statistics.selector_outside, 0u) << name;
        EXPECT_GT(result.scheduler.leaves, 16u) << name;
        set_aside += result.scheduler.set_aside;
      }
      EXPECT_TRUE(set_aside > 0 || sanitized) << name;
      all_set_aside += set_aside;
    }
  EXPECT_GT(all_set_aside, 0u);
}

// Models with facets, holes and regions, with a size and without; disks of both types.
TEST(SelectorsModels, MeshesAreChecked) {
  for (const auto& model : test::refined_models)
    for (const auto& [name, selector] : selectors<3>())
      for (const bool is_turned : {false, true}) {
        RefineOptions<3> options;
        options.selector = selector;
        options.disk.type = is_turned ? DiskType::type2 : DiskType::type1;
        options.radius_edge_bound = is_turned ? 3 : 2;
        options.size = model.size;
        const Plc<3> plc = is_turned ? test::turned<3>(model.make()) : model.make();
        const auto [result, report] = refine_and_check<3>(plc, options);
        EXPECT_LE(report.exit_code(), model.most_poor > 0 ? 1 : 0) << model.name << ", " << name << "\n"
                                                                   << test::findings(report);
        EXPECT_LE(static_cast<double>(result.poor_left), model.most_poor * static_cast<double>(result.mesh.cells.size()));
      }
}

// Bounds below the proved ones: the run ends, whatever is chosen inside the disk, and the few that stay poor say why.
TYPED_TEST(SelectorsRefine, BoundsBelowTheProvedOneEnd) {
  constexpr int D = TypeParam::value;
  for (const double bound : {D == 2 ? 1.0 : 1.5, D == 2 ? 0.9 : 1.0})
    for (const auto& [name, selector] : selectors<D>()) {
      if (sanitized && bound > 1) continue;
      RefineOptions<D> options;
      options.selector = selector;
      options.disk.type = DiskType::type1;
      options.radius_edge_bound = bound;
      options.max_vertices = 200000;
      const auto [result, report] = refine_and_check<D>(box_with_pairs<D>(sanitized && D == 3 ? 3 : 10, 0.01, 3), options);
      EXPECT_EQ(result.stop, StopCause::finished) << name;
      EXPECT_LE(report.exit_code(), 1) << test::findings(report);
      if (bound == 1.0 && D == 2) {
        EXPECT_LE(result.poor_left, result.mesh.cells.size() / 200) << name;
      }
    }
}

// At thirty degrees, below the proved bound, midpoints nearer than the edges of the element that asks for them may come.
TEST(SelectorsModels, ThirtyDegreesAreMetNearlyEverywhere) {
  RefineOptions<2> options;
  options.radius_edge_bound = 1;
  options.disk.type = DiskType::type1;
  for (const auto& selector : {PointSelector<2>(), off_center<2>(), optimized<2>()}) {
    options.selector = selector;
    const auto [result, report] = refine_and_check<2>(box_with_pairs<2>(300, 0.01, 8), options);
    EXPECT_LE(report.exit_code(), 1) << test::findings(report);
    EXPECT_LE(result.poor_left, 3u);
    EXPECT_GT(result.mesh.cells.size(), 3000u);
  }
}

// What the selectors are for.
TEST(SelectorsModels, FewerCellsAndBlunterAngles) {
  auto cells = [](const PointSelector<3>& selector, double bound) {
    RefineOptions<3> options;
    options.selector = selector;
    options.disk.type = DiskType::type1;
    options.radius_edge_bound = bound;
    options.min_dihedral = 0;
    return refine<3>(test::cube_with_two_points(), options).mesh.cells.size();
  };
  for (const double bound : {2.0, 4.0, 8.0, 16.0}) EXPECT_LT(10 * cells(off_center<3>(), bound), 9 * cells({}, bound));
  // Table 2.3 of the dissertation, circumcentres and off-centres, and fifteen per cent.
  EXPECT_LE(cells({}, 2), 1126u * 115 / 100);
  EXPECT_LE(cells({}, 20), 415u * 115 / 100);
  EXPECT_LE(cells(off_center<3>(), 2), 777u * 115 / 100);
  EXPECT_LE(cells(off_center<3>(), 20), 172u * 115 / 100);

  auto least_angles = [](const PointSelector<3>& selector) {  // the mean of the twentieth of all cells with the least
    RefineOptions<3> options;
    options.selector = selector;
    options.disk.type = DiskType::type1;
    options.min_dihedral = 0;
    const auto result = refine<3>(box_with_pairs<3>(150, 0.01, 4), options);
    std::vector<double> least;
    for (const auto& cell : result.mesh.cells) {
      Simplex<3> s;
      for (int i = 0; i < 4; ++i) s[i] = result.mesh.points[cell[i]];
      const auto angles = angles_deg<3>(s);
      least.push_back(*std::min_element(angles.begin(), angles.end()));
    }
    std::sort(least.begin(), least.end());
    double mean = 0;
    for (std::size_t i = 0; i < least.size() / 20; ++i) mean += least[i] / (least.size() / 20);
    return mean;
  };
  EXPECT_GT(least_angles(sliver_avoiding<3>()), 1.1 * least_angles({}));
}

TYPED_TEST(SelectorsRefine, ScalingByPowersOfTwoScalesTheMesh) {
  constexpr int D = TypeParam::value;
  const Plc<D> plc = test::turned<D>(box_with_pairs<D>(12, 0.01, 6), 3);
  for (const auto& selector : {off_center<D>(), optimized<D>(20), sliver_avoiding<D>(8)}) {
    RefineOptions<D> options;
    options.selector = selector;
    options.disk.type = DiskType::type1;
    const auto plain = refine<D>(plc, options);
    for (const double factor : {0x1p-40, 0x1p60}) {
      const auto big = refine<D>(test::scaled<D>(plc, factor), options);
      ASSERT_EQ(big.mesh.cells, plain.mesh.cells);
      for (std::size_t i = 0; i < plain.mesh.points.size(); ++i)
        for (int a = 0; a < D; ++a) ASSERT_EQ(big.mesh.points[i][a], plain.mesh.points[i][a] * factor);
    }
  }
}

/// What Neighborhood should say, from a mesh of a convex domain without inner constraints: all cells with p in their
/// circumsphere go, and a star is made of their outer faces.
template <int D>
Preview<D> brute_force(const OutputMesh<D>& mesh, const Point<D>& p, double bound) {
  Preview<D> found;
  std::map<std::set<std::uint32_t>, int> faces;
  for (const auto& cell : mesh.cells) {
    Simplex<D> s;
    for (int i = 0; i <= D; ++i) s[i] = mesh.points[cell[i]];
    if (in_sphere_perturbed<D>(s, p) != Sign::positive) continue;
    ++(radius_edge_within<D>(s, bound) ? found.good : found.poor);
    for (int i = 0; i <= D; ++i) {
      std::set<std::uint32_t> face(cell.begin(), cell.end());
      face.erase(cell[i]);
      ++faces[face];
    }
  }
  double least = 180;
  for (const auto& [face, times] : faces) {
    if (times == 2) continue;
    Simplex<D> s;
    int n = 0;
    for (const auto v : face) s[n++] = mesh.points[v];
    s[D] = p;
    for (const double a : angles_deg<D>(s)) least = std::min(least, a);
  }
  found.sharpest_cosine = std::cos(least * std::numbers::pi / 180);
  return found;
}

// The last insertion of a run that stops at n vertices, against the mesh of the run that stops at one less.
TYPED_TEST(SelectorsRefine, PreviewsAgreeWithTheMesh) {
  constexpr int D = TypeParam::value;
  const Plc<D> plc = box_with_pairs<D>(D == 2      ? 30
                                       : sanitized ? 6
                                                   : 15,
                                       0.02, 9);  // along the axes: no wall is some ulps off its plane
  RefineOptions<D> options;
  options.schedule.floor = std::numeric_limits<std::size_t>::max();  // one leaf: the budget is kept to the vertex
  options.radius_edge_bound = D == 2 ? 1.6 : 2.2;
  options.disk.type = DiskType::type1;
  struct Asked {
    Point<D> p;
    Preview<D> count, measure;
  };
  std::vector<Asked> asked;
  Point<D> chosen;
  options.selector = [&](const PoorElement<D>& e, Neighborhood<D>& n) {
    asked.clear();
    for (int k = -D; k <= D; ++k) {
      Point<D> p = e.disk.center;
      if (k != 0) p[std::abs(k) - 1] += (k < 0 ? -0.9 : 0.9) * e.disk.radius;
      asked.push_back({p, n.count(p), n.measure(p)});
    }
    Point<D> away = e.disk.center;
    away[0] += 1.01 * e.circumradius;
    EXPECT_EQ(n.count(away).status, Preview<D>::Status::impossible);
    away[0] = NAN;
    EXPECT_EQ(n.measure(away).status, Preview<D>::Status::impossible);
    return chosen = asked[asked.size() / 3].p;
  };
  const std::uint64_t all = refine<D>(plc, options).mesh.points.size();
  int compared = 0, possible = 0;
  for (std::uint64_t n = all * 2 / 3; n < all; n += 3) {
    options.max_vertices = n - 1;
    const auto before = refine<D>(plc, options).mesh;
    options.max_vertices = n;
    const auto after = refine<D>(plc, options).mesh;
    ASSERT_EQ(after.points.size(), n);
    ASSERT_EQ(before.points.size(), n - 1);
    auto has = [&](const OutputMesh<D>& mesh) { return std::count(mesh.points.begin(), mesh.points.end(), chosen) == 1; };
    if (!has(after) || has(before)) continue;  // it was an entity's turn
    for (const Asked& a : asked) {
      if (a.count.status == Preview<D>::Status::impossible) continue;
      const Preview<D> expected = brute_force<D>(before, a.p, options.radius_edge_bound);
      EXPECT_EQ(a.count.poor, expected.poor);
      EXPECT_EQ(a.count.good, expected.good);
      EXPECT_EQ(a.measure.poor, expected.poor);
      EXPECT_EQ(a.measure.good, expected.good);
      EXPECT_EQ(a.count.status, a.measure.status);
      ++compared;
      if (a.measure.status != Preview<D>::Status::possible) continue;
      EXPECT_NEAR(a.measure.sharpest_cosine, expected.sharpest_cosine, 1e-9);
      ++possible;
    }
  }
  EXPECT_GT(compared, 100);
  EXPECT_GT(possible, 50);
}

// A point outside the open disk: replaced and counted, or a typed error. The element's corners are no better.
TYPED_TEST(SelectorsRefine, PointsOutsideTheDisk) {
  constexpr int D = TypeParam::value;
  const Plc<D> plc = box_with_pairs<D>(20, 0.01, 2);
  RefineOptions<D> circumcenters;
  circumcenters.selector = {};
  circumcenters.min_dihedral = 0;  // as with a selector of one's own
  const auto plain = refine<D>(plc, circumcenters);
  const PointSelector<D> wrong[] = {[](const PoorElement<D>& e) {
                                      Point<D> p = e.circumcenter;
                                      p[0] += 1.001 * e.disk.radius;
                                      if (p == e.circumcenter) p[0] += e.circumradius;
                                      return p;
                                    },
                                    [](const PoorElement<D>& e) { return e.corners[0]; },
                                    [](const PoorElement<D>&) {
                                      return Point<D>{{NAN, 0}};
                                    },
                                    [](const PoorElement<D>&) {
                                      return Point<D>{{INFINITY, 0}};
                                    }};
  for (const auto& selector : wrong) {
    RefineOptions<D> options;
    options.selector = selector;
    options.disk.type = DiskType::type1;
    const auto [result, report] = refine_and_check<D>(plc, options);
    EXPECT_EQ(report.exit_code(), 0) << test::findings(report);
    EXPECT_GT(result.statistics.selector_outside, 0u);
    test::expect_same_mesh<D>(result.mesh, plain.mesh);
    options.outside = OutsidePolicy::error;
    try {
      refine<D>(plc, options);
      FAIL();
    } catch (const UsageError& e) {
      EXPECT_EQ(e.code(), Errc::bad_option);
    }
  }
}

template <int D>
double squared_shortest_edge(const OutputMesh<D>& mesh) {
  double least = std::numeric_limits<double>::infinity();
  for (const auto& cell : mesh.cells)
    for (int i = 0; i <= D; ++i)
      for (int j = 0; j < i; ++j) least = std::min(least, squared_distance(mesh.points[cell[i]], mesh.points[cell[j]]));
  return least;
}

// Further points go in, and others are left out, as near as they may come to anything; edges are as long as without them can be:
// half of the shortest that is given, as the input has no small angle.
TYPED_TEST(SelectorsRefine, FurtherPointsKeepTheirDistance) {
  constexpr int D = TypeParam::value;
  for (const DiskType disk : {DiskType::type1, DiskType::type2}) {
    RefineOptions<D> options;
    options.selector = hashed_points<D>;
    options.disk.type = disk;
    options.radius_edge_bound = 2.5;
    const auto [result, report] = refine_and_check<D>(box_with_pairs<D>(D == 2 ? 100 : 15, 0.002, 5), options);
    EXPECT_EQ(report.exit_code(), 0) << test::findings(report);
    EXPECT_EQ(result.poor_left, 0u);
    EXPECT_TRUE(result.delaunay);
    EXPECT_GT(result.statistics.selector_further, 50u);
    EXPECT_GT(result.statistics.selector_dropped, 50u);
    EXPECT_LT(result.statistics.selector_further, result.statistics.insertions_committed);
    EXPECT_GE(squared_shortest_edge(result.mesh), 0.25 * 0.002 * 0.002 * (1 - 1e-9));
  }
}

// What may not go in changes nothing: too near to the first point, to the element's corners or beyond its circumsphere, nowhere.
// Nor does it where no first point is in the disk.
TYPED_TEST(SelectorsRefine, FurtherPointsThatMayNotGoIn) {
  constexpr int D = TypeParam::value;
  const Plc<D> plc = box_with_pairs<D>(20, 0.01, 2);
  RefineOptions<D> options;
  options.disk.type = DiskType::type1;
  options.min_dihedral = 0;
  options.selector = {};
  const auto plain = refine<D>(plc, options);
  std::uint64_t outside = 0;
  options.selector = [](const PoorElement<D>& e) {
    const auto moved = [&](double by) {
      Point<D> p = e.circumcenter;
      p[0] += by;
      return p;
    };
    Point<D> beside_corner = e.corners[0];
    for (int k = 0; k < D; ++k)
      beside_corner[k] += (e.circumcenter[k] - beside_corner[k]) * 0.5 * e.shortest_edge / e.circumradius;
    return SelectedPoints<D>{e.circumcenter,
                             moved(0.99 * e.shortest_edge),
                             e.corners[1],
                             beside_corner,
                             moved(1.01 * e.circumradius),
                             moved(1e300),
                             moved(NAN),
                             e.circumcenter};
  };
  for (const bool is_first_outside : {false, true}) {
    if (is_first_outside)
      options.selector = [](const PoorElement<D>& e) { return SelectedPoints<D>{e.corners[0], e.circumcenter}; };
    const auto result = refine<D>(plc, options);
    test::expect_same_mesh<D>(result.mesh, plain.mesh);
    EXPECT_EQ(result.statistics.selector_further, 0u);
    EXPECT_EQ(result.statistics.selector_dropped > 100, !is_first_outside);
    outside += result.statistics.selector_outside;
  }
  EXPECT_GT(outside, 0u);
}

// They count as insertions where these are limited.
TYPED_TEST(SelectorsRefine, FurtherPointsKeepToTheLimitOfVertices) {
  constexpr int D = TypeParam::value;
  RefineOptions<D> options;
  options.selector = hashed_points<D>;
  options.disk.type = DiskType::type1;
  options.max_vertices = D == 2 ? 300 : 200;
  const auto result = refine<D>(box_with_pairs<D>(D == 2 ? 100 : 40, 0.002, 5), options);
  EXPECT_EQ(result.stop, StopCause::max_vertices);
  EXPECT_EQ(result.mesh.points.size(), options.max_vertices);
}

// A selector that takes its time, now and then, on eight threads.
TYPED_TEST(SelectorsRefine, SlowSelectors) {
  constexpr int D = TypeParam::value;
  const test::AllowThreads allow(8);
  const Plc<D> plc = box_with_pairs<D>(D == 2 ? 60 : 15, 0.005, 2);
  RefineOptions<D> options;
  options.schedule.floor = 5;
  options.disk.type = DiskType::type1;
  options.selector = off_center<D>();
  const auto expected = refine<D>(plc, test::with<D>(options, test::serial));
  for (const auto& runner : test::eight_threads) {
    std::atomic<unsigned> calls{0};
    test::Meeting two(2);
    options.selector = [&, quick = off_center<D>()](const PoorElement<D>& e, Neighborhood<D>& n) {
      if (++calls % 4 == 0) two.wait();
      return quick(e, n);
    };
    const auto result = refine<D>(plc, test::with<D>(options, runner));
    test::expect_same<D>(expected, result, runner.name);
    EXPECT_GT(result.scheduler.max_concurrent, 1u) << runner.name;
  }
}

// Exceptions come out, from any thread, also those thrown after a question that had no answer.
TYPED_TEST(SelectorsRefine, ExceptionsComeOut) {
  constexpr int D = TypeParam::value;
  const test::AllowThreads allow(8);
  RefineOptions<D> options;
  options.schedule.floor = 5;
  std::atomic<int> calls{0};
  options.selector = [&calls](const PoorElement<D>& e, Neighborhood<D>& n) {
    n.measure(e.circumcenter);
    if (++calls > 40) throw std::out_of_range("mine");
    return e.circumcenter;
  };
  for (const auto& runner : test::concurrent_runners) {
    calls = 0;
    EXPECT_THROW(refine<D>(box_with_pairs<D>(60, 0.005, 2), test::with<D>(options, runner)), std::out_of_range) << runner.name;
  }
}

}  // namespace pgdr::test_refine_selectors
