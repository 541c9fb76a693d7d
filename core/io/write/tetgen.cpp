// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Meshes as TetGen (3D) and Triangle (2D) write them; io/read/tetgen.cpp says which files, and reads them.
#include <algorithm>
#include <iterator>
#include <memory>
#include <vector>

#include "io/formats.hpp"
#include "pgdr/mesh_maps.hpp"

namespace pgdr::detail {
namespace {

/// "<i> <vertex> ... "
template <std::size_t N>
void put_simplex(TextBuffer& out, std::size_t i, const std::array<std::uint32_t, N>& vertices, std::uint32_t first) {
  out.put_number(i + first);
  for (const std::uint32_t v : vertices) {
    out.put(' ');
    out.put_number(std::uint64_t{v} + first);
  }
}

void put_count(FileOutput& out, std::string_view comment, std::size_t n) {
  out.put(comment);
  out.put_number(n);
  out.put('\n');
}

template <int D>
void put_node(FileOutput& out, const OutputMesh<D>& mesh, std::uint32_t first) {
  if (mesh.input_points != 0) put_count(out, input_points_comment, mesh.input_points);
  out.put(name_comments(mesh.names));
  const std::size_t attributes = mesh.points.empty() ? 0 : mesh.point_attributes.size() / mesh.points.size();
  out.put_number(mesh.points.size());
  out.put(D == 2 ? " 2 " : " 3 ");
  out.put_number(attributes);
  out.put(mesh.point_markers.empty() ? " 0\n" : " 1\n");
  out.put_each(mesh.points.size(), [&](TextBuffer& text, std::size_t i) {
    text.put_number(i + first);
    for (int k = 0; k < D; ++k) {
      text.put(' ');
      text.put_number(mesh.points[i][k]);
    }
    for (std::size_t k = 0; k < attributes; ++k) {
      text.put(' ');
      text.put_number(mesh.point_attributes[i * attributes + k]);
    }
    if (!mesh.point_markers.empty()) {
      text.put(' ');
      text.put_number(mesh.point_markers[i]);
    }
    text.put('\n');
  });
}

template <int D>
void put_ele(FileOutput& out, const OutputMesh<D>& mesh, std::uint32_t first) {
  out.put_number(mesh.cells.size());
  out.put(D == 2 ? " 3 " : " 4 ");
  out.put(mesh.regions.empty() ? "0\n" : "1\n");
  out.put_each(mesh.cells.size(), [&](TextBuffer& text, std::size_t i) {
    put_simplex(text, i, mesh.cells[i], first);
    if (!mesh.regions.empty()) {
      text.put(' ');
      text.put_number(mesh.regions[i]);
    }
    text.put('\n');
  });
}

template <class Constraints>
void put_constraints(FileOutput& out, const Constraints& constraints, std::size_t count, std::uint32_t first) {
  out.put_number(count);
  out.put(" 1\n");
  out.put_each(constraints.size(), [&](TextBuffer& text, std::size_t i) {
    put_simplex(text, i, constraints[i].vertices, first);
    text.put(' ');
    text.put_number(constraints[i].marker);
    text.put('\n');
  });
}

using Edge = std::array<std::uint32_t, 2>;

/// Edges of cells that are no subsegments, sorted.
template <int D>
std::vector<Edge> other_edges(const OutputMesh<D>& mesh) {
  std::vector<Edge> edges, subsegments;
  edges.reserve(mesh.cells.size() * D * (D + 1) / 2);
  for (const auto& c : mesh.cells)
    for (int i = 0; i <= D; ++i)
      for (int j = i + 1; j <= D; ++j) edges.push_back({std::min(c[i], c[j]), std::max(c[i], c[j])});
  for (const auto& s : mesh.subsegments) {
    const auto [a, b] = s.vertices;
    subsegments.push_back({std::min(a, b), std::max(a, b)});
  }
  for (auto* list : {&edges, &subsegments}) {
    std::sort(list->begin(), list->end());
    list->erase(std::unique(list->begin(), list->end()), list->end());
  }
  std::vector<Edge> others;
  std::set_difference(edges.begin(), edges.end(), subsegments.begin(), subsegments.end(), std::back_inserter(others));
  return others;
}

template <int D>
void put_edges(FileOutput& out, const OutputMesh<D>& mesh, const WriteOptions& options) {
  const std::size_t n = mesh.subsegments.size();
  if (!options.edges) return put_constraints(out, mesh.subsegments, n, options.first_index);
  const std::vector<Edge> others = other_edges(mesh);
  put_count(out, subsegments_comment, n);
  put_constraints(out, mesh.subsegments, n + others.size(), options.first_index);
  out.put_each(others.size(), [&](TextBuffer& text, std::size_t i) {
    put_simplex(text, n + i, others[i], options.first_index);
    text.put(" 0\n");
  });
}

template <int D>
void put_neighbors(FileOutput& out, const OutputMesh<D>& mesh, std::uint32_t first) {
  const auto neighbors = neighbors_of_cells<D>(mesh);
  out.put_number(mesh.cells.size());
  out.put(D == 2 ? " 3\n" : " 4\n");
  out.put_each(neighbors.size(), [&](TextBuffer& text, std::size_t c) {
    text.put_number(c + first);
    for (const std::uint32_t n : neighbors[c]) {
      text.put(' ');
      text.put_number(n == no_cell_beyond ? std::int64_t{-1} : std::int64_t{n} + first);
    }
    text.put('\n');
  });
}

}  // namespace

template <int D>
void write_tetgen(const OutputMesh<D>& mesh, const std::filesystem::path& file, const WriteOptions& options) {
  std::vector<std::unique_ptr<FileOutput>> files;
  const auto open = [&](std::string_view extension) -> FileOutput& {
    if (!files.empty()) files.back()->close();  // who reads one FIFO after the other waits for the end of each
    return *files.emplace_back(std::make_unique<FileOutput>(tetgen_name(file, extension)));
  };
  put_node<D>(open(".node"), mesh, options.first_index);
  if constexpr (D == 3) put_constraints(open(".face"), mesh.subfacets, mesh.subfacets.size(), options.first_index);
  put_edges<D>(open(".edge"), mesh, options);
  if (options.neighbors) put_neighbors<D>(open(".neigh"), mesh, options.first_index);
  put_ele<D>(open(".ele"), mesh, options.first_index);
  commit_together(files);
}

template void write_tetgen<2>(const OutputMesh<2>&, const std::filesystem::path&, const WriteOptions&);
template void write_tetgen<3>(const OutputMesh<3>&, const std::filesystem::path&, const WriteOptions&);

}  // namespace pgdr::detail
