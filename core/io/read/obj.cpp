// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Wavefront .obj surfaces: points ("v", further columns dropped) and faces ("f", of "7", "7/1", "7/1/2" or "7//2",
// counted from 1, or from the end if negative). Known statements of other things are stepped over, unknown ones are
// errors. A face is a facet, however many corners it has; it may come before its points.
//
// Groups ("g"), objects ("o") and materials ("usemtl") are what faces are marked by: faces that are alike in all of these have
// one marker, numbered from 1 as they come, and called by those that are not the same for all faces, with "/" between; where all
// are, by the first that there is. A face of none has marker 0. The group "default" is none.
#include <algorithm>
#include <array>
#include <iterator>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "io/formats.hpp"
#include "scan/clean_name.hpp"
#include "scan/line_scanner.hpp"

namespace pgdr::detail {
namespace {

constexpr std::string_view ignored[] = {
    "vt", "vn", "vp",    "s",   "mg",         "mtllib",    "usemap",   "maplib",
    "l",  "p",  "bevel", "lod", "shadow_obj", "trace_obj", "c_interp", "d_interp",
};
constexpr std::array<std::string_view, 3> naming{"g", "o", "usemtl"};  // in the order in which they name

using FaceNames = std::array<std::string, naming.size()>;  ///< what the last statement of each has said

/// Numbers what faces are called.
class FaceKinds {
 public:
  void set(std::size_t statement, std::string name) {
    now_[statement] = std::move(name);
    current_ = none;
  }
  /// To be called for each face.
  void add_face() {
    if (current_ == none) {
      const auto [it, is_new] = number_.emplace(now_, all_.size());
      if (is_new) all_.push_back(now_);
      current_ = it->second;
    }
    of_face_.push_back(static_cast<std::uint32_t>(current_));
  }
  void mark(Plc<3>& plc) const {
    std::array<bool, naming.size()> varies{};
    for (std::size_t k = 0; k < naming.size(); ++k)
      varies[k] = std::any_of(all_.begin(), all_.end(), [&](const FaceNames& n) { return n[k] != all_.front()[k]; });
    std::map<FaceNames, int> markers;
    std::vector<int> marker_of_kind;
    for (const FaceNames& names : all_) {
      const auto [key, name] = key_and_name(names, varies);
      int marker = 0;
      if (!name.empty()) {
        marker = markers.emplace(key, static_cast<int>(markers.size()) + 1).first->second;
        plc.names.markers[marker] = name;
      }
      marker_of_kind.push_back(marker);
    }
    for (std::size_t f = 0; f < of_face_.size(); ++f) plc.facets[f].marker = marker_of_kind[of_face_[f]];
  }

 private:
  static std::pair<FaceNames, std::string> key_and_name(const FaceNames& names, const std::array<bool, naming.size()>& varies) {
    const bool any_varies = std::find(varies.begin(), varies.end(), true) != varies.end();
    FaceNames key;
    std::string name;
    for (std::size_t k = 0; k < naming.size(); ++k) {
      if (names[k].empty() || (any_varies ? !varies[k] : !name.empty())) continue;
      key[k] = names[k];
      name += (name.empty() ? "" : "/") + names[k];
    }
    return {key, name};
  }

  static constexpr std::size_t none = static_cast<std::size_t>(-1);
  FaceNames now_;
  std::map<FaceNames, std::size_t> number_;
  std::vector<FaceNames> all_;
  std::size_t current_ = none;
  std::vector<std::uint32_t> of_face_;
};

class ObjReader {
 public:
  ObjReader(std::string_view text, Plc<3>& plc) : in_(text, plc.source.file), plc_(plc) { plc_.first_index = 1; }

  void read() {
    while (in_.advance()) {
      const std::string_view keyword = in_.word({});
      if (keyword == "v") {
        read_point();
      } else if (keyword == "f") {
        read_face();
        kinds_.add_face();
      } else if (const auto at = std::find(naming.begin(), naming.end(), keyword); at != naming.end()) {
        read_name(static_cast<std::size_t>(at - naming.begin()));
      } else if (std::find(std::begin(ignored), std::end(ignored), keyword) != std::end(ignored)) {
        skip_statement();
      } else {
        in_.fail(Errc::syntax, quoted(keyword) + " is not a statement of an .obj file that is known here");
      }
    }
    for (const Forward& f : forward_) {
      if (static_cast<std::uint64_t>(f.corner) > plc_.points.size()) fail_reference(f.face, f.corner, f.line);
    }
    kinds_.mark(plc_);
  }

 private:
  /// A corner that lay behind the last point when it was read.
  struct Forward {
    std::int64_t face, corner;
    std::uint64_t line;
  };

  /// Whether the statement goes on, on the next line if this one ends with a backslash.
  bool next_word() {
    if (!in_.more_on_line()) return false;
    if (in_.peek() != '\\') return true;
    in_.accept("\\");
    in_.end_line({"a line that continues"});
    return in_.advance();
  }

  void skip_statement() {
    while (in_.more_on_line()) {
      if (in_.word({}) == "\\" && !in_.more_on_line()) in_.advance();
    }
  }

  void read_name(std::size_t statement) {
    std::string_view line = in_.rest_of_line();
    std::string name;
    while (line.ends_with('\\') || line.ends_with("\\\r")) {  // it goes on
      name.append(line.substr(0, line.rfind('\\')));
      if (!in_.advance()) break;
      line = in_.rest_of_line();
    }
    name = clean_name(name.append(line));
    kinds_.set(statement, statement == 0 && name == "default" ? std::string() : std::move(name));
  }

  void read_point() {
    const Subject s{"point", static_cast<std::int64_t>(plc_.points.size() + 1)};
    plc_.source.point_lines.push_back(static_cast<std::uint32_t>(in_.line()));
    Point<3> p;
    for (int i = 0; i < 3; ++i) {
      next_word();
      p[i] = in_.number(s);
    }
    plc_.points.push_back(p);
    while (next_word()) in_.number(s, false);
  }

  void read_face() {
    const Subject s{"face", static_cast<std::int64_t>(plc_.facets.size() + 1)};
    plc_.source.facet_lines.push_back(static_cast<std::uint32_t>(in_.line()));
    auto& polygon = plc_.facets.emplace_back().polygons.emplace_back();
    while (next_word()) polygon.push_back(read_corner(s));
    if (polygon.size() < 3)
      in_.fail(Errc::degenerate_facet, "face " + std::to_string(s.id) + " has fewer than three corners", {s.id});
  }

  std::uint32_t read_corner(Subject s) {
    const std::string_view token = in_.word(s);
    const auto number = parse_integer(token.substr(0, token.find('/')));
    if (!number || token.find_first_not_of("+-0123456789/") != std::string_view::npos)
      in_.fail(Errc::syntax, quoted(token) + " is not a corner, in face " + std::to_string(s.id), {s.id});
    const auto points = static_cast<std::int64_t>(plc_.points.size());
    const std::int64_t corner = *number < 0 ? points + 1 + *number : *number;
    if (*number == 0 || corner < 1 || corner > most_points) fail_reference(s.id, *number, in_.line());
    if (corner > points) forward_.push_back({s.id, corner, in_.line()});
    return static_cast<std::uint32_t>(corner - 1);
  }

  [[noreturn]] void fail_reference(std::int64_t face, std::int64_t corner, std::uint64_t line) const {
    const std::string message = "face " + std::to_string(face) + " refers to point " + std::to_string(corner) +
                                ", but there are " + std::to_string(plc_.points.size());
    throw InputError(Diagnostic{Errc::index_out_of_range, message, plc_.source.file, line, {face, corner}, {}});
  }

  static constexpr std::int64_t most_points = 0xfffffffe;

  LineScanner in_;
  Plc<3>& plc_;
  std::vector<Forward> forward_;
  FaceKinds kinds_;
};

}  // namespace

Plc<3> read_obj(std::string_view text, const std::filesystem::path& file) {
  Plc<3> plc;
  plc.source.file = file.string();
  ObjReader(text, plc).read();
  return plc;
}

}  // namespace pgdr::detail
