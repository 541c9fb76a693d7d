// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Names of labels and markers: out of files, through all formats and back, and what formats that cannot hold them make of them.
#include <algorithm>

#include "io/formats.hpp"
#include "io/write/valid_names.hpp"
#include "pgdr/mesh_piece.hpp"
#include "scan/clean_name.hpp"
#include "test_io_support.hpp"

namespace pgdr::test::test_io_names {

using Markers = std::map<int, std::string>;
using Regions = std::map<double, std::string>;

template <int D>
std::vector<int> facet_markers(const Plc<D>& plc) {
  std::vector<int> markers;
  for (const auto& f : plc.facets) markers.push_back(f.marker);
  return markers;
}

TEST(Names, AreCleaned) {
  EXPECT_EQ(detail::clean_name("  two words\t\r"), "two words");
  EXPECT_EQ(detail::clean_name("a\nb"), "a b");
  EXPECT_EQ(detail::clean_name("\x01 \x7f"), "");
  EXPECT_EQ(detail::clean_name("K\xc3\xb6rper \xe2\x88\x86 \xf0\x9f\x94\xa9"), "K\xc3\xb6rper \xe2\x88\x86 \xf0\x9f\x94\xa9");
  EXPECT_EQ(detail::clean_name("K\xf6rper"), "K\xc3\xb6rper") << "Latin-1";
  EXPECT_EQ(detail::clean_name("\xc0\xaf"), "\xc3\x80\xc2\xaf") << "an overlong '/' is no UTF-8";
  EXPECT_EQ(detail::clean_name("a\xc2\x85z"), "a z") << "a control character of two bytes";
  EXPECT_EQ(detail::clean_name("\xed\xa0\x80"), "\xc3\xad\xc2\xa0") << "half of a pair of UTF-16";
}

TEST(ReadStl, SolidsHaveNames) {
  const TempFolder folder;
  const Plc<3> two = read_plc<3>(folder.put("two.stl", ascii_stl));
  EXPECT_EQ(facet_markers(two), (std::vector<int>{1, 2}));
  EXPECT_EQ(two.names.markers, (Markers{{1, "first # of two"}}));
  EXPECT_EQ(two.facet_bodies, (std::vector<std::uint32_t>{0, 1}));
  EXPECT_EQ(two.body_names, (std::vector<std::string>{"first # of two", "solid 2"}));

  const std::string facet = ascii_stl.substr(ascii_stl.find("  facet"), ascii_stl.find("endsolid") - ascii_stl.find("  facet"));
  const Plc<3> one = read_plc<3>(folder.put("one.stl", "solid Gear box\n" + facet + "endsolid\n"));
  EXPECT_EQ(facet_markers(one), (std::vector<int>{1}));
  EXPECT_EQ(one.names.markers, (Markers{{1, "Gear box"}}));
  EXPECT_TRUE(one.facet_bodies.empty() && one.body_names.empty());
  const Plc<3> none = read_plc<3>(folder.put("none.stl", "solid \n" + facet + "endsolid\n"));
  EXPECT_EQ(facet_markers(none), (std::vector<int>{0}));
  EXPECT_TRUE(none.names.empty());
}

TEST(ReadStl, AHeaderMayBeAName) {
  const TempFolder folder;
  const std::vector<std::array<float, 9>> triangles{{0, 0, 0, 1, 0, 0, 0, 1, 0}};
  const auto names = [&](const std::string& header) {
    return read_plc<3>(folder.put("a.stl", binary_stl(header, triangles))).names.markers;
  };
  EXPECT_EQ(names("solid Housing left"), (Markers{{1, "Housing left"}}));
  EXPECT_EQ(names("solid"), Markers{});
  EXPECT_EQ(names("STL file of a program"), Markers{});
  EXPECT_EQ(names("solid COLOR=\xff\x01\x02\x03"), Markers{}) << "no text";
}

TEST(ReadObj, GroupsObjectsAndMaterialsAreMarkers) {
  const TempFolder folder;
  const std::string points = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n";
  const auto read = [&](const std::string& faces) { return read_plc<3>(folder.put("a.obj", points + faces)); };
  const Plc<3> groups = read("f 1 2 3\ng wall left\nf 1 2 4\ng lid\nf 1 3 4\ng wall left\nf 2 3 4\n");
  EXPECT_EQ(facet_markers(groups), (std::vector<int>{0, 1, 2, 1}));
  EXPECT_EQ(groups.names.markers, (Markers{{1, "wall left"}, {2, "lid"}}));

  const Plc<3> materials = read("o Cube\nusemtl red\nf 1 2 3\nf 1 2 4\nusemtl blue\nf 1 3 4\nf 2 3 4\n");
  EXPECT_EQ(facet_markers(materials), (std::vector<int>{1, 1, 2, 2}));
  EXPECT_EQ(materials.names.markers, (Markers{{1, "red"}, {2, "blue"}})) << "the object is the same everywhere";

  const Plc<3> both = read("o A\nusemtl m\nf 1 2 3\nusemtl n\nf 1 2 4\no B\nf 1 3 4\nusemtl m\nf 2 3 4\n");
  EXPECT_EQ(both.names.markers, (Markers{{1, "A/m"}, {2, "A/n"}, {3, "B/n"}, {4, "B/m"}}));

  const Plc<3> one = read("o Cube\nusemtl red\nf 1 2 3\nf 1 2 4\nf 1 3 4\nf 2 3 4\n");
  EXPECT_EQ(one.names.markers, (Markers{{1, "Cube"}}));
  const Plc<3> none = read("g default\nf 1 2 3\ng\nf 1 2 4\nf 1 3 4\nf 2 3 4\n");
  EXPECT_EQ(facet_markers(none), (std::vector<int>{0, 0, 0, 0}));
  EXPECT_TRUE(none.names.empty());
}

/// A square of two triangles in a box of gmsh's version 2, with groups of three dimensions that have the same number.
const std::string msh_of_groups =
    "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n"
    "$PhysicalNames\n5\n0 5 \"corner\"\n1 5 \"edge\"\n2 5 \"wall\"\n2 6 \"lid\"\n3 5 \"steel K\xf6rper\"\n$EndPhysicalNames\n"
    "$Nodes\n4\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n$EndNodes\n"
    "$Elements\n7\n1 15 2 5 1 1\n2 1 2 5 1 1 2\n3 2 2 5 1 1 3 2\n4 2 2 6 1 1 2 4\n5 2 2 5 1 1 4 3\n6 2 2 9 1 2 3 4\n7 4 2 5 1 1 "
    "2 3 4\n"
    "$EndElements\n";

TEST(ReadMsh, GroupsAreNames) {
  const TempFolder folder;
  const auto file = folder.put("a.msh", msh_of_groups);
  // A marker has one name, so that curves and points of the number 5 get the least that are free.
  const Names names{{{5, "steel K\xc3\xb6rper"}}, {{5, "wall"}, {6, "lid"}, {1, "edge"}, {2, "corner"}}};
  const OutputMesh<3> mesh = read_mesh<3>(file);
  EXPECT_EQ(mesh.names, names);
  EXPECT_EQ(mesh.subsegments.front().marker, 1);
  EXPECT_EQ(mesh.point_markers, (std::vector<int>{2, 0, 0, 0}));
  EXPECT_EQ(mesh.regions, (std::vector<double>{5}));
  const Plc<3> plc = read_plc<3>(file);
  EXPECT_EQ(plc.names, names);
  EXPECT_EQ(facet_markers(plc), (std::vector<int>{5, 6, 5, 9}));
  EXPECT_EQ(plc.segments.front().marker, 1);

  std::string surface = msh_of_groups;  // without the cell
  surface.replace(surface.find("\n7 4 2 5 1 1 2 3 4"), 18, "");
  surface.replace(surface.find("$Elements\n7"), 11, "$Elements\n6");
  EXPECT_TRUE(read_plc<3>(folder.put("b.msh", surface)).names.regions.empty()) << "nothing has the label";
}

template <int D>
OutputMesh<D> named_mesh() {
  OutputMesh<D> mesh = some_mesh<D>(7);
  mesh.names.regions = {{-2, "K\xc3\xb6rper <1> & \"2\""}, {0, "air"}, {2, "dimension"}};
  mesh.names.markers = {
      {mesh.subsegments[0].marker, "wall # 1"}, {mesh.subsegments[1].marker, "air"}, {mesh.point_markers[0], "tip"}};
  if constexpr (D == 3) mesh.names.markers[mesh.subfacets[0].marker] = "pgdr marker 5";
  return mesh;
}

template <int D>
class NamedMesh : public testing::Test {};
template <class D>
class NamesIn : public testing::Test {};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(NamesIn, Dimensions);

TYPED_TEST(NamesIn, FilesComeBack) {
  constexpr int D = TypeParam::value;
  const TempFolder folder;
  const OutputMesh<D> mesh = named_mesh<D>();
  for (const char* name : {"a.vtu", "a.pvtu", "a.mesh", "a.node"}) {
    SCOPED_TRACE(name);
    write_mesh<D>(mesh, folder / name, {.pieces = 3});
    const OutputMesh<D> again = read_mesh<D>(folder / name);
    EXPECT_EQ(again.names, mesh.names);
    expect_same<D>(again, mesh);
    EXPECT_TRUE(unfit_names(mesh.names, folder / name).empty());
  }
  // What .msh cannot hold as it is: double quotes, and what stands for labels without a name.
  write_mesh<D>(mesh, folder / "a.msh");
  Names written = mesh.names;
  written.regions[-2] = "K\xc3\xb6rper <1> & '2'";
  if constexpr (D == 3) written.markers[mesh.subfacets[0].marker] = "pgdr_marker 5";
  const OutputMesh<D> again = read_mesh<D>(folder / "a.msh");
  EXPECT_EQ(again.names, written);
  expect_same<D>(again, as_msh(mesh));
  EXPECT_EQ(unfit_names(mesh.names, folder / "a.msh").size(), D == 3 ? 2u : 1u);
}

TYPED_TEST(NamesIn, PiecesStay) {
  constexpr int D = TypeParam::value;
  const OutputMesh<D> mesh = named_mesh<D>();
  std::vector<MeshPiece<D>> pieces;
  for (std::uint64_t k = 0; k < 3; ++k) pieces.push_back(piece_of<D>(mesh, k, 3));
  for (const auto& piece : pieces) EXPECT_EQ(piece.mesh.names, mesh.names);
  EXPECT_EQ(join_pieces<D>(pieces).names, mesh.names);
  pieces[1].mesh.names.markers.clear();
  EXPECT_EQ(error_of<InputError>([&] { join_pieces<D>(pieces); }).code, Errc::syntax);
}

TEST(Names, NoNameNoChange) {
  const TempFolder folder;
  const OutputMesh<3> mesh = some_mesh<3>(3);
  OutputMesh<3> named = mesh;
  named.names.markers[17] = "a marker that nothing has";
  write_mesh<3>(mesh, folder / "a.msh");
  write_mesh<3>(named, folder / "b.msh");
  EXPECT_EQ(content(folder / "a.msh"), content(folder / "b.msh"));
}

TEST(Names, WhatAFormatCannotHoldIsMadeValid) {
  Names names;
  const std::string longest(90, 'x');
  names.regions = {{1, "Gear A"},      {2, "gear a"},  {3, "GEAR_A"},        {4, longest},
                   {5, longest + "y"}, {6, "3 bolts"}, {7, "K\xc3\xb6rper"}, {8, "\xc3\x96l"}};
  const auto made = [&](const char* file) {
    std::vector<std::string> all;
    for (const auto& [label, name] : detail::valid_names(names, detail::name_rule(file)).regions) all.push_back(name);
    return all;
  };
  const std::string eighty(80, 'x'), shorter(78, 'x');
  EXPECT_EQ(made("a.inp"), (std::vector<std::string>{"Gear_A_2", "gear_a_3", "GEAR_A", eighty, shorter + "_2", "SET_3_bolts",
                                                     "K_rper", "SET__l"}));
  EXPECT_EQ(made("case/constant/polyMesh"), (std::vector<std::string>{"Gear_A", "gear_a", "GEAR_A", longest, longest + "y",
                                                                      "part_3_bolts", "K_rper", "part__l"}));
  EXPECT_EQ(made("polyMesh/"), made("polyMesh"));
  // CalculiX wants other names for surfaces than for element sets.
  const Names both{{{1, "lid"}, {2, "Lid_SURFACE"}}, {{1, "LID"}, {2, "wall"}}};
  EXPECT_EQ(detail::valid_names(both, detail::abaqus_names).markers, (Markers{{1, "LID_SURFACE_2"}, {2, "wall"}}));
  EXPECT_EQ(detail::valid_names(both, detail::foam_names), both);
  const auto warnings = unfit_names(names, "a.inp");
  ASSERT_EQ(warnings.size(), 7u) << "one is valid";
  EXPECT_EQ(warnings[0].code, Errc::unfit_name);
  EXPECT_EQ(warnings[0].message,
            "the name \"Gear A\" of region 1 cannot be written to this file as it is; it is \"Gear_A_2\" there");
}

/// Two tetrahedra with the wall between them, and names.
OutputMesh<3> two_cells() {
  OutputMesh<3> mesh;
  mesh.points = {{{0, 0, 0}}, {{1, 0, 0}}, {{0, 1, 0}}, {{0, 0, 1}}, {{0.1234567890123456789, -1e-7, -1.2345678901234567e-5}},
                 {{9, 9, 9}}};
  mesh.points[4] = {{1.0000000000000002, 1.0000000000000002, -1.2345678901234567e-5}};
  mesh.cells = {{0, 1, 2, 3}, {2, 1, 4, 3}};
  mesh.regions = {2.5, 1};
  mesh.subfacets = {{{0, 1, 2}, 7}, {{1, 2, 3}, -3}, {{2, 3, 4}, 0}};
  mesh.subsegments = {{{0, 1}, 4}};
  mesh.names = {{{2.5, "Gear box"}, {1, "air"}}, {{7, "in let"}, {-3, "interface"}}};
  return mesh;
}

TEST(WriteAbaqus, HasSets) {
  const TempFolder folder;
  write_mesh<3>(two_cells(), folder / "a.inp");
  EXPECT_EQ(
      content(folder / "a.inp"),
      "*HEADING\npgdr\n*NODE\n1, 0, 0, 0\n2, 1, 0, 0\n3, 0, 1, 0\n4, 0, 0, 1\n"
      "5, 1.0000000000000002, 1.0000000000000002, -1.2345678901235e-05\n6, 9, 9, 9\n"
      "*ELEMENT, TYPE=C3D4, ELSET=air\n2, 3, 2, 5, 4\n*ELEMENT, TYPE=C3D4, ELSET=Gear_box\n1, 1, 2, 3, 4\n"
      "*NSET, NSET=interface\n2, 3, 4\n*NSET, NSET=MARKER_0\n3, 4, 5\n*NSET, NSET=MARKER_4\n1, 2\n*NSET, NSET=in_let\n1, 2, 3\n"
      "*SURFACE, NAME=interface, TYPE=ELEMENT\n1, S3\n*SURFACE, NAME=MARKER_0, TYPE=ELEMENT\n2, S4\n"
      "*SURFACE, NAME=in_let, TYPE=ELEMENT\n1, S1\n");
}

TEST(WriteAbaqus, HasSetsInThePlane) {
  const TempFolder folder;
  OutputMesh<2> mesh;
  mesh.points = {{{0, 0}}, {{1, 0}}, {{0, 1}}, {{1, 1}}};
  mesh.cells = {{0, 1, 2}, {1, 3, 2}};
  mesh.subsegments = {{{0, 1}, 1}, {{1, 2}, 0}, {{1, 3}, 2}};
  write_mesh<2>(mesh, folder / "a.inp");
  EXPECT_EQ(content(folder / "a.inp"),
            "*HEADING\npgdr\n*NODE\n1, 0, 0\n2, 1, 0\n3, 0, 1\n4, 1, 1\n"
            "*ELEMENT, TYPE=CPS3, ELSET=REGION_0\n1, 1, 2, 3\n2, 2, 4, 3\n"
            "*NSET, NSET=MARKER_0\n2, 3\n*NSET, NSET=MARKER_1\n1, 2\n*NSET, NSET=MARKER_2\n2, 4\n"
            "*SURFACE, NAME=MARKER_0, TYPE=ELEMENT\n1, S2\n*SURFACE, NAME=MARKER_1, TYPE=ELEMENT\n1, S1\n"
            "*SURFACE, NAME=MARKER_2, TYPE=ELEMENT\n2, S1\n");
}

TEST(WriteMfem, HasAttributesAndSets) {
  const TempFolder folder;
  OutputMesh<3> mesh = two_cells();
  write_mesh<3>(mesh, folder / "a.mfem");
  const std::string text = content(folder / "a.mfem");
  EXPECT_TRUE(
      text.starts_with("MFEM mesh v1.3\n\ndimension\n3\n\nelements\n2\n2 4 0 1 2 3\n1 4 2 1 4 3\n\n"
                       "attribute_sets\n2\n\"Gear box\" 1 2\n\"air\" 1 1\n\n"
                       "boundary\n3\n7 2 0 1 2\n1 2 1 2 3\n2 2 2 3 4\n\n"
                       "bdr_attribute_sets\n3\n\"in let\" 1 7\n\"interface\" 1 1\n\"marker 0\" 1 2\n\nvertices\n6\n3\n0 0 0\n"))
      << text;
  EXPECT_TRUE(text.ends_with("\nmfem_mesh_end\n"));
  mesh.names = {};
  mesh.regions = {1, 2};
  for (auto& f : mesh.subfacets) f.marker = 3;
  write_mesh<3>(mesh, folder / "a.mfem");
  EXPECT_TRUE(content(folder / "a.mfem").starts_with("MFEM mesh v1.0\n"));
}

TEST(WriteFoam, HasPatchesAndZones) {
  const TempFolder folder;
  const auto polymesh = folder / "case/constant/polyMesh";
  write_mesh<3>(two_cells(), polymesh);
  EXPECT_EQ(files_of_mesh(polymesh).size(), 7u);
  for (const std::string& file : files_of_mesh(polymesh)) EXPECT_TRUE(content(file).starts_with("FoamFile\n")) << file;
  const auto list = [&](const char* name) {
    const std::string text = content(polymesh / name);
    return text.substr(text.find("}\n\n") + 3);
  };
  EXPECT_EQ(list("owner"), "7\n(\n0\n0\n0\n1\n1\n1\n0\n)\n");
  EXPECT_EQ(list("neighbour"), "1\n(\n1\n)\n");
  EXPECT_TRUE(list("points").starts_with("5\n(\n(0 0 0)\n(1 0 0)\n")) << "a point of no cell is left out";
  EXPECT_NE(
      list("boundary")
          .find("    marker_0\n    {\n        type            patch;\n        nFaces          5;\n        startFace       1;"),
      std::string::npos);
  EXPECT_NE(
      list("boundary")
          .find("    in_let\n    {\n        type            patch;\n        nFaces          1;\n        startFace       6;"),
      std::string::npos);
  EXPECT_EQ(list("cellZones"),
            "2\n(\nair\n{\n    type cellZone;\n    cellLabels List<label> 1\n(\n1\n)\n;\n}\n"
            "Gear_box\n{\n    type cellZone;\n    cellLabels List<label> 1\n(\n0\n)\n;\n}\n)\n");
  EXPECT_EQ(list("faceZones"),
            "1\n(\ninterface\n{\n    type faceZone;\n    faceLabels List<label> 1\n(\n0\n)\n;\n    flipMap List<bool> "
            "1\n(\n0\n)\n;\n}\n)\n");
  EXPECT_EQ(error_of<UsageError>([&] { write_mesh<2>(OutputMesh<2>(), folder / "polyMesh"); }).code, Errc::bad_option);
  EXPECT_FALSE(std::filesystem::exists(folder / "polyMesh"));
}

TEST(Names, DamagedOnesAreNamed) {
  const TempFolder folder;
  write_mesh<3>(two_cells(), folder / "a.mesh");
  std::string text = content(folder / "a.mesh");
  text.replace(text.find("# name marker 7"), 15, "# name marker x");
  const Diagnostic damaged = error_of<InputError>([&] { read_mesh<3>(folder.put("b.mesh", text)); });
  EXPECT_EQ(damaged.code, Errc::syntax);
  EXPECT_GT(damaged.line, 2u);
  write_mesh<3>(two_cells(), folder / "a.vtu");
  text = content(folder / "a.vtu");
  text.replace(text.find("Name=\"in let\" NumberOfTuples"), 13, "Name=\"     \" ");
  EXPECT_EQ(error_of<InputError>([&] { read_mesh<3>(folder.put("b.vtu", text)); }).code, Errc::syntax);
}

}  // namespace pgdr::test::test_io_names
