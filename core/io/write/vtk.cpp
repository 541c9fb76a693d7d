// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Writes VTK's legacy .vtk, version 3.0, as text, for programs that take no .vtu: the cells, in 3D the subfacets, and the
// subsegments, with the cell data region (0 for constraints) and marker (0 for cells), and point data marker if there are any.
// Names are field data as in a .vtu, pairs of a label or marker and the dimension of what has it; what VTK has as %20 in names of
// arrays is so here.
#include <array>
#include <string>

#include "io/formats.hpp"

namespace pgdr::detail {
namespace {

constexpr std::array<int, 5> type_of_size{0, 1, 3, 5, 10};  // VTK_LINE, VTK_TRIANGLE, VTK_TETRA by their corners

/// As vtkDataWriter encodes names of arrays.
std::string encoded(std::string_view name) {
  constexpr std::string_view digits = "0123456789ABCDEF";
  std::string made;
  for (const char c : name) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte > ' ' && byte < 127 && c != '"' && c != '%')
      made += c;
    else
      ((made += '%') += digits[byte / 16]) += digits[byte % 16];
  }
  return made;
}

void put_lines(FileOutput& out, std::string_view text, std::size_t n) {
  out.put(text);
  out.put_number(n);
  out.put('\n');
}

template <int D>
void put_field_data(FileOutput& out, const Names& names) {
  if (names.regions.empty() && names.markers.empty()) return;
  put_lines(out, "FIELD FieldData ", names.regions.size() + names.markers.size());
  const auto put = [&out](const auto& of_labels, int dimension) {
    for (const auto& [label, name] : of_labels) {
      out.put(encoded(name));
      out.put(" 2 1 double\n");
      out.put_number(label);
      out.put(' ');
      out.put_number(dimension);
      out.put('\n');
    }
  };
  put(names.regions, D);
  put(names.markers, D - 1);
}

template <class Items, class Corners>
void put_cells(FileOutput& out, const Items& items, const Corners& corners) {
  out.put_each(items.size(), [&](TextBuffer& text, std::size_t i) {
    const auto& v = corners(items[i]);
    text.put_number(v.size());
    for (const std::uint32_t p : v) {
      text.put(' ');
      text.put_number(p);
    }
    text.put('\n');
  });
}

/// One number a line for so many things.
template <class Value>
void put_values(FileOutput& out, std::size_t count, const Value& value) {
  out.put_each(count, [&](TextBuffer& text, std::size_t i) {
    text.put_number(value(i));
    text.put('\n');
  });
}

template <int D>
void put_cell_data(const OutputMesh<D>& mesh, std::size_t all, FileOutput& out) {
  const std::size_t cells = mesh.cells.size();
  put_lines(out, "CELL_DATA ", all);
  out.put("SCALARS region double 1\nLOOKUP_TABLE default\n");
  put_values(out, all, [&](std::size_t i) { return i < cells && !mesh.regions.empty() ? mesh.regions[i] : 0.0; });
  out.put("SCALARS marker int 1\nLOOKUP_TABLE default\n");
  put_values(out, cells, [](std::size_t) { return 0; });
  if constexpr (D == 3) put_values(out, mesh.subfacets.size(), [&](std::size_t i) { return mesh.subfacets[i].marker; });
  put_values(out, mesh.subsegments.size(), [&](std::size_t i) { return mesh.subsegments[i].marker; });
}

}  // namespace

template <int D>
void write_vtk(const OutputMesh<D>& mesh, FileOutput& out) {
  out.put("# vtk DataFile Version 3.0\npgdr mesh\nASCII\nDATASET UNSTRUCTURED_GRID\n");
  put_field_data<D>(out, mesh.names);
  out.put("POINTS ");
  out.put_number(mesh.points.size());
  out.put(" double\n");
  out.put_each(mesh.points.size(), [&](TextBuffer& text, std::size_t i) {
    for (int k = 0; k < 3; ++k) {
      text.put_number(k < D ? mesh.points[i][k] : 0.0);
      text.put(k < 2 ? ' ' : '\n');
    }
  });
  const std::size_t cells = mesh.cells.size(), facets = D == 3 ? mesh.subfacets.size() : 0, segments = mesh.subsegments.size();
  const std::size_t all = cells + facets + segments;
  out.put("CELLS ");
  out.put_number(all);
  put_lines(out, " ", (D + 2) * cells + 4 * facets + 3 * segments);
  const auto vertices = [](const auto& constraint) -> const auto& { return constraint.vertices; };
  put_cells(
      out, mesh.cells, [](const auto& cell) -> const auto& { return cell; });
  if constexpr (D == 3) put_cells(out, mesh.subfacets, vertices);
  put_cells(out, mesh.subsegments, vertices);
  put_lines(out, "CELL_TYPES ", all);
  put_values(out, all, [&](std::size_t i) { return type_of_size[i < cells ? D + 1 : i < cells + facets ? 3 : 2]; });
  put_cell_data(mesh, all, out);
  if (mesh.point_markers.empty()) return;
  put_lines(out, "POINT_DATA ", mesh.points.size());
  out.put("SCALARS marker int 1\nLOOKUP_TABLE default\n");
  put_values(out, mesh.points.size(), [&](std::size_t i) { return mesh.point_markers[i]; });
}

template void write_vtk<2>(const OutputMesh<2>&, FileOutput&);
template void write_vtk<3>(const OutputMesh<3>&, FileOutput&);

}  // namespace pgdr::detail
