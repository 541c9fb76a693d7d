// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The arrays of a .vtu file of ours: an XML head announces them by place and type, then come their raw bytes. Each must have
// exactly the size that the counts of the head imply and lie within the file, so nothing is allocated that the file does not
// hold. Errors carry the line of the announcement.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "io/formats.hpp"
#include "pgdr/error.hpp"
#include "scan/xml_tags.hpp"

namespace pgdr::detail {

/// How an array is announced.
struct VtuArrayPlace {
  std::string type;
  std::uint64_t offset = 0, components = 1, line = 0;
};

/// The head: counts, and where the arrays are, by "Section/Name".
struct VtuHead {
  std::uint64_t points = 0, cells = 0;
  std::map<std::string, VtuArrayPlace> arrays;
  std::string_view data;                   ///< behind the '_' that begins the appended data
  std::uint64_t line = 0, piece_line = 0;  ///< of the data, of the counts
};

inline VtuHead read_vtu_head(std::string_view text, const std::string& file) {
  VtuHead head;
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

/// The i-th number of these bytes.
template <class T>
T little_endian(std::string_view bytes, std::size_t i) {
  std::array<char, sizeof(T)> raw{};
  bytes.substr(i * sizeof(T)).copy(raw.data(), raw.size());
  if constexpr (std::endian::native == std::endian::big) std::reverse(raw.begin(), raw.end());
  return std::bit_cast<T>(raw);
}

/// The arrays of a file, each checked for its type and size when it is asked for.
class VtuArrays {
 public:
  VtuArrays(std::string_view text, const std::string& file) : file_(file), head_(read_vtu_head(text, file)) {
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
    const VtuArrayPlace& a = it->second;
    if (a.type != type) fail(Errc::unknown_format, name, " is not of type " + std::string(type));
    constexpr std::size_t prefix = sizeof(std::uint64_t);
    if (size(name) != n * bytes_each) fail(Errc::syntax, name, " has not the size that the counts of points and cells imply");
    const std::string_view rest = head_.data.substr(static_cast<std::size_t>(a.offset));
    if (rest.size() - prefix < n * bytes_each) fail(Errc::truncated, name, " reaches beyond the end of the file");
    return rest.substr(prefix, n * bytes_each);
  }

  /// The number of bytes that an array says it has.
  std::uint64_t size(const std::string& name) const {
    const VtuArrayPlace& a = head_.arrays.at(name);
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
  VtuHead head_;
};

}  // namespace pgdr::detail
