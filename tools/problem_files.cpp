// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Files of problems: as text, since people look at them, and they are small.
#include <functional>
#include <ostream>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "files.hpp"
#include "pgdr/error.hpp"
#include "pgdr/output_files.hpp"
#include "problems.hpp"
#include "text.hpp"

namespace pgdr::tool {
namespace {

using Cell = Problems::Cell;
using Cells = std::vector<const Cell*>;

/// In the order of all formats.
Cells all_cells(const Problems& p) {
  Cells all;
  for (const auto* some : {&p.vertices, &p.lines, &p.polygons})
    for (const Cell& cell : *some) all.push_back(&cell);
  return all;
}

struct Column {
  const char* name;
  const char* type;         // of XML
  const char* legacy_type;  // of .vtk, where gmsh reads these
  std::function<std::string(const Cell&)> text;
};

const std::vector<Column>& columns() {
  static const std::vector<Column> all{
      {"finding", "Int32", "int", [](const Cell& c) { return std::to_string(static_cast<int>(c.finding)); }},
      {"role", "Int32", "int", [](const Cell& c) { return std::to_string(static_cast<int>(c.role)); }},
      {"id", "Int64", "int", [](const Cell& c) { return std::to_string(c.ids[0]); }},
      {"other_id", "Int64", "int", [](const Cell& c) { return std::to_string(c.ids[1]); }},
      {"measure", "Float64", "double", [](const Cell& c) { return digits(c.measure); }}};
  return all;
}

void write_points(const Problems& p, std::ostream& out) {
  for (const auto& [x, y, z] : p.points) out << digits(x) << ' ' << digits(y) << ' ' << digits(z) << '\n';
}

void begin_array(std::ostream& out, const char* type, const std::string& name, int components = 1) {
  out << "<DataArray type=\"" << type << "\" Name=\"" << name << "\" NumberOfComponents=\"" << components
      << "\" format=\"ascii\">\n";
}
constexpr const char* end_of_array = "</DataArray>\n";

void write_connectivity(const Cells& cells, std::ostream& out) {
  begin_array(out, "Int64", "connectivity");
  for (const Cell* c : cells) {
    for (const std::uint32_t v : c->points) out << v << ' ';
    out << '\n';
  }
  out << end_of_array;
  begin_array(out, "Int64", "offsets");
  std::size_t end = 0;
  for (const Cell* c : cells) out << (end += c->points.size()) << '\n';
  out << end_of_array;
}

/// Words of findings, as codes of their letters, which is how VTK has strings in text.
void write_field_data(std::ostream& out) {
  out << "<FieldData>\n<Array type=\"String\" Name=\"findings\" NumberOfTuples=\"" << finding_kinds << "\" format=\"ascii\">\n";
  for (std::size_t k = 0; k < finding_kinds; ++k) {
    for (const char c : name(static_cast<Finding>(k))) out << static_cast<int>(c) << ' ';
    out << "0\n";
  }
  out << "</Array>\n</FieldData>\n";
}

void write_cell_data(const Cells& cells, std::ostream& out) {
  out << "<CellData Scalars=\"finding\">\n";
  for (const Column& column : columns()) {
    begin_array(out, column.type, column.name);
    for (const Cell* c : cells) out << column.text(*c) << '\n';
    out << end_of_array;
  }
  out << "</CellData>\n";
}

void write_xml(const Problems& p, bool is_poly_data, std::ostream& out) {
  const char* const kind = is_poly_data ? "PolyData" : "UnstructuredGrid";
  const Cells all = all_cells(p);
  out << "<?xml version=\"1.0\"?>\n<VTKFile type=\"" << kind << "\" version=\"1.0\" byte_order=\"LittleEndian\">\n<" << kind
      << ">\n";
  write_field_data(out);
  out << "<Piece NumberOfPoints=\"" << p.points.size() << "\" ";
  if (is_poly_data)
    out << "NumberOfVerts=\"" << p.vertices.size() << "\" NumberOfLines=\"" << p.lines.size()
        << "\" NumberOfStrips=\"0\" NumberOfPolys=\"" << p.polygons.size() << "\">\n";
  else
    out << "NumberOfCells=\"" << all.size() << "\">\n";
  out << "<Points>\n";
  begin_array(out, "Float64", "Points", 3);
  write_points(p, out);
  out << end_of_array << "</Points>\n";
  if (is_poly_data) {
    const std::pair<const char*, const std::vector<Cell>*> parts[] = {
        {"Verts", &p.vertices}, {"Lines", &p.lines}, {"Polys", &p.polygons}};
    for (const auto& [part, cells] : parts) {
      Cells some;
      for (const Cell& cell : *cells) some.push_back(&cell);
      out << '<' << part << ">\n";
      write_connectivity(some, out);
      out << "</" << part << ">\n";
    }
  } else {
    out << "<Cells>\n";
    write_connectivity(all, out);
    begin_array(out, "UInt8", "types");
    for (std::size_t i = 0; i < all.size(); ++i)  // VTK's numbers of a vertex, a chain of edges, a polygon
      out << (i < p.vertices.size() ? 1 : i < p.vertices.size() + p.lines.size() ? 4 : 7) << '\n';
    out << end_of_array << "</Cells>\n";
  }
  write_cell_data(all, out);
  out << "</Piece>\n</" << kind << ">\n</VTKFile>\n";
}

void write_legacy(const Problems& p, std::ostream& out) {
  out << "# vtk DataFile Version 3.0\npgdr: what is wrong with an input\nASCII\nDATASET POLYDATA\nPOINTS " << p.points.size()
      << " double\n";
  write_points(p, out);
  const std::pair<const char*, const std::vector<Cell>*> parts[] = {
      {"VERTICES", &p.vertices}, {"LINES", &p.lines}, {"POLYGONS", &p.polygons}};
  for (const auto& [part, cells] : parts) {
    if (cells->empty()) continue;
    std::size_t numbers = cells->size();
    for (const Cell& c : *cells) numbers += c.points.size();
    out << part << ' ' << cells->size() << ' ' << numbers << '\n';
    for (const Cell& c : *cells) {
      out << c.points.size();
      for (const std::uint32_t v : c.points) out << ' ' << v;
      out << '\n';
    }
  }
  const Cells all = all_cells(p);
  if (all.empty()) return;
  out << "CELL_DATA " << all.size() << '\n';
  for (const Column& column : columns()) {
    out << "SCALARS " << column.name << ' ' << column.legacy_type << " 1\nLOOKUP_TABLE default\n";
    for (const Cell* c : all) out << column.text(*c) << '\n';
  }
}

void write_obj(const Problems& p, std::ostream& out) {
  out << "# pgdr: what is wrong with an input\n";
  for (const auto& [x, y, z] : p.points) out << "v " << digits(x) << ' ' << digits(y) << ' ' << digits(z) << '\n';
  for (std::size_t k = 0; k < finding_kinds; ++k) {
    bool is_first = true;
    for (const Cell* c : all_cells(p)) {
      if (c->finding != static_cast<Finding>(k)) continue;
      if (std::exchange(is_first, false)) out << "g " << name(c->finding) << '\n';
      const bool is_polygon = c >= p.polygons.data() && c < p.polygons.data() + p.polygons.size();
      out << (c->points.size() == 1 ? 'p' : is_polygon ? 'f' : 'l');
      for (const std::uint32_t v : c->points) out << ' ' << v + 1;
      out << '\n';
    }
  }
}

}  // namespace

void require_problems_writable(const std::string& file) {
  if (!has_extension(file, {".vtp", ".vtu", ".vtk", ".obj"}))
    throw UsageError({.code = Errc::unknown_format, .message = "problems are written as .vtp, .vtu, .vtk or .obj", .file = file});
  require_writable(file);
}

void write_problems(const Problems& problems, const std::string& file) {
  write_file(file, [&](std::ostream& out) {
    if (has_extension(file, {".vtp", ".vtu"}))
      write_xml(problems, has_extension(file, {".vtp"}), out);
    else if (has_extension(file, {".vtk"}))
      write_legacy(problems, out);
    else
      write_obj(problems, out);
  });
}

}  // namespace pgdr::tool
