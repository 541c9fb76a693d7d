// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// STL surfaces, binary and ASCII. Binary is whatever has the size that its count of triangles implies, since binary
// headers that begin with "solid" are common. STL repeats a point for each triangle; equal coordinates (-0 is 0) become
// one point here. Normals are not read: they are often wrong or NaN, and the corners say it all.
//
// Solids are called by what follows "solid" on its line, or in the header of a binary file that begins with it and has text alone
// behind it: other headers tell which program wrote the file. Solids of a file with several, and a single one with a name, have
// the markers 1, 2, ...; several are the bodies of the file.
#include <algorithm>
#include <array>
#include <bit>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "io/formats.hpp"
#include "scan/clean_name.hpp"
#include "scan/line_scanner.hpp"

namespace pgdr::detail {
namespace {

/// Numbers distinct points in the order in which they come; open addressing, since there are three for each triangle.
class PointIndex {
 public:
  explicit PointIndex(std::vector<Point<3>>& points) : points_(points), slots_(1024, none) {}

  std::uint32_t insert(Point<3> p) {
    for (int i = 0; i < 3; ++i) p[i] += 0.0;  // makes -0 to 0
    if (2 * points_.size() >= slots_.size()) grow();
    std::size_t at = find(p);
    if (slots_[at] == none) {
      slots_[at] = static_cast<std::uint32_t>(points_.size());
      points_.push_back(p);
    }
    return slots_[at];
  }

 private:
  static constexpr std::uint32_t none = 0xffffffff;

  /// The slot of p, or the empty one where it belongs.
  std::size_t find(const Point<3>& p) const {
    std::uint64_t h = 0;
    for (int i = 0; i < 3; ++i) {
      h = (h ^ std::bit_cast<std::uint64_t>(p[i])) * 0x9e3779b97f4a7c15u;
      h ^= h >> 32;
    }
    std::size_t at = h & (slots_.size() - 1);
    while (slots_[at] != none && points_[slots_[at]] != p) at = (at + 1) & (slots_.size() - 1);
    return at;
  }
  void grow() {
    slots_.assign(2 * slots_.size(), none);
    for (std::uint32_t i = 0; i < points_.size(); ++i) slots_[find(points_[i])] = i;
  }

  std::vector<Point<3>>& points_;
  std::vector<std::uint32_t> slots_;
};

constexpr std::size_t binary_header = 84, binary_triangle = 50;

std::uint32_t number_at(std::string_view text, std::size_t at) {
  std::uint32_t v = 0;
  for (std::size_t i = 0; i < 4; ++i) v |= std::uint32_t{static_cast<unsigned char>(text[at + i])} << (8 * i);
  return v;
}

bool starts_with_solid(std::string_view text) {
  constexpr std::string_view solid = "solid";
  std::size_t at = text.starts_with("\xEF\xBB\xBF") ? 3 : 0;
  while (at < text.size() && std::isspace(static_cast<unsigned char>(text[at])) != 0) ++at;
  for (std::size_t i = 0; i < solid.size(); ++i) {
    if (at + i >= text.size() || std::tolower(static_cast<unsigned char>(text[at + i])) != solid[i]) return false;
  }
  return true;
}

[[noreturn]] void fail_binary(const Plc<3>& plc, Errc code, const std::string& message,
                              const std::vector<std::int64_t>& ids = {}) {
  throw InputError(Diagnostic{code, message, plc.source.file, 0, ids, {}});
}

void check_binary_size(std::string_view text, const Plc<3>& plc) {
  if (text.size() < binary_header) fail_binary(plc, Errc::truncated, "the file ends within the header");
  const std::uint64_t n = number_at(text, binary_header - 4);
  const std::uint64_t size = binary_header + n * binary_triangle;
  const std::string story = "the header states " + std::to_string(n) + " triangles, hence " + std::to_string(size) +
                            " bytes, but the file has " + std::to_string(text.size());
  if (size > text.size()) fail_binary(plc, Errc::count_too_large, story);
  if (size < text.size()) fail_binary(plc, Errc::syntax, story);
}

void add_triangle(Plc<3>& plc, const std::array<std::uint32_t, 3>& corners, int marker) {
  auto& facet = plc.facets.emplace_back();
  facet.polygons.emplace_back(corners.begin(), corners.end());
  facet.marker = marker;
}

/// Of facets whose markers number their solids from 1: a single one without a name has no label to lose.
void name_solids(Plc<3>& plc, const std::vector<std::string>& names) {
  if (names.size() == 1 && names.front().empty())
    for (auto& f : plc.facets) f.marker = 0;
  for (std::size_t i = 0; i < names.size(); ++i)
    if (!names[i].empty()) plc.names.markers.emplace(static_cast<int>(i + 1), names[i]);
  if (names.size() < 2) return;
  plc.facet_bodies.reserve(plc.facets.size());
  for (const auto& f : plc.facets) plc.facet_bodies.push_back(static_cast<std::uint32_t>(f.marker - 1));
  for (std::size_t i = 0; i < names.size(); ++i)
    plc.body_names.push_back(names[i].empty() ? "solid " + std::to_string(i + 1) : names[i]);
}

/// What stands behind "solid " in the header; empty if anything does that is no text.
std::string name_in_header(std::string_view text) {
  constexpr std::string_view solid = "solid ";
  std::string_view header = text.substr(0, binary_header - 4);
  if (!header.starts_with(solid)) return {};
  header.remove_prefix(solid.size());
  const std::string_view blanks(" \0", 2);
  header = header.substr(0, header.find_last_not_of(blanks) + 1);
  const auto is_text = [](char c) { return c >= ' ' && c <= '~'; };
  return std::all_of(header.begin(), header.end(), is_text) ? clean_name(header) : std::string();
}

void read_binary(std::string_view text, Plc<3>& plc) {
  const std::size_t n = number_at(text, binary_header - 4);
  plc.facets.reserve(n);
  PointIndex index(plc.points);
  for (std::size_t t = 0; t < n; ++t) {
    std::size_t at = binary_header + t * binary_triangle + 12;  // behind the normal
    std::array<std::uint32_t, 3> corners;
    for (auto& c : corners) {
      Point<3> p;
      for (int i = 0; i < 3; ++i, at += 4) {
        p[i] = std::bit_cast<float>(number_at(text, at));
        if (!std::isfinite(p[i]))
          fail_binary(plc, Errc::not_finite, "a coordinate of triangle " + std::to_string(t) + " is not finite",
                      {static_cast<std::int64_t>(t)});
      }
      c = index.insert(p);
    }
    add_triangle(plc, corners, 1);
  }
  name_solids(plc, {name_in_header(text)});
}

/// ASCII STL: a keyword at a time, in any case of letters.
class AsciiReader {
 public:
  AsciiReader(std::string_view text, Plc<3>& plc) : in_(text, plc.source.file), plc_(plc), index_(plc.points) {}

  void read() {
    constexpr Subject solid{"a solid"};
    while (in_.advance()) {
      expect("solid", solid);
      names_.push_back(clean_name(in_.rest_of_line()));
      for (;;) {
        in_.require({"a facet or the end of the solid"});
        const std::string_view word = in_.word(solid);
        if (is_end(word, "endsolid", solid)) break;
        if (!is(word, "facet")) fail(word, "'facet' or 'endsolid'");
        read_facet();
      }
      in_.skip_line();
    }
    name_solids(plc_, names_);
  }

 private:
  static bool is(std::string_view word, std::string_view keyword) {
    if (word.size() != keyword.size()) return false;
    for (std::size_t i = 0; i < word.size(); ++i) {
      if (std::tolower(static_cast<unsigned char>(word[i])) != keyword[i]) return false;
    }
    return true;
  }
  [[noreturn]] void fail(std::string_view word, std::string_view wanted) const {
    in_.fail(Errc::syntax, quoted(word) + " stands where " + std::string(wanted) + " is expected");
  }
  void expect(std::string_view keyword, Subject s) {
    in_.require(s);
    const std::string_view word = in_.word(s);
    if (!is(word, keyword)) fail(word, quoted(keyword));
  }

  /// Whether `word` is that keyword, or its first half: some programs write "end solid".
  bool is_end(std::string_view word, std::string_view keyword, Subject s) {
    if (!is(word, "end")) return is(word, keyword);
    return is(in_.word(s), keyword.substr(3));
  }
  void expect_end(std::string_view keyword, Subject s) {
    in_.require(s);
    const std::string_view word = in_.word(s);
    if (!is_end(word, keyword, s)) fail(word, quoted(keyword));
  }

  void read_facet() {
    const Subject s{"facet", static_cast<std::int64_t>(plc_.facets.size())};
    plc_.source.facet_lines.push_back(static_cast<std::uint32_t>(in_.line()));
    in_.skip_line();  // the normal
    expect("outer", s);
    expect("loop", s);
    std::array<std::uint32_t, 3> corners;
    for (auto& c : corners) {
      expect("vertex", s);
      Point<3> p;
      for (int i = 0; i < 3; ++i) {
        in_.require(s);
        p[i] = in_.number(s);
      }
      c = index_.insert(p);
    }
    expect_end("endloop", s);
    expect_end("endfacet", s);
    add_triangle(plc_, corners, static_cast<int>(names_.size()));
  }

  LineScanner in_;
  Plc<3>& plc_;
  PointIndex index_;
  std::vector<std::string> names_;  ///< of the solids so far
};

}  // namespace

Plc<3> read_stl(std::string_view text, const std::filesystem::path& file) {
  Plc<3> plc;
  plc.source.file = file.string();
  const bool sizes_agree = text.size() >= binary_header &&
                           text.size() == binary_header + std::uint64_t{number_at(text, binary_header - 4)} * binary_triangle;
  if (!sizes_agree && starts_with_solid(text)) {
    AsciiReader(text, plc).read();
  } else {
    check_binary_size(text, plc);
    read_binary(text, plc);
  }
  plc.are_floats = true;
  return plc;
}

}  // namespace pgdr::detail
