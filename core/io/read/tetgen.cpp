// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Meshes as TetGen (3D) and Triangle (2D) have them: X.node and X.ele, and, where they are there, X.face (subfacets)
// and X.edge (subsegments). They are numbered from 0 or 1. The attribute of a cell is its region. A comment at the head of
// X.node, "# pgdr input_points <n>", tells the input points from the others; further ones tell names; one at the head of X.edge,
// "# pgdr subsegments <n>", the subsegments, which come first, from the other edges.
#include <algorithm>
#include <string>

#include "io/formats.hpp"
#include "scan/line_scanner.hpp"

namespace pgdr::detail {
namespace {

/// The number in a comment at the head of a file; `otherwise` if it is not there.
std::size_t read_comment(std::string_view text, std::string_view comment, std::size_t otherwise, std::size_t most,
                         const std::string& file) {
  if (!text.starts_with(comment)) return otherwise;
  const std::string_view line = text.substr(0, text.find('\n'));
  const auto n = parse_integer(line.substr(comment.size()));
  if (!n || *n < 0 || static_cast<std::uint64_t>(*n) > most)
    throw InputError(Diagnostic{
        Errc::syntax, "the comment " + quoted(line) + " has no number from 0 to " + std::to_string(most), file, 1, {}, {}});
  return static_cast<std::size_t>(*n);
}

/// The lines before the first that is no comment.
std::string_view leading_comments(std::string_view text) {
  std::size_t end = 0;
  while (end < text.size() && text[end] == '#') end = std::min(text.find('\n', end), text.size() - 1) + 1;
  return text.substr(0, end);
}

/// References to points, as the .node file numbers them.
struct Numbering {
  std::uint32_t first;
  std::size_t points;
};

template <std::size_t N>
std::array<std::uint32_t, N> read_vertices(LineScanner& in, Subject s, const Numbering& numbering) {
  std::array<std::uint32_t, N> vertices;
  for (auto& v : vertices) v = in.reference(s, numbering.first, numbering.points);
  return vertices;
}

void require_end(LineScanner& in) {
  if (in.advance()) in.fail(Errc::syntax, quoted(in.word({})) + " stands behind the last entry");
}

template <int D>
void read_ele(std::string_view text, const std::string& file, const Numbering& numbering, OutputMesh<D>& mesh) {
  constexpr Subject header{"the list of cells"};
  LineScanner in(text, file);
  in.require(header);
  const std::size_t n = in.count(header, 2 * (D + 2));
  const std::int64_t corners = in.more_on_line() ? in.integer(header) : D + 1;
  if (corners != D + 1)
    in.fail(Errc::unknown_format,
            "cells of " + std::to_string(corners) + " points are not read in " + std::to_string(D) + "D: only simplices are");
  const std::size_t attributes = in.more_on_line() ? in.count({"attributes of a cell"}, 1) : 0;
  in.end_line(header);
  mesh.cells.reserve(n);
  if (attributes != 0) mesh.regions.reserve(n);
  for (std::size_t i = 0; i < n; ++i) {
    const Subject s{"cell", static_cast<std::int64_t>(numbering.first + i)};
    in.require(s);
    in.integer(s);
    mesh.cells.push_back(read_vertices<D + 1>(in, s, numbering));
    for (std::size_t a = 0; a < attributes; ++a) {
      const double value = in.number(s);
      if (a == 0) mesh.regions.push_back(value);
    }
    in.end_line({"the end of a cell"});
  }
  require_end(in);
}

/// A .face or .edge file. What follows the marker (neighbours, inner points) is stepped over.
template <int K, int D>
void read_constraints(std::string_view text, const std::string& file, const Numbering& numbering,
                      std::vector<typename OutputMesh<D>::template Constraint<K>>& constraints) {
  const Subject header{K == 3 ? "the list of faces" : "the list of edges"};
  LineScanner in(text, file);
  in.require(header);
  const std::size_t n = in.count(header, 2 * (K + 1));
  const bool markers = in.more_on_line() && in.integer(header) != 0;
  in.end_line(header);
  constraints.reserve(n);
  for (std::size_t i = 0; i < n; ++i) {
    const Subject s{K == 3 ? "face" : "edge", static_cast<std::int64_t>(numbering.first + i)};
    in.require(s);
    in.integer(s);
    auto& c = constraints.emplace_back();
    c.vertices = read_vertices<K>(in, s, numbering);
    if (markers) c.marker = in.marker(s);
    while (in.more_on_line()) in.integer(s);
  }
  require_end(in);
}

}  // namespace

std::string tetgen_name(const std::filesystem::path& file, std::string_view extension) {
  const std::string own = lower_extension(file);
  std::string name = file.string();
  if (own != extension) name.replace(name.size() - own.size(), own.size(), extension);
  return name;
}

template <int D>
OutputMesh<D> read_tetgen(const TetgenTexts& texts, const std::filesystem::path& file) {
  const auto name = [&file](std::string_view extension) { return tetgen_name(file, extension); };
  Plc<D> nodes = read_node<D>(texts.node, name(".node"));
  OutputMesh<D> mesh;
  mesh.points = std::move(nodes.points);
  mesh.point_markers = std::move(nodes.point_markers);
  mesh.point_attributes = std::move(nodes.point_attributes);
  mesh.input_points = read_comment(texts.node, input_points_comment, 0, mesh.points.size(), name(".node"));
  mesh.names = read_name_comments(leading_comments(texts.node), name(".node"));
  const Numbering numbering{nodes.first_index, mesh.points.size()};
  read_ele<D>(texts.ele, name(".ele"), numbering, mesh);
  if (texts.edge) {
    read_constraints<2, D>(*texts.edge, name(".edge"), numbering, mesh.subsegments);
    const std::size_t edges = mesh.subsegments.size();
    mesh.subsegments.resize(read_comment(*texts.edge, subsegments_comment, edges, edges, name(".edge")));
  }
  if constexpr (D == 3) {
    if (texts.face) read_constraints<3, D>(*texts.face, name(".face"), numbering, mesh.subfacets);
  }
  return mesh;
}

template OutputMesh<2> read_tetgen<2>(const TetgenTexts&, const std::filesystem::path&);
template OutputMesh<3> read_tetgen<3>(const TetgenTexts&, const std::filesystem::path&);

}  // namespace pgdr::detail
