// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Voronoi cells of small meshes by hand: fans about a point, what is refused, the text.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <sstream>

#include "pgdr/error.hpp"
#include "pgdr/voronoi.hpp"

namespace pgdr::test_output_voronoi {

/// Equilateral triangles with sides of 1 from the origin, each from one of these directions, in degrees, to 60 further.
OutputMesh<2> fans(const std::vector<double>& directions) {
  OutputMesh<2> mesh;
  mesh.points = {{{0, 0}}};
  for (const double direction : directions) {
    const auto first = static_cast<std::uint32_t>(mesh.points.size());
    for (const double angle : {direction, direction + 60})
      mesh.points.push_back({{std::cos(angle * std::numbers::pi / 180), std::sin(angle * std::numbers::pi / 180)}});
    mesh.cells.push_back({0, first, first + 1});
  }
  return mesh;
}

TEST(Voronoi, FansAboutAPointComeCounterclockwise) {
  const VoronoiCells cells = voronoi_cells(fans({10, 250, 130}));
  ASSERT_EQ(cells.sites.size(), 7u);
  ASSERT_EQ(cells.offsets[1], 12u);
  const std::uint32_t own = cells.corners[0];
  EXPECT_EQ(cells.points[own], cells.sites[0]);
  for (const auto& [at, triangle] : {std::pair(0u, 0u), std::pair(4u, 2u), std::pair(8u, 1u)}) {
    EXPECT_EQ(cells.corners[at], own);
    EXPECT_EQ(cells.corners[at + 2], triangle);
  }
  const double third = std::sqrt(3.0) / 4 / 3;
  EXPECT_NEAR(cells.areas[0], 3 * third, 1e-15);
  for (std::size_t v = 1; v < 7; ++v) EXPECT_NEAR(cells.areas[v], third, 1e-15);
  EXPECT_EQ(cells.links.size(), 9u);
  for (const double width : cells.widths) EXPECT_NEAR(width, std::sqrt(3.0) / 6, 1e-15);
  for (const double length : cells.lengths) EXPECT_NEAR(length, 1, 1e-15);
}

/// Two triangles of a square: its centre is both circumcentres, and the link along the diagonal has no width.
TEST(Voronoi, OfASquareAsText) {
  OutputMesh<2> mesh;
  mesh.points = {{{0, 0}}, {{2, 0}}, {{2, 2}}, {{0, 2}}, {{9, 9}}};  // the last one in no triangle
  mesh.cells = {{0, 1, 2}, {2, 3, 0}};
  const VoronoiCells cells = voronoi_cells(mesh);
  EXPECT_EQ(cells.areas, (std::vector<double>{1, 1, 1, 1, 0}));
  EXPECT_EQ(cells.links[1], (std::array<std::uint32_t, 2>{0, 2}));
  EXPECT_EQ(cells.widths[1], 0);
  std::ostringstream out;
  write_voronoi(out, cells);
  EXPECT_EQ(out.str(),
            "# pgdr voronoi 1\n10 5\n1 1\n1 1\n2 1\n1 0\n0 1\n1 2\n0 0\n2 0\n2 2\n0 2\n"
            "0 0 5 6 3 0 1 4\n2 0 4 7 2 0 3\n2 2 5 8 5 1 0 2\n0 2 4 9 4 1 5\n9 9 0\n");
}

TEST(Voronoi, WhatHasNoSuchCellsIsRefused) {
  OutputMesh<2> mesh;
  mesh.points = {{{0, 0}}, {{4, 0}}, {{2, 1}}, {{2, -3}}};
  mesh.cells = {{0, 1, 2}};  // obtuse, opposite the boundary
  EXPECT_THROW(voronoi_cells(mesh), UsageError);
  mesh.cells = {{0, 1, 2}, {1, 0, 3}};  // not Delaunay no more: 127 and 67 degrees
  EXPECT_THROW(voronoi_cells(mesh), UsageError);
  mesh.points[3] = {{2, -5}};  // 44 degrees
  EXPECT_NO_THROW(voronoi_cells(mesh));
  mesh.cells[1] = {0, 1, 3};  // clockwise
  EXPECT_THROW(voronoi_cells(mesh), UsageError);
  mesh.cells[1] = {1, 0, 4};
  EXPECT_THROW(voronoi_cells(mesh), InputError);
  EXPECT_EQ(voronoi_cells(OutputMesh<2>()).offsets, std::vector<std::size_t>{0});
}

}  // namespace pgdr::test_output_voronoi
