// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// What output points have beside their coordinates: attributes, interpolated, and markers, handed on; and the leaves of
// cells. For any number of threads the same.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numeric>
#include <set>

#include "model_plcs.hpp"
#include "parallel_support.hpp"
#include "pgdr/circumsphere.hpp"
#include "pgdr/error.hpp"
#include "pgdr/planar_plc.hpp"
#include "planar_plcs.hpp"

namespace pgdr::test_compact_point_data {

using namespace test;

/// A linear function of the point, a constant, and one that is not linear.
template <int D>
void give_attributes(Plc<D>& plc) {
  for (const Point<D>& p : plc.points) {
    double sum = 0.5;
    for (int k = 0; k < D; ++k) sum += (k + 1) * p[k];
    plc.point_attributes.insert(plc.point_attributes.end(), {sum, 0.1, std::sin(3 * p[0])});
  }
}

template <int D>
RefineResult<D> expect_attributes(Plc<D> plc, double size, const std::string& what) {
  SCOPED_TRACE(what);
  give_attributes(plc);
  RefineOptions<D> options;
  options.size = size;
  const auto result = expect_reproducible<D>(plc, options, what);
  const OutputMesh<D>& mesh = result.mesh;
  EXPECT_EQ(mesh.point_attributes.size(), 3 * mesh.points.size());
  EXPECT_GT(mesh.points.size(), plc.points.size());
  double largest = 0;
  for (const Point<D>& p : plc.points)
    for (int k = 0; k < D; ++k) largest = std::max(largest, std::abs(p[k]));
  const std::vector<double>& a = mesh.point_attributes;
  for (std::size_t i = 0; i < mesh.points.size(); ++i) {
    double sum = 0.5;
    for (int k = 0; k < D; ++k) sum += (k + 1) * mesh.points[i][k];
    EXPECT_NEAR(a[3 * i], sum, 1e-11 * largest);
    EXPECT_EQ(a[3 * i + 1], 0.1);
    if (i < mesh.input_points) {
      EXPECT_EQ(a[3 * i + 2], plc.point_attributes[3 * i + 2]);
    }
  }
  return result;
}

TEST(PointAttributes, AreInterpolatedIn2D) {
  expect_attributes<2>(square_with_hole(), 0.05, "square");
  expect_attributes<2>(turned(square_with_hole()), 0.05, "turned square");
  expect_attributes<2>(random_graph(40, 30, 0, 3), 0.01, "random");
}

TEST(PointAttributes, AreInterpolatedIn3D) {
  expect_attributes<3>(cube_with_two_points(), 0.2, "cube");
  expect_attributes<3>(two_region_cube(), 0.2, "two regions");
  expect_attributes<3>(turned(plate_with_hole()), 0.4, "turned plate");
  expect_attributes<3>(l_block(), 0.4, "block");
}

/// In 2D by the triangle of the input's constrained Delaunay triangulation: found here by looking at all.
TEST(PointAttributes, ComeFromTheTriangulationOfTheInput) {
  Plc<2> plc = square_with_hole();
  RefineOptions<2> options;
  options.refine = false;
  const OutputMesh<2> coarse = refine<2>(plc, options).mesh;
  const auto result = expect_attributes<2>(plc, 0.05, "square");
  give_attributes(plc);
  for (std::size_t i = result.mesh.input_points; i < result.mesh.points.size(); ++i) {
    const Point2& x = result.mesh.points[i];
    std::size_t holders = 0;
    for (const auto& c : coarse.cells) {
      const Point2 &p = coarse.points[c[0]], &q = coarse.points[c[1]], &r = coarse.points[c[2]];
      const auto area = [](const Point2& a, const Point2& b, const Point2& d) {
        return (b[0] - a[0]) * (d[1] - a[1]) - (b[1] - a[1]) * (d[0] - a[0]);
      };
      const double u = area(x, q, r), v = area(p, x, r), w = area(p, q, x), all = u + v + w;
      if (std::min({u, v, w}) < -1e-13) continue;
      ++holders;
      const auto value = [&](std::size_t corner) { return plc.point_attributes[3 * c[corner] + 2]; };
      EXPECT_NEAR(result.mesh.point_attributes[3 * i + 2], (u * value(0) + v * value(1) + w * value(2)) / all, 1e-11);
    }
    EXPECT_GT(holders, 0u);
  }
}

/// Among them points of the boundary's recovery, which a thin slanted facet needs.
TEST(PointAttributes, OfFacetsComeFromTheirTriangles) {
  Plc<3> plc = turned(pipe(12, 1, 1.1), 0);
  const auto result = expect_attributes<3>(plc, 0.5, "pipe");
  EXPECT_GT(result.statistics.segment_points + result.statistics.facet_points + result.statistics.insertions_committed, 0u);
}

TEST(PointAttributes, OfDuplicatesAndCrossings) {
  Plc<2> plc;
  add_square(plc, 0, 4);
  plc.points.insert(plc.points.end(), {{{1, 1}}, {{3, 3}}, {{1, 3}}, {{3, 1}}, {{1, 1}}});
  add_segment(plc, 4, 5);
  add_segment(plc, 6, 7);
  plc.point_attributes.resize(plc.points.size());
  std::iota(plc.point_attributes.begin(), plc.point_attributes.end(), 10.0);
  std::vector<Diagnostic> repairs;
  const Plc<2> split = resolve_crossings(plc, repairs);
  ASSERT_EQ(split.points.size(), 10u);
  ASSERT_EQ(split.point_attributes.size(), 10u);
  EXPECT_TRUE(split.point_attributes[9] == 14.5 || split.point_attributes[9] == 16.5) << split.point_attributes[9];
  const auto result = refine<2>(split, {});
  ASSERT_EQ(result.mesh.input_points, 9u);  // the duplicate is gone; the first counts
  EXPECT_EQ(result.mesh.point_attributes[4], 14);
  EXPECT_EQ(result.mesh.point_attributes[8], split.point_attributes[9]);
}

TEST(PointAttributes, MustBeEquallyMany) {
  Plc<2> plc = square_with_hole();
  plc.point_attributes.assign(plc.points.size() + 1, 0);
  EXPECT_THROW(refine<2>(plc, {}), UsageError);
  EXPECT_TRUE(refine<2>(square_with_hole(), {}).mesh.point_attributes.empty());
  plc.point_attributes.clear();
  plc.point_markers = {1, 2};
  EXPECT_THROW(refine<2>(plc, {}), UsageError);
}

/// Points that lie on subsegments of some marker, with all these markers.
template <class Constraints>
std::map<std::uint32_t, std::set<int>> markers_at_points(const Constraints& constraints) {
  std::map<std::uint32_t, std::set<int>> markers;
  for (const auto& c : constraints)
    for (const std::uint32_t v : c.vertices) markers[v].insert(c.marker);
  return markers;
}

TEST(PointMarkers, AreThoseOfSegmentsIn2D) {
  Plc<2> plc = square_with_hole();
  plc.point_markers.assign(plc.points.size(), 0);
  plc.point_markers[2] = 33;
  RefineOptions<2> options;
  options.size = 0.05;
  const auto mesh = expect_reproducible<2>(plc, options, "square").mesh;
  const auto at = markers_at_points(mesh.subsegments);
  std::size_t on_segments = 0;
  for (std::uint32_t v = 0; v < mesh.points.size(); ++v) {
    const auto found = at.find(v);
    if (v == 2) {
      EXPECT_EQ(mesh.point_markers[v], 33);
    } else if (found == at.end()) {
      EXPECT_EQ(mesh.point_markers[v], 0);
    } else {
      EXPECT_TRUE(found->second.count(mesh.point_markers[v])) << v << " has " << mesh.point_markers[v];
      on_segments += v >= mesh.input_points ? 1 : 0;
    }
  }
  EXPECT_GT(on_segments, 20u);
}

TEST(PointMarkers, AreThoseOfFacetsIn3D) {
  Plc<3> plc = cube_with_marked_facet();
  RefineOptions<3> options;
  options.size = 0.2;
  const auto mesh = expect_reproducible<3>(plc, options, "cube").mesh;
  const auto at = markers_at_points(mesh.subfacets);
  std::size_t marked = 0;
  for (std::uint32_t v = 0; v < mesh.points.size(); ++v) {
    const auto found = at.find(v);
    if (v < mesh.input_points || found == at.end()) {
      EXPECT_EQ(mesh.point_markers[v], 0);
    } else {
      EXPECT_TRUE(found->second.count(mesh.point_markers[v])) << v << " has " << mesh.point_markers[v];
      marked += mesh.point_markers[v] != 0 ? 1 : 0;
    }
  }
  EXPECT_GT(marked, 20u);
}

/// Boxes of circumcentres by leaf do not meet, and there are as many leaves as the tree has at most.
template <int D>
void expect_leaves(const Plc<D>& plc, double size) {
  RefineOptions<D> options;
  options.size = size;
  options.schedule.floor = 20;
  const auto without = refine<D>(plc, options);
  EXPECT_TRUE(without.mesh.leaves.empty());
  options.leaves = true;
  const auto result = expect_reproducible<D>(plc, options, "leaves");
  EXPECT_TRUE(same_bytes(without.mesh.cells, result.mesh.cells));
  ASSERT_EQ(result.mesh.leaves.size(), result.mesh.cells.size());
  struct Box {
    Point<D> low, high;
  };
  std::map<std::uint32_t, Box> boxes;
  Box all{result.mesh.points[0], result.mesh.points[0]};
  const auto extend = [](Box& b, const Point<D>& p) {
    for (int k = 0; k < D; ++k) {
      b.low[k] = std::min(b.low[k], p[k]);
      b.high[k] = std::max(b.high[k], p[k]);
    }
  };
  for (const Point<D>& p : result.mesh.points) extend(all, p);
  for (std::size_t c = 0; c < result.mesh.cells.size(); ++c) {
    Simplex<D> s;
    for (int i = 0; i <= D; ++i) s[i] = result.mesh.points[result.mesh.cells[c][i]];
    const Point<D> x = circumsphere<D>(s).center;
    bool within = true;
    for (int k = 0; k < D; ++k) within = within && x[k] >= all.low[k] && x[k] <= all.high[k];
    if (within) extend(boxes.try_emplace(result.mesh.leaves[c], Box{x, x}).first->second, x);
  }
  EXPECT_GT(boxes.size(), 8u);
  EXPECT_LT(boxes.rbegin()->first, result.scheduler.leaves);
  for (auto a = boxes.begin(); a != boxes.end(); ++a)
    for (auto b = std::next(a); b != boxes.end(); ++b) {
      bool apart = false;
      for (int k = 0; k < D; ++k) apart = apart || a->second.high[k] < b->second.low[k] || b->second.high[k] < a->second.low[k];
      EXPECT_TRUE(apart) << a->first << " and " << b->first;
    }
}

TEST(Leaves, OfCellsIn2D) { expect_leaves<2>(square_with_hole(), 0.005); }
TEST(Leaves, OfCellsIn3D) { expect_leaves<3>(cube_with_two_points(), 0.08); }

}  // namespace pgdr::test_compact_point_data
