// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Reads VTK's legacy .vtk, versions 1.0 to 5.1, as text or binary: unstructured grids and polygonal data. Lines and polylines,
// triangles, strips, quadrilaterals and tetrahedra are taken; single vertices are not cells of ours. Cell data "region" and
// "marker", point data "marker", and names as pairs of a label and a dimension in field data are as io/write/vtk.cpp writes them;
// all other arrays of point and cell data are fields. The VTK User's Guide, "VTK file formats"; of 5.1 https://docs.vtk.org,
// "VTKLegacyFileFormat": offsets before connectivity.
#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>

#include "io/formats.hpp"
#include "scan/byte_order.hpp"
#include "scan/clean_name.hpp"
#include "scan/line_scanner.hpp"

namespace pgdr::detail {
namespace {

template <class T>
double load_as_double(std::string_view bytes, std::size_t i) {
  return static_cast<double>(load<T>(bytes, i * sizeof(T), std::endian::big));
}

/// A type of numbers, as the format calls it.
struct VtkType {
  std::string_view name;
  std::size_t bytes;
  bool is_integer;
  double (*load)(std::string_view bytes, std::size_t i);  ///< the i-th
};

template <class T>
constexpr VtkType vtk_type(std::string_view name) {
  return {name, sizeof(T), std::is_integral_v<T>, load_as_double<T>};
}

/// vtkIdType is an int in files, whatever it is in programs.
constexpr VtkType vtk_types[] = {
    vtk_type<double>("double"),
    vtk_type<float>("float"),
    vtk_type<std::int32_t>("int"),
    vtk_type<std::uint32_t>("unsigned_int"),
    vtk_type<std::int64_t>("long"),
    vtk_type<std::uint64_t>("unsigned_long"),
    vtk_type<std::int16_t>("short"),
    vtk_type<std::uint16_t>("unsigned_short"),
    vtk_type<std::int8_t>("char"),
    vtk_type<std::uint8_t>("unsigned_char"),
    vtk_type<std::int32_t>("vtkidtype"),
    vtk_type<std::int64_t>("vtktypeint64"),
    vtk_type<std::uint64_t>("vtktypeuint64"),
    vtk_type<std::int8_t>("signed_char"),
};

std::string lowered(std::string_view word) {
  std::string lower(word);
  for (char& c : lower) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return lower;
}

/// As vtkDataReader decodes names: %20 is a blank.
std::string decoded(std::string_view name) {
  std::string made;
  for (std::size_t i = 0; i < name.size(); ++i) {
    const auto digit = [&](std::size_t at) { return at < name.size() && std::isxdigit(static_cast<unsigned char>(name[at])); };
    if (name[i] == '%' && digit(i + 1) && digit(i + 2)) {
      made += static_cast<char>(std::stoi(std::string(name.substr(i + 1, 2)), nullptr, 16));
      i += 2;
    } else {
      made += name[i];
    }
  }
  return clean_name(made);
}

/// What a file holds, before it is put together.
struct VtkFile {
  FileMesh mesh;
  std::vector<std::size_t> triangle_rows, tetrahedron_rows;  ///< of the cells of the file, of each
  std::size_t cells = 0;                                     ///< all of the file
  std::vector<MeshField> fields;                             ///< for all points, or all cells of the file
};

class VtkReader {
 public:
  VtkReader(std::string_view text, const std::string& file) : in_(text, file) { file_.mesh.file = file; }

  VtkFile read() {
    read_head();
    while (in_.advance()) read_section(words_of_line());
    finish();
    return std::move(file_);
  }

 private:
  enum : int { line = 3, polyline = 4, triangle = 5, strip = 6, polygon = 7, pixel = 8, quad = 9, tetrahedron = 10 };
  enum : int { quadratic_line = 21, quadratic_triangle = 22, quadratic_tetrahedron = 24 };
  enum class About { mesh, points, cells };
  static constexpr std::size_t most_components = 1024;

  /// The words of the line, which is left.
  std::vector<std::string_view> words_of_line() {
    std::string_view rest = in_.rest_of_line();
    std::vector<std::string_view> words;
    constexpr std::string_view blanks = " \t\r";
    for (;;) {
      const std::size_t begin = rest.find_first_not_of(blanks);
      if (begin == std::string_view::npos) return words;
      rest.remove_prefix(begin);
      const std::size_t end = std::min(rest.find_first_of(blanks), rest.size());
      words.push_back(rest.substr(0, end));
      rest.remove_prefix(end);
    }
  }
  std::vector<std::string_view> next_words() {
    in_.require({"a section"});
    return words_of_line();
  }

  /// Stands at the first byte of the next line, whatever this one still holds.
  void leave_line() {
    in_.skip_line();
    if (in_.remaining() > 0) in_.enter_bytes({"a line"});
  }

  void read_head() {
    constexpr std::string_view magic = "# vtk DataFile Version ";
    const std::string_view head = in_.rest_of_line();
    if (!head.starts_with(magic)) in_.fail(Errc::unknown_format, "the file does not begin with '# vtk DataFile Version'");
    const auto version = parse_double(head.substr(magic.size(), head.find_first_of(" \t\r", magic.size()) - magic.size()));
    if (!version || !(*version >= 1) || !(*version < 6)) in_.fail(Errc::unknown_format, "versions 1.0 to 5.1 are read");
    has_offsets_ = *version >= 5;
    leave_line();
    leave_line();  // the title
    const auto words = next_words();
    const std::string coding = words.empty() ? "" : lowered(words[0]);
    if (coding != "ascii" && coding != "binary") in_.fail(Errc::syntax, "the third line is neither ASCII nor BINARY");
    is_binary_ = coding == "binary";
  }

  void read_section(const std::vector<std::string_view>& words) {
    const std::string keyword = lowered(words.empty() ? "" : words[0]);
    const auto with = [&](std::size_t n) {
      if (words.size() < n) in_.fail(Errc::syntax, detail::quoted(keyword) + " has too few words behind it");
    };
    if (keyword == "dataset") return with(2), read_dataset(lowered(words[1]));
    if (keyword == "metadata") return skip_metadata();
    if (keyword == "points") return with(3), read_points(whole(words[1]), type_of(words[2]));
    if (keyword == "cells") return with(3), read_cells(whole(words[1]), whole(words[2]), 0);
    if (keyword == "cell_types") return with(2), read_types(whole(words[1]));
    const std::pair<std::string_view, int> lists[] = {
        {"vertices", 2}, {"lines", polyline}, {"polygons", polygon}, {"triangle_strips", strip}};
    for (const auto& [name, type] : lists)
      if (keyword == name) return with(3), read_cells(whole(words[1]), whole(words[2]), type);
    if (keyword == "field") return with(3), read_arrays(whole(words[2]));
    if (keyword == "point_data") return with(2), begin_data(About::points, whole(words[1]), file_.mesh.points.size());
    if (keyword == "cell_data") return with(2), begin_data(About::cells, whole(words[1]), file_.cells);
    if (!read_attribute(keyword, words)) in_.fail(Errc::syntax, detail::quoted(keyword) + " stands where a section begins");
  }

  void read_dataset(const std::string& kind) {
    if (kind != "unstructured_grid" && kind != "polydata")
      in_.fail(Errc::unknown_format, "unstructured grids and polygonal data are read, not " + detail::quoted(kind));
  }

  /// Up to an empty line.
  void skip_metadata() {
    for (;;) {
      leave_line();
      const std::string_view rest = in_.rest();
      if (rest.empty() || rest.starts_with('\n') || rest.starts_with("\r\n")) return;
    }
  }

  std::size_t whole(std::string_view word) const {
    const auto n = parse_integer(word);
    if (!n || *n < 0) in_.fail(Errc::syntax, quoted(word) + " is no count");
    return static_cast<std::size_t>(*n);
  }
  const VtkType& type_of(std::string_view word) const {
    const std::string name = lowered(word);
    const auto* const found = std::find_if(std::begin(vtk_types), std::end(vtk_types),
                                           [&](const auto& t) { return t.name == name; });
    if (found == std::end(vtk_types)) in_.fail(Errc::unknown_format, "numbers of the type " + quoted(word) + " are not read");
    return *found;
  }

  /// So many rows of numbers.
  std::vector<double> values(const VtkType& type, std::size_t rows, std::size_t components, std::string_view what) {
    if (components > most_components)
      in_.fail(Errc::count_too_large, "an array has " + std::to_string(components) + " components");
    const Subject subject{what};
    const std::size_t bytes_each = is_binary_ ? type.bytes : 1;
    in_.check_count(subject, rows, bytes_each);
    in_.check_count(subject, rows * components, bytes_each);
    std::vector<double> all(rows * components);
    if (all.empty()) return all;
    if (!is_binary_) {
      for (double& x : all) {
        in_.require(subject);
        x = in_.number(subject, false);
      }
      return all;
    }
    in_.enter_bytes(subject);
    const std::string_view bytes = in_.bytes(subject, all.size() * type.bytes);
    for (std::size_t i = 0; i < all.size(); ++i) all[i] = type.load(bytes, i);
    return all;
  }

  void read_points(std::size_t n, const VtkType& type) {
    if (!file_.mesh.points.empty()) in_.fail(Errc::syntax, "the points come twice");
    const std::vector<double> xyz = values(type, n, 3, "the list of points");
    for (const double x : xyz)
      if (!std::isfinite(x)) in_.fail(Errc::not_finite, "a coordinate is not finite");
    file_.mesh.points.resize(n);
    for (std::size_t i = 0; i < n; ++i) file_.mesh.points[i] = {{xyz[3 * i], xyz[3 * i + 1], xyz[3 * i + 2]}};
  }

  std::uint32_t corner(double value) const {
    if (!(value >= 0 && value < static_cast<double>(file_.mesh.points.size())) || value != std::floor(value))
      in_.fail(Errc::index_out_of_range, "a cell refers to a point that is not there");
    return static_cast<std::uint32_t>(value);
  }

  /// Of a cell: its type (0: not known yet), and its corners.
  struct Cell {
    int type;
    std::vector<std::uint32_t> corners;
  };

  void read_cells(std::size_t n, std::size_t size, int type) {
    if (type == 0 && !cells_.empty()) in_.fail(Errc::syntax, "the cells come twice");
    if (has_offsets_) return read_offset_cells(n, size, type);
    const std::vector<double> numbers = values(type_of("int"), size, 1, "the list of cells");
    std::size_t at = 0;
    for (std::size_t i = 0; i < n; ++i) {
      const double count = at < size ? numbers[at++] : -1;
      if (!(count >= 0 && count <= static_cast<double>(size - at)))
        in_.fail(Errc::syntax, "the list of cells does not fit its size");
      Cell& cell = cells_.emplace_back(Cell{type, {}});
      for (auto k = static_cast<std::size_t>(count); k > 0; --k) cell.corners.push_back(corner(numbers[at++]));
    }
    file_.cells = cells_.size();
  }

  void read_offset_cells(std::size_t offsets, std::size_t corners, int type) {
    if (offsets == 0) return;
    const auto list = [&](std::string_view keyword, std::size_t n) {
      const auto words = next_words();
      if (words.size() < 2 || lowered(words[0]) != keyword)
        in_.fail(Errc::syntax, "the list of cells has no " + detail::quoted(keyword));
      return values(type_of(words[1]), n, 1, "the list of cells");
    };
    const std::vector<double> begins = list("offsets", offsets), all = list("connectivity", corners);
    for (std::size_t i = 0; i + 1 < offsets; ++i) {
      if (!(begins[i] >= 0 && begins[i] <= begins[i + 1] && begins[i + 1] <= static_cast<double>(corners)))
        in_.fail(Errc::syntax, "the offsets of the cells are out of their order");
      Cell& cell = cells_.emplace_back(Cell{type, {}});
      for (auto k = static_cast<std::size_t>(begins[i]); k < static_cast<std::size_t>(begins[i + 1]); ++k)
        cell.corners.push_back(corner(all[k]));
    }
    file_.cells = cells_.size();
  }

  void read_types(std::size_t n) {
    if (n != cells_.size()) in_.fail(Errc::syntax, "there are not as many types as cells");
    const std::vector<double> types = values(type_of("int"), n, 1, "the types of the cells");
    for (std::size_t i = 0; i < n; ++i) {
      if (!(types[i] >= 1 && types[i] <= 255)) in_.fail(Errc::syntax, "a type of a cell is no such number");
      cells_[i].type = static_cast<int>(types[i]);
    }
  }

  void begin_data(About about, std::size_t n, std::size_t wanted) {
    if (n != wanted) in_.fail(Errc::syntax, "there are not as many rows of data as points, or cells");
    about_ = about;
  }

  /// SCALARS and their like. @returns false if it is none of these
  bool read_attribute(const std::string& keyword, const std::vector<std::string_view>& words) {
    const std::pair<std::string_view, std::size_t> fixed[] = {{"vectors", 3},   {"normals", 3},    {"tensors", 9},
                                                              {"tensors6", 6},  {"global_ids", 1}, {"pedigree_ids", 1},
                                                              {"edge_flags", 1}};
    if (words.size() < 3) return false;
    for (const auto& [name, components] : fixed)
      if (keyword == name) return add_field(words[1], type_of(words[2]), components), true;
    if (keyword == "scalars") {
      const std::size_t components = words.size() > 3 ? whole(words[3]) : 1;
      const std::string name(words[1]);
      const VtkType& type = type_of(words[2]);
      std::string_view rest = in_.rest();
      rest.remove_prefix(std::min(rest.find_first_not_of("\r\n"), rest.size()));
      if (lowered(rest.substr(0, 12)) == "lookup_table") next_words();
      return add_field(name, type, components), true;
    }
    const VtkType& of_colors = type_of(is_binary_ ? "unsigned_char" : "float");
    if (keyword == "color_scalars") return add_field(words[1], of_colors, whole(words[2])), true;
    if (keyword == "texture_coordinates" && words.size() > 3)
      return add_field(words[1], type_of(words[3]), whole(words[2])), true;
    if (keyword == "lookup_table") return values(of_colors, whole(words[2]), 4, "a table of colours"), true;
    return false;
  }

  void add_field(std::string_view name, const VtkType& type, std::size_t components) {
    if (about_ == About::mesh) in_.fail(Errc::syntax, "data stand before POINT_DATA and CELL_DATA");
    const bool of_points = about_ == About::points;
    const std::size_t rows = of_points ? file_.mesh.points.size() : file_.cells;
    if (components == 0) in_.fail(Errc::syntax, "an array has no components");
    const std::string decoded_name = decoded(name);
    file_.fields.push_back({decoded_name, of_points, components, values(type, rows, components, "an array"), type.is_integer});
  }

  /// The arrays of a FIELD: of the mesh, of points or of cells.
  void read_arrays(std::size_t n) {
    for (std::size_t i = 0; i < n; ++i) {
      auto words = next_words();
      while (!words.empty() && lowered(words[0]) == "metadata") {
        skip_metadata();
        words = next_words();
      }
      if (words.size() < 4) in_.fail(Errc::syntax, "an array of a FIELD needs its name, components, rows and type");
      const std::size_t components = whole(words[1]), rows = whole(words[2]);
      if (lowered(words[3]) == "string") {
        if (is_binary_) in_.fail(Errc::unknown_format, "binary arrays of strings are not read");
        for (std::size_t k = 0; k < rows && in_.advance(); ++k) in_.skip_line();
      } else if (about_ == About::mesh) {
        const std::string name = decoded(words[0]);
        pairs_.emplace_back(name, values(type_of(words[3]), rows, components, "an array"));
        if (components != 2) pairs_.pop_back();
      } else {
        if (rows != (about_ == About::points ? file_.mesh.points.size() : file_.cells))
          in_.fail(Errc::syntax, "an array has not as many rows as there are points, or cells");
        add_field(words[0], type_of(words[3]), components);
      }
    }
  }

  /// Takes an array out of the fields; empty if there is none with one component.
  std::vector<double> take(std::string_view name, bool of_points) {
    const auto it = std::find_if(file_.fields.begin(), file_.fields.end(), [&](const MeshField& f) {
      return f.name == name && f.of_points == of_points && f.components == 1;
    });
    if (it == file_.fields.end()) return {};
    std::vector<double> values = std::move(it->values);
    file_.fields.erase(it);
    return values;
  }

  void finish() {
    FileMesh& mesh = file_.mesh;
    mesh.first_index = 0;
    for (std::size_t row = 0; row < cells_.size(); ++row) add_cell(cells_[row], row);
    const std::vector<double> regions = take("region", false), markers = take("marker", false), of_points = take("marker", true);
    mesh.point_markers.resize(mesh.points.size());
    for (std::size_t i = 0; i < of_points.size(); ++i) {
      const double marker = of_points[i];
      if (!(marker >= -2147483648.0 && marker <= 2147483647.0)) in_.fail(Errc::syntax, "a marker of a point is no such number");
      mesh.point_markers[i] = static_cast<int>(marker);
    }
    const int dimension = dimension_of(mesh);
    const auto label = [](auto& elements, const std::vector<std::size_t>& rows, const std::vector<double>& labels) {
      for (std::size_t i = 0; i < elements.size() && !labels.empty(); ++i) elements[i].label = labels[rows[i]];
    };
    label(mesh.edges, edge_rows_, markers);
    label(mesh.triangles, file_.triangle_rows, dimension == 2 ? regions : markers);
    label(mesh.quadrilaterals, quadrilateral_rows_, dimension == 2 ? regions : markers);
    label(mesh.tetrahedra, file_.tetrahedron_rows, regions);
    give_names(dimension);
  }

  /// Pairs of a label and a dimension.
  void give_names(int dimension) {
    for (const auto& [name, numbers] : pairs_)
      for (std::size_t i = 0; i + 1 < numbers.size() && !name.empty(); i += 2) {
        const double label = numbers[i];
        if (numbers[i + 1] == dimension && !std::isnan(label)) file_.mesh.names.regions[label] = name;
        if (numbers[i + 1] == dimension - 1 && std::abs(label) <= 2147483647.0 && label == std::floor(label))
          file_.mesh.names.markers[static_cast<int>(label)] = name;
      }
  }

  void add_triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::size_t row) {
    file_.mesh.triangles.push_back({{a, b, c}, 0});
    file_.triangle_rows.push_back(row);
  }

  void add_cell(const Cell& cell, std::size_t row) {
    FileMesh& mesh = file_.mesh;
    const auto& v = cell.corners;
    const auto wants = [&](bool ok) {
      if (!ok) in_.fail(Errc::syntax, "a cell has " + std::to_string(v.size()) + " corners, which its type does not have");
    };
    switch (cell.type) {
      case 0: in_.fail(Errc::syntax, "the cells have no types");
      case 1:
      case 2: return;  // points alone
      case line:
      case polyline:
        wants(v.size() >= 2 && (cell.type == polyline || v.size() == 2));
        for (std::size_t i = 0; i + 1 < v.size(); ++i) {
          mesh.edges.push_back({{v[i], v[i + 1]}, 0});
          edge_rows_.push_back(row);
        }
        return;
      case strip:
        wants(v.size() >= 3);
        for (std::size_t i = 0; i + 2 < v.size(); ++i) add_triangle(v[i + i % 2], v[i + 1 - i % 2], v[i + 2], row);
        return;
      case quadratic_line:
      case quadratic_triangle:
      case quadratic_tetrahedron: return add_by_corners(cell, row);
      case triangle:
      case pixel:
      case quad:
      case polygon: return add_polygon(cell, row);
      case tetrahedron:
        wants(v.size() == 4);
        mesh.tetrahedra.push_back({{v[0], v[1], v[2], v[3]}, 0});
        file_.tetrahedron_rows.push_back(row);
        return;
      default: add_other(cell);
    }
  }

  /// Of second order: a node in the middle of each edge behind the corners.
  void add_by_corners(Cell cell, std::size_t row) {
    const std::size_t corners = cell.type == quadratic_line ? 2 : cell.type == quadratic_triangle ? 3 : 4;
    if (cell.corners.size() != corners * (corners + 1) / 2) in_.fail(Errc::syntax, "a cell has not the nodes that its type has");
    file_.mesh.mid_sides.resize(file_.mesh.points.size());
    for (std::size_t k = corners; k < cell.corners.size(); ++k) file_.mesh.mid_sides[cell.corners[k]] = 1;
    cell.corners.resize(corners);
    cell.type = corners == 2 ? line : corners == 3 ? triangle : tetrahedron;
    add_cell(cell, row);
  }

  void add_polygon(const Cell& cell, std::size_t row) {
    const auto& v = cell.corners;
    if (v.size() == 3 && (cell.type == triangle || cell.type == polygon)) return add_triangle(v[0], v[1], v[2], row);
    if (cell.type == polygon && v.size() > 4)
      in_.fail(Errc::unknown_format, "polygons of more than four corners are not read: triangles and quadrilaterals are");
    if (v.size() != 4 || cell.type == triangle) in_.fail(Errc::syntax, "a cell has not the corners that its type has");
    const bool is_pixel = cell.type == pixel;
    file_.mesh.quadrilaterals.push_back({{v[0], v[1], v[is_pixel ? 3 : 2], v[is_pixel ? 2 : 3]}, 0});
    quadrilateral_rows_.push_back(row);
  }

  void add_other(const Cell& cell) {
    const std::pair<int, const char*> known[] = {{11, "Voxels"}, {12, "Hexahedra"}, {13, "Prisms"}, {14, "Pyramids"}};
    const auto* const found = std::find_if(std::begin(known), std::end(known),
                                           [&](const auto& k) { return k.first == cell.type; });
    if (found == std::end(known))
      in_.fail(Errc::unknown_format, "cells of VTK's type " + std::to_string(cell.type) + " are not read");
    if (file_.mesh.other_cells.empty()) file_.mesh.other_cells = found->second;
    file_.mesh.other_corners.insert(file_.mesh.other_corners.end(), cell.corners.begin(), cell.corners.end());
  }

  LineScanner in_;
  VtkFile file_;
  bool is_binary_ = false, has_offsets_ = false;
  About about_ = About::mesh;
  std::vector<Cell> cells_;
  std::vector<std::size_t> edge_rows_, quadrilateral_rows_;
  std::vector<std::pair<std::string, std::vector<double>>> pairs_;  ///< arrays of field data
};

}  // namespace

FileMesh read_vtk(std::string_view text, const std::filesystem::path& file, Want) {
  return VtkReader(text, file.string()).read().mesh;
}

std::vector<MeshField> read_vtk_fields(std::string_view text, const std::filesystem::path& file) {
  VtkFile read = VtkReader(text, file.string()).read();
  const bool is_flat = dimension_of(read.mesh) == 2;
  const std::vector<std::size_t>& rows = is_flat ? read.triangle_rows : read.tetrahedron_rows;
  const std::vector<std::uint8_t> dropped = dropped_mid_sides(read.mesh);
  for (MeshField& field : read.fields) {
    if (field.of_points) {
      keep_rows(field.values, field.components, dropped);
      continue;
    }
    std::vector<double> of_cells;
    for (const std::size_t row : rows)
      for (std::size_t k = 0; k < field.components; ++k) of_cells.push_back(field.values[row * field.components + k]);
    field.values = std::move(of_cells);
  }
  std::stable_sort(read.fields.begin(), read.fields.end(), [](const MeshField& a, const MeshField& b) {
    return a.of_points != b.of_points ? a.of_points : a.name < b.name;
  });
  return std::move(read.fields);
}

}  // namespace pgdr::detail
