// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Writes Medit's .mesh. References are integers there, so region attributes that are not are numbered by value, and
// comment lines "# region <n> = <value>" before the points keep what they were; so do others the names. RequiredVertices lists
// the input points.
#include <algorithm>
#include <cmath>
#include <compare>
#include <string>

#include "io/formats.hpp"

namespace pgdr::detail {
namespace medit {

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

}  // namespace medit
namespace {

void put_section(FileOutput& out, std::string_view keyword, std::size_t n) {
  out.put(keyword);
  out.put('\n');
  out.put_number(n);
  out.put('\n');
}

template <std::size_t N>
void put_simplex(TextBuffer& out, const std::array<std::uint32_t, N>& vertices, int reference) {
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
  out.put_each(constraints.size(),
               [&](TextBuffer& text, std::size_t i) { put_simplex(text, constraints[i].vertices, constraints[i].marker); });
}

template <int D>
void put_header(FileOutput& out, const medit::RegionReferences& reference, const Names& names) {
  out.put("MeshVersionFormatted 2\nDimension ");
  out.put_number(D);
  out.put('\n');
  for (std::size_t i = 0; i < reference.values().size(); ++i) {
    out.put("# region ");
    out.put_number(i + 1);
    out.put(" = ");
    out.put_number(reference.values()[i]);
    out.put('\n');
  }
  out.put(name_comments(names));
}

}  // namespace

template <int D>
void write_medit(const OutputMesh<D>& mesh, FileOutput& out) {
  const medit::RegionReferences reference(mesh.regions);
  put_header<D>(out, reference, mesh.names);
  put_section(out, "Vertices", mesh.points.size());
  out.put_each(mesh.points.size(), [&](TextBuffer& text, std::size_t i) {
    for (int k = 0; k < D; ++k) {
      text.put_number(mesh.points[i][k]);
      text.put(' ');
    }
    text.put_number(mesh.point_markers.empty() ? 0 : mesh.point_markers[i]);
    text.put('\n');
  });
  put_constraints(out, "Edges", mesh.subsegments);
  if constexpr (D == 3) put_constraints(out, "Triangles", mesh.subfacets);
  put_section(out, D == 2 ? "Triangles" : "Tetrahedra", mesh.cells.size());
  out.put_each(mesh.cells.size(), [&](TextBuffer& text, std::size_t i) { put_simplex(text, mesh.cells[i], reference(i)); });
  if (mesh.input_points != 0) {
    put_section(out, "RequiredVertices", mesh.input_points);
    out.put_each(mesh.input_points, [](TextBuffer& text, std::size_t i) {
      text.put_number(i + 1);
      text.put('\n');
    });
  }
  out.put("End\n");
}

template void write_medit<2>(const OutputMesh<2>&, FileOutput&);
template void write_medit<3>(const OutputMesh<3>&, FileOutput&);

}  // namespace pgdr::detail
