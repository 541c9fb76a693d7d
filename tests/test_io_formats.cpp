// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Formats that are inputs and meshes alike, and PLY: what is read from each variant, what cells leave behind when their
// surface is asked for, what is said about mistakes; and that meshes go through all formats and back.
#include <algorithm>

#include "io/formats.hpp"
#include "msh_files.hpp"
#include "ply_files.hpp"
#include "test_io_support.hpp"

namespace pgdr::test::test_io_formats {

using Corners = std::vector<std::uint32_t>;

TEST(ReadPly, IsTheSameInEachEncoding) {
  const TempFolder folder;
  for (const PlyEncoding encoding : ply_encodings) {
    SCOPED_TRACE(ply_name(encoding));
    const auto file = folder.put("a.PLY", ply_file(encoding));
    EXPECT_EQ(file_dimension(file), 3);
    EXPECT_FALSE(holds_cells(file));
    const Plc<3> plc = read_plc<3>(file);
    ASSERT_EQ(plc.points.size(), 5u);
    EXPECT_EQ(plc.points[2], (Point3{{1, 1, 0}}));
    EXPECT_EQ(plc.points[4], (Point3{{0.5, 0.5, 1.25}}));
    ASSERT_EQ(plc.facets.size(), 5u);
    EXPECT_EQ(plc.facets[0].polygons, (std::vector<Corners>{{3, 2, 1, 0}}));
    EXPECT_EQ(plc.facets[4].polygons, (std::vector<Corners>{{3, 0, 4}}));
    EXPECT_TRUE(plc.segments.empty());
    EXPECT_EQ(plc.first_index, 0u);
    EXPECT_EQ(plc.source.file, file.string());
    if (encoding == PlyEncoding::text) {
      EXPECT_EQ(plc.source.point_lines, (Corners{24, 25, 26, 27, 28}));
      EXPECT_EQ(plc.source.facet_lines, (Corners{29, 30, 31, 32, 33}));
    } else {
      EXPECT_TRUE(plc.source.point_lines.empty());
    }
  }
}

TEST(ReadPly, MistakesAreNamed) {
  const std::string whole = ply_file(PlyEncoding::text);
  const auto expect = [&whole](const std::string& from, const std::string& to, Errc code, std::uint64_t line) {
    SCOPED_TRACE(from + " -> " + to);
    std::string text = whole;
    const std::size_t at = text.find(from);
    ASSERT_NE(at, std::string::npos);
    text.replace(at, from.size(), to);
    const auto error = error_of<InputError>([&] { detail::read_plc_from<3>(text, "a.ply"); });
    EXPECT_EQ(name(error.code), name(code)) << error.message;
    EXPECT_EQ(error.line, line) << error.message;
    EXPECT_EQ(error.file, "a.ply");
  };
  expect("ply\n", "plx\n", Errc::syntax, 1);
  expect("format", "fromat", Errc::syntax, 2);
  expect("ascii", "latin1", Errc::unknown_format, 2);
  expect("1.0", "2.0", Errc::unknown_format, 2);
  expect("vertex 5", "vertex 1000000000", Errc::count_too_large, 8);
  expect("face 5", "face 99999999999999999999", Errc::count_too_large, 14);
  expect("vertex 5", "vertex -5", Errc::syntax, 8);
  expect("element vertex", "element face", Errc::syntax, 14);
  expect("element face", "element tristrips", Errc::unknown_format, 14);
  expect("property uchar red", "property colour red", Errc::syntax, 7);
  expect("property double z", "property double w", Errc::syntax, 8);
  expect("property double z", "property double x", Errc::syntax, 8);
  expect("property double z", "property list uchar double z", Errc::syntax, 8);
  expect("int32 vertex_indices", "float vertex_indices", Errc::syntax, 14);
  expect("list uint8 int32", "list float int32", Errc::syntax, 16);
  expect("element edge 1\n", "element edge 1\nelement none 0\n", Errc::syntax, 22);
  expect("property float quality\n", "hello\n", Errc::syntax, 15);
  expect("0 2 1 1 2", "0 300 1 1 2", Errc::syntax, 26);  // beyond a uchar
  expect("0 0 0 0 0", "inf 0 0 0 0", Errc::not_finite, 24);
  expect("0 1 1 0 1 0.5", "0 1 x 0 1 0.5", Errc::syntax, 25);
  expect("0 1 1 0 1 0.5", "0 1 1 0 2 0.5", Errc::syntax, 25);  // one too few
  expect("-0.125 4 3 2 1 0", "-0.125 2 3 2", Errc::degenerate_facet, 29);
  expect("-0.125 4 3 2 1 0", "-0.125 4 3 2 1 5", Errc::index_out_of_range, 29);
  expect("-0.125 4 3 2 1 0", "-0.125 4 3 2 1 -1", Errc::index_out_of_range, 29);
  expect("-0.125 4 3 2 1 0", "-0.125 200 3 2 1 0", Errc::count_too_large, 29);
  expect("\n0 2 \n", "\n0 2 \nmore\n", Errc::syntax, 35);
  expect("\n0 2 \n", "\n", Errc::truncated, 34);
}

TEST(ReadMsh, IsTheSameInEachVariant) {
  const TempFolder folder;
  for (const MshVariant& v : msh_variants) {
    SCOPED_TRACE(v.name());
    const auto file = folder.put("a.msh", msh_file(two_tetrahedra(), v));
    EXPECT_EQ(file_dimension(file), 3);
    EXPECT_TRUE(holds_cells(file));
    const OutputMesh<3> mesh = read_mesh<3>(file);
    ASSERT_EQ(mesh.points.size(), 5u);  // in the order of their tags
    EXPECT_EQ(mesh.points[0], (Point3{{1, 0, 0}}));
    EXPECT_EQ(mesh.points[1], (Point3{{0.75, 0.75, 0.75}}));
    EXPECT_EQ(mesh.points[2], (Point3{{0, 0, 0}}));
    EXPECT_EQ(mesh.point_markers, (std::vector<int>{0, 0, 11, 0, 0}));
    EXPECT_EQ(mesh.cells, (std::vector<std::array<std::uint32_t, 4>>{{2, 0, 3, 4}, {0, 3, 4, 1}}));
    EXPECT_EQ(mesh.regions, (std::vector<double>{7, 8}));
    ASSERT_EQ(mesh.subsegments.size(), 2u);
    EXPECT_EQ(mesh.subsegments[0].marker, -6);  // by the name of its group
    EXPECT_EQ(mesh.subsegments[1].vertices, (std::array<std::uint32_t, 2>{0, 3}));
    EXPECT_EQ(mesh.subsegments[1].marker, 0);
    std::vector<int> markers;
    for (const auto& f : mesh.subfacets) markers.push_back(f.marker);
    EXPECT_EQ(markers, (std::vector<int>{4, 4, 3, 3, 3}));
    EXPECT_EQ(mesh.input_points, 0u);
  }
}

TEST(ReadMsh, AsInputItIsTheSurfaceWithSeedsForTheRegions) {
  const TempFolder folder;
  for (const MshVariant& v : msh_variants) {
    SCOPED_TRACE(v.name());
    const Plc<3> plc = read_plc<3>(folder.put("a.msh", msh_file(two_tetrahedra(), v)));
    EXPECT_EQ(plc.points.size(), 5u);
    ASSERT_EQ(plc.segments.size(), 2u);
    EXPECT_EQ(plc.segments[0].marker, -6);
    // Five facets of the file, the face between the regions and the one that the file leaves open.
    ASSERT_EQ(plc.facets.size(), 7u);
    EXPECT_EQ(plc.facets[0].polygons, (std::vector<Corners>{{2, 3, 0}}));
    EXPECT_EQ(plc.facets[0].marker, 4);
    EXPECT_EQ(plc.facets[5].polygons, (std::vector<Corners>{{0, 1, 4}}));
    EXPECT_EQ(plc.facets[6].polygons, (std::vector<Corners>{{0, 3, 4}}));
    EXPECT_EQ(plc.facets[6].marker, 0);
    ASSERT_EQ(plc.regions.size(), 2u);
    EXPECT_EQ(plc.regions[0].attribute, 7);
    EXPECT_EQ(plc.regions[0].point, (Point3{{0.25, 0.25, 0.25}}));
    EXPECT_EQ(plc.regions[1].attribute, 8);
    if (v.binary) {
      EXPECT_TRUE(plc.source.point_lines.empty());
    } else {
      EXPECT_EQ(plc.source.point_lines.size(), 5u);
      EXPECT_EQ(plc.source.facet_lines.size(), 7u);
      EXPECT_NE(plc.source.facet_lines[0], 0u);
      EXPECT_EQ(plc.source.facet_lines[6], 0u);
    }
  }
}

TEST(ReadMsh, AFlatFileIs2D) {
  MshModel m;
  m.entities[1] = {{1, {5}}};
  m.entities[2] = {{1, {6}}, {2, {7}}};
  m.nodes = {{1, {0, 0, 0}}, {2, {1, 0, 0}}, {3, {1, 1, 0}}, {4, {0, 1, 0}}};
  m.elements = {{1, 1, {1, 2}}, {2, 1, {1, 2, 3}}, {2, 2, {1, 3, 4}}};
  const TempFolder folder;
  for (const MshVariant& v : msh_variants) {
    SCOPED_TRACE(v.name());
    const auto file = folder.put("a.msh", msh_file(m, v));
    EXPECT_EQ(file_dimension(file), 2);
    EXPECT_TRUE(holds_cells(file));
    const OutputMesh<2> mesh = read_mesh<2>(file);
    EXPECT_EQ(mesh.cells.size(), 2u);
    EXPECT_EQ(mesh.regions, (std::vector<double>{6, 7}));
    EXPECT_EQ(mesh.subsegments.size(), 1u);
    const Plc<2> plc = read_plc<2>(file);
    EXPECT_EQ(plc.segments.size(), 5u);  // one of the file, three of the boundary, one between the regions
    EXPECT_EQ(plc.segments[0].marker, 5);
    EXPECT_EQ(plc.regions.size(), 2u);
    EXPECT_EQ(error_of<InputError>([&] { read_plc<3>(file); }).code, Errc::syntax);
    EXPECT_EQ(error_of<InputError>([&] { read_mesh<3>(file); }).code, Errc::syntax);
  }
}

TEST(ReadMsh, PointsOfCellsAloneAreDropped) {
  // A tetrahedron cut into four at its centre; a point of nothing, and one of a point element, both in the volume.
  MshModel m;
  m.entities[0] = {{1, {}}};
  m.entities[3] = {{1, {1}}};
  m.nodes = {{1, {0, 0, 0}}, {2, {0.25, 0.25, 0.25}}, {3, {4, 0, 0}},    {4, {0, 4, 0}},
             {5, {0, 0, 4}}, {6, {1, 0.5, 0.5}},      {7, {0.5, 1, 0.5}}};
  m.elements = {{15, 1, {7}}, {4, 1, {2, 3, 4, 5}}, {4, 1, {1, 3, 4, 2}}, {4, 1, {1, 5, 3, 2}}, {4, 1, {1, 4, 5, 2}}};
  for (const MshVariant& v : msh_variants) {
    SCOPED_TRACE(v.name());
    const Plc<3> plc = detail::read_plc_from<3>(msh_file(m, v), "a.msh");
    ASSERT_EQ(plc.points.size(), 6u);
    EXPECT_EQ(plc.points[1], (Point3{{4, 0, 0}}));
    EXPECT_EQ(plc.points[4], (Point3{{1, 0.5, 0.5}}));
    ASSERT_EQ(plc.facets.size(), 4u);
    EXPECT_EQ(plc.facets[3].polygons, (std::vector<Corners>{{1, 2, 3}}));
    ASSERT_EQ(plc.regions.size(), 1u);  // the four are one part
    EXPECT_EQ(plc.regions[0].attribute, 1);
  }
  // A file without the volume keeps them all.
  m.elements = {{15, 1, {7}}, {2, 1, {1, 3, 4}}};
  EXPECT_EQ(detail::read_plc_from<3>(msh_file(m, {}), "a.msh").points.size(), 7u);
}

TEST(ReadMsh, CellsThatAreNoSimplices) {
  MshModel m;
  m.nodes = {{1, {0, 0, 0}}, {2, {1, 0, 0}}, {3, {1, 1, 0}}, {4, {0, 1, 0}}, {5, {0, 0, 1}}, {6, {0.5, 0.5, 0.5}}};
  m.elements = {{7, 1, {1, 2, 3, 4, 5}}};
  for (const MshVariant& v : msh_variants) {
    EXPECT_EQ(error_of<InputError>([&] { detail::read_mesh_from<3>(msh_file(m, v), "a.msh"); }).code, Errc::unknown_format);
    EXPECT_EQ(error_of<InputError>([&] { detail::read_plc_from<3>(msh_file(m, v), "a.msh"); }).code, Errc::unknown_format);
  }
  m.elements.push_back({3, 1, {1, 2, 3, 4}});
  const Plc<3> plc = detail::read_plc_from<3>(msh_file(m, {}), "a.msh");
  ASSERT_EQ(plc.facets.size(), 1u);
  EXPECT_EQ(plc.facets[0].polygons, (std::vector<Corners>{{0, 1, 2, 3}}));
  EXPECT_EQ(plc.points.size(), 5u);            // the apex goes, the point of nothing stays
  m.elements = {{17, 1, {1, 2, 3, 4, 5, 6}}};  // hexahedra of second order
  const auto error = error_of<InputError>([&] { detail::read_plc_from<3>(msh_file(m, {2}), "a.msh"); });
  EXPECT_EQ(error.code, Errc::unknown_format);
  EXPECT_NE(error.message.find("type 17"), std::string::npos);
}

/// Tetrahedra, triangles and lines of second order count by their corners, and nodes that are no corners of anything go.
TEST(ReadMsh, SecondOrder) {
  MshModel m;
  const std::array<Point3, 4> corners{{{{0, 0, 0}}, {{2, 0, 0}}, {{0, 2, 0}}, {{0, 0, 2}}}};
  m.nodes = {{1, {0, 0, 0}}, {5, {1, 0, 0}}, {2, {2, 0, 0}},  {6, {1, 1.5, 0}}, {3, {0, 2, 0}}, {7, {0, 1, 0}},
             {8, {0, 0, 1}}, {9, {0, 1, 1}}, {10, {1, 0, 1}}, {4, {0, 0, 2}},   {11, {9, 9, 9}}};
  m.elements = {{8, 1, {1, 2, 5}}, {9, 1, {1, 2, 3, 5, 6, 7}}, {11, 1, {1, 2, 3, 4, 5, 6, 7, 8, 9, 10}}};
  for (const MshVariant& v : msh_variants) {
    const auto mesh = detail::read_mesh_from<3>(msh_file(m, v), "a.msh");
    ASSERT_EQ(mesh.points.size(), 5u);  // in the order of their tags, with the one that nothing has
    for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(mesh.points[i], corners[i]);
    ASSERT_EQ(mesh.cells.size(), 1u);
    EXPECT_EQ(mesh.cells[0], (std::array<std::uint32_t, 4>{0, 1, 2, 3}));
    ASSERT_EQ(mesh.subfacets.size(), 1u);
    EXPECT_EQ(mesh.subfacets[0].vertices, (std::array<std::uint32_t, 3>{0, 1, 2}));
    ASSERT_EQ(mesh.subsegments.size(), 1u);
    EXPECT_EQ(mesh.subsegments[0].vertices, (std::array<std::uint32_t, 2>{0, 1}));
    const auto plc = detail::read_plc_from<3>(msh_file(m, v), "a.msh");
    EXPECT_EQ(plc.points.size(), 5u);
    EXPECT_EQ(plc.facets.size(), 4u);
  }
  m.elements.push_back({1, 1, {5, 11}});  // what is a corner of something stays
  EXPECT_EQ(detail::read_mesh_from<3>(msh_file(m, {}), "a.msh").points.size(), 6u);
  m.elements = {{11, 1, {1, 2, 3, 4, 5, 6, 7, 8, 9, 77}}};
  EXPECT_EQ(error_of<InputError>([&] { detail::read_mesh_from<3>(msh_file(m, {}), "a.msh"); }).code, Errc::index_out_of_range);
}

TEST(ReadMsh, MistakesAreNamed) {
  const auto expect = [](int version, const std::string& from, const std::string& to, Errc code, std::uint64_t later = 1) {
    SCOPED_TRACE(from + " -> " + to);
    std::string text = msh_file(two_tetrahedra(), {version});
    const std::size_t at = text.find(from);
    ASSERT_NE(at, std::string::npos) << text;
    text.replace(at, from.size(), to);
    const std::string before = text.substr(0, at);
    const auto line = static_cast<std::uint64_t>(std::count(before.begin(), before.end(), '\n')) + 1;
    const auto error = error_of<InputError>([&] { detail::read_mesh_from<3>(text, "a.msh"); });
    EXPECT_EQ(name(error.code), name(code)) << error.message;
    EXPECT_GE(error.line, line) << error.message;
    EXPECT_LE(error.line, line + later) << error.message;
  };
  expect(2, "$MeshFormat", "$MeshFromat", Errc::unknown_format);
  expect(2, "2.2 0 8", "1.0 0 8", Errc::unknown_format);
  expect(2, "2.2 0 8", "2.2 2 8", Errc::syntax);
  expect(2, "2.2 0 8", "2.2 0 4", Errc::syntax);
  expect(4, "4.1 0 8", "4.0 0 8", Errc::unknown_format);
  expect(4, "$Entities", "$PartitionedEntities", Errc::unknown_format);
  expect(4, "$EndNodes", "$EndNotes", Errc::syntax);
  expect(4, "$EndPhysicalNames", "2 2 none\n$EndPhysicalNames", Errc::syntax);
  expect(4, "\"first\"", "first", Errc::syntax);
  expect(4, "pgdr marker -6", "pgdr marker six", Errc::syntax);
  expect(2, "$Nodes\n5", "$Nodes\n1000000000", Errc::count_too_large);
  expect(2, "$Elements\n11", "$Elements\n1000000000", Errc::count_too_large);
  expect(4, "$Nodes\n2 5", "$Nodes\n2 1000000000", Errc::count_too_large);
  expect(4, "$Nodes\n2 5", "$Nodes\n2 4", Errc::syntax, 7);
  expect(4, "$Elements\n11 11", "$Elements\n11 1000000000", Errc::count_too_large);
  expect(4, "$Elements\n11 11", "$Elements\n11 10", Errc::syntax, 22);
  expect(2, "5 0.75", "10 0.75", Errc::syntax);  // a tag twice
  expect(2, "5 0.75", "-5 0.75", Errc::syntax);
  expect(2, "5 0.75", "5 nan", Errc::not_finite);
  expect(2, "11 4 2 8 2 3", "11 4 2 8 2 4", Errc::index_out_of_range);
  expect(2, "11 4 2 8 2 3", "11 4 2 8 2 3 3", Errc::syntax);
  expect(2, "11 4 2 8", "11 44 2 8", Errc::unknown_format);
  expect(4, "3 2 4 1", "2 2 4 1", Errc::syntax);  // a tetrahedron is not of dimension 2
}

TEST(ReadMsh, SectionsThatAreUnknownAreSkipped) {
  MshModel m = two_tetrahedra();
  m.other_sections = "$ElementData\n1\n\"$Nodes # of it\"\n$EndElementData\n";
  for (const MshVariant& v : msh_variants) EXPECT_EQ(detail::read_mesh_from<3>(msh_file(m, v), "a.msh").cells.size(), 2u);
  m.other_sections += "$Nodes\n0\n$EndNodes\n";
  EXPECT_EQ(error_of<InputError>([&] { detail::read_mesh_from<3>(msh_file(m, {}), "a.msh"); }).code, Errc::syntax);
}

TEST(ReadMedit, VoidsOfCellsAreHoles) {
  // A ring of eight triangles, and a part of its own inside of it.
  std::string text = "MeshVersionFormatted 2\nDimension 2\nVertices 11\n";
  for (const int side : {3, 1}) {
    const int low = side == 3 ? 0 : 1, high = low + side;
    for (const auto& [x, y] : {std::pair{low, low}, {high, low}, {high, high}, {low, high}})
      text += std::to_string(x) + " " + std::to_string(y) + " 0\n";
  }
  text += "1.25 1.25 0\n1.5 1.25 0\n1.25 1.5 0\nTriangles 9\n";
  for (int i = 0; i < 4; ++i) {
    const int j = (i + 1) % 4, a = i + 1, b = j + 1, c = i + 5, d = j + 5;
    for (const auto& t : {std::array{a, b, d}, std::array{a, d, c}}) {
      for (const int v : t) text += std::to_string(v) + " ";
      text += "5\n";
    }
  }
  text += "9 10 11 6\nEnd\n";
  const Plc<2> plc = detail::read_plc_from<2>(text, "a.mesh");
  EXPECT_EQ(plc.segments.size(), 11u);
  ASSERT_EQ(plc.regions.size(), 2u);
  EXPECT_EQ(plc.regions[1].attribute, 6);
  ASSERT_EQ(plc.holes.size(), 1u);  // the ring encloses a void; what lies in the void encloses none
  const Point2 hole = plc.holes[0];
  EXPECT_TRUE(hole[0] > 1 && hole[0] < 2 && hole[1] > 1 && hole[1] < 2);
  EXPECT_FALSE(hole[0] >= 1.25 && hole[1] >= 1.25 && hole[0] + hole[1] <= 2.75);

  // The void without the part, with its walls listed: the same.
  const std::size_t at = text.find("9 10 11 6");
  std::string listed = text.substr(0, at) + "Edges 4\n5 6 7\n6 7 7\n7 8 7\n8 5 7\nEnd\n";
  listed.replace(listed.find("Triangles 9"), 11, "Triangles 8");
  const Plc<2> again = detail::read_plc_from<2>(listed, "a.mesh");
  EXPECT_EQ(again.segments.size(), 8u);
  EXPECT_EQ(again.holes.size(), 1u);
}

const std::string medit_surface =
    "MeshVersionFormatted 2\nDimension 3\nVertices 5\n0 0 0 1\n4 0 0 2\n0 4 0 3\n0 0 4 4\n1 1 1 5\n"
    "Edges 1\n1 2 9\nTriangles 3\n1 3 2 -5\n1 2 4 6\n1 4 3 7\nQuadrilaterals 1\n2 3 5 4 8\n";

TEST(ReadMedit, AsInput) {
  const TempFolder folder;
  const auto file = folder.put("a.mesh", medit_surface + "End\n");
  EXPECT_EQ(file_dimension(file), 3);
  EXPECT_FALSE(holds_cells(file));
  const Plc<3> plc = read_plc<3>(file);
  EXPECT_EQ(plc.points.size(), 5u);
  EXPECT_EQ(plc.point_markers, (std::vector<int>{1, 2, 3, 4, 5}));
  EXPECT_EQ(plc.first_index, 1u);
  ASSERT_EQ(plc.segments.size(), 1u);
  EXPECT_EQ(plc.segments[0].marker, 9);
  ASSERT_EQ(plc.facets.size(), 4u);
  EXPECT_EQ(plc.facets[0].marker, -5);
  EXPECT_EQ(plc.facets[3].polygons, (std::vector<Corners>{{1, 2, 4, 3}}));
  EXPECT_EQ(plc.facets[3].marker, 8);
  EXPECT_EQ(plc.source.point_lines, (Corners{4, 5, 6, 7, 8}));
  EXPECT_EQ(plc.source.segment_lines, (Corners{10}));
  EXPECT_EQ(plc.source.facet_lines, (Corners{12, 13, 14, 16}));
  EXPECT_EQ(error_of<InputError>([&] { read_plc<2>(file); }).code, Errc::syntax);
}

TEST(ReadMedit, PointsThatAreRequiredAreKept) {
  const std::string cells = medit_surface + "Tetrahedra 1\n1 2 3 5 2\n";
  EXPECT_EQ(detail::read_plc_from<3>(cells + "End\n", "a.mesh").points.size(), 5u);  // a corner of the quadrilateral
  const std::string without = cells.substr(0, cells.find("Quad")) + "Tetrahedra 1\n1 2 3 5 2\n";
  EXPECT_EQ(detail::read_plc_from<3>(without + "End\n", "a.mesh").facets.size(), 6u);  // with three faces of the cell
  const std::string flat =
      "MeshVersionFormatted 2\nDimension 2\nVertices 4\n0 0 0\n4 0 0\n0 4 0\n1 1 0\n"
      "Triangles 3\n1 2 4 0\n2 3 4 0\n3 1 4 0\n";
  const Plc<2> dropped = detail::read_plc_from<2>(flat + "End\n", "a.mesh");
  EXPECT_EQ(dropped.points.size(), 3u);
  EXPECT_EQ(dropped.segments.size(), 3u);
  EXPECT_TRUE(dropped.regions.empty());
  EXPECT_EQ(detail::read_plc_from<2>(flat + "RequiredVertices 1\n4\nEnd\n", "a.mesh").points.size(), 4u);
}

TEST(ReadMedit, AFlatFileWithoutCellsIs2D) {
  const TempFolder folder;
  const auto file = folder.put("a.mesh",
                               "MeshVersionFormatted 2\nDimension 3\nVertices 3\n0 0 0 0\n1 0 0 0\n0 1 0 0\n"
                               "Edges 3\n1 2 3\n2 3 3\n3 1 4\nEnd\n");
  EXPECT_EQ(file_dimension(file), 2);
  EXPECT_EQ(read_plc<2>(file).segments.size(), 3u);
  EXPECT_FALSE(holds_cells(file));
}

TEST(ReadTetgen, ForeignFiles) {
  const TempFolder folder;
  folder.put("a.node", "# by another program\n4 3 2 1\n0 0 0 0 0.5 1 7\n1 1 0 0 0.5 1 0\n2 0 1 0 0.5 1 0\n3 0 0 1 0.5 1 -1\n");
  folder.put("a.ele", "1 4 2\n  0  0 1 2 3  2.5 9 # a comment\n# Generated by tetgen\n");
  const OutputMesh<3> bare = read_mesh<3>(folder / "a.node");
  EXPECT_TRUE(bare.subfacets.empty());
  EXPECT_TRUE(bare.subsegments.empty());
  folder.put("a.face", "2 1\n0 0 1 2 5 -1 0\n1 0 1 3 -6 0 -1\n");
  folder.put("a.edge", "1 0\n0 0 1 5\n");
  const OutputMesh<3> mesh = read_mesh<3>(folder / "a.ele");
  EXPECT_EQ(mesh.point_markers, (std::vector<int>{7, 0, 0, -1}));
  EXPECT_EQ(mesh.cells, (std::vector<std::array<std::uint32_t, 4>>{{0, 1, 2, 3}}));
  EXPECT_EQ(mesh.regions, (std::vector<double>{2.5}));
  ASSERT_EQ(mesh.subfacets.size(), 2u);
  EXPECT_EQ(mesh.subfacets[1].marker, -6);
  ASSERT_EQ(mesh.subsegments.size(), 1u);
  EXPECT_EQ(mesh.subsegments[0].marker, 0);  // the header says that there are none

  EXPECT_EQ(file_dimension(folder / "a.ele"), 3);
  EXPECT_TRUE(holds_cells(folder / "a.ele"));
  EXPECT_FALSE(holds_cells(folder / "a.node"));
  EXPECT_EQ(error_of<InputError>([&] { read_mesh<2>(folder / "a.ele"); }).code, Errc::syntax);
  folder.put("a.ele", "1 10 0\n0 0 1 2 3 0 1 2 3 0 1\n");  // of second order, whose nodes are corners, too
  EXPECT_EQ(read_mesh<3>(folder / "a.ele").cells, mesh.cells);
  EXPECT_EQ(read_mesh<3>(folder / "a.ele").points, mesh.points);
  folder.put("a.ele", "1 8 0\n0 0 1 2 3 0 1 2 3\n");
  EXPECT_EQ(error_of<InputError>([&] { read_mesh<3>(folder / "a.ele"); }).code, Errc::unknown_format);
  folder.put("a.ele", "1 4 0\n0 0 1 2 4\n");
  const auto error = error_of<InputError>([&] { read_mesh<3>(folder / "a.node"); });
  EXPECT_EQ(error.code, Errc::index_out_of_range);
  EXPECT_EQ(error.file, (folder / "a.ele").string());
  EXPECT_EQ(error.line, 2u);
  std::filesystem::remove(folder / "a.ele");
  EXPECT_EQ(error_of<FileError>([&] { read_mesh<3>(folder / "a.node"); }).file, (folder / "a.ele").string());
}

TEST(WriteTetgen, TextIsWhatOthersExpect) {
  OutputMesh<3> mesh;
  mesh.points = {{{0, 0, 0}}, {{1, 0, 0}}, {{0, 1, 0}}, {{0, 0, 0.1}}};
  mesh.input_points = 4;
  mesh.point_markers = {1, 0, 0, -2};
  mesh.cells = {{0, 1, 2, 3}};
  mesh.regions = {7.5};
  mesh.subfacets = {{{0, 1, 2}, -3}};
  mesh.subsegments = {{{2, 3}, 4}};
  const TempFolder folder;
  write_mesh<3>(mesh, folder / "a.b.node");
  EXPECT_EQ(content(folder / "a.b.node"), "# pgdr input_points 4\n4 3 0 1\n1 0 0 0 1\n2 1 0 0 0\n3 0 1 0 0\n4 0 0 0.1 -2\n");
  EXPECT_EQ(content(folder / "a.b.ele"), "1 4 1\n1 1 2 3 4 7.5\n");
  EXPECT_EQ(content(folder / "a.b.face"), "1 1\n1 1 2 3 -3\n");
  EXPECT_EQ(content(folder / "a.b.edge"), "1 1\n1 3 4 4\n");
  EXPECT_EQ(files_of_mesh(folder / "a.b.ele").size(), 4u);
  EXPECT_EQ(files_of_mesh(folder / "a.b.ele", {1, false, true}).back(), (folder / "a.b.neigh").string());
  mesh.point_attributes = {0.5, 1, -1, 2, 0, 3, 1e100, 4};
  write_mesh<3>(mesh, folder / "a.b.node", {0, true, true});
  EXPECT_EQ(content(folder / "a.b.node"),
            "# pgdr input_points 4\n4 3 2 1\n0 0 0 0 0.5 1 1\n1 1 0 0 -1 2 0\n2 0 1 0 0 3 0\n3 0 0 0.1 1e+100 4 -2\n");
  EXPECT_EQ(content(folder / "a.b.ele"), "1 4 1\n0 0 1 2 3 7.5\n");
  EXPECT_EQ(content(folder / "a.b.edge"), "# pgdr subsegments 1\n6 1\n0 2 3 4\n1 0 1 0\n2 0 2 0\n3 0 3 0\n4 1 2 0\n5 1 3 0\n");
  EXPECT_EQ(content(folder / "a.b.neigh"), "1 4\n0 -1 -1 -1 -1\n");
  EXPECT_EQ(files_of_mesh(folder / "a.b.vtu"), (std::vector<std::string>{(folder / "a.b.vtu").string()}));
}

/// Triangle's: the first neighbour is opposite the first corner, and so on.
TEST(WriteTetgen, NeighborsAreOppositeTheCorners) {
  OutputMesh<2> mesh;
  mesh.points = {{{0, 0}}, {{1, 0}}, {{1, 1}}, {{0, 1}}, {{0.5, 0.5}}};
  mesh.cells = {{4, 0, 1}, {4, 1, 2}, {2, 3, 4}, {0, 4, 3}};
  const TempFolder folder;
  write_mesh<2>(mesh, folder / "a.ele", {1, false, true});
  EXPECT_EQ(content(folder / "a.neigh"), "4 3\n1 -1 2 4\n2 -1 3 1\n3 4 2 -1\n4 3 -1 1\n");
  std::filesystem::remove(folder / "a.neigh");
  write_mesh<2>(mesh, folder / "a.ele");
  EXPECT_FALSE(std::filesystem::exists(folder / "a.neigh"));
}

/// Any mesh, through any formats one after the other, stays what it was, but for labels that are all 0.
template <int D>
void expect_to_survive_all_formats() {
  const TempFolder folder;
  const std::string extensions[] = {".vtu", ".msh", ".mesh", ".node"};
  constexpr std::uint64_t seed = 20260102;
  std::mt19937_64 random(seed);
  for (int trial = 0; trial < 60; ++trial) {
    SCOPED_TRACE("trial " + std::to_string(trial));
    OutputMesh<D> mesh = some_mesh<D>(random(), 4 + random() % 60);
    const auto small = [&random] { return static_cast<int>(random() % 7) - 3; };
    if (trial % 2 == 0) {  // labels that many have, as in real meshes; each kind with a label that is not 0
      for (auto& m : mesh.point_markers) m = small();
      mesh.point_markers[0] = 1;
      for (auto& r : mesh.regions) r = trial % 4 == 0 ? 0.5 * small() + 0.0 : small() + 0.0;
      mesh.regions[0] = trial % 3 == 0 ? 1e-300 : 2;
      for (auto& s : mesh.subsegments) s.marker = small();
      for (auto& f : mesh.subfacets) f.marker = small();
    }
    if (trial % 5 == 0) mesh.regions.clear();
    if (trial % 7 == 0) mesh.point_markers.clear();
    OutputMesh<D> copy = mesh;
    for (int step = 0; step < 4; ++step) {
      const std::string extension = extensions[random() % 4];
      const auto file = folder / ("a" + extension);
      write_mesh<D>(copy, file);
      copy = read_mesh<D>(file);
      if (extension == ".msh") mesh = as_msh<D>(mesh);
    }
    expect_same(copy, mesh);
    ASSERT_FALSE(testing::Test::HasFailure()) << "seed " << seed;
  }
}

TEST(AllFormats, MeshesSurviveThemIn3D) { expect_to_survive_all_formats<3>(); }
TEST(AllFormats, MeshesSurviveThemIn2D) { expect_to_survive_all_formats<2>(); }

}  // namespace pgdr::test::test_io_formats
