// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Meshes as TetGen (3D) and Triangle (2D) have them: X.node and X.ele, and, where they are there, X.face (subfacets)
// and X.edge (subsegments). They are numbered from 0 or 1. The attribute of a cell is its region. A comment at the head of
// X.node, "# pgdr input_points <n>", tells the input points from the others; further ones tell names; one at the head of X.edge,
// "# pgdr subsegments <n>", the subsegments, which come first, from the other edges. Cells of second order (-o2), of 10 nodes, in
// 2D 6, are read by their corners, which come first; so are faces and edges.
#include <algorithm>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "io/formats.hpp"
#include "output/simplices.hpp"
#include "pgdr/mesh_maps.hpp"
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

/// Nodes in the middles of edges: one a point; empty where cells are of first order.
using MidSideMarks = std::vector<std::uint8_t>;

template <int D>
void read_ele(std::string_view text, const std::string& file, const Numbering& numbering, OutputMesh<D>& mesh,
              MidSideMarks& middles) {
  constexpr Subject header{"the list of cells"};
  LineScanner in(text, file);
  in.require(header);
  const std::size_t n = in.count(header, 2 * (D + 2));
  const std::int64_t corners = in.more_on_line() ? in.integer(header) : D + 1;
  constexpr std::int64_t second_order = (D + 1) * (D + 2) / 2;
  if (corners != D + 1 && corners != second_order)
    in.fail(Errc::unknown_format,
            "cells of " + std::to_string(corners) + " points are not read in " + std::to_string(D) + "D: only simplices are");
  if (corners == second_order) middles.resize(mesh.points.size());
  const std::size_t attributes = in.more_on_line() ? in.count({"attributes of a cell"}, 1) : 0;
  in.end_line(header);
  mesh.cells.reserve(n);
  if (attributes != 0) mesh.regions.reserve(n);
  for (std::size_t i = 0; i < n; ++i) {
    const Subject s{"cell", static_cast<std::int64_t>(numbering.first + i)};
    in.require(s);
    in.integer(s);
    mesh.cells.push_back(read_vertices<D + 1>(in, s, numbering));
    for (std::int64_t k = D + 1; k < corners; ++k) middles[in.reference(s, numbering.first, numbering.points)] = 1;
    for (std::size_t a = 0; a < attributes; ++a) {
      const double value = in.number(s);
      if (a == 0) mesh.regions.push_back(value);
    }
    in.end_line({"the end of a cell"});
  }
  require_end(in);
}

/// The marker of a face or edge of second order, from what follows its corners: nodes in the middles of edges, where they are
/// there, and the marker.
template <int K>
int marker_behind(LineScanner& in, Subject s, const Numbering& numbering, const MidSideMarks& middles) {
  constexpr std::size_t nodes = K * (K - 1) / 2;
  std::vector<std::int64_t> rest;
  while (in.more_on_line()) rest.push_back(in.integer(s));
  const auto is_middle = [&](std::int64_t v) {
    const std::int64_t i = v - numbering.first;
    return i >= 0 && static_cast<std::size_t>(i) < middles.size() && middles[static_cast<std::size_t>(i)] != 0;
  };
  const bool has_nodes = rest.size() > nodes && std::all_of(rest.begin(), rest.begin() + nodes, is_middle);
  const std::size_t at = has_nodes ? nodes : 0;
  if (rest.size() <= at) in.fail(Errc::truncated, "a marker is missing", {s.id});
  if (rest[at] < -2147483648 || rest[at] > 2147483647) in.fail(Errc::syntax, "a marker is no number of 32 bits", {s.id});
  return static_cast<int>(rest[at]);
}

/// A .face or .edge file. What follows the marker (neighbours, inner points) is stepped over.
template <int K, int D>
void read_constraints(std::string_view text, const std::string& file, const Numbering& numbering, const MidSideMarks& middles,
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
    if (markers) c.marker = middles.empty() ? in.marker(s) : marker_behind<K>(in, s, numbering, middles);
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

namespace {

/// Takes out the nodes in the middles of edges that nothing has as a corner. @returns how many these are
template <int D>
std::size_t drop_middles(OutputMesh<D>& mesh, MidSideMarks middles) {
  if (middles.empty()) return 0;
  each_simplex(mesh, [&](const auto& vertices) {
    for (const std::uint32_t v : vertices) middles[v] = 0;
  });
  std::vector<std::uint32_t> dropped;
  for (std::uint32_t v = 0; v < middles.size(); ++v)
    if (middles[v] != 0) dropped.push_back(v);
  drop_points(mesh, std::span<const std::uint32_t>(dropped));
  return dropped.size();
}

}  // namespace

template <int D>
OutputMesh<D> read_tetgen(const TetgenTexts& texts, const std::filesystem::path& file, std::size_t* left_out) {
  const auto name = [&file](std::string_view extension) { return tetgen_name(file, extension); };
  Plc<D> nodes = read_node<D>(texts.node, name(".node"));
  OutputMesh<D> mesh;
  mesh.points = std::move(nodes.points);
  mesh.point_markers = std::move(nodes.point_markers);
  mesh.point_attributes = std::move(nodes.point_attributes);
  mesh.input_points = read_comment(texts.node, input_points_comment, 0, mesh.points.size(), name(".node"));
  mesh.names = read_name_comments(leading_comments(texts.node), name(".node"));
  const Numbering numbering{nodes.first_index, mesh.points.size()};
  MidSideMarks middles;
  read_ele<D>(texts.ele, name(".ele"), numbering, mesh, middles);
  if (texts.edge) {
    read_constraints<2, D>(*texts.edge, name(".edge"), numbering, middles, mesh.subsegments);
    const std::size_t edges = mesh.subsegments.size();
    mesh.subsegments.resize(read_comment(*texts.edge, subsegments_comment, edges, edges, name(".edge")));
  }
  if constexpr (D == 3) {
    if (texts.face) read_constraints<3, D>(*texts.face, name(".face"), numbering, middles, mesh.subfacets);
  }
  const std::size_t dropped = drop_middles(mesh, std::move(middles));
  if (left_out != nullptr) *left_out = dropped;
  return mesh;
}

template OutputMesh<2> read_tetgen<2>(const TetgenTexts&, const std::filesystem::path&, std::size_t*);
template OutputMesh<3> read_tetgen<3>(const TetgenTexts&, const std::filesystem::path&, std::size_t*);

}  // namespace pgdr::detail
