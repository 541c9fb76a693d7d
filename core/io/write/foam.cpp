// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Writes a folder polyMesh of OpenFOAM: points, faces, owner, neighbour, boundary, cellZones, faceZones, as text. Inner faces
// come first, by the cell that owns them and then by the other; those of the boundary follow by patches, one a marker in their
// order. A zone of cells is a region, a zone of faces a marker of walls between cells. Points of no cell are left out, the others
// keep their order. OpenFOAM User Guide, "Mesh description".
#include <algorithm>
#include <array>
#include <map>
#include <memory>
#include <string>
#include <utility>

#include "input/words.hpp"
#include "io/formats.hpp"
#include "io/write/valid_names.hpp"
#include "io/write/wall_sides.hpp"
#include "pgdr/error.hpp"
#include "pgdr/mesh_maps.hpp"

namespace pgdr::detail {
namespace {

using Path = std::filesystem::path;
constexpr std::array foam_file_names{"points", "faces", "owner", "neighbour", "cellZones", "faceZones", "boundary"};

Path foam_folder(const Path& file) { return file.has_filename() ? file : file.parent_path(); }

/// Corners of the face opposite each corner, counter-clockwise from outside.
constexpr std::array<std::array<std::size_t, 3>, 4> outward{{{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}};

struct FoamFace {
  std::uint32_t owner, neighbour;  ///< no_cell: it is of the boundary
  std::uint32_t corner;            ///< of the owner, opposite
  int marker = 0;
};

struct FoamZone {
  std::string name;
  std::vector<std::size_t> members;
};

/// Names of all labels, those given first.
template <class Label>
std::map<Label, std::string> foam_words(const std::map<Label, std::string>& given, const std::vector<Label>& labels,
                                        const std::string& what) {
  NamePool pool(foam_names);
  std::map<Label, std::string> all;
  for (const auto& [label, name] : given) all.emplace(label, pool.give(name));
  for (const Label label : labels)
    if (!all.contains(label)) all.emplace(label, pool.give(what + to_text(static_cast<double>(label))));
  return all;
}

class FoamWriter {
 public:
  explicit FoamWriter(const OutputMesh<3>& mesh) : mesh_(mesh), names_(mesh.names) {
    number_points();
    list_faces();
  }

  /// What is put into one of the files.
  void write(std::size_t file, FileOutput& out) const {
    constexpr std::array classes{"vectorField", "faceList",    "labelList",       "labelList",
                                 "regIOobject", "regIOobject", "polyBoundaryMesh"};
    out.put("FoamFile\n{\n    version     2.0;\n    format      ascii;\n    class       ");
    out.put(classes[file]);
    if (file == 2 || file == 3) put_note(out);
    out.put(";\n    location    \"constant/polyMesh\";\n    object      ");
    out.put(foam_file_names[file]);
    out.put(";\n}\n\n");
    switch (file) {
      case 0: return put_points(out);
      case 1: return put_faces(out);
      case 2: return put_labels(out, faces_.size(), [this](std::size_t i) { return faces_[i].owner; });
      case 3: return put_labels(out, inner_, [this](std::size_t i) { return faces_[i].neighbour; });
      case 4: return put_zones(out, cell_zones(), "cellZone", "cellLabels");
      case 5: return put_zones(out, face_zones(), "faceZone", "faceLabels");
      default: return put_patches(out);
    }
  }

 private:
  void number_points() {
    std::vector<std::uint8_t> used(mesh_.points.size(), 0);
    for (const auto& cell : mesh_.cells)
      for (const std::uint32_t v : cell) used[v] = 1;
    number_.resize(used.size());
    for (std::uint32_t v = 0; v < used.size(); ++v) {
      number_[v] = static_cast<std::uint32_t>(points_.size());
      if (used[v]) points_.push_back(v);
    }
  }

  void list_faces() {
    const auto neighbours = neighbors_of_cells<3>(mesh_);
    std::vector<FoamFace> boundary;
    for (std::uint32_t c = 0; c < neighbours.size(); ++c) {
      const std::size_t first = faces_.size();
      for (std::uint32_t k = 0; k < 4; ++k) {
        const std::uint32_t n = neighbours[c][k];
        if (n == no_cell_beyond)
          boundary.push_back({c, no_cell, k});
        else if (n > c)
          faces_.push_back({c, n, k});
      }
      std::sort(faces_.begin() + static_cast<std::ptrdiff_t>(first), faces_.end(),
                [](const FoamFace& a, const FoamFace& b) { return a.neighbour < b.neighbour; });
    }
    inner_ = faces_.size();
    mark(boundary);
    std::stable_sort(boundary.begin(), boundary.end(), [](const FoamFace& a, const FoamFace& b) { return a.marker < b.marker; });
    faces_.insert(faces_.end(), boundary.begin(), boundary.end());
  }

  /// Faces of the boundary get the markers of their walls; walls between cells are kept by theirs.
  void mark(std::vector<FoamFace>& boundary) {
    const auto before = [](const FoamFace& a, const FoamFace& b) {
      return std::pair(a.owner, a.corner) < std::pair(b.owner, b.corner);
    };
    const auto sides = sides_of_walls<3>(mesh_);
    for (std::size_t w = 0; w < sides.size(); ++w) {
      const auto& [first, second] = sides[w];
      const int marker = mesh_.subfacets[w].marker;
      if (first.cell == no_cell) continue;
      if (second.cell == no_cell) {
        std::lower_bound(boundary.begin(), boundary.end(), FoamFace{first.cell, no_cell, first.corner}, before)->marker = marker;
        continue;
      }
      const auto row = std::lower_bound(
          faces_.begin(), faces_.end(), std::pair(first.cell, second.cell),
          [](const FoamFace& f, const auto& cells) { return std::pair(f.owner, f.neighbour) < cells; });
      if (marker != 0 || names_.markers.contains(marker))
        walls_[marker].push_back(static_cast<std::size_t>(row - faces_.begin()));
    }
  }

  void put_note(FileOutput& out) const {
    out.put(";\n    note        \"nPoints:");
    out.put_number(points_.size());
    out.put("  nCells:");
    out.put_number(mesh_.cells.size());
    out.put("  nFaces:");
    out.put_number(faces_.size());
    out.put("  nInternalFaces:");
    out.put_number(inner_);
    out.put('"');
  }

  template <class Put>
  static void put_list(FileOutput& out, std::size_t n, const Put& put) {
    out.put_number(n);
    out.put("\n(\n");
    out.put_each(n, [&put](TextBuffer& text, std::size_t i) {
      put(text, i);
      text.put('\n');
    });
    out.put(")\n");
  }
  template <class Of>
  static void put_labels(FileOutput& out, std::size_t n, const Of& of) {
    put_list(out, n, [&of](TextBuffer& text, std::size_t i) { text.put_number(of(i)); });
  }
  void put_points(FileOutput& out) const {
    put_list(out, points_.size(), [this](TextBuffer& text, std::size_t i) {
      for (int k = 0; k < 3; ++k) {
        text.put(k == 0 ? '(' : ' ');
        text.put_number(mesh_.points[points_[i]][k]);
      }
      text.put(')');
    });
  }
  void put_faces(FileOutput& out) const {
    put_list(out, faces_.size(), [this](TextBuffer& text, std::size_t i) {
      text.put("3(");
      const auto& corners = outward[faces_[i].corner];
      for (std::size_t k = 0; k < 3; ++k) {
        if (k > 0) text.put(' ');
        text.put_number(number_[mesh_.cells[faces_[i].owner][corners[k]]]);
      }
      text.put(')');
    });
  }

  std::vector<FoamZone> cell_zones() const {
    if (mesh_.regions.empty() && !names_.regions.contains(0)) return {};
    std::map<double, std::vector<std::size_t>> cells;
    for (std::size_t c = 0; c < mesh_.cells.size(); ++c) cells[mesh_.regions.empty() ? 0 : mesh_.regions[c]].push_back(c);
    return zones(std::move(cells), names_.regions, "region_");
  }
  std::vector<FoamZone> face_zones() const { return zones(walls_, names_.markers, "marker_"); }
  template <class Label>
  static std::vector<FoamZone> zones(std::map<Label, std::vector<std::size_t>> members, const std::map<Label, std::string>& given,
                                     const std::string& what) {
    std::vector<Label> labels;
    for (const auto& [label, list] : members) labels.push_back(label);
    const auto names = foam_words<Label>(given, labels, what);
    std::vector<FoamZone> all;
    for (auto& [label, list] : members) {
      std::sort(list.begin(), list.end());
      all.push_back({names.at(label), std::move(list)});
    }
    return all;
  }
  static void put_zones(FileOutput& out, const std::vector<FoamZone>& zones, std::string_view type, std::string_view key) {
    out.put_number(zones.size());
    out.put("\n(\n");
    for (const FoamZone& zone : zones) {
      out.put(zone.name);
      out.put("\n{\n    type ");
      out.put(type);
      out.put(";\n    ");
      out.put(key);
      out.put(" List<label> ");
      put_labels(out, zone.members.size(), [&zone](std::size_t i) { return zone.members[i]; });
      if (type == "faceZone") {
        out.put(";\n    flipMap List<bool> ");
        put_labels(out, zone.members.size(), [](std::size_t) { return 0; });
      }
      out.put(";\n}\n");
    }
    out.put(")\n");
  }

  void put_patches(FileOutput& out) const {
    std::map<int, std::pair<std::size_t, std::size_t>> patches;  // the first face, and how many
    for (std::size_t i = inner_; i < faces_.size(); ++i) ++patches.try_emplace(faces_[i].marker, i, 0).first->second.second;
    std::vector<int> markers;
    for (const auto& [marker, faces] : patches) markers.push_back(marker);
    const auto names = foam_words<int>(names_.markers, markers, "marker_");
    out.put_number(patches.size());
    out.put("\n(\n");
    for (const auto& [marker, faces] : patches) {
      out.put("    ");
      out.put(names.at(marker));
      out.put("\n    {\n        type            patch;\n        nFaces          ");
      out.put_number(faces.second);
      out.put(";\n        startFace       ");
      out.put_number(faces.first);
      out.put(";\n    }\n");
    }
    out.put(")\n");
  }

  const OutputMesh<3>& mesh_;
  const Names& names_;
  std::vector<std::uint32_t> points_, number_;
  std::vector<FoamFace> faces_;
  std::size_t inner_ = 0;                          // so many of them, the first, lie between cells
  std::map<int, std::vector<std::size_t>> walls_;  // inner faces, by marker
};

/// The folders that were made go again, unless `keep` was called.
class MadeFolders {
 public:
  explicit MadeFolders(const Path& folder) {
    std::error_code failed;
    for (Path p = folder; !p.empty() && !std::filesystem::exists(p, failed); p = p.parent_path()) made_.push_back(p);
    std::filesystem::create_directories(folder, failed);
    if (failed) {
      remove();
      cannot_write(folder.string(), failed.message().c_str());
    }
  }
  MadeFolders(const MadeFolders&) = delete;
  MadeFolders& operator=(const MadeFolders&) = delete;
  ~MadeFolders() { remove(); }
  void keep() { made_.clear(); }

 private:
  void remove() {
    std::error_code ignored;
    for (const Path& p : made_) std::filesystem::remove(p, ignored);
  }
  std::vector<Path> made_;
};

}  // namespace

bool is_foam_mesh(const Path& file) { return foam_folder(file).filename() == "polyMesh"; }

std::vector<std::string> foam_files(const Path& folder) {
  std::vector<std::string> files;
  for (const char* name : foam_file_names) files.push_back((foam_folder(folder) / name).string());
  return files;
}

template <int D>
void write_foam(const OutputMesh<D>& mesh, const Path& folder) {
  if constexpr (D == 2) {
    throw UsageError(Diagnostic{Errc::bad_option, "a folder polyMesh is for meshes in 3D", folder.string(), 0, {}, {}});
  } else {
    const FoamWriter writer(mesh);
    MadeFolders made(foam_folder(folder));
    std::vector<std::unique_ptr<FileOutput>> files;
    for (const std::string& name : foam_files(folder)) {
      files.push_back(std::make_unique<FileOutput>(name));
      writer.write(files.size() - 1, *files.back());
      files.back()->close();
    }
    commit_together(files);
    made.keep();
  }
}

template void write_foam<2>(const OutputMesh<2>&, const Path&);
template void write_foam<3>(const OutputMesh<3>&, const Path&);

}  // namespace pgdr::detail
