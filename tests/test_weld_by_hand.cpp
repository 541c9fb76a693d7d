// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Meshes that are joined, by hand: what is said where they do not match, and what comes along where they do.
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "joined_meshes.hpp"
#include "pgdr/predicates.hpp"

namespace pgdr::test_weld_by_hand {

using namespace pgdr::test;

OutputMesh<3> tetrahedron(const std::array<Point3, 4>& p) {
  OutputMesh<3> mesh;
  mesh.points.assign(p.begin(), p.end());
  mesh.cells = {{0, 1, 2, 3}};
  if (orient<3>({p[0], p[1], p[2], p[3]}) == Sign::negative) mesh.cells = {{0, 2, 1, 3}};
  return mesh;
}

/// All that is said of a refusal.
template <int D>
std::string refusal(const std::vector<OutputMesh<D>>& meshes) {
  try {
    joined(meshes, {.names = {"a.vtu", "b.vtu"}});
  } catch (const InputError& e) {
    std::string text;
    for (const Diagnostic& d : e.diagnostics()) text += (text.empty() ? "" : "\n") + std::string(name(d.code)) + ": " + d.message;
    return text;
  }
  return "joined";
}

const OutputMesh<3> above = tetrahedron({{{{0, 0, 0}}, {{4, 0, 0}}, {{0, 4, 0}}, {{0, 0, 4}}}});

TEST(JoinRefusals, VertexInsideAFace) {
  const OutputMesh<3> below = tetrahedron({{{{0, 0, 0}}, {{4, 0, 0}}, {{1, 1, 0}}, {{0, 0, -4}}}});
  EXPECT_EQ(refusal<3>({above, below}),
            "point_on_facet: vertex 2 of b.vtu lies inside the face with the vertices 0, 1, 2 of a.vtu, at (1, 1, 0)\n"
            "facets_overlap: the face with the vertices 0, 1, 2 of a.vtu overlaps the face with the vertices 0, 1, 2 of b.vtu, "
            "at (1, 1, 0)");
}

TEST(JoinRefusals, VertexInsideAnEdge) {
  const OutputMesh<3> below = tetrahedron({{{{0, 0, 0}}, {{2, 0, 0}}, {{0, 4, 0}}, {{0, 0, -4}}}});
  EXPECT_EQ(refusal<3>({above, below}),
            "point_on_segment: vertex 1 of b.vtu lies inside the edge with the vertices 0, 1 of a.vtu, at (2, 0, 0)\n"
            "facets_overlap: the face with the vertices 0, 1, 2 of a.vtu overlaps the face with the vertices 0, 2, 1 of b.vtu, "
            "at (2, 0, 0)");
}

/// Two cells each on a square, with the two diagonals of it.
TEST(JoinRefusals, AnotherDiagonal) {
  OutputMesh<3> up, down;
  up.points = {{{0, 0, 0}}, {{4, 0, 0}}, {{4, 4, 0}}, {{0, 4, 0}}, {{2, 2, 4}}};
  up.cells = {{0, 1, 2, 4}, {0, 2, 3, 4}};
  down.points = {{{0, 0, 0}}, {{4, 0, 0}}, {{4, 4, 0}}, {{0, 4, 0}}, {{2, 2, -4}}};
  down.cells = {{1, 0, 3, 4}, {2, 1, 3, 4}};
  EXPECT_EQ(refusal<3>({up, down}),
            "facets_overlap: the face with the vertices 0, 1, 2 of a.vtu overlaps the face with the vertices 0, 1, 3 of b.vtu, "
            "at (2, 2, 0)\n"
            "facets_overlap: the face with the vertices 0, 1, 2 of a.vtu overlaps the face with the vertices 1, 2, 3 of b.vtu, "
            "at (2, 2, 0)\n"
            "facets_overlap: the face with the vertices 0, 2, 3 of a.vtu overlaps the face with the vertices 0, 1, 3 of b.vtu, "
            "at (2, 2, 0)\n"
            "facets_overlap: the face with the vertices 0, 2, 3 of a.vtu overlaps the face with the vertices 1, 2, 3 of b.vtu, "
            "at (2, 2, 0)");
}

TEST(JoinRefusals, EdgeThroughAFace) {
  const OutputMesh<3> through = tetrahedron({{{{1, 1, -1}}, {{1, 1, 1}}, {{9, 9, -1}}, {{9, 8, 1}}}});
  EXPECT_EQ(refusal<3>({above, through}),
            "entities_intersect: the face with the vertices 0, 1, 2 of a.vtu crosses the face with the vertices 0, 1, 2 of "
            "b.vtu, at (1, 1, 0)\n"
            "entities_intersect: the face with the vertices 0, 1, 2 of a.vtu crosses the face with the vertices 0, 1, 3 of "
            "b.vtu, at (1, 1, 0)\n"
            "entities_intersect: the face with the vertices 1, 2, 3 of a.vtu crosses the face with the vertices 0, 1, 2 of "
            "b.vtu, at (1.5714285714285712, 1.5714285714285712, 0.8571428571428572)\n"
            "entities_intersect: the face with the vertices 1, 2, 3 of a.vtu crosses the face with the vertices 0, 1, 3 of "
            "b.vtu, at (1.5333333333333332, 1.4666666666666668, 1)\n"
            "entities_intersect: the face with the vertices 1, 2, 3 of a.vtu crosses the face with the vertices 1, 2, 3 of "
            "b.vtu, at (1.5333333333333332, 1.4666666666666668, 1)");
}

TEST(JoinRefusals, OneInsideTheOther) {
  const OutputMesh<3> inside = tetrahedron({{{{0.5, 0.5, 0.5}}, {{1, 0.5, 0.5}}, {{0.5, 1, 0.5}}, {{0.5, 0.5, 1}}}});
  EXPECT_EQ(refusal<3>({above, inside}),
            "bodies_overlap: the face with the vertices 0, 1, 2 of b.vtu reaches into cell 0 of a.vtu, at (0.5, 0.5, 0.5)\n"
            "bodies_overlap: the face with the vertices 0, 1, 3 of b.vtu reaches into cell 0 of a.vtu, at (0.5, 0.5, 0.5)\n"
            "bodies_overlap: the face with the vertices 0, 2, 3 of b.vtu reaches into cell 0 of a.vtu, at (0.5, 0.5, 0.5)\n"
            "bodies_overlap: the face with the vertices 1, 2, 3 of b.vtu reaches into cell 0 of a.vtu, at (1, 0.5, 0.5)");
  EXPECT_EQ(refusal<3>({inside, above}),
            "bodies_overlap: the face with the vertices 0, 1, 2 of a.vtu reaches into cell 0 of b.vtu, at (0.5, 0.5, 0.5)\n"
            "bodies_overlap: the face with the vertices 0, 1, 3 of a.vtu reaches into cell 0 of b.vtu, at (0.5, 0.5, 0.5)\n"
            "bodies_overlap: the face with the vertices 0, 2, 3 of a.vtu reaches into cell 0 of b.vtu, at (0.5, 0.5, 0.5)\n"
            "bodies_overlap: the face with the vertices 1, 2, 3 of a.vtu reaches into cell 0 of b.vtu, at (1, 0.5, 0.5)");
}

/// The other mesh is a cell of the first.
TEST(JoinRefusals, ACellTwice) {
  OutputMesh<3> two = above;
  two.points.push_back({{0, 0, -4}});
  two.cells.push_back({0, 2, 1, 4});
  EXPECT_EQ(refusal<3>({two, above}),
            "bodies_overlap: cell 0 of a.vtu and cell 0 of b.vtu are on the same side of the face with the vertices 0, 1, 2 of "
            "a.vtu, at (0, 0, 0)\n"
            "bodies_overlap: cell 0 of a.vtu and cell 0 of b.vtu are on the same side of the face with the vertices 0, 1, 3 of "
            "a.vtu, at (0, 0, 0)\n"
            "bodies_overlap: cell 0 of a.vtu and cell 0 of b.vtu are on the same side of the face with the vertices 0, 2, 3 of "
            "a.vtu, at (0, 0, 0)\n"
            "bodies_overlap: cell 0 of a.vtu and cell 0 of b.vtu are on the same side of the face with the vertices 1, 2, 3 of "
            "a.vtu, at (4, 0, 0)");
}

TEST(JoinRefusals, TheSameTwice) {
  EXPECT_EQ(refusal<3>({above, above}),
            "bodies_overlap: cell 0 of a.vtu and cell 0 of b.vtu are on the same side of the face with the vertices 0, 1, 2 of "
            "a.vtu, at (0, 0, 0)\n"
            "bodies_overlap: cell 0 of a.vtu and cell 0 of b.vtu are on the same side of the face with the vertices 0, 1, 3 of "
            "a.vtu, at (0, 0, 0)\n"
            "bodies_overlap: cell 0 of a.vtu and cell 0 of b.vtu are on the same side of the face with the vertices 0, 2, 3 of "
            "a.vtu, at (0, 0, 0)\n"
            "bodies_overlap: cell 0 of a.vtu and cell 0 of b.vtu are on the same side of the face with the vertices 1, 2, 3 of "
            "a.vtu, at (4, 0, 0)");
}

TEST(JoinRefusals, UnsoundMeshes) {
  OutputMesh<3> mesh = above;
  std::swap(mesh.cells[0][0], mesh.cells[0][1]);
  EXPECT_EQ(refusal<3>({above, mesh}), "inconsistent_orientation: cell 0 of b.vtu is flat or turned over, at (4, 0, 0)");
  mesh = above;
  mesh.points.push_back({{4, 0, -0.0}});
  EXPECT_EQ(refusal<3>({above, mesh}), "duplicate_point: vertices 1 and 4 of b.vtu are both at (4, 0, 0)");
  mesh = above;
  mesh.points[2][1] = std::numeric_limits<double>::infinity();
  EXPECT_EQ(refusal<3>({above, mesh}), "not_finite: vertex 2 of b.vtu has coordinates that are not finite");
  mesh = above;
  mesh.cells[0][2] = 4;
  EXPECT_EQ(refusal<3>({above, mesh}), "index_out_of_range: a cell has a vertex that is none of the 4 points");
  EXPECT_THROW(joined<3>({}), UsageError);
  EXPECT_THROW(joined<3>({above, OutputMesh<3>()}), UsageError);
  EXPECT_THROW(joined<3>({above}, {.names = {"a", "b"}}), UsageError);
  JoinOptions options;
  std::stop_source stop;
  stop.request_stop();
  options.stop = stop.get_token();
  EXPECT_THROW(joined<3>({above}, options), CancelledError);
}

TEST(JoinRefusals, InThePlane) {
  OutputMesh<2> left, right;
  left.points = {{{0, 0}}, {{4, 0}}, {{0, 4}}};
  left.cells = {{0, 1, 2}};
  right.points = {{{4, 0}}, {{4, 4}}, {{2, 2}}};
  right.cells = {{0, 1, 2}};
  EXPECT_EQ(refusal<2>({left, right}),
            "point_on_segment: vertex 2 of b.vtu lies inside the edge with the vertices 1, 2 of a.vtu, at (2, 2)");
  right.points = {{{4, 4}}, {{1, 1}}, {{4, 3}}};
  EXPECT_EQ(
      refusal<2>({left, right}),
      "entities_intersect: the edge with the vertices 1, 2 of a.vtu crosses the edge with the vertices 0, 1 of b.vtu, at (2, 2)\n"
      "entities_intersect: the edge with the vertices 1, 2 of a.vtu crosses the edge with the vertices 1, 2 of b.vtu, at (2.2, "
      "1.8)");
}

/// Boundaries that rounding has put an ulp apart are not one; that is said, whether it is refused or not.
TEST(JoinRefusals, NearlyOne) {
  const double off = 4 - 0x1p-50;
  const OutputMesh<3> below = tetrahedron({{{{0, 0, 0}}, {{off, 0, 0}}, {{0, 4, 0}}, {{0, 0, -4}}}});
  EXPECT_EQ(
      refusal<3>({above, below}),
      "point_on_segment: vertex 1 of b.vtu lies inside the edge with the vertices 0, 1 of a.vtu, at (3.999999999999999, 0, 0)\n"
      "facets_overlap: the face with the vertices 0, 1, 2 of a.vtu overlaps the face with the vertices 0, 2, 1 of b.vtu, at "
      "(3.999999999999999, 0, 0)\n"
      "near_points: vertex 1 of a.vtu and vertex 1 of b.vtu are 8.881784197001252e-16 apart, and not one, at (3.999999999999999, "
      "0, 0)");
  const OutputMesh<3> apart = tetrahedron({{{{0, 0, -0x1p-50}}, {{4, 0, -0x1p-50}}, {{0, 4, -0x1p-50}}, {{0, 0, -4}}}});
  const JoinedMesh<3> out = joined<3>({above, apart}, {.names = {"a.vtu", "b.vtu"}});
  ASSERT_EQ(out.warnings.size(), 3u);
  EXPECT_EQ(out.warnings[0].code, Errc::near_points);
  EXPECT_EQ(
      out.warnings[0].message,
      "vertex 0 of a.vtu and vertex 0 of b.vtu are 8.881784197001252e-16 apart, and not one, at (0, 0, -8.881784197001252e-16)");
  EXPECT_EQ(out.shared_points, 0u);
}

/// An edge, or a vertex, in common is no reason to refuse.
TEST(Join3D, TouchingAlongAnEdge) {
  const OutputMesh<3> other = tetrahedron({{{{0, 0, -0.0}}, {{4, -0.0, 0}}, {{1, -4, 0}}, {{1, -4, 4}}}});
  const JoinedMesh<3> out = joined<3>({above, other});
  EXPECT_EQ(out.shared_points, 2u);
  EXPECT_TRUE(out.interfaces.empty());
  EXPECT_EQ(out.mesh.points.size(), 6u);
  EXPECT_EQ(out.added_walls, 8u);
  EXPECT_EQ(findings_alone(out.mesh), "");
}

TEST(JoinData, WhatTheFirstSaysStands) {
  OutputMesh<3> a = above, b = tetrahedron({{{{4, 0, 0}}, {{0, 0, 0}}, {{0, 4, 0}}, {{0, 0, -4}}}});
  a.input_points = 4;
  b.input_points = 3;
  a.regions = {3};
  b.regions = {3};
  a.names.regions[3] = "steel";
  b.names.regions[3] = "iron";
  a.names.markers[7] = "wall";
  b.names.markers = {{7, "floor"}, {8, "base"}};
  a.point_markers = {10, 11, 12, 13};
  b.point_markers = {21, 10, 12, 23};
  a.point_attributes = {0, 0, 1, 1, 2, 2, 3, 3};
  b.point_attributes = {1, 1, 0, 0, 2, 2, 9, 8};
  a.leaves = {2};
  b.leaves = {1};
  a.subfacets = {{{0, 2, 1}, 7}};
  b.subfacets = {{{0, 1, 2}, 8}, {{1, 0, 3}, 8}};
  a.subsegments = {{{0, 1}, 5}};
  b.subsegments = {{{0, 1}, 6}};
  JoinedMesh<3> out = joined<3>({a, b}, {.names = {"a.vtu", "b.vtu"}});
  EXPECT_EQ(findings_alone(out.mesh), "");
  EXPECT_EQ(out.mesh.input_points, 4u);
  EXPECT_EQ(out.mesh.regions, (std::vector<double>{3, 3}));
  EXPECT_EQ(out.mesh.leaves, (std::vector<std::uint32_t>{2, 4}));
  EXPECT_EQ(out.mesh.point_markers, (std::vector<int>{10, 11, 12, 13, 23}));
  EXPECT_EQ(out.mesh.point_attributes, (std::vector<double>{0, 0, 1, 1, 2, 2, 3, 3, 9, 8}));
  EXPECT_EQ(out.mesh.names.regions, (std::map<double, std::string>{{3, "steel"}}));
  EXPECT_EQ(out.mesh.names.markers, (std::map<int, std::string>{{7, "wall"}, {8, "base"}}));
  EXPECT_EQ(out.interfaces, (std::vector<SharedConstraints>{{{0, 1}, {7, 8}, 1}}));
  EXPECT_EQ(out.shared_segments, (std::vector<SharedConstraints>{{{0, 1}, {5, 6}, 1}}));
  EXPECT_EQ(out.labels, (std::vector<JoinedLabel>{{0, 3, 3}, {1, 3, 3}}));
  EXPECT_EQ(out.shared_points, 3u);
  EXPECT_EQ(out.added_walls, 5u);
  EXPECT_EQ(out.dropped,
            (std::vector<std::string>{"the name \"iron\" that b.vtu has for the label 3, which is called \"steel\"",
                                      "the markers of points of b.vtu at 1 common vertex, where a mesh before it has others",
                                      "the name \"floor\" that b.vtu has for the marker 7, which is called \"wall\""}));
  ASSERT_EQ(out.mesh.subfacets.size(), 7u);
  EXPECT_EQ(std::ranges::count(out.mesh.subfacets, 7, &OutputMesh<3>::Constraint<3>::marker), 1);

  out = joined<3>({a, b}, {.relabel = true});
  EXPECT_EQ(out.mesh.regions, (std::vector<double>{1, 2}));
  EXPECT_EQ(out.labels, (std::vector<JoinedLabel>{{0, 3, 1}, {1, 3, 2}}));
  EXPECT_EQ(out.mesh.names.regions, (std::map<double, std::string>{{1, "steel"}, {2, "iron"}}));

  b.point_markers.clear();
  b.point_attributes = {1, 2, 3, 4};
  b.input_points = 0;
  b.leaves.clear();
  out = joined<3>({a, b});
  EXPECT_TRUE(out.mesh.point_markers.empty());
  EXPECT_TRUE(out.mesh.point_attributes.empty());
  EXPECT_TRUE(out.mesh.leaves.empty());
  EXPECT_EQ(out.mesh.input_points, 0u);
  EXPECT_EQ(out.dropped[1], "the leaves of cells, of which mesh 0 has 1 each, and mesh 1 0");
  EXPECT_EQ(out.dropped[2], "the markers of points, of which mesh 0 has 1 each, and mesh 1 0");
  EXPECT_EQ(out.dropped[3], "the attributes of points, of which mesh 0 has 2 each, and mesh 1 1");
}

/// Cells of two labels with no wall between them, of one mesh: check() asks for one.
TEST(JoinData, LabelsAreApart) {
  OutputMesh<2> square;
  square.points = {{{0, 0}}, {{1, 0}}, {{1, 1}}, {{0, 1}}};
  square.cells = {{0, 1, 2}, {0, 2, 3}};
  square.regions = {1, 2};
  const JoinedMesh<2> out = joined<2>({square});
  EXPECT_EQ(out.added_walls, 5u);
  EXPECT_EQ(findings_alone(out.mesh), "");
  EXPECT_NE(findings_alone(square), "");
}

}  // namespace pgdr::test_weld_by_hand
