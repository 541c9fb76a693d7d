// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The summary of a mesh, which computes few angles, against all angles one by one.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "pgdr/circumsphere.hpp"
#include "pgdr/quality.hpp"

namespace pgdr::test_output_quality {

template <int D>
Simplex<D> simplex_of(const OutputMesh<D>& mesh, std::size_t c) {
  Simplex<D> s;
  for (int i = 0; i <= D; ++i) s[i] = mesh.points[mesh.cells[c][i]];
  return s;
}

template <int D>
void expect_as_one_by_one(const OutputMesh<D>& mesh, const char* what) {
  QualitySummary expected;
  for (std::size_t c = 0; c < mesh.cells.size(); ++c) {
    const Simplex<D> s = simplex_of(mesh, c);
    const double ratio = std::sqrt(circumsphere<D>(s).squared_radius / shortest_edge_squared<D>(s));
    expected.max_radius_edge = std::max(expected.max_radius_edge, ratio);
    for (const double a : angles_deg<D>(s)) {
      expected.min_angle_deg = std::min(expected.min_angle_deg, a);
      expected.max_angle_deg = std::max(expected.max_angle_deg, a);
      ++expected.histogram[std::clamp(static_cast<int>(a / 10), 0, 17)];
    }
  }
  const QualitySummary q = summarize_quality(mesh);
  EXPECT_EQ(q.histogram, expected.histogram) << what;
  EXPECT_EQ(q.min_angle_deg, expected.min_angle_deg) << what;
  EXPECT_EQ(q.max_angle_deg, expected.max_angle_deg) << what;
  EXPECT_EQ(q.max_radius_edge, expected.max_radius_edge) << what;
}

template <int D>
void add(OutputMesh<D>& mesh, const Simplex<D>& s) {
  std::array<std::uint32_t, D + 1> cell;
  for (int i = 0; i <= D; ++i) {
    cell[i] = static_cast<std::uint32_t>(mesh.points.size());
    mesh.points.push_back(s[i]);
  }
  mesh.cells.push_back(cell);
}

template <class T>
class Quality : public testing::Test {};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(Quality, Dimensions);

/// Of all shapes, flatter and flatter, and needles, at several scales.
TYPED_TEST(Quality, OfRandomSimplices) {
  constexpr int D = TypeParam::value;
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> uniform(0, 1);
  for (const double scale : {1.0, 1e-15, 1e20})
    for (const double flat : {1.0, 1e-3, 1e-6, 1e-9}) {
      OutputMesh<D> mesh;
      for (int n = 0; n < 3000; ++n) {
        Simplex<D> s;
        for (auto& p : s)
          for (int k = 0; k < D; ++k) p[k] = scale * uniform(random) * (k < 1 + n % D ? flat : 1);
        add(mesh, s);
      }
      expect_as_one_by_one(mesh, (std::to_string(scale) + " " + std::to_string(flat)).c_str());
    }
}

/// Angles at the limits of bins: right ones, and nearly so.
TYPED_TEST(Quality, OfAGrid) {
  constexpr int D = TypeParam::value;
  for (const double turn : {0.0, 1e-12, 1e-9, 0.3}) {
    OutputMesh<D> mesh;
    for (int n = 0; n < 500; ++n) {
      // A path of unit steps from a corner of a cube to the opposite one, turned a little.
      std::array<int, D> axes;
      for (int k = 0; k < D; ++k) axes[k] = (k + n) % D;
      Simplex<D> s;
      s[0] = {};
      s[0][0] = n;
      for (int k = 0; k < D; ++k) {
        s[k + 1] = s[k];
        s[k + 1][axes[k]] += 1;
      }
      for (auto& p : s) {
        const double x = p[0], y = p[1];
        p[0] = x * std::cos(turn) - y * std::sin(turn);
        p[1] = x * std::sin(turn) + y * std::cos(turn);
      }
      add(mesh, s);
    }
    expect_as_one_by_one(mesh, std::to_string(turn).c_str());
  }
}

/// Triangles with every angle that is a whole number of degrees.
TEST(QualityOfTriangles, AtEveryLimit) {
  OutputMesh<2> mesh;
  const double degree = std::acos(-1.0) / 180;
  for (int a = 1; a < 179; ++a)
    for (int b = 1; a + b < 180; ++b) {
      const double side = std::sin(b * degree) / std::sin((a + b) * degree);
      add<2>(mesh, {{{{0, 0}}, {{1, 0}}, {{side * std::cos(a * degree), side * std::sin(a * degree)}}}});
    }
  expect_as_one_by_one(mesh, "whole degrees");
}

TEST(QualityOfTriangles, OfNone) {
  const QualitySummary q = summarize_quality(OutputMesh<2>{});
  EXPECT_EQ(q.max_radius_edge, 0);
  EXPECT_EQ(q.min_angle_deg, 180);
}

}  // namespace pgdr::test_output_quality
