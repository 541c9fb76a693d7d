// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Any bytes as a file of the format fuzz_extension, in each dimension, as input and as mesh. The reader returns what
// has no bad index, or throws an InputError that names the file, a line it has, and what is wrong. A small mesh that was
// read goes through the checker, which has no say here but must not fail.
#include <algorithm>
#include <cstdint>
#include <string>
#include <string_view>

#include "expect.hpp"
#include "io/formats.hpp"
#include "output/piece_join.hpp"
#include "pgdr/check.hpp"
#include "pgdr/error.hpp"

extern const std::string_view fuzz_extension;  // of the program, fuzz_extension.cpp

namespace pgdr {
namespace {

const std::string_view extension = fuzz_extension;
const bool spatial = extension == ".smesh" || extension == ".obj" || extension == ".off" || extension == ".ply" ||
                     extension == ".stl";
const bool tetgen = extension == ".ele";
const bool vtk = extension == ".vtu" || extension == ".pvtu";
const bool input = !tetgen && !vtk;
const bool mesh = tetgen || vtk || extension == ".mesh" || extension == ".msh" || extension == ".vtk";
constexpr std::size_t most_cells = 30;  // for the checker

/// In a folder that does not exist: what refers to a file beside it finds none.
const std::string name = "no_such_folder_of_pgdr/a" + std::string(extension);

template <class Read>
void guarded(std::string_view bytes, Read read) {
  try {
    read();
  } catch (const InputError& e) {
    const Diagnostic& d = e.diagnostic();
    FUZZ_EXPECT(tetgen || d.file == name, d.file);
    FUZZ_EXPECT(!d.message.empty());
    FUZZ_EXPECT(d.line <= static_cast<std::uint64_t>(std::count(bytes.begin(), bytes.end(), '\n')) + 1, e.what());
  } catch (const FileError& e) {
    // No points here: they are in the .node file beside it. Or no cells: they are in the files of the pieces.
    FUZZ_EXPECT(extension == ".poly" || extension == ".smesh" || extension == ".pvtu", e.what());
    FUZZ_EXPECT(e.code() == Errc::cannot_open, e.what());
  }
}

template <int D>
void expect_in_range(const Plc<D>& plc) {
  const auto expect = [n = plc.points.size()](std::uint32_t v) { FUZZ_EXPECT(v < n); };
  for (const auto& s : plc.segments)
    for (const std::uint32_t v : s.points) expect(v);
  for (const auto& f : plc.facets)
    for (const auto& polygon : f.polygons)
      for (const std::uint32_t v : polygon) expect(v);
  FUZZ_EXPECT(plc.point_markers.empty() || plc.point_markers.size() == plc.points.size());
  FUZZ_EXPECT(plc.point_attributes.empty() || plc.point_attributes.size() % plc.points.size() == 0);
}

template <int D>
void expect_in_range(const OutputMesh<D>& m) {
  const auto expect = [&m](const auto& corners) {
    for (const std::uint32_t v : corners) FUZZ_EXPECT(v < m.points.size());
  };
  FUZZ_EXPECT(m.input_points <= m.points.size());
  for (const auto& cell : m.cells) expect(cell);
  for (const auto& s : m.subsegments) expect(s.vertices);
  for (const auto& f : m.subfacets) expect(f.vertices);
  FUZZ_EXPECT(m.regions.empty() || m.regions.size() == m.cells.size());
  FUZZ_EXPECT(m.point_markers.empty() || m.point_markers.size() == m.points.size());
  FUZZ_EXPECT(m.point_attributes.empty() || m.point_attributes.size() % m.points.size() == 0);
  FUZZ_EXPECT(m.leaves.empty() || m.leaves.size() == m.cells.size());
}

template <int D>
void look_at(const OutputMesh<D>& m) {
  expect_in_range<D>(m);
  if (m.cells.size() + m.subsegments.size() + m.subfacets.size() <= most_cells) check<D>(m, CheckOptions<D>{});
}

/// The texts of the files .node, .ele, .face and .edge, in this order, with a byte 0 between; the last may be missing.
template <int D>
void read_tetgen_texts(std::string_view bytes) {
  std::string texts[4];
  std::size_t n = 0;
  for (const char c : bytes) {
    if (c == '\0' && n < 3)
      ++n;
    else
      texts[n] += c;
  }
  const auto there = [&](std::size_t i) { return n >= i ? std::optional<std::string_view>(texts[i]) : std::nullopt; };
  look_at<D>(detail::read_tetgen<D>({texts[0], texts[1], there(2), there(3)}, name));
}

/// The file of a piece that is all of its mesh.
template <int D>
void read_piece(std::string_view bytes) {
  const MeshPiece<D> piece = detail::read_vtu_piece<D>(bytes, name);
  expect_in_range<D>(piece.mesh);
  const detail::PieceView<D> view{&piece, name};
  look_at<D>(detail::join_views<D>({&view, 1}, name));
}

void read_fields(std::string_view bytes) {
  for (const MeshField& field : detail::read_vtu_fields(bytes, name))
    FUZZ_EXPECT(field.components > 0 && field.values.size() % field.components == 0, field.name);
}

template <int D>
void read(std::string_view bytes) {
  if (input) guarded(bytes, [&] { expect_in_range<D>(detail::read_plc_from<D>(bytes, name)); });
  if (tetgen)
    guarded(bytes, [&] { read_tetgen_texts<D>(bytes); });
  else if (mesh)
    guarded(bytes, [&] { look_at<D>(detail::read_mesh_from<D>(bytes, name)); });
  if (extension == ".vtu") guarded(bytes, [&] { read_piece<D>(bytes); });
  if (extension == ".vtu") guarded(bytes, [&] { read_fields(bytes); });
}

}  // namespace
}  // namespace pgdr

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  // A copy of its own: the sanitizer sees a read beyond its end.
  const std::string bytes(reinterpret_cast<const char*>(data), size);
  if (!pgdr::spatial) pgdr::read<2>(bytes);
  pgdr::read<3>(bytes);
  return 0;
}
