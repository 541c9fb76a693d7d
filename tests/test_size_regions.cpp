// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Sizes of single regions: meshes that the checker verifies with the same sizes, and that a loop over all cells does; what
// cannot be a size of a region; and sizes that grow from one region into the next.
#include <gtest/gtest.h>

#include <cmath>

#include "parallel_support.hpp"
#include "pgdr/circumsphere.hpp"
#include "pgdr/flat_arrays.hpp"
#include "pgdr/predicates.hpp"
#include "pgdr/size_fields.hpp"

namespace pgdr::test_size_regions {

/// A box of the sides 1 with a wall at x = 1/2. Left of it is region 1, right of it region 7.5.
template <int D>
Plc<D> halves() {
  Plc<D> plc;
  if constexpr (D == 3) {
    plc.points = {{0, 0, 0}, {0.5, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.5, 1, 0}, {1, 1, 0},
                  {0, 0, 1}, {0.5, 0, 1}, {1, 0, 1}, {0, 1, 1}, {0.5, 1, 1}, {1, 1, 1}};
    const std::vector<std::vector<std::uint32_t>> facets = {{0, 3, 9, 6},        {1, 4, 10, 7},        {2, 5, 11, 8},
                                                            {0, 1, 2, 8, 7, 6},  {3, 4, 5, 11, 10, 9}, {0, 1, 2, 5, 4, 3},
                                                            {6, 7, 8, 11, 10, 9}};
    for (const auto& polygon : facets) plc.facets.push_back({{polygon}, {}, 0});
    plc.regions = {{{0.25, 0.5, 0.5}, 1, 0}, {{0.75, 0.5, 0.5}, 7.5, 0}};
  } else {
    plc.points = {{0, 0}, {0.5, 0}, {1, 0}, {0, 1}, {0.5, 1}, {1, 1}};
    for (const auto& ends : std::vector<std::array<std::uint32_t, 2>>{{0, 1}, {1, 2}, {2, 5}, {5, 4}, {4, 3}, {3, 0}, {1, 4}})
      plc.segments.push_back({ends, 0});
    plc.regions = {{{0.25, 0.5}, 1, 0}, {{0.75, 0.5}, 7.5, 0}};
  }
  return plc;
}

template <int D>
bool within(const OutputMesh<D>& mesh, std::size_t cell, double size) {
  Simplex<D> s;
  for (int i = 0; i <= D; ++i) s[i] = mesh.points[mesh.cells[cell][i]];
  if constexpr (D == 3) {
    return circumradius_within<3>(s, size);
  } else {
    return measure_within<2>(s, size);
  }
}

template <int D>
std::size_t cells_of(const OutputMesh<D>& mesh, double label) {
  return static_cast<std::size_t>(std::count(mesh.regions.begin(), mesh.regions.end(), label));
}

template <class F>
Diagnostic error_of(const F& f) {
  try {
    f();
  } catch (const UsageError& e) {
    return e.diagnostic();
  }
  ADD_FAILURE() << "no UsageError";
  return {};
}

constexpr double left = 1, right = 7.5;
template <int D>
constexpr double fine = D == 3 ? 0.06 : 0.0005;
template <int D>
constexpr double coarse = D == 3 ? 0.25 : 0.01;

/// Ten times as fine at the top as at the bottom; asked on the right alone.
template <int D>
double rising(const Point<D>& p) {
  if (p[0] < 0.5) throw std::runtime_error("asked beyond the region");
  return coarse<D> * (1 - 0.7 * p[1]);
}

template <class T>
class RegionSizesOf : public testing::Test {};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(RegionSizesOf, Dimensions);

TYPED_TEST(RegionSizesOf, MeshesMeetThemReproducibly) {
  constexpr int D = TypeParam::value;
  RefineOptions<D> options;
  options.region_sizes = {{left, fine<D>}, {right, rising<D>}};
  options.schedule.floor = 20;
  const auto mesh = test::expect_reproducible<D>(halves<D>(), options, "function and constant").mesh;
  ASSERT_EQ(mesh.regions.size(), mesh.cells.size());
  for (std::size_t c = 0; c < mesh.cells.size(); ++c) {
    Simplex<D> s;
    for (int i = 0; i <= D; ++i) s[i] = mesh.points[mesh.cells[c][i]];
    ASSERT_TRUE(within<D>(mesh, c, mesh.regions[c] == left ? fine<D> : rising<D>(centroid<D>(s)))) << c;
  }
  EXPECT_GT(cells_of(mesh, left), 3 * cells_of(mesh, right));
  EXPECT_GT(cells_of(mesh, right), 20u);
  // The checker sees to them, each where it belongs.
  const Plc<D> plc = halves<D>();
  for (const double label : {left, right}) {
    CheckOptions<D> check_options;
    check_options.input = &plc;
    check_options.region_sizes = {{label, D == 3 ? 1e-3 : 1e-6}};
    EXPECT_EQ(check<D>(mesh, check_options).over_size, cells_of(mesh, label));
    check_options.input = nullptr;
    EXPECT_EQ(check<D>(mesh, check_options).over_size, cells_of(mesh, label));
  }
}

TYPED_TEST(RegionSizesOf, AllThatApplyAreMet) {
  constexpr int D = TypeParam::value;
  const auto mesh_of = [](SizingField<D> size, RegionSizes<D> sizes) {
    RefineOptions<D> options;
    options.size = std::move(size);
    options.region_sizes = std::move(sizes);
    const auto outcome = test::refine_and_check<D>(halves<D>(), options);
    EXPECT_EQ(outcome.report.exit_code(), 0) << test::findings(outcome.report);
    return outcome.result.mesh;
  };
  const auto expected = mesh_of({}, {{left, fine<D>}, {right, coarse<D>}});
  test::expect_same_mesh<D>(expected, mesh_of({}, {{right, coarse<D>}, {left, INFINITY}, {left, fine<D>}, {left, 1}}));
  test::expect_same_mesh<D>(expected, mesh_of(coarse<D>, {{left, fine<D>}}));
  test::expect_same_mesh<D>(expected, mesh_of([](const Point<D>&) { return coarse<D>; }, {{left, fine<D>}, {0, 1e-9}}));
  test::expect_same_mesh<D>(mesh_of(coarse<D>, {}), mesh_of(coarse<D>, {{left, INFINITY}}));
}

// Automatic labels, and the one that cells have where there are none.
TYPED_TEST(RegionSizesOf, LabelsWithoutSeeds) {
  constexpr int D = TypeParam::value;
  Plc<D> plc = halves<D>();
  plc.regions.clear();
  RefineOptions<D> options;
  options.region_sizes = {{0, fine<D>}};
  RefineOptions<D> everywhere;
  everywhere.size = fine<D>;
  test::expect_same_mesh<D>(refine<D>(plc, everywhere).mesh, test::refine_and_check<D>(plc, options).result.mesh);
  // Both halves are on the outside's side of one wall between them: solid, with a label each.
  options.regions = RegionMode::automatic;
  options.region_sizes = {{2, fine<D>}};
  const auto mesh = refine<D>(plc, options).mesh;
  EXPECT_GT(cells_of(mesh, 2), 3 * cells_of(mesh, 1));
  EXPECT_GT(cells_of(mesh, 1), 0u);
}

TYPED_TEST(RegionSizesOf, WhatCannotBeOneIsATypedError) {
  constexpr int D = TypeParam::value;
  const auto meshing = [](RegionSizes<D> sizes) {
    return [sizes] {
      RefineOptions<D> options;
      options.region_sizes = sizes;
      refine<D>(halves<D>(), options);
    };
  };
  for (const double bad : {0.0, -1.0, double(NAN)}) {
    EXPECT_EQ(error_of(meshing({{left, bad}})).code, Errc::bad_option);
    const auto sometimes = [bad](const Point<D>& p) { return p[1] > 0.5 ? bad : coarse<D>; };
    const Diagnostic d = error_of(meshing({{left, coarse<D>}, {right, sometimes}}));
    EXPECT_EQ(d.code, Errc::bad_size);
    ASSERT_EQ(d.points.size(), 1u);
    EXPECT_GT(d.points[0][0], 0.5);
    EXPECT_GT(d.points[0][1], 0.5);
  }
  const Diagnostic unknown = error_of(meshing({{3, coarse<D>}}));
  EXPECT_EQ(unknown.code, Errc::bad_option);
  EXPECT_EQ(unknown.message, "a size is given for the region label 3, which no region has; there are 0, 1, 7.5");
  const auto throwing = [](const Point<D>&) -> double { throw std::logic_error("mine"); };
  EXPECT_THROW(meshing({{right, throwing}})(), std::logic_error);

  const auto mesh = refine<D>(halves<D>(), {}).mesh;
  CheckOptions<D> check_options;
  check_options.region_sizes = {{3, coarse<D>}};
  EXPECT_EQ(error_of([&] { check<D>(mesh, check_options); }).code, Errc::bad_option);
  EXPECT_EQ(error_of([&] { sizes_of_regions<D>(mesh, {{3, 1}}, 1); }).code, Errc::bad_option);
  EXPECT_EQ(error_of([&] { sizes_of_regions<D>(mesh, {}, INFINITY); }).code, Errc::bad_option);
  EXPECT_EQ(error_of([&] { sizes_of_regions<D>(mesh, {{left, 0.0}}, 1); }).code, Errc::bad_size);
}

// A fine region beside a coarse one, once as it is and once with sizes that grow by a fifth of the distance.
TYPED_TEST(RegionSizesOf, GrowIntoTheirNeighbours) {
  constexpr int D = TypeParam::value;
  RefineOptions<D> options;
  options.size = coarse<D>;
  const auto background = refine<D>(halves<D>(), options).mesh;
  const auto values = sizes_of_regions<D>(background, {{left, fine<D>}}, coarse<D>);
  ASSERT_EQ(values.size(), background.points.size());
  for (std::size_t v = 0; v < values.size(); ++v)
    EXPECT_EQ(values[v], background.points[v][0] <= 0.5 ? fine<D> : coarse<D>);  // the wall belongs to both

  const double growth = D == 3 ? 0.2 : 0.1;
  const SizingField<D> gradual = sizes_on_mesh<D>(background, limit_growth<D>(background, values, growth));
  const double x[] = {0.25, 0.5, 0.75};
  double last = 0;
  for (const double at : x) {
    Point<D> p;
    p.x.fill(at);
    EXPECT_GE(gradual.at(p), last);
    last = gradual.at(p);
  }
  EXPECT_GT(last, fine<D>);
  EXPECT_LT(last, coarse<D>);
  options.size = gradual;
  const auto mesh = test::expect_reproducible<D>(halves<D>(), options, "gradual").mesh;
  options.size = coarse<D>;
  options.region_sizes = {{left, fine<D>}};
  const auto abrupt = refine<D>(halves<D>(), options).mesh;
  EXPECT_GT(cells_of(mesh, right), cells_of(abrupt, right));
}

}  // namespace pgdr::test_size_regions
