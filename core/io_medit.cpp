// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Medit's .mesh. References are integers there, so region attributes that are not are numbered by value, and comment
// lines "# region <n> = <value>" before the points keep what they were. RequiredVertices lists the input points.
// References that are all 0 read back as no labels at all.
#include <algorithm>
#include <cmath>
#include <compare>
#include <string>

#include "detail/io_formats.hpp"
#include "detail/line_scanner.hpp"

namespace pgdr::detail {
namespace {

constexpr std::string_view region_comment = "# region ";

/// Region attributes as references: themselves where all are integers, else their rank among the distinct values.
class RegionReferences {
 public:
  explicit RegionReferences(const std::vector<double>& regions) : regions_(regions) {
    if (std::all_of(regions.begin(), regions.end(), is_reference)) return;
    values_ = regions;
    std::sort(values_.begin(), values_.end(), before);
    const auto same = [](double a, double b) { return std::strong_order(a, b) == 0; };
    values_.erase(std::unique(values_.begin(), values_.end(), same), values_.end());
  }
  /// Empty where the references are the attributes; else reference n stands for value n - 1.
  const std::vector<double>& values() const { return values_; }
  int operator()(std::size_t cell) const {
    if (regions_.empty()) return 0;
    if (values_.empty()) return static_cast<int>(regions_[cell]);
    const auto at = std::lower_bound(values_.begin(), values_.end(), regions_[cell], before);
    return static_cast<int>(at - values_.begin()) + 1;
  }

 private:
  // A total order of all doubles, so that even -0 and NaN, which no file holds, would not be undefined behaviour.
  static bool before(double a, double b) { return std::strong_order(a, b) < 0; }
  static bool is_reference(double v) {
    constexpr double most = 2147483647;
    return v >= -most && v <= most && v == std::floor(v) && !(v == 0 && std::signbit(v));
  }

  const std::vector<double>& regions_;
  std::vector<double> values_;
};

void put_section(FileOutput& out, std::string_view keyword, std::size_t n) {
  out.put(keyword);
  out.put('\n');
  out.put_number(n);
  out.put('\n');
}

template <std::size_t N>
void put_simplex(FileOutput& out, const std::array<std::uint32_t, N>& vertices, int reference) {
  for (const std::uint32_t v : vertices) {
    out.put_number(std::uint64_t{v} + 1);
    out.put(' ');
  }
  out.put_number(reference);
  out.put('\n');
}

template <class Constraints>
void put_constraints(FileOutput& out, std::string_view keyword, const Constraints& constraints) {
  if (constraints.empty()) return;
  put_section(out, keyword, constraints.size());
  for (const auto& c : constraints) put_simplex(out, c.vertices, c.marker);
}

template <int D>
void put_header(FileOutput& out, const RegionReferences& reference) {
  out.put("MeshVersionFormatted 2\nDimension ");
  out.put_number(D);
  out.put('\n');
  for (std::size_t i = 0; i < reference.values().size(); ++i) {
    out.put(region_comment);
    out.put_number(i + 1);
    out.put(" = ");
    out.put_number(reference.values()[i]);
    out.put('\n');
  }
}

/// The values of the region comments, which stand before the points. @throws syntax
std::vector<double> read_region_comments(std::string_view text, const LineScanner& in) {
  std::vector<double> values;
  while (!text.empty() && !text.starts_with("Vertices")) {
    const std::string_view line = text.substr(0, text.find('\n'));
    text.remove_prefix(std::min(line.size() + 1, text.size()));
    if (!line.starts_with(region_comment)) continue;
    LineScanner words(line.substr(region_comment.size()), "");
    const std::string_view n = words.word({}), equals = words.word({}), value = words.word({});
    const auto number = parse_double(value);
    if (parse_integer(n) != static_cast<std::int64_t>(values.size()) + 1 || equals != "=" || !number)
      in.fail(Errc::syntax, "the comment " + quoted(line) + " does not say what a region is");
    values.push_back(*number);
  }
  return values;
}

/// A .mesh file, section by section. Sections that an OutputMesh has no place for are stepped over.
template <int D>
class MeditReader {
 public:
  MeditReader(std::string_view text, const std::string& file)
      : in_(text, file), region_values_(read_region_comments(text, in_)) {}

  OutputMesh<D> read() {
    for (;;) {
      in_.require({"a section or End"});
      const std::string_view keyword = in_.word({});
      if (keyword == "End") break;
      read_section(keyword);
    }
    if (in_.advance()) in_.fail(Errc::syntax, quoted(in_.word({})) + " stands behind End");
    if (!dimension_known_) in_.fail(Errc::syntax, "the file states no dimension");
    if (std::all_of(mesh_.point_markers.begin(), mesh_.point_markers.end(), [](int m) { return m == 0; }))
      mesh_.point_markers.clear();
    if (std::all_of(mesh_.regions.begin(), mesh_.regions.end(), [](double r) { return r == 0; }) &&
        region_values_.empty())
      mesh_.regions.clear();
    return std::move(mesh_);
  }

 private:
  void read_section(std::string_view keyword) {
    if (keyword == "MeshVersionFormatted") {
      integer({"the version"});
    } else if (keyword == "Dimension") {
      if (const std::int64_t d = integer({"the dimension"}); d != D)
        in_.fail(Errc::syntax, "the dimension is " + std::to_string(d) + ", not " + std::to_string(D));
      dimension_known_ = true;
    } else if (keyword == "Vertices") {
      read_points();
    } else if (keyword == "Edges") {
      read_constraints(mesh_.subsegments, "edge");
    } else if (keyword == "Triangles" && D == 3) {
      read_constraints(mesh_.subfacets, "triangle");
    } else if (keyword == (D == 3 ? "Tetrahedra" : "Triangles")) {
      read_cells();
    } else if (keyword == "RequiredVertices") {
      read_input_points();
    } else {
      skip_section(keyword);
    }
  }

  void skip_section(std::string_view keyword) {
    if (!is_letter(keyword.front())) in_.fail(Errc::syntax, quoted(keyword) + " stands where a section begins");
    for (const std::string_view cells : {"Tetrahedra", "Quadrilaterals", "Hexahedra", "Prisms", "Pyramids"}) {
      if (keyword == cells && count({"the list of cells"}, 2) != 0)
        in_.fail(Errc::unknown_format, std::string(keyword) + " cannot be read: only simplices are");
    }
    while (in_.advance() && !is_letter(in_.peek())) in_.word({});
  }

  void read_points() {
    if (!mesh_.points.empty()) in_.fail(Errc::syntax, "the section Vertices comes twice");
    const std::size_t n = count({"the list of points"}, 2 * (D + 1));
    mesh_.points.resize(n);
    mesh_.point_markers.resize(n);
    for (std::size_t i = 0; i < n; ++i) {
      const Subject s{"point", static_cast<std::int64_t>(i + 1)};
      for (int k = 0; k < D; ++k) {
        in_.require(s);
        mesh_.points[i][k] = in_.number(s);
      }
      mesh_.point_markers[i] = label(s);
    }
  }

  template <class Constraint>
  void read_constraints(std::vector<Constraint>& list, std::string_view what) {
    if (!list.empty()) in_.fail(Errc::syntax, "a section comes twice");
    list.resize(count({"a list of constraints"}, 2 * (Constraint{}.vertices.size() + 1)));
    for (std::size_t i = 0; i < list.size(); ++i) {
      const Subject s{what, static_cast<std::int64_t>(i + 1)};
      read_vertices(list[i].vertices, s);
      list[i].marker = label(s);
    }
  }

  void read_cells() {
    if (!mesh_.cells.empty()) in_.fail(Errc::syntax, "the section of the cells comes twice");
    const std::size_t n = count({"the list of cells"}, 2 * (D + 2));
    mesh_.cells.resize(n);
    mesh_.regions.resize(n);
    for (std::size_t i = 0; i < n; ++i) {
      const Subject s{"cell", static_cast<std::int64_t>(i + 1)};
      read_vertices(mesh_.cells[i], s);
      const int reference = label(s);
      mesh_.regions[i] = region_values_.empty() ? reference : region_value(s, reference);
    }
  }

  double region_value(Subject s, int reference) const {
    if (reference < 1 || static_cast<std::size_t>(reference) > region_values_.size())
      in_.fail(Errc::index_out_of_range, "no comment says what region " + std::to_string(reference) + " is",
               {s.id, reference});
    return region_values_[static_cast<std::size_t>(reference) - 1];
  }

  /// The input points, if the list is what `write_medit` makes of them; other programs list other points.
  void read_input_points() {
    const std::size_t n = count({"the list of required points"}, 2);
    bool ours = true;
    for (std::size_t i = 0; i < n; ++i) {
      in_.require({"a required point"});
      ours &= in_.reference({"the list of required points"}, 1, mesh_.points.size()) == i;
    }
    mesh_.input_points = ours ? n : 0;
  }

  template <std::size_t N>
  void read_vertices(std::array<std::uint32_t, N>& vertices, Subject s) {
    for (auto& v : vertices) {
      in_.require(s);
      v = in_.reference(s, 1, mesh_.points.size());
    }
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
  std::vector<double> region_values_;
  OutputMesh<D> mesh_;
  bool dimension_known_ = false;
};

}  // namespace

template <int D>
void write_medit(const OutputMesh<D>& mesh, FileOutput& out) {
  const RegionReferences reference(mesh.regions);
  put_header<D>(out, reference);
  put_section(out, "Vertices", mesh.points.size());
  for (std::size_t i = 0; i < mesh.points.size(); ++i) {
    for (int k = 0; k < D; ++k) {
      out.put_number(mesh.points[i][k]);
      out.put(' ');
    }
    out.put_number(mesh.point_markers.empty() ? 0 : mesh.point_markers[i]);
    out.put('\n');
  }
  put_constraints(out, "Edges", mesh.subsegments);
  if constexpr (D == 3) put_constraints(out, "Triangles", mesh.subfacets);
  put_section(out, D == 2 ? "Triangles" : "Tetrahedra", mesh.cells.size());
  for (std::size_t i = 0; i < mesh.cells.size(); ++i) put_simplex(out, mesh.cells[i], reference(i));
  if (mesh.input_points != 0) {
    put_section(out, "RequiredVertices", mesh.input_points);
    for (std::size_t i = 1; i <= mesh.input_points; ++i) {
      out.put_number(i);
      out.put('\n');
    }
  }
  out.put("End\n");
}

template <int D>
OutputMesh<D> read_medit(std::string_view text, const std::filesystem::path& file) {
  return MeditReader<D>(text, file.string()).read();
}

int medit_dimension(std::string_view text, const std::filesystem::path& file) {
  LineScanner in(text, file.string());
  constexpr Subject dimension{"the dimension"};
  for (;;) {
    in.require(dimension);
    if (in.word(dimension) == "Dimension") break;
  }
  in.require(dimension);
  const std::int64_t d = in.integer(dimension);
  if (d != 2 && d != 3) in.fail(Errc::syntax, "the dimension is " + std::to_string(d) + ", not 2 or 3");
  return static_cast<int>(d);
}

template OutputMesh<2> read_medit<2>(std::string_view, const std::filesystem::path&);
template OutputMesh<3> read_medit<3>(std::string_view, const std::filesystem::path&);
template void write_medit<2>(const OutputMesh<2>&, FileOutput&);
template void write_medit<3>(const OutputMesh<3>&, FileOutput&);

}  // namespace pgdr::detail
