// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Writes MFEM's mesh: elements, boundary elements (all walls, also those between cells) and vertices, with positive attributes
// for labels and markers. Version 1.3, which has named sets of attributes (MFEM 4.7 or later), where anything has a name or an
// attribute that is not its label; else version 1.0. https://mfem.org/mesh-formats
#include <algorithm>
#include <map>
#include <string>

#include "input/words.hpp"
#include "io/formats.hpp"
#include "io/write/valid_names.hpp"
#include "io/write/wall_sides.hpp"

namespace pgdr::detail {
namespace {

constexpr int mfem_segment = 1, mfem_triangle = 2, mfem_tetrahedron = 4;  // MFEM's numbers

/// Attributes of one kind of elements, and the sets that name them.
class Attributes {
 public:
  template <class Key>
  Attributes(std::vector<double> labels, const std::map<Key, std::string>& names, const std::string& what)
      : labels_(distinct_labels(std::move(labels))), numbers_(positive_numbers(labels_)) {
    for (std::size_t i = 0; i < labels_.size(); ++i) {
      const auto it = names.find(static_cast<Key>(labels_[i]));
      if (it != names.end())
        sets_[it->second].push_back(numbers_[i]);
      else if (!is_positive_number(labels_[i]))
        sets_[what + to_text(labels_[i])].push_back(numbers_[i]);
    }
  }
  int of(double label) const {
    return numbers_[static_cast<std::size_t>(std::lower_bound(labels_.begin(), labels_.end(), label) - labels_.begin())];
  }
  bool has_sets() const { return !sets_.empty(); }
  void put_sets(FileOutput& out, std::string_view section) const {
    out.put(section);
    out.put_number(sets_.size());
    out.put('\n');
    for (const auto& [name, numbers] : sets_) {
      out.put('"');
      out.put(name);
      out.put("\" ");
      out.put_number(numbers.size());
      for (const int n : numbers) {
        out.put(' ');
        out.put_number(n);
      }
      out.put('\n');
    }
  }

 private:
  std::vector<double> labels_;
  std::vector<int> numbers_;
  std::map<std::string, std::vector<int>> sets_;
};

template <class Vertices>
void put_element(TextBuffer& text, int attribute, int geometry, const Vertices& vertices) {
  text.put_number(attribute);
  text.put(' ');
  text.put_number(geometry);
  for (const std::uint32_t v : vertices) {
    text.put(' ');
    text.put_number(v);
  }
  text.put('\n');
}

void put_heading(FileOutput& out, std::string_view section, std::size_t n) {
  out.put(section);
  out.put_number(n);
  out.put('\n');
}

}  // namespace

template <int D>
void write_mfem(const OutputMesh<D>& mesh, FileOutput& out) {
  const Names names = valid_names(mesh.names, mfem_names);
  const auto& walls = walls_of<D>(mesh);
  std::vector<double> markers;
  for (const auto& w : walls) markers.push_back(w.marker);
  const Attributes regions(mesh.regions.empty() ? std::vector<double>{0} : mesh.regions, names.regions, "region ");
  const Attributes boundary(std::move(markers), names.markers, "marker ");
  const bool has_sets = regions.has_sets() || boundary.has_sets();
  out.put(has_sets ? "MFEM mesh v1.3\n\ndimension\n" : "MFEM mesh v1.0\n\ndimension\n");
  out.put_number(D);
  put_heading(out, "\n\nelements\n", mesh.cells.size());
  out.put_each(mesh.cells.size(), [&](TextBuffer& text, std::size_t i) {
    put_element(text, regions.of(mesh.regions.empty() ? 0 : mesh.regions[i]), D == 3 ? mfem_tetrahedron : mfem_triangle,
                mesh.cells[i]);
  });
  if (has_sets) regions.put_sets(out, "\nattribute_sets\n");
  put_heading(out, "\nboundary\n", walls.size());
  out.put_each(walls.size(), [&](TextBuffer& text, std::size_t i) {
    put_element(text, boundary.of(walls[i].marker), D == 3 ? mfem_triangle : mfem_segment, walls[i].vertices);
  });
  if (has_sets) boundary.put_sets(out, "\nbdr_attribute_sets\n");
  put_heading(out, "\nvertices\n", mesh.points.size());
  out.put_number(D);
  out.put('\n');
  out.put_each(mesh.points.size(), [&](TextBuffer& text, std::size_t i) {
    for (int k = 0; k < D; ++k) {
      if (k > 0) text.put(' ');
      text.put_number(mesh.points[i][k]);
    }
    text.put('\n');
  });
  if (has_sets) out.put("\nmfem_mesh_end\n");
}

template void write_mfem<2>(const OutputMesh<2>&, FileOutput&);
template void write_mfem<3>(const OutputMesh<3>&, FileOutput&);

}  // namespace pgdr::detail
