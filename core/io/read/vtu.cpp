// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Reads the .vtu files that io/write/vtu.cpp makes, and refuses all others by name: an XML head that announces arrays
// by place and type, then their raw bytes. Further arrays of point and cell data, as of a solution, are fields. Each array must
// have exactly the size that the counts of the head imply and lie within the file, so nothing is allocated that the file does not
// hold. Errors carry the line of the announcement.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <iterator>
#include <map>
#include <string>
#include <utility>

#include "io/field_formats.hpp"
#include "io/formats.hpp"
#include "scan/clean_name.hpp"
#include "scan/xml_tags.hpp"

namespace pgdr::detail {
namespace {

struct Array {
  std::string type;
  std::uint64_t offset = 0, components = 1, line = 0;
};

/// The head: counts, and where the arrays are, by "Section/Name".
struct Head {
  std::uint64_t points = 0, cells = 0;
  std::map<std::string, Array> arrays;
  std::string_view data;                   ///< behind the '_' that begins the appended data
  std::uint64_t line = 0, piece_line = 0;  ///< of the data, of the counts
};

Head read_head(std::string_view text, const std::string& file) {
  Head head;
  TagScanner tags(text, file);
  std::string section;
  for (;;) {
    const Tag tag = tags.next();
    if (tag.name == "VTKFile") {
      tags.require(tag, "type", "UnstructuredGrid");
      tags.require(tag, "byte_order", "LittleEndian");
      tags.require(tag, "header_type", "UInt64");
      if (tag.attributes.contains("compressor")) tags.fail(Errc::unknown_format, "compressed arrays are not read", tag.line);
    } else if (tag.name == "Piece") {
      head.piece_line = tag.line;
      head.points = tags.unsigned_attribute(tag, "NumberOfPoints");
      head.cells = tags.unsigned_attribute(tag, "NumberOfCells");
    } else if (tag.name == "DataArray") {
      tags.require(tag, "format", "appended");
      const std::string name = section + "/" + xml_unescaped(tags.attribute(tag, "Name"));
      const bool one = !tag.attributes.contains("NumberOfComponents");
      head.arrays[name] = {std::string(tags.attribute(tag, "type")), tags.unsigned_attribute(tag, "offset"),
                           one ? 1 : tags.unsigned_attribute(tag, "NumberOfComponents"), tag.line};
    } else if (tag.name == "AppendedData") {
      tags.require(tag, "encoding", "raw");
      break;
    } else if (!tag.name.starts_with('/')) {
      section = tag.name;
    }
  }
  head.data = tags.behind('_');
  head.line = tags.line();
  return head;
}

template <class T>
T little_endian(std::string_view bytes, std::size_t i) {
  std::array<char, sizeof(T)> raw{};
  bytes.substr(i * sizeof(T)).copy(raw.data(), raw.size());
  if constexpr (std::endian::native == std::endian::big) std::reverse(raw.begin(), raw.end());
  return std::bit_cast<T>(raw);
}

/// The arrays of a file, each checked for its type and size when it is asked for.
class Arrays {
 public:
  Arrays(std::string_view text, const std::string& file) : file_(file), head_(read_head(text, file)) {
    check_count(head_.points, 3 * sizeof(double), "points");
    check_count(head_.cells, sizeof(std::uint8_t) + sizeof(std::int64_t), "cells");
  }

  std::size_t points() const { return static_cast<std::size_t>(head_.points); }
  std::size_t cells() const { return static_cast<std::size_t>(head_.cells); }
  bool has(const std::string& name) const { return head_.arrays.contains(name); }

  /// The bytes of an array of `n` numbers.
  std::string_view bytes(const std::string& name, std::string_view type, std::size_t n, std::size_t bytes_each) {
    const auto it = head_.arrays.find(name);
    if (it == head_.arrays.end()) fail_at(Errc::syntax, "the file has no array " + name, head_.line);
    const Array& a = it->second;
    if (a.type != type) fail(Errc::unknown_format, name, " is not of type " + std::string(type));
    constexpr std::size_t prefix = sizeof(std::uint64_t);
    if (size(name) != n * bytes_each) fail(Errc::syntax, name, " has not the size that the counts of points and cells imply");
    const std::string_view rest = head_.data.substr(static_cast<std::size_t>(a.offset));
    if (rest.size() - prefix < n * bytes_each) fail(Errc::truncated, name, " reaches beyond the end of the file");
    return rest.substr(prefix, n * bytes_each);
  }

  /// The number of bytes that an array says it has.
  std::uint64_t size(const std::string& name) const {
    const Array& a = head_.arrays.at(name);
    constexpr std::size_t prefix = sizeof(std::uint64_t);
    if (head_.data.size() < prefix || a.offset > head_.data.size() - prefix)
      fail(Errc::truncated, name, " lies behind the end of the file");
    return little_endian<std::uint64_t>(head_.data.substr(static_cast<std::size_t>(a.offset)), 0);
  }

  /// The end tags must follow the last of all arrays, asked for or not.
  void check_end() const {
    std::size_t end = 0;
    for (const auto& [name, array] : head_.arrays) end = std::max(end, end_of(name));
    check_tags(end);
  }

  /// As doubles, `count` rows at the beginning of an array of `rows`.
  std::vector<double> numbers(const std::string& name, std::size_t count, std::size_t rows) {
    const std::string& kind = type(name);
    const std::size_t n = count * static_cast<std::size_t>(components(name));
    const auto read = [&]<class T>(T) {
      const std::string_view all = bytes(name, kind, rows * static_cast<std::size_t>(components(name)), sizeof(T));
      std::vector<double> values(n);
      for (std::size_t i = 0; i < n; ++i) values[i] = static_cast<double>(little_endian<T>(all, i));
      return values;
    };
    if (kind == "Float64") return read(double());
    if (kind == "Float32") return read(float());
    if (kind == "Int8") return read(std::int8_t());
    if (kind == "UInt8") return read(std::uint8_t());
    if (kind == "Int16") return read(std::int16_t());
    if (kind == "UInt16") return read(std::uint16_t());
    if (kind == "Int32") return read(std::int32_t());
    if (kind == "UInt32") return read(std::uint32_t());
    if (kind == "Int64") return read(std::int64_t());
    if (kind == "UInt64") return read(std::uint64_t());
    fail(Errc::unknown_format, name, " is of the type " + kind + ", which is no number");
  }

  /// The names of all arrays that begin so.
  std::vector<std::string> names_in(std::string_view section) const {
    std::vector<std::string> names;
    for (const auto& [name, array] : head_.arrays)
      if (name.starts_with(section)) names.push_back(name);
    return names;
  }
  const std::string& type(const std::string& name) const { return head_.arrays.at(name).type; }
  std::uint64_t components(const std::string& name) const { return head_.arrays.at(name).components; }

  [[noreturn]] void fail(Errc code, const std::string& name, const std::string& why) const {
    fail_at(code, "the array " + name + why, head_.arrays.at(name).line);
  }

 private:
  /// Where an array ends in the data. It lies within them.
  std::size_t end_of(const std::string& name) const {
    constexpr std::size_t prefix = sizeof(std::uint64_t);
    const std::uint64_t length = size(name);
    const auto begin = static_cast<std::size_t>(head_.arrays.at(name).offset) + prefix;
    if (head_.data.size() - begin < length) fail(Errc::truncated, name, " reaches beyond the end of the file");
    return begin + static_cast<std::size_t>(length);
  }
  void check_tags(std::size_t begin) const {
    std::string found;
    for (const char c : head_.data.substr(begin)) {
      if (c != '\n' && c != '\r' && c != ' ') found += c;
    }
    constexpr std::string_view tags = "</AppendedData></VTKFile>";
    if (found == tags) return;
    if (tags.starts_with(found)) fail_at(Errc::truncated, "the file ends too early", 0);
    fail_at(Errc::syntax, "bytes are left behind the data", 0);
  }
  [[noreturn]] void fail_at(Errc code, const std::string& message, std::uint64_t line) const {
    throw InputError(Diagnostic{code, message, file_, line, {}, {}});
  }
  void check_count(std::uint64_t n, std::size_t bytes_each, const std::string& what) const {
    constexpr std::uint64_t most_ids = 0xfffffffe;
    if (n <= head_.data.size() / bytes_each && n <= most_ids) return;
    fail_at(Errc::count_too_large, "the file cannot hold " + std::to_string(n) + " " + what, head_.piece_line);
  }

  const std::string& file_;
  Head head_;
};

std::int64_t read_dimension(Arrays& arrays) {
  const auto d = little_endian<std::int64_t>(arrays.bytes("FieldData/dimension", "Int64", 1, sizeof(std::int64_t)), 0);
  if (d != 2 && d != 3) arrays.fail(Errc::syntax, "FieldData/dimension", " is neither 2 nor 3");
  return d;
}

/// Puts a mesh together out of the arrays.
template <int D>
class GridReader {
 public:
  explicit GridReader(Arrays& arrays) : arrays_(arrays) {}

  OutputMesh<D> read(std::size_t& left_out) {
    read_mesh();
    arrays_.check_end();
    left_out = left_out_;
    return std::move(mesh_);
  }

  MeshPiece<D> read_piece() {
    MeshPiece<D> piece;
    const std::vector<std::uint64_t> of_whole = numbers("FieldData/piece", 7);
    auto& total = piece.total;
    read_mesh();
    std::uint64_t* const to[] = {&total.points,      &total.input_points, &total.cells,     &total.subfacets,
                                 &total.subsegments, &piece.first_point,  &piece.own_points};
    for (std::size_t k = 0; k < std::size(to); ++k) *to[k] = of_whole[k];
    total.attributes_per_point = arrays_.has(attributes) ? arrays_.components(attributes) : 0;
    total.point_markers = arrays_.has("PointData/marker");
    total.regions = arrays_.has("CellData/region");
    total.leaves = arrays_.has("CellData/leaf");
    if (mesh_.point_attributes.size() != mesh_.points.size() * total.attributes_per_point)
      arrays_.fail(Errc::syntax, attributes, " has not as many numbers as it says");
    piece.point_numbers = numbers("PointData/" + std::string(point_ids), arrays_.points());
    read_cell_ids(piece);
    arrays_.check_end();
    piece.mesh = std::move(mesh_);
    return piece;
  }

 private:
  void read_mesh() {
    if (read_dimension(arrays_) != D) arrays_.fail(Errc::syntax, "FieldData/dimension", " is not " + std::to_string(D));
    read_points();
    read_input_points();
    read_types();
    read_offsets();
    read_connectivity();
    read_labels();
    read_names();
    drop_mid_sides();
  }

  /// Pairs of a label and a dimension.
  void read_names() {
    constexpr std::string_view section = "FieldData/";
    for (const std::string& array : arrays_.names_in(section)) {
      std::string_view own = std::string_view(array).substr(section.size());
      if (std::count(std::begin(own_field_data), std::end(own_field_data), own) > 0) continue;
      if (own.starts_with(field_data_escape)) own.remove_prefix(field_data_escape.size());
      const std::string name = clean_name(own);
      const bool integers = arrays_.type(array) == "Int64";
      const auto count = static_cast<std::size_t>(arrays_.size(array) / sizeof(double));
      const std::string_view bytes = arrays_.bytes(array, integers ? "Int64" : "Float64", count, sizeof(double));
      const auto number = [&](std::size_t i) {
        return integers ? static_cast<double>(little_endian<std::int64_t>(bytes, i)) : little_endian<double>(bytes, i);
      };
      for (std::size_t i = 0; i + 1 < count; i += 2) give_name(array, name, number(i), number(i + 1));
      if (count % 2 != 0 || name.empty()) arrays_.fail(Errc::syntax, array, " has no pairs of a label and a dimension");
    }
  }
  void give_name(const std::string& array, const std::string& name, double label, double dimension) {
    const bool is_marker = dimension == D - 1 && label >= -2147483648.0 && label <= 2147483647.0 && label == std::floor(label);
    if (dimension == D && !std::isnan(label))
      mesh_.names.regions[label] = name;
    else if (is_marker)
      mesh_.names.markers[static_cast<int>(label)] = name;
    else
      arrays_.fail(Errc::syntax, array, " has no pairs of a label and a dimension");
  }

  /// Numbers that count or name something.
  std::vector<std::uint64_t> numbers(const std::string& name, std::size_t n) {
    const std::string_view bytes = arrays_.bytes(name, "Int64", n, sizeof(std::int64_t));
    std::vector<std::uint64_t> all(n);
    for (std::size_t i = 0; i < n; ++i) {
      const auto value = little_endian<std::int64_t>(bytes, i);
      if (value < 0) arrays_.fail(Errc::index_out_of_range, name, " has a number below 0");
      all[i] = static_cast<std::uint64_t>(value);
    }
    return all;
  }

  /// Those of the cells, of the subfacets and of the subsegments are successive each.
  void read_cell_ids(MeshPiece<D>& piece) {
    const std::string name = "CellData/" + std::string(cell_ids);
    const std::vector<std::uint64_t> ids = numbers(name, arrays_.cells());
    std::size_t at = 0;
    const auto take = [&](std::size_t count, std::uint64_t begin) {
      const std::uint64_t first = count == 0 ? begin : ids[at];
      if (first < begin) arrays_.fail(Errc::index_out_of_range, name, " has the number of a cell for something else");
      for (std::size_t i = 0; i < count; ++i, ++at)
        if (ids[at] != first + i) arrays_.fail(Errc::syntax, name, " has " + std::to_string(ids[at]) + " out of its order");
      return first - begin;
    };
    piece.first_cell = take(mesh_.cells.size(), 0);
    piece.first_subfacet = take(mesh_.subfacets.size(), piece.total.cells);
    piece.first_subsegment = take(mesh_.subsegments.size(), piece.total.cells + piece.total.subfacets);
  }

  void read_points() {
    const std::string_view xyz = arrays_.bytes("Points/Points", "Float64", 3 * arrays_.points(), sizeof(double));
    mesh_.points.resize(arrays_.points());
    for (std::size_t i = 0; i < mesh_.points.size(); ++i) {
      for (std::size_t k = 0; k < 3; ++k) {
        const double x = little_endian<double>(xyz, 3 * i + k);
        if (!std::isfinite(x)) arrays_.fail(Errc::not_finite, "Points/Points", " has a coordinate that is not finite");
        if (k < D)
          mesh_.points[i].x[k] = x;
        else if (x != 0)
          arrays_.fail(Errc::syntax, "Points/Points", " has a third coordinate that is not 0, in 2D");
      }
    }
    read_point_attributes();
    if (!arrays_.has("PointData/marker")) return;
    const std::string_view markers = arrays_.bytes("PointData/marker", "Int32", arrays_.points(), sizeof(std::int32_t));
    mesh_.point_markers.resize(arrays_.points());
    for (std::size_t i = 0; i < mesh_.point_markers.size(); ++i) mesh_.point_markers[i] = little_endian<std::int32_t>(markers, i);
  }

  void read_point_attributes() {
    const std::string& name = attributes;
    if (!arrays_.has(name)) return;
    const std::uint64_t count = arrays_.size(name) / sizeof(double);
    if (arrays_.points() == 0 ? count != 0 : count % arrays_.points() != 0)
      arrays_.fail(Errc::syntax, name, " has not as many numbers for each point");
    const std::string_view values = arrays_.bytes(name, "Float64", static_cast<std::size_t>(count), sizeof(double));
    mesh_.point_attributes.resize(static_cast<std::size_t>(count));
    for (std::size_t i = 0; i < mesh_.point_attributes.size(); ++i) mesh_.point_attributes[i] = little_endian<double>(values, i);
  }

  void read_input_points() {
    const std::string name = "FieldData/input_points";
    const auto n = little_endian<std::int64_t>(arrays_.bytes(name, "Int64", 1, sizeof(std::int64_t)), 0);
    if (n < 0 || static_cast<std::uint64_t>(n) > arrays_.points())
      arrays_.fail(Errc::index_out_of_range, name, " is not a number of points");
    mesh_.input_points = static_cast<std::size_t>(n);
  }

  /// Cells, subfacets, subsegments, in this order.
  void read_types() {
    const std::string_view types = arrays_.bytes("Cells/types", "UInt8", arrays_.cells(), 1);
    is_second_order_ = !types.empty() && static_cast<std::uint8_t>(types[0]) > 20;  // VTK's numbers: linear, quadratic
    const std::uint8_t line = is_second_order_ ? 21 : 3, triangle = is_second_order_ ? 22 : 5,
                       tetrahedron = is_second_order_ ? 24 : 10;
    std::size_t at = 0;
    const auto run = [&](std::uint8_t type) {
      const std::size_t begin = std::exchange(at, std::min(types.find_first_not_of(static_cast<char>(type), at), types.size()));
      return at - begin;
    };
    mesh_.cells.resize(run(D == 3 ? tetrahedron : triangle));
    if constexpr (D == 3) mesh_.subfacets.resize(run(triangle));
    mesh_.subsegments.resize(run(line));
    if (at != types.size()) arrays_.fail(Errc::syntax, "Cells/types", " has a type that does not belong where it stands");
  }

  /// Of an element of so many corners.
  std::size_t nodes(std::size_t corners) const { return is_second_order_ ? corners * (corners + 1) / 2 : corners; }

  void read_offsets() {
    const std::string_view offsets = arrays_.bytes("Cells/offsets", "Int64", arrays_.cells(), sizeof(std::int64_t));
    std::int64_t end = 0;
    for (std::size_t i = 0; i < arrays_.cells(); ++i) {
      end += static_cast<std::int64_t>(nodes(i < mesh_.cells.size()                            ? D + 1
                                             : i < mesh_.cells.size() + mesh_.subfacets.size() ? 3
                                                                                               : 2));
      if (little_endian<std::int64_t>(offsets, i) != end)
        arrays_.fail(Errc::syntax, "Cells/offsets", " does not agree with the types of the cells");
    }
  }

  void read_connectivity() {
    const std::string name = "Cells/connectivity";
    const std::size_t count = nodes(D + 1) * mesh_.cells.size() + nodes(3) * mesh_.subfacets.size() +
                              nodes(2) * mesh_.subsegments.size();
    const std::string_view ids = arrays_.bytes(name, "Int64", count, sizeof(std::int64_t));
    std::size_t at = 0;
    const auto next = [&] {
      const auto id = static_cast<std::uint64_t>(little_endian<std::int64_t>(ids, at++));
      if (id >= arrays_.points()) arrays_.fail(Errc::index_out_of_range, name, " refers to a point that is not there");
      return static_cast<std::uint32_t>(id);
    };
    const auto fill = [&](auto& vertices) {
      for (std::uint32_t& v : vertices) last_corner_ = std::max<std::size_t>(last_corner_, v = next());
      for (std::size_t k = vertices.size(); k < nodes(vertices.size()); ++k)
        first_mid_side_ = std::min<std::size_t>(first_mid_side_, next());
    };
    for (auto& c : mesh_.cells) fill(c);
    for (auto& c : mesh_.subfacets) fill(c.vertices);
    for (auto& c : mesh_.subsegments) fill(c.vertices);
  }

  /// Nodes in the middles of edges lie behind all corners in what we write; others' files are not read.
  void drop_mid_sides() {
    const std::size_t kept = std::min(first_mid_side_, arrays_.points());
    left_out_ = arrays_.points() - kept;
    if (left_out_ > 0 && (last_corner_ >= kept || mesh_.input_points > kept))
      arrays_.fail(Errc::unknown_format, "Cells/connectivity", " has a node in the middle of an edge before a corner");
    mesh_.point_attributes.resize(mesh_.points.empty() ? 0 : mesh_.point_attributes.size() / mesh_.points.size() * kept);
    mesh_.points.resize(kept);
    if (!mesh_.point_markers.empty()) mesh_.point_markers.resize(kept);
  }

  void read_labels() {
    const std::string_view markers = arrays_.bytes("CellData/marker", "Int32", arrays_.cells(), sizeof(std::int32_t));
    std::size_t at = mesh_.cells.size();
    for (auto& c : mesh_.subfacets) c.marker = little_endian<std::int32_t>(markers, at++);
    for (auto& c : mesh_.subsegments) c.marker = little_endian<std::int32_t>(markers, at++);
    read_leaves();
    if (!arrays_.has("CellData/region")) return;
    const std::string_view regions = arrays_.bytes("CellData/region", "Float64", arrays_.cells(), sizeof(double));
    mesh_.regions.resize(mesh_.cells.size());
    for (std::size_t i = 0; i < mesh_.regions.size(); ++i) mesh_.regions[i] = little_endian<double>(regions, i);
  }

  void read_leaves() {
    const std::string name = "CellData/leaf";
    if (!arrays_.has(name)) return;
    const std::string_view leaves = arrays_.bytes(name, "Int64", arrays_.cells(), sizeof(std::int64_t));
    mesh_.leaves.resize(mesh_.cells.size());
    for (std::size_t i = 0; i < mesh_.leaves.size(); ++i) {
      const auto leaf = little_endian<std::int64_t>(leaves, i);
      if (leaf < 0 || leaf > std::int64_t{0xffffffff}) arrays_.fail(Errc::index_out_of_range, name, " has no leaf of a cell");
      mesh_.leaves[i] = static_cast<std::uint32_t>(leaf);
    }
  }

  static inline const std::string attributes = "PointData/attributes";
  Arrays& arrays_;
  OutputMesh<D> mesh_;
  bool is_second_order_ = false;
  std::size_t last_corner_ = 0, first_mid_side_ = ~std::size_t{0}, left_out_ = 0;
};

template <int D>
std::pair<std::size_t, std::size_t> rows_in(Arrays& arrays) {
  std::size_t left_out = 0;
  const OutputMesh<D> mesh = GridReader<D>(arrays).read(left_out);
  return {mesh.points.size(), mesh.cells.size()};
}

/// How many points and cells of the mesh there are: the first of those of the file, before nodes in the middles of edges, and
/// before its constraints.
std::pair<std::size_t, std::size_t> count_rows(Arrays& arrays) {
  const bool is_spatial = read_dimension(arrays) == 3;
  const char kind = is_spatial ? 10 : 5;
  const std::string_view types = arrays.bytes("Cells/types", "UInt8", arrays.cells(), 1);
  if (!types.empty() && types[0] > 20) return is_spatial ? rows_in<3>(arrays) : rows_in<2>(arrays);
  return {arrays.points(), std::min(types.find_first_not_of(kind), types.size())};
}

}  // namespace

std::vector<MeshField> read_vtu_fields(std::string_view text, const std::filesystem::path& file) {
  const std::string name = file.string();
  Arrays arrays(text, name);
  const auto [points, cells] = count_rows(arrays);
  std::vector<MeshField> fields;
  for (const std::string_view section : {"PointData/", "CellData/"})
    for (const std::string& array : arrays.names_in(section)) {
      const bool of_points = section == "PointData/";
      std::string_view name_there = std::string_view(array).substr(section.size());
      if (of_points ? std::ranges::count(own_point_data, name_there) > 0 : std::ranges::count(own_cell_data, name_there) > 0)
        continue;
      constexpr std::uint64_t most_components = 1024;  // no count of the file overflows
      if (const std::uint64_t n = arrays.components(array); n == 0 || n > most_components)
        arrays.fail(Errc::count_too_large, array, " has " + std::to_string(n) + " components");
      if (name_there.starts_with(field_data_escape)) name_there.remove_prefix(field_data_escape.size());
      fields.push_back({std::string(name_there), of_points, static_cast<std::size_t>(arrays.components(array)),
                        arrays.numbers(array, of_points ? points : cells, of_points ? arrays.points() : arrays.cells()),
                        !arrays.type(array).starts_with("Float")});
    }
  arrays.check_end();
  return fields;
}

template <int D>
OutputMesh<D> read_vtu(std::string_view text, const std::filesystem::path& file, std::size_t& left_out) {
  const std::string name = file.string();
  Arrays arrays(text, name);
  return GridReader<D>(arrays).read(left_out);
}

template <int D>
MeshPiece<D> read_vtu_piece(std::string_view text, const std::filesystem::path& file) {
  const std::string name = file.string();
  Arrays arrays(text, name);
  return GridReader<D>(arrays).read_piece();
}

int vtu_dimension(std::string_view text, const std::filesystem::path& file) {
  const std::string name = file.string();
  Arrays arrays(text, name);
  return static_cast<int>(read_dimension(arrays));
}

template OutputMesh<2> read_vtu<2>(std::string_view, const std::filesystem::path&, std::size_t&);
template OutputMesh<3> read_vtu<3>(std::string_view, const std::filesystem::path&, std::size_t&);
template MeshPiece<2> read_vtu_piece<2>(std::string_view, const std::filesystem::path&);
template MeshPiece<3> read_vtu_piece<3>(std::string_view, const std::filesystem::path&);

}  // namespace pgdr::detail
