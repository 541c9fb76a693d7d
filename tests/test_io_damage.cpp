// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Damaged files: cut at every byte, and with bytes changed at random. Whatever the damage, the reader returns or throws
// an InputError with the name of the file and a message; formats that say where they end are never believed when cut.
#include <algorithm>
#include <functional>
#include <memory>
#include <optional>

#include "io/formats.hpp"
#include "msh_files.hpp"
#include "output/piece_join.hpp"
#include "ply_files.hpp"
#include "test_io_support.hpp"

namespace pgdr::test::test_io_damage {

struct Format {
  std::string name, file;
  std::function<std::string()> bytes;  ///< made by the tests that need them, as each test is a process of its own
  std::function<void(const std::filesystem::path&)> read;
  bool says_its_end;  ///< no part of it is a valid file
};

void PrintTo(const Format& f, std::ostream* out) { *out << f.name; }

template <int D>
std::string mesh_bytes(const std::string& extension) {
  const TempFolder folder;
  write_mesh<D>(some_mesh<D>(2, 6), folder / ("a" + extension));
  return content(folder / ("a" + extension));
}

template <int D>
void read_input(const std::filesystem::path& file) {
  const Plc<D> plc = read_plc<D>(file);
  const auto in_range = [&](std::uint32_t id) { return id < plc.points.size(); };
  for (const auto& s : plc.segments) ASSERT_TRUE(in_range(s.points[0]) && in_range(s.points[1]));
  for (const auto& f : plc.facets) {
    for (const auto& polygon : f.polygons) {
      for (const std::uint32_t c : polygon) ASSERT_TRUE(in_range(c));
    }
  }
}

template <int D>
void expect_in_range(const OutputMesh<D>& mesh) {
  ASSERT_LE(mesh.input_points, mesh.points.size());
  const auto expect = [&mesh](const auto& corners) {
    for (const std::uint32_t v : corners) ASSERT_LT(v, mesh.points.size());
  };
  for (const auto& cell : mesh.cells) expect(cell);
  for (const auto& s : mesh.subsegments) expect(s.vertices);
  for (const auto& f : mesh.subfacets) expect(f.vertices);
  ASSERT_TRUE(mesh.regions.empty() || mesh.regions.size() == mesh.cells.size());
  ASSERT_TRUE(mesh.point_markers.empty() || mesh.point_markers.size() == mesh.points.size());
}

template <int D>
void read_output(const std::filesystem::path& file) {
  expect_in_range<D>(read_mesh<D>(file));
}

/// A .vtu as a solver leaves it, with a number a point and a vector a cell; both follow pgdr's own arrays.
std::string with_fields(std::string bytes) {
  const auto count = [&bytes](const std::string& name) {
    return std::stoul(bytes.substr(bytes.find(name + "=\"") + name.size() + 2));
  };
  const std::size_t points = count("NumberOfPoints"), cells = count("NumberOfCells");
  const std::string begin = "<AppendedData encoding=\"raw\">";
  const std::size_t data = bytes.find('_', bytes.find(begin)) + 1, end = bytes.rfind("</AppendedData>");
  std::string raw;
  const auto announce = [&](const std::string& section, const std::string& about, std::size_t size) {
    const std::string tag = "<DataArray " + about + " format=\"appended\" offset=\"" + std::to_string(end - data + raw.size()) +
                            "\"/>";
    const auto length = static_cast<std::uint64_t>(size);
    for (int i = 0; i < 8; ++i) raw += static_cast<char>(length >> (8 * i) & 255);
    for (std::size_t i = 0; i < size; ++i) raw += static_cast<char>(i % 100);
    return std::pair("</" + section + ">", tag);
  };
  const auto temperature = announce("PointData", "type=\"Int16\" Name=\"T\"", 2 * points);
  const auto flux = announce("CellData", "type=\"Float32\" Name=\"flux\" NumberOfComponents=\"3\"", 12 * cells);
  bytes.insert(end, raw);
  for (const auto& [closing, tag] : {temperature, flux}) bytes.insert(bytes.find(closing), tag);
  return bytes;
}

void read_fields(const std::filesystem::path& file) {
  InputFile input(file);
  const std::vector<MeshField> fields = input.read_fields();
  const OutputMesh<3> mesh = input.read_mesh<3>();
  for (const MeshField& field : fields)
    EXPECT_EQ(field.values.size(), field.components * (field.of_points ? mesh.points.size() : mesh.cells.size()));
}

/// A file of a piece that is a whole mesh.
template <int D>
Format file_of_piece() {
  const auto bytes = [] {
    const TempFolder folder;
    write_mesh<D>(some_mesh<D>(2, 6), folder / "a.pvtu");
    return content(folder / "a_0.vtu");
  };
  const auto read = [](const std::filesystem::path& file) {
    const MeshPiece<D> piece = detail::read_vtu_piece<D>(content(file), file);
    const detail::PieceView<D> view{&piece, file.string()};
    expect_in_range<D>(detail::join_views<D>({&view, 1}, file.string()));
  };
  return {"vtu_piece_" + std::to_string(D) + "d", "a.vtu", bytes, read, true};
}

/// A file that names pieces, which lie beside it.
template <int D>
Format names_of_pieces() {
  const auto folder = std::make_shared<std::optional<TempFolder>>();
  const auto bytes = [folder] {
    write_mesh<D>(some_mesh<D>(2, 6), folder->emplace() / "a.pvtu", {.pieces = 2});
    return content(**folder / "a.pvtu");
  };
  const auto read = [folder](const std::filesystem::path& file) {
    for (const std::string piece : {"a_0.vtu", "a_1.vtu"})
      std::filesystem::copy_file(**folder / piece, file.parent_path() / piece, std::filesystem::copy_options::skip_existing);
    expect_in_range<D>(read_mesh<D>(file));
  };
  return {"pvtu_" + std::to_string(D) + "d", "a.pvtu", bytes, read, true};
}

/// One file of a mesh in TetGen's files; the others are whole.
template <int D>
Format tetgen_file(const std::string& extension) {
  const auto folder = std::make_shared<std::optional<TempFolder>>();
  const auto bytes = [folder, extension] {
    write_mesh<D>(some_mesh<D>(2, 6), folder->emplace() / "a.ele");
    return content(**folder / ("a" + extension));
  };
  const auto read = [folder, extension](const std::filesystem::path& file) {
    const auto text = [&](const std::string& e) {
      return content(e == extension ? file : std::filesystem::path(**folder / ("a" + e)));
    };
    const std::string face = text(".face"), edge = text(".edge");
    const auto mesh = detail::read_tetgen<D>({text(".node"), text(".ele"), face, edge}, file);
    expect_in_range<D>(mesh);
  };
  return {"tetgen" + extension.substr(1) + std::to_string(D), "a" + extension, bytes, read, false};
}

std::vector<Format> formats() {
  std::vector<Format> all{
      {"poly_2d", "a.poly", [] { return std::string(triangle_poly); }, read_input<2>, false},
      {"poly_3d", "a.poly", [] { return std::string(tetgen_poly); }, read_input<3>, false},
      {"smesh", "a.smesh", [] { return std::string(tetgen_smesh); }, read_input<3>, false},
      {"node", "a.node", [] { return std::string("2 3 1 1\n1 0.5 1 2 3 4\n2 -1e5 0 0 7 5\n"); }, read_input<3>, false},
      {"off", "a.off", [] { return std::string(colour_off); }, read_input<3>, false},
      {"obj", "a.obj", [] { return std::string(wavefront_obj); }, read_input<3>, false},
      {"stl_ascii", "a.stl", [] { return std::string(ascii_stl); }, read_input<3>, false},
      {"stl_binary", "a.stl",
       [] {
         return binary_stl("solid", {{1, 2, 3}, {4, 5, 6, 7, 8, 9}});
       },
       read_input<3>, true},
      {"mesh_2d", "a.mesh", [] { return mesh_bytes<2>(".mesh"); }, read_output<2>, true},
      {"mesh_3d", "a.mesh", [] { return mesh_bytes<3>(".mesh"); }, read_output<3>, true},
      {"vtu_2d", "a.vtu", [] { return mesh_bytes<2>(".vtu"); }, read_output<2>, true},
      {"vtu_3d", "a.vtu", [] { return mesh_bytes<3>(".vtu"); }, read_output<3>, true},
      {"vtu_with_fields", "a.vtu", [] { return with_fields(mesh_bytes<3>(".vtu")); }, read_fields, true},
      {"msh_2d", "a.msh", [] { return mesh_bytes<2>(".msh"); }, read_output<2>, true},
      {"msh_3d", "a.msh", [] { return mesh_bytes<3>(".msh"); }, read_output<3>, true},
      {"mesh_as_input_2d", "a.mesh", [] { return mesh_bytes<2>(".mesh"); }, read_input<2>, true},
      {"mesh_as_input_3d", "a.mesh", [] { return mesh_bytes<3>(".mesh"); }, read_input<3>, true},
      {"msh_as_input_2d", "a.msh", [] { return mesh_bytes<2>(".msh"); }, read_input<2>, true},
  };
  for (const PlyEncoding encoding : ply_encodings)
    all.push_back({"ply_" + ply_name(encoding), "a.ply", [encoding] { return ply_file(encoding); }, read_input<3>,
                   encoding != PlyEncoding::text});
  for (const MshVariant& v : msh_variants) {
    all.push_back({v.name(), "a.msh", [v] { return msh_file(two_tetrahedra(), v); }, read_output<3>, true});
    all.push_back({v.name() + "_as_input", "a.msh", [v] { return msh_file(two_tetrahedra(), v); }, read_input<3>, true});
  }
  for (const Format& format : {file_of_piece<2>(), file_of_piece<3>(), names_of_pieces<2>(), names_of_pieces<3>()})
    all.push_back(format);
  for (const std::string extension : {".node", ".ele", ".face", ".edge"}) all.push_back(tetgen_file<3>(extension));
  for (const std::string extension : {".node", ".ele", ".edge"}) all.push_back(tetgen_file<2>(extension));
  return all;
}

class Damage : public testing::TestWithParam<Format> {
 protected:
  /// Whether `bytes` is read as a file of the format; if not, the error must be a proper one.
  bool accepted(const std::string& bytes) {
    const Format& f = GetParam();
    const auto file = folder_.put(f.file, bytes);
    try {
      f.read(file);
      return true;
    } catch (const InputError& e) {
      const bool of_piece = f.file == "a.pvtu" && std::filesystem::path(e.diagnostic().file).parent_path() == file.parent_path();
      EXPECT_TRUE(e.diagnostic().file == file.string() || of_piece) << e.what();
      EXPECT_FALSE(e.diagnostic().message.empty());
      EXPECT_LE(e.diagnostic().line, static_cast<std::uint64_t>(std::count(bytes.begin(), bytes.end(), '\n')) + 1);
    } catch (const FileError& e) {
      // A point count that became 0 sends the reader to the .node file beside it, the name of a piece to any file there.
      if (f.file != "a.pvtu") {
        EXPECT_EQ(std::filesystem::path(e.diagnostic().file).extension(), ".node");
      }
    }
    return false;
  }

 private:
  TempFolder folder_;
};

TEST_P(Damage, ACutAtEveryByte) {
  const Format& f = GetParam();
  const std::string whole = f.bytes();
  ASSERT_TRUE(accepted(whole));
  if (f.says_its_end) {
    EXPECT_FALSE(accepted(whole + "more"));
  }
  for (std::size_t n = 0; n < whole.size(); ++n) {
    const bool blank_lost = n + 1 == whole.size() && whole.back() == '\n';
    const bool ok = accepted(whole.substr(0, n));
    if (f.says_its_end) {
      EXPECT_EQ(ok, blank_lost);
    }
    ASSERT_FALSE(HasFailure()) << "cut after " << n << " bytes";
  }
}

TEST_P(Damage, BytesChangedAtRandom) {
  const Format& f = GetParam();
  constexpr std::uint64_t seed = 20260101;
  RecordProperty("seed", std::to_string(seed));
  std::mt19937_64 random(seed);
  const std::string likely = "0123456789.-+eE#\n\t ,\"<>/naif";
  const std::string whole = f.bytes();
  int refused = 0;
  constexpr int trials = 2500;
  for (int trial = 0; trial < trials; ++trial) {
    std::string bytes = whole;
    for (std::uint64_t flips = 1 + random() % 3; flips > 0; --flips) {
      char& c = bytes[random() % bytes.size()];
      c = random() % 2 == 0 ? static_cast<char>(random()) : likely[random() % likely.size()];
    }
    refused += accepted(bytes) ? 0 : 1;
    ASSERT_FALSE(HasFailure()) << "seed " << seed << ", trial " << trial << ":\n" << bytes;
  }
  EXPECT_GT(refused, 0);
  EXPECT_LT(refused, trials);
}

INSTANTIATE_TEST_SUITE_P(Formats, Damage, testing::ValuesIn(formats()), [](const auto& i) { return i.param.name; });

}  // namespace pgdr::test::test_io_damage
