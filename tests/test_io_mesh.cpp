// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Meshes in files: what is written reads back bit for bit, other programs' .mesh files are understood, mistakes are
// named, and a write that fails leaves everything as it was.
#include <tbb/task_arena.h>

#include <algorithm>

#include "test_io_support.hpp"

namespace pgdr::test::test_io_mesh {

template <int D>
void expect_round_trip(const OutputMesh<D>& mesh) {
  const TempFolder folder;
  for (const std::string extension : {".mesh", ".vtu", ".VTU", ".msh", ".node", ".ele", ".NODE"}) {
    SCOPED_TRACE(extension);
    const auto file = folder / ("mesh" + extension);
    write_mesh<D>(mesh, file);
    EXPECT_EQ(file_dimension(file), D);
    expect_same(read_mesh<D>(file), extension == ".msh" ? as_msh<D>(mesh) : mesh);
    const std::string once = content(file);
    write_mesh<D>(read_mesh<D>(file), file);
    EXPECT_TRUE(content(file) == once) << "the file of the mesh that was read differs";
  }
  // Those of .node and .ele are the same; beside .NODE are .ele, .edge and, in 3D, .face.
  EXPECT_EQ(folder.files(), 4u + (D == 3 ? 5u : 4u)) << "temporary files are left";
}

template <int D>
void expect_round_trips() {
  const OutputMesh<D> full = some_mesh<D>(D);
  expect_round_trip<D>(full);
  expect_round_trip<D>({});
  expect_round_trip<D>(some_mesh<D>(5, 20000));  // many times the buffer

  OutputMesh<D> bare = full;
  bare.regions.clear();
  bare.point_markers.clear();
  bare.subsegments.clear();
  bare.subfacets.clear();
  bare.input_points = 0;
  expect_round_trip<D>(bare);
}

TEST(MeshFiles, RoundTripBitForBitIn3D) { expect_round_trips<3>(); }
TEST(MeshFiles, RoundTripBitForBitIn2D) { expect_round_trips<2>(); }

// Blocks of a large file are formatted side by side where there are threads.
TEST(MeshFiles, DoNotDependOnTheNumberOfThreads) {
  const TempFolder folder;
  OutputMesh<3> mesh = some_mesh<3>(7, 20000);
  const auto cells = mesh.cells;
  while (mesh.cells.size() < 600000) mesh.cells.insert(mesh.cells.end(), cells.begin(), cells.end());
  mesh.regions.resize(mesh.cells.size(), 2);
  for (const std::string extension : {".mesh", ".vtu", ".msh", ".ele"}) {
    std::array<std::string, 2> written;
    for (const int threads : {1, 4}) {
      const auto file = folder / (std::to_string(threads) + extension);
      tbb::task_arena(threads).execute([&] { write_mesh<3>(mesh, file); });
      written[threads == 1 ? 0 : 1] = content(file);
    }
    EXPECT_TRUE(written[0] == written[1]) << extension;
  }
}

/// What .vtu and .node alone keep, and .vtu alone.
template <int D>
void expect_point_attributes_and_leaves_to_survive() {
  const TempFolder folder;
  for (const std::size_t columns : {1, 3}) {
    OutputMesh<D> mesh = some_mesh<D>(columns);
    std::mt19937_64 random(columns);
    for (std::size_t i = 0; i < columns * mesh.points.size(); ++i)
      mesh.point_attributes.push_back(std::ldexp(static_cast<double>(random()) - 0x1p63, static_cast<int>(random() % 300) - 150));
    for (const std::string extension : {".node", ".vtu"}) {
      if (extension == ".vtu")
        for (std::size_t c = 0; c < mesh.cells.size(); ++c) mesh.leaves.push_back(static_cast<std::uint32_t>(random()));
      for (const std::uint32_t first : {0u, 1u}) {
        write_mesh<D>(mesh, folder / ("a" + extension), {first, true, false});  // cells of chance have no neighbours
        expect_same(read_mesh<D>(folder / ("a" + extension)), mesh);
      }
    }
  }
  OutputMesh<D> none;
  write_mesh<D>(none, folder / "b.node", {0, true, true});
  expect_same(read_mesh<D>(folder / "b.ele"), none);
  EXPECT_EQ(error_of<UsageError>([&] { write_mesh<D>(none, folder / "c.node", {2, false, false}); }).code, Errc::bad_option);
}

TEST(MeshFiles, PointAttributesAndLeavesIn3D) { expect_point_attributes_and_leaves_to_survive<3>(); }
TEST(MeshFiles, PointAttributesAndLeavesIn2D) { expect_point_attributes_and_leaves_to_survive<2>(); }

TEST(MeshFiles, RegionsThatAreNoIntegersRoundTrip) {
  OutputMesh<3> mesh = some_mesh<3>(3);
  const double values[] = {0.1, -2, 1e300, 5e-324, -0.0, 0, 2147483648.0};
  for (std::size_t i = 0; i < mesh.regions.size(); ++i) mesh.regions[i] = values[i % 7];
  expect_round_trip<3>(mesh);
  const TempFolder folder;
  write_mesh<3>(mesh, folder / "a.mesh");
  EXPECT_NE(content(folder / "a.mesh").find("# region 1 = -2\n# region 2 = -0\n# region 3 = 0\n"), std::string::npos);
  std::fill(mesh.regions.begin(), mesh.regions.end(), 0.5);
  expect_round_trip<3>(mesh);
  // Integers but for one zero that has a sign.
  std::fill(mesh.regions.begin(), mesh.regions.end(), 1);
  mesh.regions[0] = -0.0;
  expect_round_trip<3>(mesh);
}

TEST(MeshFiles, MeditTextIsWhatOthersExpect) {
  OutputMesh<3> mesh;
  mesh.points = {{{0, 0, 0}}, {{1, 0, 0}}, {{0, 1, 0}}, {{0, 0, 0.1}}};
  mesh.input_points = 1;
  mesh.cells = {{0, 1, 2, 3}};
  mesh.regions = {7};
  mesh.subfacets = {{{0, 1, 2}, -3}};
  mesh.subsegments = {{{2, 3}, 4}};
  const TempFolder folder;
  write_mesh<3>(mesh, folder / "a.mesh");
  EXPECT_EQ(content(folder / "a.mesh"),
            "MeshVersionFormatted 2\nDimension 3\nVertices\n4\n0 0 0 0\n1 0 0 0\n0 1 0 0\n0 0 0.1 0\nEdges\n1\n3 4 4\n"
            "Triangles\n1\n1 2 3 -3\nTetrahedra\n1\n1 2 3 4 7\nRequiredVertices\n1\n1\nEnd\n");
}

TEST(MeshFiles, OtherProgramsMeditFiles) {
  const TempFolder folder;
  const auto mesh = read_mesh<3>(folder.put("a.mesh",
                                            " MeshVersionFormatted 2\n\n Dimension\n 3\n Vertices\n 4\n"
                                            "    0     0   0    1\n 1 0 0 2\n 0 1 0 2\n 0 0 1.5e0 0\n"
                                            " Corners\n 2\n 1\n 2\n Normals\n1\n0 -1 0.5\nQuadrilaterals 0\n"
                                            " Triangles 1\n 1 2 3 6\nUnheardOf 2\n1 2 3\n4 5 6\n Ridges 1 1\n"
                                            "RequiredVertices\n2\n3\n1\n Tetrahedra\n 1\n 1 2 3 4 0\n End\n"));
  EXPECT_EQ(mesh.points.size(), 4u);
  EXPECT_EQ(mesh.points.at(3), (Point3{{0, 0, 1.5}}));
  EXPECT_EQ(mesh.point_markers, (std::vector<int>{1, 2, 2, 0}));
  EXPECT_EQ(mesh.cells, (std::vector<std::array<std::uint32_t, 4>>{{0, 1, 2, 3}}));
  EXPECT_TRUE(mesh.regions.empty());
  ASSERT_EQ(mesh.subfacets.size(), 1u);
  EXPECT_EQ(mesh.subfacets[0].marker, 6);
  EXPECT_EQ(mesh.input_points, 0u);  // their required points are not our input points
}

struct Mistake {
  std::string name, text;
  Errc code;
  std::uint64_t line;
  std::string words;
};

void PrintTo(const Mistake& m, std::ostream* out) { *out << m.name; }

class MeditMistake : public testing::TestWithParam<Mistake> {};

TEST_P(MeditMistake, IsNamedWithItsLine) {
  const Mistake& m = GetParam();
  const TempFolder folder;
  const auto file = folder.put("a.mesh", m.text);
  const auto error = error_of<InputError>([&] { read_mesh<3>(file); });
  EXPECT_EQ(name(error.code), name(m.code)) << error.message;
  EXPECT_EQ(error.line, m.line) << error.message;
  EXPECT_EQ(error.file, file.string());
  EXPECT_NE(error.message.find(m.words), std::string::npos) << error.message;
}

const std::string medit = "MeshVersionFormatted 2\nDimension 3\nVertices\n4\n0 0 0 0\n1 0 0 0\n0 1 0 0\n0 0 1 0\n";

INSTANTIATE_TEST_SUITE_P(
    Medit, MeditMistake,
    testing::Values(
        Mistake{"empty", "", Errc::truncated, 1, "section or End"},
        Mistake{"no_end", medit, Errc::truncated, 9, "section or End"},
        Mistake{"no_dimension", "Vertices\n0\nEnd\n", Errc::syntax, 4, "dimension"},
        Mistake{"dimension", "Dimension 2\nEnd\n", Errc::syntax, 1, "2"},
        Mistake{"points", "Dimension 3\nVertices\n1000000000\n0 0 0 0\nEnd\n", Errc::count_too_large, 3, "1000000000"},
        Mistake{"points_cut", "Dimension 3\nVertices 2\n0 0 0 0\n1.000 1.0 ", Errc::truncated, 4, "point 2"},
        Mistake{"not_finite", "Dimension 3\nVertices 1\n0 inf 0 0\nEnd\n", Errc::not_finite, 3, "point 1"},
        Mistake{"word", "Dimension 3\nVertices 1\n0 here 0 0\nEnd\n", Errc::syntax, 3, "'here'"},
        Mistake{"reference", medit + "Tetrahedra 1\n1 2 3 5 0\nEnd\n", Errc::index_out_of_range, 10, "point 5"},
        Mistake{"reference_0", medit + "Edges 1\n1 0 0\nEnd\n", Errc::index_out_of_range, 10, "point 0"},
        Mistake{"cells_first", "Dimension 3\nTetrahedra 1\n1 2 3 4 0\n" + medit, Errc::index_out_of_range, 3, "no points"},
        Mistake{"twice", medit + "Vertices 1\n0 0 0 0\nEnd\n", Errc::syntax, 9, "twice"},
        Mistake{"marker", medit + "Edges 1\n1 2 1.5\nEnd\n", Errc::syntax, 10, "'1.5'"},
        Mistake{"number", medit + "1 2 3\nEnd\n", Errc::syntax, 9, "'1'"},
        Mistake{"hexahedra", medit + "Hexahedra 1\n1 2 3 4 1 2 3 4 0\nEnd\n", Errc::unknown_format, 9, "Hexahedra"},
        Mistake{"behind", medit + "End\nmore\n", Errc::syntax, 10, "'more'"},
        Mistake{"region", "# region 1 = 0.5\n" + medit + "Tetrahedra 1\n1 2 3 4 2\nEnd\n", Errc::index_out_of_range, 11,
                "region 2"},
        Mistake{"comment", "# region 2 = 0.5\n" + medit + "End\n", Errc::syntax, 1, "# region 2 = 0.5"}),
    [](const auto& info) { return info.param.name; });

/// A valid .vtu with `from` replaced by `to`, of the same length where it lies before the data.
Diagnostic vtu_mistake(const std::string& from, const std::string& to) {
  const TempFolder folder;
  write_mesh<3>(some_mesh<3>(1, 10), folder / "a.vtu");
  std::string text = content(folder / "a.vtu");
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  text.replace(at, from.size(), to);
  folder.put("a.vtu", text);
  return error_of<InputError>([&] { read_mesh<3>(folder / "a.vtu"); });
}

TEST(VtuMistake, IsNamedWithItsLine) {
  const auto expect = [](const std::string& from, const std::string& to, Errc code, std::uint64_t line) {
    const auto error = vtu_mistake(from, to);
    EXPECT_EQ(name(error.code), name(code)) << from << ": " << error.message;
    EXPECT_EQ(error.line, line) << from << ": " << error.message;
  };
  expect("\"LittleEndian\"", "\"BigEndian\"", Errc::unknown_format, 2);
  expect("\"UInt64\"", "\"UInt32\"", Errc::unknown_format, 2);
  expect("UnstructuredGrid", "PolyData", Errc::unknown_format, 2);
  expect("header_type", "compressor=\"x\" header_type", Errc::unknown_format, 2);
  expect("NumberOfPoints=\"10\"", "NumberOfPoints=\"99999999999\"", Errc::count_too_large, 8);
  expect("NumberOfCells=\"60\"", "NumberOfCells=\"-1\"", Errc::syntax, 8);
  expect("NumberOfPoints=\"10\"", "NumberOfPoints=\"11\"", Errc::syntax, 17);
  expect("Name=\"types\"", "Name=\"typos\"", Errc::syntax, 27);
  expect("type=\"Float64\" Name=\"Points\"", "type=\"Float32\" Name=\"Points\"", Errc::unknown_format, 17);
  expect("format=\"appended\"", "format=\"ascii\"", Errc::unknown_format, 5);
  expect("offset=\"0\"", "offset=\"999999999\"", Errc::truncated, 22);
  expect("encoding=\"raw\"", "encoding=\"base64\"", Errc::unknown_format, 26);
  expect("<?xml", "xml", Errc::syntax, 1);
  expect("</VTKFile>", "", Errc::truncated, 0);
  expect("</VTKFile>", "</VTKFile>more", Errc::syntax, 0);
}

TEST(VtuMistake, ContentIsChecked) {
  const TempFolder folder;
  const auto code_of = [&](OutputMesh<3> mesh) {
    write_mesh<3>(mesh, folder / "a.vtu");
    return error_of<InputError>([&] { read_mesh<3>(folder / "a.vtu"); }).code;
  };
  OutputMesh<3> mesh = some_mesh<3>(1, 10);
  mesh.points[4][1] = std::numeric_limits<double>::infinity();
  EXPECT_EQ(code_of(mesh), Errc::not_finite);
  mesh = some_mesh<3>(1, 10);
  mesh.subfacets[3].vertices[1] = 10;
  EXPECT_EQ(code_of(mesh), Errc::index_out_of_range);
  mesh = some_mesh<3>(1, 10);
  mesh.input_points = 11;
  EXPECT_EQ(code_of(mesh), Errc::index_out_of_range);
  EXPECT_EQ(error_of<InputError>([&] { read_mesh<2>(folder / "a.vtu"); }).code, Errc::syntax);
}

TEST(WriteMesh, RefusesWhatItCannotWriteAndLeavesNothing) {
  const TempFolder folder;
  const auto mesh = some_mesh<3>(1);
  for (const std::string name : {"a.stl", "a", "a.vtuu"})
    EXPECT_EQ(error_of<InputError>([&] { write_mesh<3>(mesh, folder / name); }).code, Errc::unknown_format);
  EXPECT_EQ(error_of<InputError>([&] { read_mesh<3>(folder / "a.stl"); }).code, Errc::unknown_format);
  EXPECT_EQ(error_of<FileError>([&] { read_mesh<3>(folder / "a.vtu"); }).code, Errc::cannot_open);

  const auto error = error_of<FileError>([&] { write_mesh<3>(mesh, folder / "missing/a.vtu"); });
  EXPECT_EQ(error.code, Errc::cannot_write);
  EXPECT_EQ(error.file, (folder / "missing/a.vtu").string());
  std::filesystem::create_directory(folder / "b.vtu");
  EXPECT_EQ(error_of<FileError>([&] { write_mesh<3>(mesh, folder / "b.vtu"); }).code, Errc::cannot_write);
  EXPECT_EQ(folder.files(), 1u);
}

TEST(WriteMesh, ReplacesAFileAndKeepsALink) {
  const TempFolder folder;
  folder.put("a.mesh", "old");
  std::filesystem::create_symlink(folder / "a.mesh", folder / "link.mesh");
  const auto mesh = some_mesh<2>(1);
  write_mesh<2>(mesh, folder / "link.mesh");
  EXPECT_TRUE(std::filesystem::is_symlink(folder / "link.mesh"));
  expect_same(read_mesh<2>(folder / "a.mesh"), mesh);
  EXPECT_EQ(folder.files(), 2u);
}

TEST(WriteMesh, AFullDiskLeavesTheOldFileAndNoOther) {
  const TempFolder folder;
  const auto mesh = some_mesh<3>(1, 30000);
  for (const std::string name : {"a.vtu", "a.mesh", "a.msh"}) {
    folder.put(name, "old");
    Diagnostic error;
    for (const rlim_t bytes : {0, 100, 2000000}) {
      {
        const FullDisk full(bytes);
        error = error_of<FileError>([&] { write_mesh<3>(mesh, folder / name); });
      }
      EXPECT_EQ(error.code, Errc::cannot_write);
      EXPECT_EQ(error.file, (folder / name).string());
      EXPECT_EQ(content(folder / name), "old");
      EXPECT_EQ(folder.files(), 1u) << "a temporary file is left";
    }
    std::filesystem::remove(folder / name);
  }
}

TEST(WriteMesh, TheFourFilesOfTetgenAreReplacedTogetherOrNotAtAll) {
  const TempFolder folder;
  const auto mesh = some_mesh<3>(1, 30000), other = some_mesh<3>(2, 20);
  write_mesh<3>(other, folder / "a.ele");
  const std::vector<std::string> names{"a.node", "a.ele", "a.face", "a.edge"};
  std::vector<std::string> before;
  for (const auto& name : names) before.push_back(content(folder / name));
  const auto expect_unchanged = [&](std::size_t files) {
    for (std::size_t i = 0; i < names.size(); ++i) EXPECT_EQ(content(folder / names[i]), before[i]) << names[i];
    EXPECT_EQ(folder.files(), files) << "a temporary file is left";
  };
  for (const rlim_t bytes : {0, 100, 1500000, 2500000}) {
    const FullDisk full(bytes);
    EXPECT_EQ(error_of<FileError>([&] { write_mesh<3>(mesh, folder / "a.node"); }).code, Errc::cannot_write);
    expect_unchanged(4);
  }
  // One that cannot be replaced.
  before[3] = "";
  std::filesystem::remove(folder / "a.edge");
  std::filesystem::create_directory(folder / "a.edge");
  EXPECT_EQ(error_of<FileError>([&] { write_mesh<3>(mesh, folder / "a.node"); }).file, (folder / "a.edge").string());
  expect_unchanged(4);
  std::filesystem::remove(folder / "a.edge");
  write_mesh<3>(mesh, folder / "a.node");
  expect_same(read_mesh<3>(folder / "a.ele"), mesh);
  EXPECT_EQ(folder.files(), 4u);
}

}  // namespace pgdr::test::test_io_mesh
