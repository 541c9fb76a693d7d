// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// What lives on a mesh, on another one: linear functions stay what they are, amounts too, label by label; any number of threads
// makes the same bytes.
#include <gtest/gtest.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <map>
#include <random>

#include "dimensions.hpp"
#include "pgdr/predicates.hpp"
#include "pgdr/refine.hpp"
#include "pgdr/transfer.hpp"

namespace pgdr::test_transfer_fields {

/// The cube or square [0, 1]^D in two halves with labels, turned.
template <int D>
Plc<D> halves() {
  Plc<D> plc;
  const int corners = D == 2 ? 6 : 12;
  for (int i = 0; i < corners; ++i) {
    Point<D> p{};
    p[0] = i % 3 * 0.5;
    p[1] = i / 3 % 2;
    if constexpr (D == 3) p[2] = i / 6;
    plc.points.push_back(p);
  }
  if constexpr (D == 2) {
    plc.segments = {{{0, 1}, 1}, {{1, 2}, 1}, {{2, 5}, 2}, {{5, 4}, 1}, {{4, 3}, 1}, {{3, 0}, 3}, {{1, 4}, 4}};
    plc.regions = {{{{0.25, 0.5}}, 7, 0}, {{{0.75, 0.5}}, 9, 0}};
  } else {
    for (const auto& [corner, marker] : std::vector<std::pair<std::vector<std::uint32_t>, int>>{{{0, 1, 4, 3}, 1},
                                                                                                {{1, 2, 5, 4}, 1},
                                                                                                {{6, 7, 10, 9}, 2},
                                                                                                {{7, 8, 11, 10}, 2},
                                                                                                {{0, 1, 7, 6}, 3},
                                                                                                {{1, 2, 8, 7}, 3},
                                                                                                {{3, 4, 10, 9}, 4},
                                                                                                {{4, 5, 11, 10}, 4},
                                                                                                {{0, 3, 9, 6}, 5},
                                                                                                {{2, 5, 11, 8}, 6},
                                                                                                {{1, 4, 10, 7}, 7}}) {
      plc.facets.emplace_back().polygons = {corner};
      plc.facets.back().marker = marker;
    }
    plc.regions = {{{{0.25, 0.5, 0.5}}, 7, 0}, {{{0.75, 0.5, 0.5}}, 9, 0}};
  }
  const double c = std::cos(0.6), s = std::sin(0.6);
  const auto turn = [&](Point<D>& p) {
    const double x = p[0], y = p[1];
    p[0] = c * x - s * y + 10;
    p[1] = s * x + c * y - 3;
  };
  for (Point<D>& p : plc.points) turn(p);
  for (auto& r : plc.regions) turn(r.point);
  return plc;
}

template <int D>
OutputMesh<D> meshed(double size) {
  RefineOptions<D> options;
  options.size = size;
  return refine(halves<D>(), options).mesh;
}

template <int D>
double measure(const OutputMesh<D>& mesh, std::size_t c) {
  std::array<Point<D>, D> e;
  for (std::size_t i = 0; i < D; ++i)
    for (int k = 0; k < D; ++k) e[i][k] = mesh.points[mesh.cells[c][i + 1]][k] - mesh.points[mesh.cells[c][0]][k];
  if constexpr (D == 2)
    return (e[0][0] * e[1][1] - e[0][1] * e[1][0]) / 2;
  else
    return (e[0][0] * (e[1][1] * e[2][2] - e[1][2] * e[2][1]) - e[0][1] * (e[1][0] * e[2][2] - e[1][2] * e[2][0]) +
            e[0][2] * (e[1][0] * e[2][1] - e[1][1] * e[2][0])) /
           6;
}

template <int D>
std::map<double, double> integrals(const OutputMesh<D>& mesh, const std::vector<double>& values, std::size_t width,
                                   std::size_t k) {
  std::map<double, double> sums;
  for (std::size_t c = 0; c < mesh.cells.size(); ++c) sums[mesh.regions[c]] += measure(mesh, c) * values[c * width + k];
  return sums;
}

template <int D>
double linear(const Point<D>& p) {
  double sum = 3;
  for (int k = 0; k < D; ++k) sum += (k + 1.5) * p[k];
  return sum;
}

template <class Number>
class Transfer : public testing::Test {};
TYPED_TEST_SUITE(Transfer, test::Dimensions);

TYPED_TEST(Transfer, LinearFunctionsOfPoints) {
  constexpr int D = TypeParam::value;
  const OutputMesh<D> from = meshed<D>(D == 2 ? 0.004 : 0.15), to = meshed<D>(D == 2 ? 0.001 : 0.1);
  std::vector<double> values;
  for (const Point<D>& p : from.points) values.insert(values.end(), {linear(p), 1.0, -linear(p)});
  const std::vector<double> made = PointTransfer<D>(from, to.points)(values, 3);
  ASSERT_EQ(made.size(), 3 * to.points.size());
  for (std::size_t i = 0; i < to.points.size(); ++i) {
    EXPECT_NEAR(made[3 * i], linear(to.points[i]), 1e-12 * std::abs(linear(to.points[i])));
    EXPECT_EQ(made[3 * i + 1], 1.0);
    EXPECT_EQ(made[3 * i + 2], -made[3 * i]);
  }
  EXPECT_THROW(PointTransfer<D>(from, to.points)(values, 2), UsageError);
  std::vector<double> numbers;
  for (std::size_t i = 0; i < from.points.size(); ++i) numbers.push_back(static_cast<double>(i));
  const std::vector<double> nearest = PointTransfer<D>(from, from.points).of_nearest_corners(numbers);
  EXPECT_EQ(nearest, numbers);
}

/// A cell with corners in a plane (on a line) that rounding has made no plane: the measures in it are all rounding, and a point
/// in it had the values of others.
TYPED_TEST(Transfer, LinearFunctionsInFlatCells) {
  constexpr int D = TypeParam::value;
  std::mt19937 random(11);
  std::uniform_real_distribution<double> number(-1, 1);
  const auto on_plane = [&](const std::array<Point<D>, D>& corners) {
    double sum = 0;
    std::array<double, D> weights;
    for (double& w : weights) sum += w = number(random) + 1;
    Point<D> p{};
    for (int i = 0; i < D; ++i)
      for (int k = 0; k < D; ++k) p[k] += weights[i] / sum * corners[i][k];
    return p;
  };
  int tried = 0;
  while (tried < 200) {
    OutputMesh<D> mesh;
    std::array<Point<D>, D> corners;
    for (Point<D>& p : corners)
      for (int k = 0; k < D; ++k) p[k] = 7 * number(random);
    mesh.points.assign(corners.begin(), corners.end());
    mesh.points.push_back(on_plane(corners));
    mesh.cells.emplace_back();
    for (std::uint32_t i = 0; i <= D; ++i) mesh.cells[0][i] = i;
    Simplex<D> s;
    std::copy(mesh.points.begin(), mesh.points.end(), s.begin());
    if (orient<D>(s) == Sign::zero) continue;
    ++tried;
    std::vector<Point<D>> to;
    for (int i = 0; i < 20; ++i) to.push_back(on_plane(corners));
    std::vector<double> values;
    for (const Point<D>& p : mesh.points) values.push_back(linear(p));
    const std::vector<double> made = PointTransfer<D>(mesh, to)(values);
    for (std::size_t i = 0; i < to.size(); ++i) EXPECT_NEAR(made[i], linear(to[i]), 1e-12 * 50);
  }
}

TYPED_TEST(Transfer, AmountsOfCells) {
  constexpr int D = TypeParam::value;
  const double sizes[] = {D == 2 ? 0.004 : 0.2, D == 2 ? 0.0008 : 0.1};
  for (const bool finer : {false, true}) {
    const OutputMesh<D> from = meshed<D>(sizes[finer ? 0 : 1]), to = meshed<D>(sizes[finer ? 1 : 0]);
    std::mt19937 random(7);
    std::uniform_real_distribution<double> number(-1, 2);
    std::vector<double> values;
    for (std::size_t c = 0; c < from.cells.size(); ++c)
      values.insert(values.end(), {number(random), 5.0, from.regions[c] == 7 ? 1e6 : 1e-6});
    const CellTransfer<D> transfer(from, to);
    const std::vector<double> made = transfer.means(values, 3);
    for (std::size_t k = 0; k < 3; ++k) {
      const auto before = integrals(from, values, 3, k), after = integrals(to, made, 3, k);
      ASSERT_EQ(before.size(), 2u);
      for (const auto& [label, sum] : before) EXPECT_NEAR(after.at(label), sum, 1e-12 * std::max(std::abs(sum), 0.1 * (k == 0)));
    }
    for (std::size_t c = 0; c < to.cells.size(); ++c) {
      EXPECT_NEAR(made[3 * c + 1], 5, 1e-9);
      EXPECT_GT(made[3 * c + 2], 0) << "nothing comes from beyond the wall, nor is anything lost";
      if (to.regions[c] == 9) {
        EXPECT_LT(made[3 * c + 2], 1.1e-6);
      }
    }
  }
}

TYPED_TEST(Transfer, LabelsByTheLargestShare) {
  constexpr int D = TypeParam::value;
  const OutputMesh<D> from = meshed<D>(D == 2 ? 0.002 : 0.15), to = meshed<D>(D == 2 ? 0.001 : 0.1);
  std::vector<double> labels;
  for (const double label : from.regions) labels.push_back(label == 7 ? -4 : 12);
  const std::vector<double> made = CellTransfer<D>(from, to).largest_share(labels);
  for (std::size_t c = 0; c < to.cells.size(); ++c) EXPECT_EQ(made[c], to.regions[c] == 7 ? -4 : 12);
  OutputMesh<D> without_labels = to;
  without_labels.regions.clear();  // labels do not count: cells at the wall have one of both
  const std::vector<double> by_place = CellTransfer<D>(from, without_labels).largest_share(labels);
  EXPECT_EQ(made, by_place);
}

/// The same cells are all there is of each: their values come back.
TYPED_TEST(Transfer, OntoItself) {
  constexpr int D = TypeParam::value;
  const OutputMesh<D> mesh = meshed<D>(D == 2 ? 0.002 : 0.15);
  std::vector<double> values;
  for (std::size_t c = 0; c < mesh.cells.size(); ++c) values.push_back(std::sin(static_cast<double>(c)));
  const std::vector<double> made = CellTransfer<D>(mesh, mesh).means(values);
  for (std::size_t c = 0; c < mesh.cells.size(); ++c) EXPECT_NEAR(made[c], values[c], 1e-11);
}

TYPED_TEST(Transfer, AnyNumberOfThreads) {
  constexpr int D = TypeParam::value;
  const OutputMesh<D> from = meshed<D>(D == 2 ? 0.002 : 0.15), to = meshed<D>(D == 2 ? 0.001 : 0.1);
  std::vector<double> values;
  for (std::size_t c = 0; c < from.cells.size(); ++c) values.push_back(std::cos(static_cast<double>(c)));
  std::vector<std::uint64_t> first;
  for (const int threads : {1, 2, 8}) {
    tbb::task_arena arena(threads);
    std::vector<std::uint64_t> bits;
    arena.execute([&] {
      for (const double x : CellTransfer<D>(from, to).means(values)) bits.push_back(std::bit_cast<std::uint64_t>(x));
    });
    if (first.empty()) first = bits;
    EXPECT_EQ(bits, first) << threads;
  }
}

/// Cells that have nothing in common but places: each with points of its own.
template <int D>
OutputMesh<D> apart(const OutputMesh<D>& mesh) {
  OutputMesh<D> out;
  out.regions = mesh.regions;
  for (const auto& cell : mesh.cells) {
    auto& own = out.cells.emplace_back();
    for (std::size_t i = 0; i <= D; ++i) {
      own[i] = static_cast<std::uint32_t>(out.points.size());
      out.points.push_back(mesh.points[cell[i]]);
    }
  }
  return out;
}

/// What walks from cell to cell find is what is found by boxes, where no cell lies beside another one: coarser, finer, and the
/// same.
TYPED_TEST(Transfer, WalksFindWhatBoxesDo) {
  constexpr int D = TypeParam::value;
  const OutputMesh<D> from = meshed<D>(D == 2 ? 0.002 : 0.12), soup = apart(from);
  std::mt19937 random(7);
  std::vector<double> values;
  for (std::size_t c = 0; c < from.cells.size(); ++c) values.push_back(std::uniform_real_distribution<double>(1, 2)(random));
  for (const double size : D == 2 ? std::array{0.05, 0.002, 0.0003} : std::array{0.6, 0.12, 0.09}) {
    OutputMesh<D> to = meshed<D>(size);
    for (const bool labelled : {true, false}) {
      if (!labelled) std::ranges::fill(to.regions, 7);
      const std::vector<double> walked = CellTransfer<D>(from, to).means(values), boxes = CellTransfer<D>(soup, to).means(values);
      ASSERT_EQ(walked.size(), to.cells.size());
      for (std::size_t c = 0; c < walked.size(); ++c) ASSERT_NEAR(walked[c], boxes[c], 1e-11) << size << ' ' << c;
    }
  }
}

/// A new mesh that is a little smaller, or larger: amounts stay all the same.
TYPED_TEST(Transfer, BoundariesThatDiffer) {
  constexpr int D = TypeParam::value;
  const OutputMesh<D> from = meshed<D>(D == 2 ? 0.002 : 0.15);
  for (const double factor : {0.99, 1.01, 1.5}) {
    OutputMesh<D> to = meshed<D>(D == 2 ? 0.001 : 0.1);
    for (Point<D>& p : to.points) {
      p[0] = 10 + factor * (p[0] - 10);
      p[1] = -3 + factor * (p[1] + 3);
    }
    std::vector<double> values(from.cells.size(), 2);
    const std::vector<double> made = CellTransfer<D>(from, to).means(values);
    const auto before = integrals(from, values, 1, 0), after = integrals(to, made, 1, 0);
    for (const auto& [label, sum] : before) EXPECT_NEAR(after.at(label), sum, 1e-12 * sum) << factor;
  }
}

}  // namespace pgdr::test_transfer_fields
