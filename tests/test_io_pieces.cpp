// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Meshes in several hands: a .vtu of which each writes its rows is, byte by byte, the one that a single writer makes; the files
// of a .pvtu are read as the mesh that they are of, and mistakes in them are named with file and number.
#include <algorithm>

#include "dimensions.hpp"
#include "io/formats.hpp"
#include "test_io_support.hpp"

namespace pgdr::test::test_io_pieces {

template <int D>
OutputMesh<D> full_mesh(std::uint64_t seed, std::size_t points) {
  OutputMesh<D> mesh = some_mesh<D>(seed, points);
  for (std::size_t i = 0; i < mesh.cells.size(); ++i) mesh.leaves.push_back(static_cast<std::uint32_t>(7 * i));
  for (std::size_t i = 0; i < 2 * points; ++i) mesh.point_attributes.push_back(static_cast<double>(i) / 3);
  return mesh;
}

template <int D>
OutputMesh<D> bare_mesh(std::uint64_t seed, std::size_t points) {
  OutputMesh<D> mesh = some_mesh<D>(seed, points);
  mesh.regions.clear();
  mesh.point_markers.clear();
  return mesh;
}

template <class T>
class FilesOfPieces : public testing::Test {
 protected:
  static constexpr int D = T::value;
  TempFolder folder_;
};
TYPED_TEST_SUITE(FilesOfPieces, Dimensions);

TYPED_TEST(FilesOfPieces, RowsAtTheirPlacesAreTheFile) {
  constexpr int D = TypeParam::value;
  std::mt19937 random(1);
  for (const OutputMesh<D>& mesh : {full_mesh<D>(1, 40), bare_mesh<D>(2, 40), full_mesh<D>(3, 30000), OutputMesh<D>{}}) {
    write_mesh<D>(mesh, this->folder_ / "whole.vtu");
    const std::string whole = content(this->folder_ / "whole.vtu");
    for (const std::uint64_t count : {1u, 2u, 3u, 7u, 200u}) {
      const auto file = this->folder_.put("rows.vtu", "");
      std::vector<std::uint64_t> order(count);
      for (std::uint64_t k = 0; k < count; ++k) order[k] = k;
      std::shuffle(order.begin(), order.end(), random);
      for (const std::uint64_t k : order) {
        detail::FileSlices out(file.string(), "whole.vtu");
        detail::write_vtu_rows<D>(piece_of<D>(mesh, k, count), k == count / 2, out);
      }
      EXPECT_TRUE(content(file) == whole) << count << " writers, " << mesh.points.size() << " points";
    }
  }
}

TYPED_TEST(FilesOfPieces, SlicesEndAtMultiplesWhateverIsPut) {
  const auto file = this->folder_.put("a", "");
  std::string expected(5000000, '\0');
  std::mt19937 random(2);
  detail::FileSlices out(file.string(), "a");
  for (const std::size_t begin : {3u, 1048576u, 2500000u}) {
    out.begin_at(begin);
    std::size_t at = begin;
    for (const std::size_t size : {0u, 1u, 1048570u, 7u, 20u}) {
      std::string bytes(size, 'x');
      for (char& c : bytes) c = static_cast<char>(random());
      expected.replace(at, size, bytes);
      out.put(bytes);
      at += size;
    }
  }
  out.begin_at(expected.size() - 1);
  out.put(std::string_view(expected).substr(expected.size() - 1));
  out.close();
  EXPECT_TRUE(content(file) == expected);
}

TYPED_TEST(FilesOfPieces, RowsThatCannotBeWritten) {
  constexpr int D = TypeParam::value;
  const auto piece = piece_of<D>(full_mesh<D>(1, 30000), 1, 2);
  const auto expect_error = [&](const std::string& name) {
    const Diagnostic d = error_of<FileError>([&] {
      detail::FileSlices out(name, "target.vtu");
      detail::write_vtu_rows<D>(piece, false, out);
    });
    EXPECT_EQ(d.code, Errc::cannot_write);
    EXPECT_EQ(d.file, "target.vtu");
  };
  expect_error((this->folder_ / "missing").string());
  expect_error("/dev/full");
  const auto file = this->folder_.put("a", "");
  const FullDisk full(2000000);
  expect_error(file.string());
}

TYPED_TEST(FilesOfPieces, ReadAsTheMesh) {
  constexpr int D = TypeParam::value;
  for (const OutputMesh<D>& mesh : {full_mesh<D>(1, 40), bare_mesh<D>(2, 300), OutputMesh<D>{}}) {
    for (const std::uint32_t count : {1u, 2u, 3u, 7u, 200u}) {
      const TempFolder folder;
      const auto file = folder / "a&<b>\"'.PVTU";
      const WriteOptions options{.pieces = count};
      write_mesh<D>(mesh, file, options);
      EXPECT_EQ(file_dimension(file), D);
      EXPECT_TRUE(holds_cells(file) && is_mesh_format(file));
      expect_same(read_mesh<D>(file), mesh);
      const std::vector<std::string> files = files_of_mesh(file, options);
      EXPECT_EQ(files.size(), count + 1);
      EXPECT_EQ(folder.files(), count + 1);
      for (const std::string& one : files) EXPECT_TRUE(std::filesystem::exists(one)) << one;
      // A piece alone is a mesh, too.
      expect_same(read_mesh<D>(files.back()), piece_of<D>(mesh, count - 1, count).mesh);
    }
  }
}

TYPED_TEST(FilesOfPieces, AreWrittenAllOrNone) {
  constexpr int D = TypeParam::value;
  const auto mesh = full_mesh<D>(1, 30000);
  for (const std::string name : {"a.pvtu", "a_0.vtu", "a_1.vtu"}) this->folder_.put(name, "old");
  for (const rlim_t bytes : {0, 100, 2000000}) {
    Diagnostic error;
    {
      const FullDisk full(bytes);
      error = error_of<FileError>([&] { write_mesh<D>(mesh, this->folder_ / "a.pvtu", {.pieces = 3}); });
    }
    EXPECT_EQ(error.code, Errc::cannot_write);
    EXPECT_EQ(error.file, (this->folder_ / "a_0.vtu").string());
    EXPECT_EQ(this->folder_.files(), 3u);
  }
  std::filesystem::create_directory(this->folder_ / "a_2.vtu");
  EXPECT_EQ(error_of<FileError>([&] { write_mesh<D>(mesh, this->folder_ / "a.pvtu", {.pieces = 3}); }).file,
            (this->folder_ / "a_2.vtu").string());
  for (const std::string name : {"a.pvtu", "a_0.vtu", "a_1.vtu"}) EXPECT_EQ(content(this->folder_ / name), "old");
  EXPECT_EQ(this->folder_.files(), 4u);
}

TYPED_TEST(FilesOfPieces, TooManyAreRefused) {
  constexpr int D = TypeParam::value;
  const WriteOptions options{.pieces = most_pieces + 1};
  EXPECT_EQ(error_of<UsageError>([&] { write_mesh<D>({}, this->folder_ / "a.pvtu", options); }).code, Errc::bad_option);
  EXPECT_EQ(this->folder_.files(), 0u);
}

TYPED_TEST(FilesOfPieces, MistakesAreNamedWithFileAndNumber) {
  constexpr int D = TypeParam::value;
  const auto mesh = full_mesh<D>(1, 40);
  const auto file = [&](const std::string& name) { return this->folder_ / name; };
  const auto written = [&] { write_mesh<D>(mesh, file("a.pvtu"), {.pieces = 3}); };
  const auto read = [&] { read_mesh<D>(file("a.pvtu")); };
  const auto expect_at = [&](const std::string& name, std::int64_t id) {
    const Diagnostic d = error_of<InputError>(read);
    EXPECT_EQ(d.file, file(name).string()) << d.message;
    EXPECT_EQ(d.ids, std::vector{id}) << d.message;
  };
  const auto copy = [&](const std::string& from, const std::string& to) {
    std::filesystem::copy_file(file(from), file(to), std::filesystem::copy_options::overwrite_existing);
  };
  /// Changes the first bytes of an array in a file to these.
  const auto change = [&](const std::string& name, const std::string& array, std::size_t row, auto value) {
    std::string bytes = content(file(name));
    const std::size_t data = bytes.find("<AppendedData");
    const std::size_t begin = bytes.find('_', data) + 1, line = bytes.find("Name=\"" + array + "\"");
    const std::size_t offset = std::stoul(bytes.substr(bytes.find("offset=\"", line) + 8));
    std::memcpy(bytes.data() + begin + offset + 8 + row * sizeof value, &value, sizeof value);
    this->folder_.put(name, bytes);
  };

  written();
  std::filesystem::remove(file("a_1.vtu"));
  EXPECT_EQ(error_of<FileError>(read).file, file("a_1.vtu").string());
  copy("a_0.vtu", "a_1.vtu");
  expect_at("a_1.vtu", 0);

  written();
  std::string text = content(file("a.pvtu"));
  const std::string last = "<Piece Source=\"a_2.vtu\"/>\n";
  this->folder_.put("a.pvtu", text.erase(text.find(last), last.size()));
  expect_at("a.pvtu", 80 / 3);

  written();
  change("a_2.vtu", "GlobalPointIds", 1, std::int64_t{0});
  expect_at("a_2.vtu", 0);
  written();
  change("a_2.vtu", "GlobalPointIds", 0, std::int64_t{-1});
  EXPECT_EQ(error_of<InputError>(read).code, Errc::index_out_of_range);
  written();
  const auto piece = piece_of<D>(mesh, 2, 3);
  ASSERT_LT(piece.point_numbers[0], piece.first_point);
  change("a_2.vtu", "Points", 0, 0.25);
  expect_at("a_2.vtu", static_cast<std::int64_t>(piece.point_numbers[0]));
  written();
  change("a_2.vtu", "GlobalCellIds", 0, std::int64_t{0});
  EXPECT_EQ(error_of<InputError>(read).file, file("a_2.vtu").string());
  written();
  change("a_0.vtu", "piece", 2, std::int64_t{80});
  change("a_0.vtu", "piece", 1, std::int64_t{19});
  EXPECT_EQ(error_of<InputError>(read).file, file("a_1.vtu").string());
  written();
  copy("a.pvtu", "b.pvtu");
  this->folder_.put("b.pvtu", "<VTKFile type=\"PUnstructuredGrid\"><Piece Source=\"../a_0.vtu\"/></VTKFile>\n");
  EXPECT_EQ(error_of<InputError>([&] { read_mesh<D>(file("b.pvtu")); }).code, Errc::unknown_format);
}

}  // namespace pgdr::test::test_io_pieces
