// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Reads the .pvtu files that io/write/pvtu.cpp makes, with their pieces, which lie beside them. Each piece says what the whole
// mesh has and which rows are its own, so that what is missing or there twice is found by its number.
#include <memory>

#include "io/formats.hpp"
#include "output/piece_join.hpp"
#include "scan/xml_tags.hpp"

namespace pgdr::detail {
namespace {

/// The files of the pieces, in their order: at least one.
std::vector<std::filesystem::path> piece_files(std::string_view text, const std::filesystem::path& file) {
  const std::string name = file.string();
  TagScanner tags(text, name);
  std::vector<std::filesystem::path> pieces;
  for (;;) {
    const Tag tag = tags.next();
    if (tag.name == "VTKFile") tags.require(tag, "type", "PUnstructuredGrid");
    if (tag.name == "PUnstructuredGrid") tags.require(tag, "GhostLevel", "0");
    if (tag.name == "/VTKFile") break;
    if (tag.name != "Piece") continue;
    const std::string source = xml_unescaped(tags.attribute(tag, "Source"));
    if (source.empty() || source.find('/') != std::string::npos || source.find('\0') != std::string::npos)
      tags.fail(Errc::unknown_format, "only pieces beside the file are read, not " + detail::quoted(source), tag.line);
    pieces.push_back(file.parent_path() / source);
  }
  if (!tags.at_end()) tags.fail(Errc::syntax, "something is left behind the end", tags.line());
  if (pieces.empty()) tags.fail(Errc::syntax, "the file has no pieces", 0);
  return pieces;
}

}  // namespace

template <int D>
OutputMesh<D> read_pvtu(std::string_view text, const std::filesystem::path& file, FileTexts& beside) {
  const std::vector<std::filesystem::path> files = piece_files(text, file);
  std::vector<MeshPiece<D>> pieces;
  std::vector<PieceView<D>> views;
  pieces.reserve(files.size());
  for (const std::filesystem::path& piece : files) {
    pieces.push_back(read_vtu_piece<D>(beside.of(piece), piece));
    views.push_back({&pieces.back(), piece.string()});
  }
  return join_views<D>(views, file.string());
}

int pvtu_dimension(std::string_view text, const std::filesystem::path& file, FileTexts& beside) {
  const std::filesystem::path first = piece_files(text, file).front();
  return vtu_dimension(beside.of(first), first);
}

template OutputMesh<2> read_pvtu<2>(std::string_view, const std::filesystem::path&, FileTexts&);
template OutputMesh<3> read_pvtu<3>(std::string_view, const std::filesystem::path&, FileTexts&);

}  // namespace pgdr::detail
