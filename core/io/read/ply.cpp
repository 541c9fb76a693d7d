// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Stanford's PLY, as text and in both byte orders: x, y, z of the element "vertex", the list "vertex_indices" (or
// "vertex_index") of the element "face". All other properties and elements are checked and dropped. A face is a facet,
// however many corners it has. The edges of a PLY are not read: programs list all edges there, or those they draw.
// Greg Turk, The PLY Polygon File Format, 1994.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "io/formats.hpp"
#include "scan/byte_order.hpp"
#include "scan/line_scanner.hpp"

namespace pgdr::detail {
namespace {

enum class Type { i8, u8, i16, u16, i32, u32, f32, f64 };

struct TypeName {
  std::string_view name;
  Type type;
};
constexpr TypeName type_names[] = {
    {"char", Type::i8},   {"int8", Type::i8},     {"uchar", Type::u8},   {"uint8", Type::u8},
    {"short", Type::i16}, {"int16", Type::i16},   {"ushort", Type::u16}, {"uint16", Type::u16},
    {"int", Type::i32},   {"int32", Type::i32},   {"uint", Type::u32},   {"uint32", Type::u32},
    {"float", Type::f32}, {"float32", Type::f32}, {"double", Type::f64}, {"float64", Type::f64},
};
constexpr bool is_integer(Type t) { return t != Type::f32 && t != Type::f64; }
constexpr std::size_t size_of(Type t) {
  constexpr std::size_t sizes[] = {1, 1, 2, 2, 4, 4, 4, 8};
  return sizes[static_cast<std::size_t>(t)];
}

template <class T>
bool in_range(std::int64_t v) {
  return v >= std::numeric_limits<T>::min() && v <= std::numeric_limits<T>::max();
}
bool fits(std::int64_t v, Type t) {
  switch (t) {
    case Type::i8: return in_range<std::int8_t>(v);
    case Type::u8: return in_range<std::uint8_t>(v);
    case Type::i16: return in_range<std::int16_t>(v);
    case Type::u16: return in_range<std::uint16_t>(v);
    case Type::i32: return in_range<std::int32_t>(v);
    case Type::u32: return in_range<std::uint32_t>(v);
    case Type::f32:
    case Type::f64: break;
  }
  return true;
}

struct Property {
  std::string_view name;
  Type type = Type::f32;
  bool list = false;
  Type length = Type::u8;  ///< of a list
};

struct Element {
  std::string_view name;
  std::size_t count = 0;
  std::vector<Property> properties;
  std::uint64_t line = 0;
};

enum class Encoding { text, little, big };

struct Header {
  Encoding encoding = Encoding::text;
  std::vector<Element> elements;
};

class HeaderReader {
 public:
  explicit HeaderReader(LineScanner& in) : in_(in) {}

  Header read() {
    in_.require(subject);
    if (in_.word(subject) != "ply") in_.fail(Errc::syntax, "the file does not begin with 'ply'");
    in_.next_line(subject);
    if (in_.word(subject) != "format") in_.fail(Errc::syntax, "the second line is not the format");
    read_format();
    for (;;) {
      in_.next_line(subject);
      const std::string_view keyword = in_.word(subject);
      if (keyword == "end_header") break;
      if (keyword == "comment" || keyword == "obj_info") {
        in_.skip_line();
      } else if (keyword == "element") {
        read_element();
      } else if (keyword == "property") {
        read_property();
      } else {
        in_.fail(Errc::syntax, quoted(keyword) + " is not a word of the header");
      }
    }
    if (header_.encoding == Encoding::text)
      in_.end_line(subject);
    else
      in_.enter_bytes(subject);
    for (const Element& e : header_.elements) check_size(e);
    return std::move(header_);
  }

 private:
  static constexpr Subject subject{"the header"};

  void read_format() {
    const std::string_view word = in_.word(subject);
    if (word == "ascii")
      header_.encoding = Encoding::text;
    else if (word == "binary_little_endian")
      header_.encoding = Encoding::little;
    else if (word == "binary_big_endian")
      header_.encoding = Encoding::big;
    else
      in_.fail(Errc::unknown_format, quoted(word) + " is not a format of PLY");
    if (const std::string_view version = in_.word(subject); version != "1.0")
      in_.fail(Errc::unknown_format, "version " + quoted(version) + " of PLY is not known");
  }

  void read_element() {
    Element element;
    element.name = in_.word(subject);
    element.line = in_.line();
    for (const Element& other : header_.elements) {
      if (other.name == element.name) in_.fail(Errc::syntax, "the element " + quoted(element.name) + " comes twice");
    }
    element.count = in_.count({element.name}, 1);
    header_.elements.push_back(element);
  }

  Type type_of(std::string_view word) const {
    for (const auto& [name, type] : type_names) {
      if (name == word) return type;
    }
    in_.fail(Errc::syntax, quoted(word) + " is not a type");
  }

  void read_property() {
    if (header_.elements.empty()) in_.fail(Errc::syntax, "a property belongs to no element");
    Property property;
    std::string_view word = in_.word(subject);
    if (word == "list") {
      property.list = true;
      property.length = type_of(in_.word(subject));
      if (!is_integer(property.length)) in_.fail(Errc::syntax, "the length of a list is not an integer");
      word = in_.word(subject);
    }
    property.type = type_of(word);
    property.name = in_.word(subject);
    header_.elements.back().properties.push_back(property);
  }

  /// An entry takes at least two bytes a property as text, its size in binary.
  void check_size(const Element& e) const {
    if (e.properties.empty()) in_.fail(Errc::syntax, "the element " + quoted(e.name) + " has no properties");
    std::size_t bytes = 0;
    for (const Property& p : e.properties) bytes += header_.encoding == Encoding::text ? 2 : size_of(p.list ? p.length : p.type);
    in_.check_count({e.name}, e.count, bytes);
  }

  LineScanner& in_;
  Header header_;
};

/// The values behind the header, one after the other. All types but the two of floating point fit a std::int64_t.
class Values {
 public:
  Values(LineScanner& in, Encoding encoding)
      : in_(in), text_(encoding == Encoding::text), order_(encoding == Encoding::big ? std::endian::big : std::endian::little) {}

  void begin_entry(Subject s) {
    if (text_) in_.require(s);
  }
  void end_entry() {
    if (text_) in_.end_line({"the end of an entry"});
  }
  std::int64_t integer(Type type, Subject s) {
    if (text_) {
      const std::int64_t v = in_.integer(s);
      if (!fits(v, type)) in_.fail(Errc::syntax, std::to_string(v) + " is beyond its type", {v});
      return v;
    }
    const std::string_view b = in_.bytes(s, size_of(type));
    switch (type) {
      case Type::i8: return load<std::int8_t>(b, 0, order_);
      case Type::u8: return load<std::uint8_t>(b, 0, order_);
      case Type::i16: return load<std::int16_t>(b, 0, order_);
      case Type::u16: return load<std::uint16_t>(b, 0, order_);
      case Type::i32: return load<std::int32_t>(b, 0, order_);
      case Type::u32: return load<std::uint32_t>(b, 0, order_);
      case Type::f32:
      case Type::f64: break;
    }
    return 0;  // not reached: the header was checked
  }
  /// Any number; those of text keep all their digits, whatever their type.
  double number(Type type, Subject s) {
    if (is_integer(type)) return static_cast<double>(integer(type, s));
    if (text_) return in_.number(s, false);
    const std::string_view b = in_.bytes(s, size_of(type));
    return type == Type::f32 ? double{load<float>(b, 0, order_)} : load<double>(b, 0, order_);
  }
  /// The length of a list, which the rest of the file can hold.
  std::size_t length(const Property& p, Subject s) {
    const std::int64_t n = integer(p.length, s);
    if (n < 0) in_.fail(Errc::syntax, "a list has the length " + std::to_string(n), {s.id});
    in_.check_count(s, static_cast<std::uint64_t>(n), text_ ? 2 : size_of(p.type));
    return static_cast<std::size_t>(n);
  }
  void skip(const Property& p, Subject s) {
    const std::size_t n = p.list ? length(p, s) : 1;
    if (!text_) {
      in_.bytes(s, n * size_of(p.type));
      return;
    }
    for (std::size_t i = 0; i < n; ++i) number(p.type, s);
  }

 private:
  LineScanner& in_;
  bool text_;
  std::endian order_;
};

class PlyReader {
 public:
  PlyReader(std::string_view text, Plc<3>& plc)
      : in_(text, plc.source.file), plc_(plc), header_(HeaderReader(in_).read()), values_(in_, header_.encoding) {}

  void read() {
    for (const Element& e : header_.elements) {
      if (e.name == "vertex") points_ = e.count;
      if (e.name == "tristrips") fail(e, Errc::unknown_format, "strips of triangles are not read");
    }
    for (const Element& e : header_.elements) {
      if (e.name == "vertex")
        read_points(e);
      else if (e.name == "face")
        read_faces(e);
      else
        skip(e);
    }
    if (header_.encoding == Encoding::text ? in_.advance() : in_.remaining() != 0)
      in_.fail(Errc::syntax, "something stands behind the last element");
  }

 private:
  bool text() const { return header_.encoding == Encoding::text; }

  void read_points(const Element& e) {
    std::array<std::size_t, 3> column{};
    for (std::size_t k = 0; k < 3; ++k) column[k] = find(e, std::string_view("xyz").substr(k, 1), false);
    plc_.points.reserve(e.count);
    for (std::size_t i = 0; i < e.count; ++i) {
      const Subject s{"vertex", static_cast<std::int64_t>(i)};
      values_.begin_entry(s);
      if (text()) plc_.source.point_lines.push_back(static_cast<std::uint32_t>(in_.line()));
      Point3 p;
      for (std::size_t c = 0; c < e.properties.size(); ++c) {
        const auto axis = static_cast<std::size_t>(std::find(column.begin(), column.end(), c) - column.begin());
        if (axis < 3)
          p.x[axis] = values_.number(e.properties[c].type, s);
        else
          values_.skip(e.properties[c], s);
      }
      for (const double x : p.x) {
        if (!std::isfinite(x))
          in_.fail(Errc::not_finite, "a coordinate of vertex " + std::to_string(i) + " is not finite", {s.id});
      }
      values_.end_entry();
      plc_.points.push_back(p);
    }
    if (std::all_of(column.begin(), column.end(), [&e](std::size_t c) { return e.properties[c].type == Type::f32; }))
      plc_.are_floats = true;
  }

  void read_faces(const Element& e) {
    const bool singular = std::any_of(e.properties.begin(), e.properties.end(),
                                      [](const Property& p) { return p.name == "vertex_index"; });
    const std::size_t corners = find(e, singular ? "vertex_index" : "vertex_indices", true);
    plc_.facets.reserve(e.count);
    for (std::size_t i = 0; i < e.count; ++i) {
      const Subject s{"face", static_cast<std::int64_t>(i)};
      values_.begin_entry(s);
      if (text()) plc_.source.facet_lines.push_back(static_cast<std::uint32_t>(in_.line()));
      for (std::size_t c = 0; c < e.properties.size(); ++c) {
        if (c == corners)
          read_face(e.properties[c], s);
        else
          values_.skip(e.properties[c], s);
      }
      values_.end_entry();
    }
  }

  void read_face(const Property& p, Subject s) {
    const std::size_t n = values_.length(p, s);
    if (n < 3) in_.fail(Errc::degenerate_facet, "face " + std::to_string(s.id) + " has fewer than three corners", {s.id});
    auto& polygon = plc_.facets.emplace_back().polygons.emplace_back(n);
    for (auto& corner : polygon) {
      const std::int64_t v = values_.integer(p.type, s);
      if (v < 0 || static_cast<std::uint64_t>(v) >= points_)
        in_.fail(Errc::index_out_of_range,
                 "face " + std::to_string(s.id) + " refers to vertex " + std::to_string(v) + ", but there are " +
                     std::to_string(points_),
                 {s.id, v});
      corner = static_cast<std::uint32_t>(v);
    }
  }

  void skip(const Element& e) {
    for (std::size_t i = 0; i < e.count; ++i) {
      const Subject s{e.name, static_cast<std::int64_t>(i)};
      values_.begin_entry(s);
      for (const Property& p : e.properties) values_.skip(p, s);
      values_.end_entry();
    }
  }

  /// An error of the header.
  [[noreturn]] void fail(const Element& e, Errc code, const std::string& message) const {
    throw InputError(Diagnostic{code, message, plc_.source.file, e.line, {}, {}});
  }

  /// The column of a property that must be there, and be a list of integers or a number.
  std::size_t find(const Element& e, std::string_view name, bool list) const {
    std::size_t found = e.properties.size();
    for (std::size_t c = 0; c < e.properties.size(); ++c) {
      if (e.properties[c].name != name) continue;
      if (found != e.properties.size()) fail(e, Errc::syntax, "the property " + quoted(name) + " comes twice");
      found = c;
    }
    const std::string what = "the element " + quoted(e.name);
    if (found == e.properties.size()) fail(e, Errc::syntax, what + " has no property " + quoted(name));
    const Property& p = e.properties[found];
    if (p.list != list || (list && !is_integer(p.type)))
      fail(e, Errc::syntax, what + " has a property " + quoted(name) + " of the wrong type");
    return found;
  }

  LineScanner in_;
  Plc<3>& plc_;
  Header header_;
  Values values_;
  std::size_t points_ = 0;
};

}  // namespace

Plc<3> read_ply(std::string_view text, const std::filesystem::path& file) {
  Plc<3> plc;
  plc.source.file = file.string();
  PlyReader(text, plc).read();
  return plc;
}

}  // namespace pgdr::detail
