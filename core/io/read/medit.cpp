// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Reads Medit's .mesh as text, section by section. References are markers and region attributes; what ours state in
// comments (io/write/medit.cpp) is heeded. Sections that nothing has a place for are stepped over.
// Pascal Frey, MEDIT: an interactive mesh visualization software, INRIA RT-0253, 2001.
#include <algorithm>
#include <set>
#include <string>

#include "io/formats.hpp"
#include "scan/line_scanner.hpp"

namespace pgdr::detail {
namespace {

/// The values of the comments "# region <n> = <value>", which stand before the points. @throws syntax
std::vector<double> read_region_comments(std::string_view text, const LineScanner& in) {
  constexpr std::string_view region_comment = "# region ";
  std::vector<double> values;
  while (!text.empty() && !text.starts_with("Vertices")) {
    const std::string_view line = text.substr(0, text.find('\n'));
    text.remove_prefix(std::min(line.size() + 1, text.size()));
    if (!line.starts_with(region_comment)) continue;
    LineScanner words(line.substr(region_comment.size()), "");
    const auto next = [&words] { return words.more_on_line() ? words.word({}) : std::string_view(); };
    const std::string_view n = next(), equals = next(), value = next();
    const auto number = parse_double(value);
    if (parse_integer(n) != static_cast<std::int64_t>(values.size()) + 1 || equals != "=" || !number)
      in.fail(Errc::syntax, "the comment " + quoted(line) + " does not say what a region is");
    values.push_back(*number);
  }
  return values;
}

class MeditReader {
 public:
  MeditReader(std::string_view text, const std::string& file, Want want)
      : in_(text, file), want_(want), region_values_(read_region_comments(text, in_)) {
    mesh_.file = file;
    mesh_.names = read_name_comments(text.substr(0, text.find("\nVertices")), file);
  }

  FileMesh read() {
    while (!spatial_) {
      in_.require({"a section or End"});
      const std::string_view keyword = in_.word({});
      if (keyword == "End") break;
      read_section(keyword);
    }
    if (spatial_) return std::move(mesh_);
    if (in_.advance()) in_.fail(Errc::syntax, quoted(in_.word({})) + " stands behind End");
    if (!dimension_known_) in_.fail(Errc::syntax, "the file states no dimension");
    mesh_.point_markers.resize(mesh_.points.size());
    return std::move(mesh_);
  }

 private:
  void read_section(std::string_view keyword) {
    if (keyword == "MeshVersionFormatted") {
      integer({"the version"});
    } else if (keyword == "Dimension") {
      read_dimension();
    } else if (keyword == "Vertices") {
      read_points();
    } else if (keyword == "Edges" || keyword == "EdgesP2") {
      read_elements(keyword, mesh_.edges, &mesh_.edge_lines, "edge", 1);
    } else if (keyword == "Triangles" || keyword == "TrianglesP2") {
      read_elements(keyword, mesh_.triangles, &mesh_.triangle_lines, "triangle", 2);
    } else if (keyword == "Quadrilaterals") {
      read_elements(keyword, mesh_.quadrilaterals, &mesh_.quadrilateral_lines, "quadrilateral", 2);
    } else if (keyword == "Tetrahedra" || keyword == "TetrahedraP2") {
      read_elements(keyword, mesh_.tetrahedra, nullptr, "tetrahedron", 3);
    } else if (keyword == "RequiredVertices") {
      read_required_points();
    } else {
      skip_section(keyword);
    }
  }

  void read_dimension() {
    if (dimension_known_) in_.fail(Errc::syntax, "the dimension comes twice");
    const std::int64_t d = integer({"the dimension"});
    if (d != 2 && d != 3) in_.fail(Errc::syntax, "the dimension is " + std::to_string(d) + ", not 2 or 3");
    if (d == 2 && want_.dimension == 3) in_.fail(Errc::syntax, "the dimension is 2, not 3");
    mesh_.dimension = static_cast<int>(d);
    mesh_.dimension_line = in_.line();
    dimension_known_ = true;
    spatial_ = want_.purpose == Purpose::dimension && d == 2;
  }

  void skip_section(std::string_view keyword) {
    if (!is_letter(keyword.front())) in_.fail(Errc::syntax, quoted(keyword) + " stands where a section begins");
    const std::uint64_t line = in_.line();
    const std::pair<std::string_view, std::size_t> other[] = {{"Hexahedra", 8}, {"Prisms", 6}, {"Pyramids", 5}};
    for (const auto& [name, corners] : other) {
      if (keyword == name) return read_other_cells(name, corners, line);
    }
    while (in_.advance() && !is_letter(in_.peek())) in_.word({});
  }

  void read_other_cells(std::string_view name, std::size_t corners, std::uint64_t line) {
    const std::size_t n = count({"the list of cells"}, 2 * (corners + 1));
    if (n != 0 && mesh_.other_cells.empty()) {
      mesh_.other_cells = name;
      mesh_.other_line = line;
    }
    for (std::size_t i = 0; i < n; ++i) {
      const Subject s{"cell", static_cast<std::int64_t>(i + 1)};
      for (std::size_t k = 0; k < corners; ++k) mesh_.other_corners.push_back(corner(s));
      label(s);
    }
  }

  void read_points() {
    if (!mesh_.points.empty()) in_.fail(Errc::syntax, "the section Vertices comes twice");
    const std::size_t n = count({"the list of points"}, 2 * 3);
    if (n != 0 && !dimension_known_) in_.fail(Errc::syntax, "the points come before the dimension");
    in_.check_count({"the list of points"}, n, 2 * (static_cast<std::size_t>(mesh_.dimension) + 1));
    mesh_.points.resize(n);
    mesh_.point_markers.resize(n);
    for (std::size_t i = 0; i < n; ++i) {
      const Subject s{"point", static_cast<std::int64_t>(i + 1)};
      for (int k = 0; k < mesh_.dimension; ++k) {
        in_.require(s);
        if (k == 0 && want_.purpose == Purpose::input) mesh_.point_lines.push_back(static_cast<std::uint32_t>(in_.line()));
        mesh_.points[i][k] = in_.number(s);
      }
      mesh_.point_markers[i] = label(s);
      spatial_ = want_.purpose == Purpose::dimension && mesh_.points[i][2] != 0;
      if (spatial_) return;
    }
  }

  /// Elements of second order, of libMeshb's sections ...P2, have a node in the middle of each edge behind their corners.
  template <std::size_t N>
  void read_elements(std::string_view keyword, std::vector<FileMesh::Element<N>>& list, std::vector<std::uint32_t>* lines,
                     std::string_view what, int dimension) {
    if (!sections_.insert(keyword).second) in_.fail(Errc::syntax, "a section comes twice");
    const std::size_t middles = keyword.ends_with("P2") ? N * (N - 1) / 2 : 0, before = list.size();
    list.resize(before + count({"a list of elements"}, 2 * (N + middles + 1)));
    if (middles > 0) mesh_.mid_sides.resize(mesh_.points.size());
    for (std::size_t i = before; i < list.size(); ++i) {
      const Subject s{what, static_cast<std::int64_t>(i - before + 1)};
      for (auto& c : list[i].corners) c = corner(s);
      for (std::size_t k = 0; k < middles; ++k) mesh_.mid_sides[corner(s)] = 1;
      if (lines != nullptr && want_.purpose == Purpose::input) lines->push_back(static_cast<std::uint32_t>(in_.line()));
      const int reference = label(s);
      list[i].label = dimension == mesh_.dimension && !region_values_.empty() ? region_value(s, reference) : reference;
    }
  }

  /// What the comments say that a reference of a cell stands for.
  double region_value(Subject s, int reference) const {
    if (reference < 1 || static_cast<std::size_t>(reference) > region_values_.size())
      in_.fail(Errc::index_out_of_range, "no comment says what region " + std::to_string(reference) + " is", {s.id, reference});
    return region_values_[static_cast<std::size_t>(reference) - 1];
  }

  /// Points that are to stay. They are the input points, if the list is what `write_medit` makes of them.
  void read_required_points() {
    const std::size_t n = count({"the list of required points"}, 2);
    mesh_.required.resize(mesh_.points.size());
    bool ours = true;
    for (std::size_t i = 0; i < n; ++i) {
      in_.require({"a required point"});
      const std::uint32_t v = in_.reference({"the list of required points"}, 1, mesh_.points.size());
      mesh_.required[v] = 1;
      ours &= v == i;
    }
    mesh_.input_points = ours ? n : 0;
  }

  std::uint32_t corner(Subject s) {
    in_.require(s);
    return in_.reference(s, 1, mesh_.points.size());
  }
  int label(Subject s) {
    in_.require(s);
    return in_.marker(s);
  }
  std::int64_t integer(Subject s) {
    in_.require(s);
    return in_.integer(s);
  }
  std::size_t count(Subject s, std::size_t bytes_each) {
    in_.require(s);
    return in_.count(s, bytes_each);
  }
  static bool is_letter(char c) { return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z'); }

  LineScanner in_;
  Want want_;
  std::vector<double> region_values_;
  FileMesh mesh_;
  std::set<std::string_view> sections_;  ///< of elements that have been read
  bool dimension_known_ = false;
  bool spatial_ = false;  ///< the dimension was asked for, and is decided
};

}  // namespace

FileMesh read_medit(std::string_view text, const std::filesystem::path& file, Want want) {
  return MeditReader(text, file.string(), want).read();
}

}  // namespace pgdr::detail
