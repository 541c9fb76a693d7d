// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The summary of a mesh, which computes few angles, against all angles one by one; other measures against their definitions.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>

#include "allow_threads.hpp"
#include "pgdr/circumsphere.hpp"
#include "pgdr/quality.hpp"

#if PGDR_TEST_TBB
#include <tbb/task_arena.h>
#endif

namespace pgdr::test_output_quality {

template <int D>
Simplex<D> simplex_of(const OutputMesh<D>& mesh, std::size_t c) {
  Simplex<D> s;
  for (int i = 0; i <= D; ++i) s[i] = mesh.points[mesh.cells[c][i]];
  return s;
}

/// The determinant of the edges at corner 0, and measures of shape, by their definitions in long doubles.
template <int D>
struct Definitions {
  using Real = long double;
  Real determinant = 0, radius_ratio = 0, scaled_jacobian = 0;

  explicit Definitions(const Simplex<D>& s) {
    std::array<std::array<Real, 3>, D + 1> p{};
    Real longest = 0;
    for (int i = 0; i <= D; ++i)
      for (int k = 0; k < D; ++k) {
        p[i][k] = Real{s[i][k]} - Real{s[0][k]};
        longest = std::max(longest, std::abs(p[i][k]));
      }
    for (auto& corner : p)
      for (Real& x : corner) x /= longest;
    const auto minus = [](const auto& a, const auto& b) { return std::array<Real, 3>{a[0] - b[0], a[1] - b[1], a[2] - b[2]}; };
    const auto cross = [](const auto& a, const auto& b) {
      return std::array<Real, 3>{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
    };
    const auto dot = [](const auto& a, const auto& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; };
    const auto length = [&](const auto& a) { return std::sqrt(dot(a, a)); };
    Real measure, surface, radius;
    if constexpr (D == 2) {
      determinant = cross(p[1], p[2])[2];
      measure = determinant / 2;
      const Real a = length(p[1]), b = length(p[2]), c = length(minus(p[1], p[2]));
      surface = a + b + c;
      radius = a * b * c / (4 * measure);
    } else {
      determinant = dot(p[1], cross(p[2], p[3]));
      measure = determinant / 6;
      surface = 0;
      for (int i = 0; i < 4; ++i)
        surface += length(cross(minus(p[(i + 2) % 4], p[(i + 1) % 4]), minus(p[(i + 3) % 4], p[(i + 1) % 4]))) / 2;
      const auto u = cross(p[2], p[3]), v = cross(p[3], p[1]), w = cross(p[1], p[2]);
      std::array<Real, 3> center;
      for (int k = 0; k < 3; ++k) center[k] = dot(p[1], p[1]) * u[k] + dot(p[2], p[2]) * v[k] + dot(p[3], p[3]) * w[k];
      radius = length(center) / (2 * determinant);
    }
    radius_ratio = D * (D * measure / surface) / radius;
    Real largest = 0;
    for (int i = 0; i <= D; ++i) {
      Real product = 1;
      for (int j = 0; j <= D; ++j)
        if (i != j) product *= length(minus(p[i], p[j]));
      largest = std::max(largest, product);
    }
    scaled_jacobian = (D == 2 ? 2 / std::sqrt(Real{3}) : std::sqrt(Real{2})) * determinant / largest;
  }
};

/// The measures of some cells, one by one. The radius ratio and the scaled Jacobian are of cells in order.
template <int D>
struct OneByOne {
  QualityMeasures q;
  std::vector<double> smallest, radius_ratio, scaled_jacobian;

  void add(const Simplex<D>& s) {
    const double ratio = std::sqrt(circumsphere<D>(s).squared_radius / shortest_edge_squared<D>(s));
    q.max_radius_edge = std::max(q.max_radius_edge, ratio);
    double least = 180;
    for (const double a : angles_deg<D>(s)) {
      least = std::min(least, a);
      q.min_angle_deg = std::min(q.min_angle_deg, a);
      q.max_angle_deg = std::max(q.max_angle_deg, a);
      ++q.histogram[std::clamp(static_cast<int>(a / 10), 0, 17)];
    }
    ++q.cells_by_smallest_angle[std::clamp(static_cast<int>(least / 5), 0, 14)];
    smallest.push_back(least);
    const Definitions<D> d(s);
    radius_ratio.push_back(static_cast<double>(d.radius_ratio));
    scaled_jacobian.push_back(static_cast<double>(d.scaled_jacobian));
  }
  /// The value that at least one in so many are not above, and no less one is.
  static double quantile(std::vector<double> values, std::size_t one_in) {
    std::sort(values.begin(), values.end());
    for (std::size_t i = 0;; ++i)
      if ((i + 1) * one_in >= values.size()) return values[i];
  }
  static void expect(const MeasureSummary& m, const std::vector<double>& values, const std::string& what) {
    double sum = 0;
    for (const double v : values) sum += v;
    EXPECT_NEAR(m.least, *std::min_element(values.begin(), values.end()), 1e-9) << what;
    EXPECT_NEAR(m.one_percent, quantile(values, 100), 1e-6) << what;
    EXPECT_NEAR(m.mean, sum / static_cast<double>(values.size()), 1e-9) << what;
  }
  void expect(const QualityMeasures& found, const std::string& what) const {
    EXPECT_EQ(found.histogram, q.histogram) << what;
    EXPECT_EQ(found.cells_by_smallest_angle, q.cells_by_smallest_angle) << what;
    EXPECT_EQ(found.min_angle_deg, q.min_angle_deg) << what;
    EXPECT_EQ(found.max_angle_deg, q.max_angle_deg) << what;
    EXPECT_EQ(found.max_radius_edge, q.max_radius_edge) << what;
    for (int i = 0; i < 3; ++i)
      EXPECT_NEAR(found.smallest_angle_quantiles_deg[i], quantile(smallest, i == 0 ? 1000 : i == 1 ? 100 : 20), 0.01) << what;
    expect(found.radius_ratio, radius_ratio, what + ", radius ratio");
    expect(found.scaled_jacobian, scaled_jacobian, what + ", scaled Jacobian");
  }
};

template <int D>
void expect_as_one_by_one(const OutputMesh<D>& mesh, const std::string& what) {
  OneByOne<D> all;
  std::map<double, OneByOne<D>> regions;
  for (std::size_t c = 0; c < mesh.cells.size(); ++c) {
    all.add(simplex_of(mesh, c));
    regions[mesh.regions.empty() ? 0 : mesh.regions[c]].add(simplex_of(mesh, c));
  }
  const QualitySummary q = summarize_quality(mesh);
  all.expect(q, what);
  ASSERT_EQ(q.regions.size(), regions.size());
  std::size_t r = 0;
  for (const auto& [label, expected] : regions) {
    EXPECT_EQ(q.regions[r].label, label);
    expected.expect(q.regions[r++], what + ", region " + std::to_string(label));
  }
}

/// Positively oriented.
template <int D>
void add(OutputMesh<D>& mesh, Simplex<D> s) {
  if (Definitions<D>(s).determinant < 0) std::swap(s[0], s[1]);
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
  for (const double scale : {1.0, 1e-15, 1e20, 1e-90, 1e70})
    for (const double flat : {1.0, 1e-3, 1e-6, 1e-9}) {
      OutputMesh<D> mesh;
      for (int n = 0; n < 3000; ++n) {
        Simplex<D> s;
        for (auto& p : s)
          for (int k = 0; k < D; ++k) p[k] = scale * uniform(random) * (k < 1 + n % D ? flat : 1);
        add(mesh, s);
      }
      expect_as_one_by_one(mesh, std::to_string(scale) + " " + std::to_string(flat));
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
    expect_as_one_by_one(mesh, std::to_string(turn));
  }
}

/// Labels that alternate, that are in one part of the mesh alone, and that one cell has.
TYPED_TEST(Quality, OfRegions) {
  constexpr int D = TypeParam::value;
  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> uniform(0, 1);
  OutputMesh<D> mesh;
  for (int n = 0; n < 40000; ++n) {
    Simplex<D> s;
    for (auto& p : s)
      for (int k = 0; k < D; ++k) p[k] = uniform(random);
    add(mesh, s);
    mesh.regions.push_back(n == 20000 ? -7.5 : n < 10000 ? n % 2 : n < 30000 ? 5 : n % 2);
  }
  expect_as_one_by_one(mesh, "regions");
}

/// Every fourth cell is flat, so that a sample of every fourth shows nothing else.
TYPED_TEST(Quality, OfAPattern) {
  constexpr int D = TypeParam::value;
  std::mt19937_64 random(17);
  std::uniform_real_distribution<double> uniform(0, 1);
  OutputMesh<D> mesh;
  for (int n = 0; n < 4000; ++n) {
    Simplex<D> s;
    for (auto& p : s)
      for (int k = 0; k < D; ++k) p[k] = uniform(random) * (n % 4 == 0 && k == 0 ? 1e-3 : 1);
    add(mesh, s);
  }
  expect_as_one_by_one(mesh, "pattern");
}

/// For any number of threads.
TYPED_TEST(Quality, IsTheSame) {
#if PGDR_TEST_TBB
  constexpr int D = TypeParam::value;
  std::mt19937_64 random(13);
  std::uniform_real_distribution<double> uniform(0, 1);
  OutputMesh<D> mesh;
  for (int n = 0; n < 100000; ++n) {
    Simplex<D> s;
    for (auto& p : s)
      for (int k = 0; k < D; ++k) p[k] = uniform(random);
    add(mesh, s);
    mesh.regions.push_back(n / 30000);
  }
  const test::AllowThreads allow(8);
  std::vector<QualitySummary> found;
  for (const int threads : {1, 2, 8}) tbb::task_arena(threads).execute([&] { found.push_back(summarize_quality(mesh)); });
  for (std::size_t i = 1; i < found.size(); ++i) {
    EXPECT_EQ(found[i].radius_ratio.mean, found[0].radius_ratio.mean);
    EXPECT_EQ(found[i].scaled_jacobian.mean, found[0].scaled_jacobian.mean);
    EXPECT_EQ(found[i].smallest_angle_quantiles_deg, found[0].smallest_angle_quantiles_deg);
    EXPECT_EQ(found[i].histogram, found[0].histogram);
    ASSERT_EQ(found[i].regions.size(), 4u);
    for (std::size_t r = 0; r < 4; ++r) EXPECT_EQ(found[i].regions[r].radius_ratio.mean, found[0].regions[r].radius_ratio.mean);
  }
#else
  GTEST_SKIP() << "oneTBB under the thread sanitizer";
#endif
}

/// The best there is, and a cell of no volume.
TEST(QualityOfTetrahedra, OfRegularAndFlat) {
  OutputMesh<3> mesh;
  mesh.points = {{{1, 1, 1}}, {{1, -1, -1}}, {{-1, 1, -1}}, {{-1, -1, 1}}, {{0, 0, 0}}, {{1, 0, 0}}, {{1, 1, 0}}, {{0, 1, 0}}};
  mesh.cells = {{0, 1, 3, 2}};
  const QualitySummary regular = summarize_quality(mesh);
  EXPECT_NEAR(regular.radius_ratio.least, 1, 1e-12);
  EXPECT_NEAR(regular.scaled_jacobian.least, 1, 1e-12);
  EXPECT_NEAR(std::abs(regular.smallest_angle_quantiles_deg[0]), std::acos(1.0 / 3) * 180 / std::acos(-1.0), 1e-4);
  EXPECT_EQ(regular.cells_by_smallest_angle[14], 1u);
  mesh.cells.push_back({4, 5, 6, 7});
  const QualitySummary both = summarize_quality(mesh);
  EXPECT_EQ(both.radius_ratio.least, 0);
  EXPECT_EQ(both.scaled_jacobian.least, 0);
  EXPECT_EQ(both.smallest_angle_quantiles_deg[2], 0);
  EXPECT_EQ(both.cells_by_smallest_angle[0], 1u);
  EXPECT_NEAR(both.radius_ratio.mean, 0.5, 1e-12);
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
  EXPECT_TRUE(q.regions.empty());
}

}  // namespace pgdr::test_output_quality
