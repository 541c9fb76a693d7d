// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Writes the part of an input of Abaqus or CalculiX that is the mesh: nodes; elements C3D4 (2D: CPS3; of second order C3D10,
// CPS6) in an element set a region; of each marker a node set, and of one that walls have an element-based surface. Numbers are
// places from 1. A wall between cells is the face of the one with the smaller number. Coordinates have at most 20 characters, as
// both programs read no more: up to 14 digits where 17 would not fit. Abaqus Analysis User's Guide, "Element-based surface
// definition"; CalculiX CrunchiX User's Manual, *SURFACE.
#include <algorithm>
#include <map>
#include <string>
#include <utility>

#include "input/words.hpp"
#include "io/formats.hpp"
#include "io/write/valid_names.hpp"
#include "io/write/wall_sides.hpp"
#include "output/mid_sides.hpp"

namespace pgdr::detail {
namespace {

constexpr std::size_t most_characters = 20, numbers_a_line = 16;

void put_coordinate(TextBuffer& out, double x) {
  char text[32];
  char* const begin = text;
  char* end = std::to_chars(begin, begin + sizeof text, x).ptr;
  for (int digits = 16; static_cast<std::size_t>(end - begin) > most_characters; --digits)
    end = std::to_chars(begin, begin + sizeof text, x, std::chars_format::scientific, digits).ptr;
  out.put({begin, static_cast<std::size_t>(end - begin)});
}

template <int D>
class AbaqusWriter {
 public:
  AbaqusWriter(const OutputMesh<D>& mesh, const MidSides<D>* middles, FileOutput& out)
      : mesh_(mesh), middles_(middles), out_(out), names_(valid_names(mesh.names, abaqus_names)) {}

  void write() {
    out_.put("*HEADING\npgdr\n");
    put_nodes();
    put_elements();
    put_node_sets();
    put_surfaces();
  }

 private:
  void put_nodes() {
    out_.put("*NODE\n");
    out_.put_each(mesh_.points.size(), [this](TextBuffer& text, std::size_t i) {
      text.put_number(i + 1);
      for (const double x : mesh_.points[i].x) {
        text.put(", ");
        put_coordinate(text, x);
      }
      text.put('\n');
    });
  }

  /// The names of the sets of all labels: those given first, so that none of the others takes one away.
  template <class Label>
  static std::map<Label, std::string> set_names(const std::map<Label, std::string>& given, const std::vector<Label>& labels,
                                                const std::string& what) {
    NamePool pool(abaqus_names);
    std::map<Label, std::string> all;
    for (const auto& [label, name] : given) all.emplace(label, pool.give(name));
    for (const Label label : labels)
      if (!all.contains(label)) all.emplace(label, pool.give(what + to_text(static_cast<double>(label))));
    return all;
  }

  void put_elements() {
    const std::vector<double> labels = mesh_.regions.empty() ? std::vector<double>{0} : distinct_labels(mesh_.regions);
    const auto names = set_names<double>(names_.regions, labels, "REGION_");
    std::vector<std::pair<double, std::uint32_t>> cells;
    for (std::uint32_t c = 0; c < mesh_.cells.size(); ++c) cells.emplace_back(mesh_.regions.empty() ? 0 : mesh_.regions[c], c);
    std::stable_sort(cells.begin(), cells.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    for (std::size_t begin = 0, end = 0; begin < cells.size(); begin = end) {
      while (end < cells.size() && cells[end].first == cells[begin].first) ++end;
      out_.put("*ELEMENT, TYPE=");
      out_.put(middles_ ? (D == 3 ? "C3D10" : "CPS6") : (D == 3 ? "C3D4" : "CPS3"));
      out_.put(", ELSET=");
      out_.put(names.at(cells[begin].first));
      out_.put('\n');
      out_.put_each(end - begin, [&](TextBuffer& text, std::size_t i) {
        const std::uint32_t cell = cells[begin + i].second;
        text.put_number(std::uint64_t{cell} + 1);
        each_node(mesh_.cells[cell], [&text](std::uint32_t v) {
          text.put(", ");
          text.put_number(std::uint64_t{v} + 1);
        });
        text.put('\n');
      });
    }
  }

  /// Corners, and of second order the nodes in the middles of edges.
  template <class Corners, class F>
  void each_node(const Corners& corners, const F& f) const {
    for (const std::uint32_t v : corners) f(v);
    for (std::size_t e = 0; middles_ && e < mid_sides_of(corners.size()); ++e)
      f(middles_->between(corners[abaqus_mid_sides[e][0]], corners[abaqus_mid_sides[e][1]]));
  }

  std::vector<int> markers(bool of_walls) const {
    std::vector<int> all;
    for (const auto& w : walls_of<D>(mesh_)) all.push_back(w.marker);
    const auto add = [&all](int marker) {
      if (marker != 0) all.push_back(marker);
    };
    if (!of_walls) {
      for (const auto& s : mesh_.subsegments) add(s.marker);
      for (const int marker : mesh_.point_markers) add(marker);
    }
    std::sort(all.begin(), all.end());
    all.erase(std::unique(all.begin(), all.end()), all.end());
    return all;
  }

  void put_node_sets() {
    std::vector<std::pair<int, std::uint32_t>> nodes;
    const auto add = [&nodes](int marker, std::uint32_t v, bool counts_0) {
      if (marker != 0 || counts_0) nodes.emplace_back(marker, v);
    };
    for (const auto& w : walls_of<D>(mesh_)) each_node(w.vertices, [&](std::uint32_t v) { add(w.marker, v, true); });
    for (const auto& s : mesh_.subsegments) each_node(s.vertices, [&](std::uint32_t v) { add(s.marker, v, D == 2); });
    for (std::uint32_t v = 0; v < mesh_.point_markers.size(); ++v) add(mesh_.point_markers[v], v, false);
    std::sort(nodes.begin(), nodes.end());
    nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
    marker_names_ = set_names<int>(names_.markers, markers(false), "MARKER_");
    for (std::size_t begin = 0, end = 0; begin < nodes.size(); begin = end) {
      while (end < nodes.size() && nodes[end].first == nodes[begin].first) ++end;
      out_.put("*NSET, NSET=");
      out_.put(marker_names_.at(nodes[begin].first));
      out_.put('\n');
      for (std::size_t i = begin; i < end; ++i) {
        out_.put_number(std::uint64_t{nodes[i].second} + 1);
        out_.put(i + 1 == end || (i + 1 - begin) % numbers_a_line == 0 ? "\n" : ", ");
      }
    }
  }

  void put_surfaces() {
    const auto sides = sides_of_walls<D>(mesh_);
    const auto& walls = walls_of<D>(mesh_);
    for (const int marker : markers(true)) {
      out_.put("*SURFACE, NAME=");
      out_.put(marker_names_.at(marker));
      out_.put(", TYPE=ELEMENT\n");
      for (std::size_t w = 0; w < walls.size(); ++w) {
        const CellFace side = sides[w][0];
        if (walls[w].marker != marker || side.cell == no_cell) continue;
        out_.put_number(std::uint64_t{side.cell} + 1);
        out_.put(", S");
        out_.put_number(face_number[side.corner]);
        out_.put('\n');
      }
    }
  }

  /// Of the face opposite a corner, as they stand in the mesh. Faces of C3D4 are of nodes 123, 142, 243, 341, of CPS3 12, 23, 31.
  static constexpr auto face_number = [] {
    if constexpr (D == 3)
      return std::array{3, 4, 2, 1};
    else
      return std::array{2, 3, 1};
  }();

  const OutputMesh<D>& mesh_;
  const MidSides<D>* middles_;
  FileOutput& out_;
  const Names names_;
  std::map<int, std::string> marker_names_;
};

}  // namespace

template <int D>
void write_abaqus(const OutputMesh<D>& mesh, const MidSides<D>* middles, FileOutput& out) {
  AbaqusWriter<D>(mesh, middles, out).write();
}

template void write_abaqus<2>(const OutputMesh<2>&, const MidSides<2>*, FileOutput&);
template void write_abaqus<3>(const OutputMesh<3>&, const MidSides<3>*, FileOutput&);

}  // namespace pgdr::detail
