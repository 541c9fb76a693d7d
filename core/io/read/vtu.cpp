// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Reads the .vtu files that io/write/vtu.cpp makes, and refuses all others by name: an XML head that announces arrays
// by place and type, then their raw bytes. Each array must have exactly the size that the counts of the head imply and
// lie within the file, so nothing is allocated that the file does not hold. Errors carry the line of the announcement.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <map>
#include <string>

#include "io/formats.hpp"
#include "io/scan/line_scanner.hpp"

namespace pgdr::detail {
namespace {

/// "<Name a="v" b="w">", "</Name>" or "<?...?>".
struct Tag {
  std::string_view name;  ///< with its '/' if it closes, "?" for a declaration
  std::map<std::string_view, std::string_view> attributes;
  std::uint64_t line = 0;
};

struct Array {
  std::string_view type;
  std::uint64_t offset = 0, line = 0;
};

/// The head: counts, and where the arrays are, by "Section/Name".
struct Head {
  std::uint64_t points = 0, cells = 0;
  std::map<std::string, Array> arrays;
  std::string_view data;                   ///< behind the '_' that begins the appended data
  std::uint64_t line = 0, piece_line = 0;  ///< of the data, of the counts
};

class HeadReader {
 public:
  HeadReader(std::string_view text, const std::string& file) : text_(text), file_(file) {}

  Head read() {
    std::string section;
    for (;;) {
      const Tag tag = next_tag();
      if (tag.name == "VTKFile") {
        require(tag, "type", "UnstructuredGrid");
        require(tag, "byte_order", "LittleEndian");
        require(tag, "header_type", "UInt64");
        if (tag.attributes.contains("compressor")) fail(Errc::unknown_format, "compressed arrays are not read", tag.line);
      } else if (tag.name == "Piece") {
        head_.piece_line = tag.line;
        head_.points = unsigned_attribute(tag, "NumberOfPoints");
        head_.cells = unsigned_attribute(tag, "NumberOfCells");
      } else if (tag.name == "DataArray") {
        read_array(tag, section);
      } else if (tag.name == "AppendedData") {
        require(tag, "encoding", "raw");
        break;
      } else if (!tag.name.starts_with('/')) {
        section = tag.name;
      }
    }
    while (at_ < text_.size() && text_[at_] != '_') step();
    if (at_ == text_.size()) fail(Errc::truncated, "the file ends before its data", line_);
    head_.data = text_.substr(at_ + 1);
    head_.line = line_;
    return std::move(head_);
  }

  [[noreturn]] void fail(Errc code, const std::string& message, std::uint64_t line) const {
    throw InputError(Diagnostic{code, message, file_, line, {}, {}});
  }

 private:
  void step() {
    if (text_[at_] == '\n') ++line_;
    ++at_;
  }
  static bool is_space(char c) { return c == ' ' || c == '\n' || c == '\t' || c == '\r'; }
  void skip_space() {
    while (at_ < text_.size() && is_space(text_[at_])) step();
  }
  /// Up to, and over, one of `ends`.
  std::string_view until(std::string_view ends) {
    const std::size_t begin = at_;
    while (at_ < text_.size() && ends.find(text_[at_]) == std::string_view::npos) step();
    if (at_ == text_.size()) fail(Errc::truncated, "the file ends within its head", line_);
    return text_.substr(begin, at_ - begin);
  }

  Tag next_tag() {
    skip_space();
    if (at_ == text_.size()) fail(Errc::truncated, "the file ends within its head", line_);
    Tag tag;
    tag.line = line_;
    if (text_[at_] != '<') fail(Errc::syntax, quoted(until(" \n<>")) + " stands where an XML tag is expected", line_);
    step();
    if (at_ < text_.size() && text_[at_] == '?') {
      until(">");
      step();
      tag.name = "?";
      return tag;
    }
    tag.name = until(" \t\r\n>");
    for (;;) {
      skip_space();
      const std::string_view name = until("=>");
      if (text_[at_] == '>') break;
      step();
      if (at_ == text_.size() || text_[at_] != '"') fail(Errc::syntax, quoted(name) + " has no value in quotes", line_);
      step();
      tag.attributes[name] = until("\"");
      step();
    }
    step();
    return tag;
  }

  std::string_view attribute(const Tag& tag, std::string_view name) const {
    const auto it = tag.attributes.find(name);
    if (it == tag.attributes.end()) fail(Errc::syntax, quoted(tag.name) + " has no " + std::string(name), tag.line);
    return it->second;
  }
  void require(const Tag& tag, std::string_view name, std::string_view value) const {
    const std::string_view found = attribute(tag, name);
    if (found != value)
      fail(Errc::unknown_format, std::string(name) + " is " + quoted(found) + ", only " + quoted(value) + " is read", tag.line);
  }
  std::uint64_t unsigned_attribute(const Tag& tag, std::string_view name) const {
    const auto value = parse_integer(attribute(tag, name));
    if (!value || *value < 0) fail(Errc::syntax, std::string(name) + " is " + quoted(attribute(tag, name)), tag.line);
    return static_cast<std::uint64_t>(*value);
  }
  void read_array(const Tag& tag, const std::string& section) {
    require(tag, "format", "appended");
    const std::string name = section + "/" + std::string(attribute(tag, "Name"));
    head_.arrays[name] = {attribute(tag, "type"), unsigned_attribute(tag, "offset"), tag.line};
  }

  std::string_view text_;
  const std::string& file_;
  std::size_t at_ = 0;
  std::uint64_t line_ = 1;
  Head head_;
};

template <class T>
T little_endian(std::string_view bytes, std::size_t i) {
  std::array<char, sizeof(T)> raw;
  bytes.substr(i * sizeof(T)).copy(raw.data(), raw.size());
  if constexpr (std::endian::native == std::endian::big) std::reverse(raw.begin(), raw.end());
  return std::bit_cast<T>(raw);
}

/// The arrays of a file, each checked for its type and size when it is asked for.
class Arrays {
 public:
  Arrays(std::string_view text, const std::string& file) : reader_(text, file), head_(reader_.read()) {
    check_count(head_.points, 3 * sizeof(double), "points");
    check_count(head_.cells, sizeof(std::uint8_t) + sizeof(std::int64_t), "cells");
  }

  std::size_t points() const { return static_cast<std::size_t>(head_.points); }
  std::size_t cells() const { return static_cast<std::size_t>(head_.cells); }
  bool has(const std::string& name) const { return head_.arrays.contains(name); }

  /// The bytes of an array of `n` numbers.
  std::string_view bytes(const std::string& name, std::string_view type, std::size_t n, std::size_t bytes_each) {
    const auto it = head_.arrays.find(name);
    if (it == head_.arrays.end()) reader_.fail(Errc::syntax, "the file has no array " + name, head_.line);
    const Array& a = it->second;
    if (a.type != type) fail(Errc::unknown_format, name, " is not of type " + std::string(type));
    constexpr std::size_t prefix = sizeof(std::uint64_t);
    if (size(name) != n * bytes_each) fail(Errc::syntax, name, " has not the size that the counts of points and cells imply");
    const std::string_view rest = head_.data.substr(static_cast<std::size_t>(a.offset));
    if (rest.size() - prefix < n * bytes_each) fail(Errc::truncated, name, " reaches beyond the end of the file");
    end_ = std::max(end_, static_cast<std::size_t>(a.offset) + prefix + n * bytes_each);
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

  /// After the last array was asked for: the end tags must follow.
  void check_end() const {
    std::string found;
    for (const char c : head_.data.substr(end_)) {
      if (c != '\n' && c != '\r' && c != ' ') found += c;
    }
    constexpr std::string_view end = "</AppendedData></VTKFile>";
    if (found == end) return;
    const bool cut = end.starts_with(found);
    if (cut) reader_.fail(Errc::truncated, "the file ends too early", 0);
    reader_.fail(Errc::syntax, "bytes are left behind the data", 0);
  }

  [[noreturn]] void fail(Errc code, const std::string& name, const std::string& why) const {
    reader_.fail(code, "the array " + name + why, head_.arrays.at(name).line);
  }

 private:
  void check_count(std::uint64_t n, std::size_t bytes_each, const std::string& what) const {
    constexpr std::uint64_t most_ids = 0xfffffffe;
    if (n <= head_.data.size() / bytes_each && n <= most_ids) return;
    reader_.fail(Errc::count_too_large, "the file cannot hold " + std::to_string(n) + " " + what, head_.piece_line);
  }

  HeadReader reader_;
  Head head_;
  std::size_t end_ = 0;
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

  OutputMesh<D> read() {
    if (read_dimension(arrays_) != D) arrays_.fail(Errc::syntax, "FieldData/dimension", " is not " + std::to_string(D));
    read_points();
    read_input_points();
    read_types();
    read_offsets();
    read_connectivity();
    read_labels();
    arrays_.check_end();
    return std::move(mesh_);
  }

 private:
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
    const std::string name = "PointData/attributes";
    if (!arrays_.has(name)) return;
    const std::uint64_t count = arrays_.size(name) / sizeof(double);
    if (arrays_.points() == 0 || count % arrays_.points() != 0)
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
    constexpr std::uint8_t line = 3, triangle = 5, tetrahedron = 10;
    const std::string_view types = arrays_.bytes("Cells/types", "UInt8", arrays_.cells(), 1);
    std::size_t at = 0;
    const auto run = [&](std::uint8_t type) {
      const std::size_t begin = at;
      while (at < types.size() && static_cast<std::uint8_t>(types[at]) == type) ++at;
      return at - begin;
    };
    mesh_.cells.resize(run(D == 3 ? tetrahedron : triangle));
    if constexpr (D == 3) mesh_.subfacets.resize(run(triangle));
    mesh_.subsegments.resize(run(line));
    if (at != types.size()) arrays_.fail(Errc::syntax, "Cells/types", " has a type that does not belong where it stands");
  }

  void read_offsets() {
    const std::string_view offsets = arrays_.bytes("Cells/offsets", "Int64", arrays_.cells(), sizeof(std::int64_t));
    std::int64_t end = 0;
    for (std::size_t i = 0; i < arrays_.cells(); ++i) {
      end += i < mesh_.cells.size() ? D + 1 : i < mesh_.cells.size() + mesh_.subfacets.size() ? 3 : 2;
      if (little_endian<std::int64_t>(offsets, i) != end)
        arrays_.fail(Errc::syntax, "Cells/offsets", " does not agree with the types of the cells");
    }
  }

  void read_connectivity() {
    const std::string name = "Cells/connectivity";
    const std::size_t corners = (D + 1) * mesh_.cells.size() + 3 * mesh_.subfacets.size() + 2 * mesh_.subsegments.size();
    const std::string_view ids = arrays_.bytes(name, "Int64", corners, sizeof(std::int64_t));
    std::size_t at = 0;
    const auto fill = [&](auto& vertices) {
      for (std::uint32_t& v : vertices) {
        const auto id = static_cast<std::uint64_t>(little_endian<std::int64_t>(ids, at++));
        if (id >= arrays_.points()) arrays_.fail(Errc::index_out_of_range, name, " refers to a point that is not there");
        v = static_cast<std::uint32_t>(id);
      }
    };
    for (auto& c : mesh_.cells) fill(c);
    for (auto& c : mesh_.subfacets) fill(c.vertices);
    for (auto& c : mesh_.subsegments) fill(c.vertices);
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

  Arrays& arrays_;
  OutputMesh<D> mesh_;
};

}  // namespace

template <int D>
OutputMesh<D> read_vtu(std::string_view text, const std::filesystem::path& file) {
  const std::string name = file.string();
  Arrays arrays(text, name);
  return GridReader<D>(arrays).read();
}

int vtu_dimension(std::string_view text, const std::filesystem::path& file) {
  const std::string name = file.string();
  Arrays arrays(text, name);
  return static_cast<int>(read_dimension(arrays));
}

template OutputMesh<2> read_vtu<2>(std::string_view, const std::filesystem::path&);
template OutputMesh<3> read_vtu<3>(std::string_view, const std::filesystem::path&);

}  // namespace pgdr::detail
