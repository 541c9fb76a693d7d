// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// VTK's file of a grid in pieces: which arrays the pieces have, and the names of their files, which lie beside it. No ghost
// cells: VTK and ParaView make them from the global numbers.
#include <memory>

#include "io/formats.hpp"
#include "io/write/vtu_layout.hpp"
#include "pgdr/error.hpp"

namespace pgdr::detail {

std::string name_of_piece(const std::filesystem::path& file, std::uint64_t k) {
  return (file.parent_path() / (file.stem().string() + "_" + std::to_string(k) + ".vtu")).string();
}

template <int D>
std::string pvtu_text(const MeshPiece<D>& piece, std::uint64_t count, const std::filesystem::path& file) {
  const VtuPart<D> part = VtuPart<D>::file_of_piece(piece);
  const std::vector<VtuArray> arrays = arrays_of<D>(part);
  std::string out =
      "<?xml version=\"1.0\"?>\n"
      "<VTKFile type=\"PUnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">\n"
      "<PUnstructuredGrid GhostLevel=\"0\">\n";
  const auto put_section = [&](std::string_view section, const std::string& attributes) {
    out += "<P" + std::string(section) + attributes + ">\n";
    for (const VtuArray& a : arrays)
      if (a.section == section)
        out += "<PDataArray type=\"" + std::string(a.type) + "\" Name=\"" + a.name + "\"" + a.shape + "/>\n";
    out += "</P" + std::string(section) + ">\n";
  };
  put_section("PointData", " GlobalIds=\"" + std::string(point_ids) + "\"");
  put_section("CellData", " GlobalIds=\"" + std::string(cell_ids) + "\"");
  put_section("Points", "");
  for (std::uint64_t k = 0; k < count; ++k) {
    const std::string name = std::filesystem::path(name_of_piece(file, k)).filename().string();
    out += "<Piece Source=\"" + xml_escaped(name) + "\"/>\n";
  }
  return out + "</PUnstructuredGrid>\n</VTKFile>\n";
}

template <int D>
void write_pvtu(const OutputMesh<D>& mesh, const std::filesystem::path& file, std::uint64_t count) {
  std::vector<std::unique_ptr<FileOutput>> files;  // the last, whose presence means all of them, is that of their names
  std::string text;
  for (std::uint64_t k = 0; k < count; ++k) {
    const MeshPiece<D> piece = piece_of<D>(mesh, k, count);
    if (k == 0) text = pvtu_text<D>(piece, count, file);
    files.push_back(std::make_unique<FileOutput>(name_of_piece(file, k)));
    write_vtu_of_piece<D>(piece, *files.back());
    files.back()->close();
  }
  files.push_back(std::make_unique<FileOutput>(file));
  files.back()->put(text);
  commit_together(files);
}

template std::string pvtu_text<2>(const MeshPiece<2>&, std::uint64_t, const std::filesystem::path&);
template std::string pvtu_text<3>(const MeshPiece<3>&, std::uint64_t, const std::filesystem::path&);
template void write_pvtu<2>(const OutputMesh<2>&, const std::filesystem::path&, std::uint64_t);
template void write_pvtu<3>(const OutputMesh<3>&, const std::filesystem::path&, std::uint64_t);

}  // namespace pgdr::detail
