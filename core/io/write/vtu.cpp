// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// VTK's XML file of an unstructured grid, all arrays appended as raw bytes, so that writing is copying and doubles keep
// their bits. Cells come first, then subfacets (3D), then subsegments; "region" and "leaf" (-1 elsewhere) mean something for
// the cells and "marker" for the others. Field data "dimension" and "input_points" let our reader restore the mesh.
#include <functional>
#include <initializer_list>
#include <string>
#include <utility>

#include "io/formats.hpp"

namespace pgdr::detail {
namespace {

/// One array of the file: how it is announced, how large it is, and what puts its bytes.
struct Block {
  std::string_view section, type, name;
  std::string shape;  ///< an attribute of the announcement, or empty
  std::uint64_t bytes;
  std::function<void(FileOutput&)> put;
  std::uint64_t offset = 0;  ///< in the appended data
};

template <int D>
std::size_t grid_cells(const OutputMesh<D>& mesh) {
  return mesh.cells.size() + mesh.subfacets.size() + mesh.subsegments.size();
}

template <int D>
void put_points(const OutputMesh<D>& mesh, FileOutput& out) {
  out.put_each(mesh.points.size(), [&](TextBuffer& bytes, std::size_t i) {
    for (int k = 0; k < 3; ++k) bytes.put_binary(k < D ? mesh.points[i][k] : 0.0);
  });
}

template <int D>
void put_point_markers(const OutputMesh<D>& mesh, FileOutput& out) {
  for (const int m : mesh.point_markers) out.put_binary(std::int32_t{m});
}

template <int D>
void put_connectivity(const OutputMesh<D>& mesh, FileOutput& out) {
  const auto put = [&out](const auto& simplices, const auto& vertices_of) {
    out.put_each(simplices.size(), [&](TextBuffer& bytes, std::size_t i) {
      for (const std::uint32_t v : vertices_of(simplices[i])) bytes.put_binary(std::int64_t{v});
    });
  };
  const auto of_constraint = [](const auto& c) -> const auto& { return c.vertices; };
  put(
      mesh.cells, [](const auto& c) -> const auto& { return c; });
  put(mesh.subfacets, of_constraint);
  put(mesh.subsegments, of_constraint);
}

template <int D>
void put_offsets(const OutputMesh<D>& mesh, FileOutput& out) {
  std::int64_t end = 0;
  const auto put = [&](std::size_t n, std::int64_t corners) {
    out.put_each(n,
                 [&](TextBuffer& bytes, std::size_t i) { bytes.put_binary(end + static_cast<std::int64_t>(i + 1) * corners); });
    end += static_cast<std::int64_t>(n) * corners;
  };
  put(mesh.cells.size(), D + 1);
  put(mesh.subfacets.size(), 3);
  put(mesh.subsegments.size(), 2);
}

template <int D>
void put_types(const OutputMesh<D>& mesh, FileOutput& out) {
  constexpr char line = 3, triangle = 5, tetrahedron = 10;  // VTK's numbers
  out.put_each(mesh.cells.size(), [](TextBuffer& bytes, std::size_t) { bytes.put(D == 3 ? tetrahedron : triangle); });
  for (std::size_t i = 0; i < mesh.subfacets.size(); ++i) out.put(triangle);
  for (std::size_t i = 0; i < mesh.subsegments.size(); ++i) out.put(line);
}

template <int D>
void put_regions(const OutputMesh<D>& mesh, FileOutput& out) {
  out.put_each(mesh.regions.size(), [&](TextBuffer& bytes, std::size_t i) { bytes.put_binary(mesh.regions[i]); });
  for (std::size_t i = mesh.cells.size(); i < grid_cells(mesh); ++i) out.put_binary(0.0);
}

template <int D>
void put_leaves(const OutputMesh<D>& mesh, FileOutput& out) {
  out.put_each(mesh.leaves.size(), [&](TextBuffer& bytes, std::size_t i) { bytes.put_binary(std::int64_t{mesh.leaves[i]}); });
  for (std::size_t i = mesh.cells.size(); i < grid_cells(mesh); ++i) out.put_binary(std::int64_t{-1});
}

template <int D>
void put_markers(const OutputMesh<D>& mesh, FileOutput& out) {
  out.put_each(mesh.cells.size(), [](TextBuffer& bytes, std::size_t) { bytes.put_binary(std::int32_t{0}); });
  for (const auto& c : mesh.subfacets) out.put_binary(std::int32_t{c.marker});
  for (const auto& c : mesh.subsegments) out.put_binary(std::int32_t{c.marker});
}

template <int D>
std::vector<Block> blocks_of(const OutputMesh<D>& mesh) {
  const std::uint64_t points = mesh.points.size(), cells = grid_cells(mesh);
  const std::uint64_t corners = (D + 1) * mesh.cells.size() + 3 * mesh.subfacets.size() + 2 * mesh.subsegments.size();
  const std::string scalar = " NumberOfTuples=\"1\"", vector = " NumberOfComponents=\"3\"";
  std::vector<Block> blocks;
  const auto add = [&blocks](std::string_view section, std::string_view type, std::string_view name, std::string shape,
                             std::uint64_t bytes, std::function<void(FileOutput&)> put) {
    blocks.push_back({section, type, name, std::move(shape), bytes, std::move(put)});
  };
  add("FieldData", "Int64", "dimension", scalar, 8, [](auto& out) { out.put_binary(std::int64_t{D}); });
  add("FieldData", "Int64", "input_points", scalar, 8,
      [&mesh](auto& out) { out.put_binary(static_cast<std::int64_t>(mesh.input_points)); });
  if (!mesh.point_markers.empty())
    add("PointData", "Int32", "marker", "", 4 * points, [&mesh](auto& out) { put_point_markers(mesh, out); });
  if (!mesh.point_attributes.empty())
    add("PointData", "Float64", "attributes",
        " NumberOfComponents=\"" + std::to_string(mesh.point_attributes.size() / points) + "\"", 8 * mesh.point_attributes.size(),
        [&mesh](auto& out) {
          for (const double a : mesh.point_attributes) out.put_binary(a);
        });
  if (!mesh.leaves.empty()) add("CellData", "Int64", "leaf", "", 8 * cells, [&mesh](auto& out) { put_leaves(mesh, out); });
  if (!mesh.regions.empty()) add("CellData", "Float64", "region", "", 8 * cells, [&mesh](auto& out) { put_regions(mesh, out); });
  add("CellData", "Int32", "marker", "", 4 * cells, [&mesh](auto& out) { put_markers(mesh, out); });
  add("Points", "Float64", "Points", vector, 24 * points, [&mesh](auto& out) { put_points(mesh, out); });
  add("Cells", "Int64", "connectivity", "", 8 * corners, [&mesh](auto& out) { put_connectivity(mesh, out); });
  add("Cells", "Int64", "offsets", "", 8 * cells, [&mesh](auto& out) { put_offsets(mesh, out); });
  add("Cells", "UInt8", "types", "", cells, [&mesh](auto& out) { put_types(mesh, out); });
  return blocks;
}

/// The last array announced comes first. VTK takes any order; meshio, which replaces offsets one after the other and
/// looks arrays up by offset, finds the right ones only in this.
void lay_out(std::vector<Block>& blocks) {
  std::uint64_t at = 0;
  for (auto b = blocks.rbegin(); b != blocks.rend(); ++b) {
    b->offset = at;
    at += sizeof(std::uint64_t) + b->bytes;
  }
}

/// The announcements of one section.
void put_section(FileOutput& out, std::string_view section, const std::vector<Block>& blocks) {
  const auto put = [&out](std::initializer_list<std::string_view> parts) {
    for (const std::string_view part : parts) out.put(part);
  };
  put({"<", section, ">\n"});
  for (const Block& b : blocks) {
    if (b.section != section) continue;
    put({"<DataArray type=\"", b.type, "\" Name=\"", b.name, "\"", b.shape, " format=\"appended\" offset=\""});
    out.put_number(b.offset);
    out.put("\"/>\n");
  }
  put({"</", section, ">\n"});
}

}  // namespace

template <int D>
void write_vtu(const OutputMesh<D>& mesh, FileOutput& out) {
  std::vector<Block> blocks = blocks_of(mesh);
  lay_out(blocks);
  out.put(
      "<?xml version=\"1.0\"?>\n"
      "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">\n"
      "<UnstructuredGrid>\n");
  put_section(out, "FieldData", blocks);
  out.put("<Piece NumberOfPoints=\"" + std::to_string(mesh.points.size()) + "\" NumberOfCells=\"" +
          std::to_string(grid_cells(mesh)) + "\">\n");
  for (const std::string_view section : {"PointData", "CellData", "Points", "Cells"}) put_section(out, section, blocks);
  out.put("</Piece>\n</UnstructuredGrid>\n<AppendedData encoding=\"raw\">\n_");
  for (auto b = blocks.rbegin(); b != blocks.rend(); ++b) {
    out.put_binary(b->bytes);
    b->put(out);
  }
  out.put("\n</AppendedData>\n</VTKFile>\n");
}

template void write_vtu<2>(const OutputMesh<2>&, FileOutput&);
template void write_vtu<3>(const OutputMesh<3>&, FileOutput&);

}  // namespace pgdr::detail
