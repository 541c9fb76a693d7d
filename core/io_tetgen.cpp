// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Meshes as TetGen (3D) and Triangle (2D) have them: X.node and X.ele, and, where they are there, X.face (subfacets)
// and X.edge (subsegments). Ours are numbered from 1; those that are read may be from 0. The attribute of a cell is its
// region. A comment at the head of X.node, "# pgdr input_points <n>", tells the input points from the others.
#include <string>

#include "detail/io_formats.hpp"
#include "detail/line_scanner.hpp"

namespace pgdr::detail {
namespace {

constexpr std::string_view input_points_comment = "# pgdr input_points ";

std::size_t read_input_points(std::string_view text, std::size_t points, const std::string& file) {
  if (!text.starts_with(input_points_comment)) return 0;
  const std::string_view line = text.substr(0, text.find('\n'));
  const auto n = parse_integer(line.substr(input_points_comment.size()));
  if (!n || *n < 0 || static_cast<std::uint64_t>(*n) > points)
    throw InputError(
        Diagnostic{Errc::syntax, "the comment " + quoted(line) + " names no number of points", file, 1, {}, {}});
  return static_cast<std::size_t>(*n);
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
    in.fail(Errc::unknown_format, "cells of " + std::to_string(corners) + " points are not read in " +
                                      std::to_string(D) + "D: only simplices are");
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
void read_constraints(const std::string& text, const std::string& file, const Numbering& numbering,
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

/// "<i> <vertex> ... ", all counted from 1.
template <std::size_t N>
void put_simplex(FileOutput& out, std::size_t i, const std::array<std::uint32_t, N>& vertices) {
  out.put_number(i + 1);
  for (const std::uint32_t v : vertices) {
    out.put(' ');
    out.put_number(std::uint64_t{v} + 1);
  }
}

template <int D>
void put_node(FileOutput& out, const OutputMesh<D>& mesh) {
  if (mesh.input_points != 0) {
    out.put(input_points_comment);
    out.put_number(mesh.input_points);
    out.put('\n');
  }
  out.put_number(mesh.points.size());
  out.put(D == 2 ? " 2 0 " : " 3 0 ");
  out.put(mesh.point_markers.empty() ? "0\n" : "1\n");
  for (std::size_t i = 0; i < mesh.points.size(); ++i) {
    out.put_number(i + 1);
    for (int k = 0; k < D; ++k) {
      out.put(' ');
      out.put_number(mesh.points[i][k]);
    }
    if (!mesh.point_markers.empty()) {
      out.put(' ');
      out.put_number(mesh.point_markers[i]);
    }
    out.put('\n');
  }
}

template <int D>
void put_ele(FileOutput& out, const OutputMesh<D>& mesh) {
  out.put_number(mesh.cells.size());
  out.put(D == 2 ? " 3 " : " 4 ");
  out.put(mesh.regions.empty() ? "0\n" : "1\n");
  for (std::size_t i = 0; i < mesh.cells.size(); ++i) {
    put_simplex(out, i, mesh.cells[i]);
    if (!mesh.regions.empty()) {
      out.put(' ');
      out.put_number(mesh.regions[i]);
    }
    out.put('\n');
  }
}

template <class Constraints>
void put_constraints(FileOutput& out, const Constraints& constraints) {
  out.put_number(constraints.size());
  out.put(" 1\n");
  for (std::size_t i = 0; i < constraints.size(); ++i) {
    put_simplex(out, i, constraints[i].vertices);
    out.put(' ');
    out.put_number(constraints[i].marker);
    out.put('\n');
  }
}

}  // namespace

std::string tetgen_name(const std::filesystem::path& file, std::string_view extension) {
  const std::string own = lower_extension(file);
  std::string name = file.native();
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
  mesh.input_points = read_input_points(texts.node, mesh.points.size(), name(".node"));
  const Numbering numbering{nodes.first_index, mesh.points.size()};
  read_ele<D>(texts.ele, name(".ele"), numbering, mesh);
  if (texts.edge != nullptr)
    read_constraints<2, D>(*texts.edge, name(".edge"), numbering, mesh.subsegments);
  if constexpr (D == 3) {
    if (texts.face != nullptr)
      read_constraints<3, D>(*texts.face, name(".face"), numbering, mesh.subfacets);
  }
  return mesh;
}

template <int D>
void write_tetgen(const OutputMesh<D>& mesh, const std::filesystem::path& file) {
  std::vector<std::unique_ptr<FileOutput>> files;
  const auto open = [&](std::string_view extension) -> FileOutput& {
    return *files.emplace_back(std::make_unique<FileOutput>(tetgen_name(file, extension)));
  };
  put_node<D>(open(".node"), mesh);
  if constexpr (D == 3) put_constraints(open(".face"), mesh.subfacets);
  put_constraints(open(".edge"), mesh.subsegments);
  put_ele<D>(open(".ele"), mesh);
  commit_together(files);
}

template OutputMesh<2> read_tetgen<2>(const TetgenTexts&, const std::filesystem::path&);
template OutputMesh<3> read_tetgen<3>(const TetgenTexts&, const std::filesystem::path&);
template void write_tetgen<2>(const OutputMesh<2>&, const std::filesystem::path&);
template void write_tetgen<3>(const OutputMesh<3>&, const std::filesystem::path&);

}  // namespace pgdr::detail
