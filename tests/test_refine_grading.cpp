// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Theorems 2.2 and 2.4 of the dissertation: without a size bound, on inputs whose angles are 90 degrees or more, a
// delta-graded refinement leaves no vertex p nearer to another than lfs(p) / (C_S + 1). The local feature size lfs(p), the
// radius of the smallest ball about p that meets two features that are not incident, comes from its definition; the inputs
// are unions of boxes along the axes, so that distances are exact.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "pgdr/selectors.hpp"
#include "refined_models.hpp"
#include "scattered_models.hpp"

namespace pgdr::test_refine_grading {

/// A point, segment or rectangle along the axes.
template <int D>
struct Feature {
  Point<D> low, high;
};

template <int D>
double distance(const Feature<D>& f, const Point<D>& p) {
  double s = 0;
  for (int i = 0; i < D; ++i) {
    const double d = std::max({f.low[i] - p[i], p[i] - f.high[i], 0.0});
    s += d * d;
  }
  return std::sqrt(s);
}

template <int D>
bool incident(const Feature<D>& a, const Feature<D>& b) {
  for (int i = 0; i < D; ++i)
    if (a.high[i] < b.low[i] || b.high[i] < a.low[i]) return false;
  return true;
}

template <int D>
std::vector<Feature<D>> features(const Plc<D>& plc) {
  std::vector<Feature<D>> all;
  auto add = [&](const std::vector<std::uint32_t>& points) {
    Feature<D> f{plc.points[points[0]], plc.points[points[0]]};
    for (const auto v : points)
      for (int i = 0; i < D; ++i) {
        f.low[i] = std::min(f.low[i], plc.points[v][i]);
        f.high[i] = std::max(f.high[i], plc.points[v][i]);
      }
    all.push_back(f);
  };
  for (std::uint32_t i = 0; i < plc.points.size(); ++i) add({i});
  for (const auto& s : plc.segments) add({s.points[0], s.points[1]});
  for (const auto& f : plc.facets)
    for (const auto& polygon : f.polygons) {
      add(polygon);
      for (std::size_t i = 0; i < polygon.size(); ++i) add({polygon[i], polygon[(i + 1) % polygon.size()]});
    }
  return all;
}

template <int D>
double local_feature_size(const std::vector<Feature<D>>& all, const Point<D>& p) {
  std::vector<std::pair<double, const Feature<D>*>> near;
  for (const auto& f : all) near.push_back({distance(f, p), &f});
  std::sort(near.begin(), near.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  for (std::size_t i = 1; i < near.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (!incident(*near[i].second, *near[j].second)) return near[i].first;
  return std::numeric_limits<double>::infinity();
}

/// C_S of Lemma 2.5 (with angles of 90 degrees: cos = 0) and of section 2.3.3.
template <int D>
double grading_constant(double bound, double delta) {
  if constexpr (D == 2)
    return std::max((2 - delta) * bound * (1 + std::sqrt(2.0)) / (delta * bound - std::sqrt(2.0)), (2 - delta) / delta);
  else
    return (2 - delta) / delta * ((3 + std::sqrt(2.0)) * delta * bound) / (delta * bound - 2);
}

/// Far out in the disk, towards the element's first, second, ... corner by turns, or away from it.
template <int D>
Point<D> far_out(const PoorElement<D>& e) {
  if (!(e.disk.radius > 0)) return e.circumcenter;
  const int turn = static_cast<int>(std::fmod(1e7 * std::abs(e.circumcenter[0]), 2 * (D + 1)));
  const double s = (turn % 2 ? -0.999 : 0.999) * e.disk.radius / e.circumradius;
  Point<D> p;
  for (int i = 0; i < D; ++i) p[i] = e.circumcenter[i] + s * (e.corners[turn / 2][i] - e.circumcenter[i]);
  return p;
}

template <int D>
void expect_graded(const Plc<D>& plc, const std::string& what) {
  const auto all = features(plc);
  struct Case {
    const char* name;
    PointSelector<D> selector;
  };
  const Case cases[] = {{"circumcenter", {}},
                        {"off_center", off_center<D>()},
                        {"optimized", optimized<D>(30)},
                        {"sliver_avoiding", sliver_avoiding<D>(6)},
                        {"far_out", far_out<D>}};
  for (const double factor : {1.15, 1.5, 3.0})
    for (const double reach : {0.3, 0.9})
      for (const Case& c : cases) {
        RefineOptions<D> options;
        options.radius_edge_bound = factor * smallest_proved_bound<D>();
        options.disk.type = DiskType::type2;
        options.disk.delta = 1 - reach * (1 - 1 / factor);  // delta times the bound is above the smallest proved one
        options.selector = c.selector;
        options.min_dihedral = 0;  // the bounds are those of the refinement
        const auto [result, report] = test::refine_and_check<D>(plc, options);
        EXPECT_EQ(report.exit_code(), 0) << what << ", " << c.name << "\n" << test::findings(report);
        EXPECT_EQ(result.statistics.selector_outside, 0u);
        const auto& points = result.mesh.points;
        std::vector<double> nearest(points.size(), std::numeric_limits<double>::infinity());
        for (const auto& cell : result.mesh.cells)  // in a Delaunay mesh the nearest neighbour is joined by an edge
          for (const auto v : cell)
            for (const auto w : cell)
              if (v != w) nearest[v] = std::min(nearest[v], std::sqrt(squared_distance(points[v], points[w])));
        const double constant = grading_constant<D>(options.radius_edge_bound, options.disk.delta);
        for (std::size_t i = 0; i < points.size(); ++i)
          ASSERT_GE(nearest[i], local_feature_size(all, points[i]) / (constant + 1))
              << what << ", " << c.name << ", bound " << options.radius_edge_bound << ", delta " << options.disk.delta;
        EXPECT_GT(points.size(), plc.points.size());
      }
}

/// Axis-aligned rectangle from its corners.
void add_rectangle(Plc<2>& plc, const Point2& low, const Point2& high) {
  const auto first = static_cast<std::uint32_t>(plc.points.size());
  for (const Point2& p : {low, Point2{{high[0], low[1]}}, high, Point2{{low[0], high[1]}}}) plc.points.push_back(p);
  for (std::uint32_t i = 0; i < 4; ++i) plc.segments.push_back({{first + i, first + (i + 1) % 4}, 1});
}

TEST(Grading, Plane) {
  expect_graded<2>(test::box_with_pairs<2>(8, 1e-3, 1), "pairs");
  expect_graded<2>(test::box_with_pairs<2>(1, 1e-7, 2), "a close pair");
  Plc<2> frame;
  add_rectangle(frame, {{0, 0}}, {{3, 2}});
  add_rectangle(frame, {{1, 0.01}}, {{1.25, 1}});
  add_rectangle(frame, {{2, 1}}, {{2.9, 1.999}});
  frame.holes = {{{1.1, 0.5}}};
  frame.points.push_back({{0.5, 1.5}});
  frame.points.push_back({{0.5, 1.502}});
  expect_graded<2>(frame, "frame");
}

TEST(Grading, Space) {
  expect_graded<3>(test::cube_with_two_points(), "cube with two points");
  expect_graded<3>(test::box_with_pairs<3>(4, 1e-2, 1), "pairs");
  expect_graded<3>(test::block_with_cavity(), "block with cavity");
  Plc<3> near_wall;
  test::add_box(near_wall, {{0, 0, 0}}, {{3, 2, 2}});
  test::add_box(near_wall, {{1, 0.5, 0.02}}, {{2, 1.25, 1}}, 11);
  near_wall.holes = {{{1.5, 1, 0.5}}};
  expect_graded<3>(near_wall, "cavity near the wall");
}

// The oracle itself: features of a square, by hand.
TEST(Grading, LocalFeatureSizes) {
  const auto all = features(test::square());
  EXPECT_EQ(local_feature_size<2>(all, {{0, 0}}), 1);        // the other two corners' sides
  EXPECT_EQ(local_feature_size<2>(all, {{0.5, 0.5}}), 0.5);  // opposite sides
  EXPECT_EQ(local_feature_size<2>(all, {{0.25, 0}}), 0.75);  // one corner and the side at the other
}

}  // namespace pgdr::test_refine_grading
