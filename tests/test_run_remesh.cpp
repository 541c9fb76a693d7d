// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Meshes that are made of meshes, by the library alone: attributes come along, the checker agrees with the old mesh as input, and
// sizes of cells hold in these.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>

#include "dimensions.hpp"
#include "pgdr/check.hpp"
#include "pgdr/remesh.hpp"
#include "pgdr/size_fields.hpp"

namespace pgdr::test_run_remesh {

/// The square or cube [0, 1]^D, with attributes that are linear.
template <int D>
Plc<D> unit() {
  Plc<D> plc;
  for (int i = 0; i < (1 << D); ++i) {
    Point<D> p{};
    for (int k = 0; k < D; ++k) p[k] = i >> k & 1;
    plc.points.push_back(p);
    plc.point_attributes.push_back(1 + 2 * p[0] - 3 * p[1]);
  }
  if constexpr (D == 2) {
    plc.segments = {{{0, 1}, 1}, {{1, 3}, 2}, {{3, 2}, 3}, {{2, 0}, 4}};
  } else {
    int marker = 0;
    for (const auto& polygon : std::vector<std::vector<std::uint32_t>>{
             {0, 1, 3, 2}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 3, 7, 5}}) {
      plc.facets.emplace_back().polygons = {polygon};
      plc.facets.back().marker = ++marker;
    }
  }
  return plc;
}

template <int D>
CheckReport checked(const OutputMesh<D>& mesh, const OutputMesh<D>& old, const std::vector<std::uint8_t>& required,
                    const RefineOptions<D>& options) {
  const MeshBoundary<D> boundary = boundary_with_vertices<D>(old, required);
  CheckOptions<D> check_options;
  check_options.input = &boundary.plc;
  check_options.required_points = required_points<D>(boundary, required);
  check_options.radius_edge_bound = options.radius_edge_bound;
  check_options.size = options.size;
  return check(mesh, check_options);
}

template <class Number>
class Remesh : public testing::Test {};
TYPED_TEST_SUITE(Remesh, test::Dimensions);

TYPED_TEST(Remesh, AttributesAndRequiredVertices) {
  constexpr int D = TypeParam::value;
  RefineOptions<D> options;
  options.size = D == 2 ? 0.002 : 0.15;
  const OutputMesh<D> old = refine(unit<D>(), options).mesh;
  options.size = D == 2 ? 0.02 : 0.4;
  RemeshInputOptions how;
  how.required.assign(old.points.size(), 0);
  for (std::size_t v = 0; v < old.points.size(); v += 50) how.required[v] = 1;
  const OutputMesh<D> mesh = remesh<D>(old, options, how).mesh;
  EXPECT_LT(mesh.cells.size(), old.cells.size());
  ASSERT_EQ(mesh.point_attributes.size(), mesh.points.size());
  for (std::size_t v = 0; v < mesh.points.size(); ++v)
    EXPECT_NEAR(mesh.point_attributes[v], 1 + 2 * mesh.points[v][0] - 3 * mesh.points[v][1], 1e-12);
  for (std::size_t v = 0; v < old.points.size(); v += 50) EXPECT_EQ(std::ranges::count(mesh.points, old.points[v]), 1);
  EXPECT_EQ(checked<D>(mesh, old, how.required, options).exit_code(), 0);
  const OutputMesh<D> bare = remesh<D>(old, options).mesh;
  EXPECT_EQ(bare.input_points, std::size_t{1} << D);
  EXPECT_EQ(checked<D>(bare, old, {}, options).exit_code(), 0);
  EXPECT_EQ(checked<D>(bare, old, how.required, options).exit_code(), 6);
  how.required.pop_back();
  EXPECT_THROW(remesh<D>(old, options, how), UsageError);
}

/// The facets (2D: segments) of the mesh, by the places of their corners.
template <int D>
std::set<std::array<std::array<double, D>, D>> facets_of(const OutputMesh<D>& mesh) {
  std::set<std::array<std::array<double, D>, D>> all;
  const auto add = [&](const auto& facets) {
    for (const auto& f : facets) {
      std::array<std::array<double, D>, D> corners;
      for (std::size_t i = 0; i < D; ++i) corners[i] = mesh.points[f.vertices[i]].x;
      std::sort(corners.begin(), corners.end());
      all.insert(corners);
    }
  };
  if constexpr (D == 2)
    add(mesh.subsegments);
  else
    add(mesh.subfacets);
  return all;
}

/// By the option of the run as by that of the input: finer and coarser inside, of facets that have points of their own.
TYPED_TEST(Remesh, TheBoundaryIsKept) {
  constexpr int D = TypeParam::value;
  RefineOptions<D> options;
  options.size = D == 2 ? 0.005 : 0.25;
  const OutputMesh<D> old = refine(unit<D>(), options).mesh;
  ASSERT_GT(facets_of<D>(old).size(), 20u);
  options.keep_boundary = true;
  std::vector<std::size_t> cells;
  for (const double size : D == 2 ? std::array{0.001, 0.05} : std::array{0.15, 0.6}) {
    options.size = size;
    const RefineResult<D> made = remesh<D>(old, options);
    EXPECT_EQ(facets_of<D>(made.mesh), facets_of<D>(old));
    EXPECT_EQ(made.statistics.boundary_points, 0u);
    const MeshBoundary<D> boundary = boundary_with_vertices<D>(old, {});
    CheckOptions<D> check_options;
    check_options.input = &boundary.plc;
    check_options.required_points = required_points<D>(boundary, {});
    check_options.radius_edge_bound = options.radius_edge_bound;
    check_options.size = size;
    check_options.delaunay = made.delaunay;
    check_options.reasons = &made.reasons;
    check_options.keep_boundary = true;
    const CheckReport report = check(made.mesh, check_options);
    EXPECT_LE(report.exit_code(), 1) << (report.findings.empty() ? "" : report.findings.front().message);
    cells.push_back(made.mesh.cells.size());
  }
  EXPECT_GT(cells[0], cells[1]);
}

TYPED_TEST(Remesh, AllVerticesStayAndCellsHaveTheirBounds) {
  constexpr int D = TypeParam::value;
  RefineOptions<D> options;
  options.size = D == 2 ? 0.01 : 0.3;
  const OutputMesh<D> old = refine(unit<D>(), options).mesh;
  std::vector<double> bounds;
  for (std::size_t c = 0; c < old.cells.size(); ++c) bounds.push_back(c % 7 == 0 ? (D == 2 ? 0.001 : 0.12) : -1);
  options.size = sizes_in_cells<D>(old, bounds);
  RemeshInputOptions how;
  how.keep_vertices = true;
  const OutputMesh<D> mesh = remesh<D>(old, options, how).mesh;
  EXPECT_GT(mesh.cells.size(), old.cells.size());
  for (const Point<D>& p : old.points) EXPECT_EQ(std::ranges::count(mesh.points, p), 1);
  EXPECT_EQ(checked<D>(mesh, old, std::vector<std::uint8_t>(old.points.size(), 1), options).exit_code(), 0);
  EXPECT_EQ(options.size.at(Point<D>{{-1}}), std::numeric_limits<double>::infinity());
  EXPECT_THROW(sizes_in_cells<D>(old, std::vector<double>(3, 1)), UsageError);
}

TYPED_TEST(Remesh, UnitsOfSizes) {
  constexpr int D = TypeParam::value;
  EXPECT_EQ(in_usual_unit<D>(0.5, usual_size_unit<D>()), 0.5);
  EXPECT_EQ(in_usual_unit<D>(2, SizeUnit::edge), D == 2 ? 2.5 : 1.5);
  EXPECT_THROW(in_usual_unit<D>(1, D == 2 ? SizeUnit::volume : SizeUnit::area), UsageError);
  EXPECT_TRUE(std::isnan(in_usual_unit<D>(std::nan(""), SizeUnit::edge)));
  EXPECT_EQ(in_usual_unit<D>(-1, SizeUnit::radius), -1);
  const SizingField<D> field = in_usual_unit<D>(SizingField<D>([](const Point<D>& p) { return p[0]; }), SizeUnit::edge);
  EXPECT_EQ(field.at(Point<D>{{2}}), in_usual_unit<D>(2, SizeUnit::edge));
  EXPECT_FALSE(in_usual_unit<D>(SizingField<D>(), SizeUnit::edge).bounded());
  if constexpr (D == 3) {
    for (const double r : {1e-100, 1e-9, 0.3, 1.0, 7.0, 1e10, 1e90}) {
      const double volume = 0.5132002392796674 * r * r * r;
      EXPECT_NEAR(in_usual_unit<3>(volume, SizeUnit::volume) / r, 1, 1e-14);
    }
  }
  EXPECT_NEAR(growth_of_unit<D>(SizeUnit::edge), D == 2 ? std::sqrt(0.625) : 0.75, 1e-15);
}

}  // namespace pgdr::test_run_remesh
