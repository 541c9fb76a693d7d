// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "io/read/file_mesh.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <map>
#include <set>
#include <type_traits>
#include <utility>

#include "input/words.hpp"
#include "output/cell_surface.hpp"
#include "pgdr/error.hpp"
#include "pgdr/predicates.hpp"

namespace pgdr::detail {
namespace {

[[noreturn]] void fail(const FileMesh& mesh, Errc code, const std::string& message, std::uint64_t line) {
  throw InputError(Diagnostic{code, message, mesh.file, line, {}, {}});
}

void require_dimension(const FileMesh& mesh, int wanted) {
  const int d = dimension_of(mesh);
  if (d != wanted)
    fail(mesh, Errc::syntax, "the dimension is " + std::to_string(d) + ", not " + std::to_string(wanted), mesh.dimension_line);
}

[[noreturn]] void refuse_cells(const FileMesh& mesh, const std::string& what, std::uint64_t line) {
  fail(mesh, Errc::unknown_format, what + " cannot be read as cells of a mesh: only simplices are", line);
}

std::uint64_t first_of(const std::vector<std::uint32_t>& lines) { return lines.empty() ? 0 : lines.front(); }

bool is_marker(double label) { return label >= -2147483648.0 && label <= 2147483647.0 && label == std::floor(label); }

int marker_of(const FileMesh& mesh, double label) {
  if (!is_marker(label))
    fail(mesh, Errc::syntax, "the label " + detail::to_text(label) + " is no marker: markers are integers", 0);
  return static_cast<int>(label);
}

template <int D>
Point<D> flattened(const Point3& p) {
  Point<D> q;
  for (int k = 0; k < D; ++k) q[k] = p[k];
  return q;
}

/// Empty if all are 0, since files that cannot do without markers state 0 where there is none.
std::vector<int> markers_if_any(std::vector<int> markers) {
  if (std::all_of(markers.begin(), markers.end(), [](int m) { return m == 0; })) markers.clear();
  return markers;
}

/// Calls f with the label of each element of a dimension, which it may change.
template <class F>
void each_label(FileMesh& mesh, int dimension, const F& f) {
  const auto each = [&f](auto& elements) {
    for (auto& e : elements) f(e.label);
  };
  if (dimension == 0)
    for (int& marker : mesh.point_markers) {
      double label = marker;
      f(label);
      marker = static_cast<int>(label);
    }
  if (dimension == 1) each(mesh.edges);
  if (dimension == 2) each(mesh.triangles), each(mesh.quadrilaterals);
  if (dimension == 3) each(mesh.tetrahedra);
}

std::set<double> labels_of(FileMesh& mesh, int dimension) {
  std::set<double> labels;
  each_label(mesh, dimension, [&labels](double label) { labels.insert(label); });
  if (dimension == 0) labels.erase(0);  // a point of no group
  return labels;
}

/// The names of labels and markers. Groups of several dimensions may have one number, markers have one name: where elements of
/// more dimensions use a number, and name it otherwise or not at all, the group gets the least positive number that is free.
class GroupNames {
 public:
  GroupNames(FileMesh& mesh, int dimension) : mesh_(mesh), dimension_(dimension), names_(std::move(mesh.names)) {}

  Names take() {
    if (mesh_.group_names.empty()) return std::move(names_);
    for (const double label : labels_of(mesh_, dimension_))
      if (const std::string* name = find(dimension_, label)) names_.regions[label] = *name;
    for (int d = 0; d < dimension_; ++d) taken_.merge(labels_of(mesh_, d));
    std::set<double> used_above;
    for (int d = dimension_ - 1; d >= 0; --d) name_markers(d, used_above);
    return std::move(names_);
  }

 private:
  const std::string* find(int d, double label) const {
    const auto it = mesh_.group_names.find({d, label});
    return it == mesh_.group_names.end() ? nullptr : &it->second;
  }

  void name_markers(int d, std::set<double>& used_above) {
    std::set<double> used = labels_of(mesh_, d);
    std::map<double, double> now;
    for (const double label : used) {
      const std::string* name = find(d, label);
      if (name == nullptr || !is_marker(label)) continue;
      const auto above = names_.markers.find(static_cast<int>(label));
      const bool is_alike = above != names_.markers.end() && above->second == *name;
      const double number = used_above.contains(label) && !is_alike ? free_number() : label;
      if (number != label) now[label] = number;
      names_.markers[static_cast<int>(number)] = *name;
    }
    if (!now.empty())
      each_label(mesh_, d, [&now](double& label) {
        if (const auto it = now.find(label); it != now.end()) label = it->second;
      });
    used_above.merge(used);
  }
  double free_number() {
    while (!taken_.insert(next_).second) ++next_;
    return next_;
  }

  FileMesh& mesh_;
  int dimension_;
  Names names_;
  std::set<double> taken_;
  double next_ = 1;
};

/// One step of the way from a FileMesh to a Plc.
template <int D>
class PlcBuilder {
 public:
  explicit PlcBuilder(FileMesh&& mesh) : mesh_(std::move(mesh)) {}

  Plc<D> build() {
    if (!mesh_.other_cells.empty() && facet_count() == 0)
      fail(mesh_, Errc::unknown_format, mesh_.other_cells + " have no surface here: the file must list it", mesh_.other_line);
    plc_.names = GroupNames(mesh_, D).take();
    plc_.source.file = mesh_.file;
    plc_.first_index = mesh_.first_index;
    for (const Point3& p : mesh_.points) plc_.points.push_back(flattened<D>(p));
    if constexpr (D == 2) split_quadrilaterals();
    add_segments();
    if constexpr (D == 3) add_facets();
    if (has_cells(mesh_)) {
      if (mesh_.other_cells.empty()) add_surface_of_cells();
      drop_points_of_cells();
    }
    plc_.point_markers = markers_if_any(std::move(mesh_.point_markers));
    plc_.source.point_lines = std::move(mesh_.point_lines);
    drop_names_without_seeds();
    return std::move(plc_);
  }

 private:
  /// Volumes that have no seed are numbered, or 0, and not what cells of the file were that it has no more.
  void drop_names_without_seeds() {
    std::erase_if(plc_.names.regions, [this](const auto& of_label) {
      const double label = of_label.first;
      return label != 0 &&
             std::none_of(plc_.regions.begin(), plc_.regions.end(), [&](const auto& r) { return r.attribute == label; });
    });
  }

  std::size_t facet_count() const { return D == 2 ? mesh_.edges.size() : mesh_.triangles.size() + mesh_.quadrilaterals.size(); }

  /// 2D: quadrilaterals are cells, each as two triangles on the same side of the diagonal's ends.
  void split_quadrilaterals() {
    for (std::size_t i = 0; i < mesh_.quadrilaterals.size(); ++i) {
      const auto& [corners, label] = mesh_.quadrilaterals[i];
      const auto& [a, b, c, d] = corners;
      const auto side = [this](std::uint32_t u, std::uint32_t v, std::uint32_t w) {
        return orient2d(plc_.points[u], plc_.points[v], plc_.points[w]);
      };
      const Sign one = side(a, b, c), other = side(a, b, d);
      if (one != Sign::zero && one == side(a, c, d)) {
        mesh_.triangles.push_back({{a, b, c}, label});
        mesh_.triangles.push_back({{a, c, d}, label});
      } else if (other != Sign::zero && other == side(b, c, d)) {
        mesh_.triangles.push_back({{a, b, d}, label});
        mesh_.triangles.push_back({{b, c, d}, label});
      } else {
        fail(mesh_, Errc::self_crossing_facet, "quadrilateral " + std::to_string(i + 1) + " crosses itself, or has no area",
             i < mesh_.quadrilateral_lines.size() ? mesh_.quadrilateral_lines[i] : 0);
      }
    }
    mesh_.quadrilaterals.clear();
  }

  void add_segments() {
    plc_.segments.reserve(mesh_.edges.size());
    for (const auto& e : mesh_.edges) plc_.segments.push_back({e.corners, marker_of(mesh_, e.label)});
    plc_.source.segment_lines = std::move(mesh_.edge_lines);
  }

  template <class Corners>
  void add_facet(const Corners& corners, int marker) {
    auto& facet = plc_.facets.emplace_back();
    facet.polygons.emplace_back(corners.begin(), corners.end());
    facet.marker = marker;
  }
  void add_facets() {
    plc_.facets.reserve(facet_count());
    for (const auto& t : mesh_.triangles) add_facet(t.corners, marker_of(mesh_, t.label));
    for (const auto& q : mesh_.quadrilaterals) add_facet(q.corners, marker_of(mesh_, q.label));
    auto& lines = plc_.source.facet_lines = std::move(mesh_.triangle_lines);
    lines.insert(lines.end(), mesh_.quadrilateral_lines.begin(), mesh_.quadrilateral_lines.end());
  }

  static std::array<std::uint32_t, D> sorted(std::array<std::uint32_t, D> face) {
    std::sort(face.begin(), face.end());
    return face;
  }

  /// A quadrilateral is the wall between triangles on either of its diagonals.
  std::vector<std::array<std::uint32_t, D>> walls() const {
    std::vector<std::array<std::uint32_t, D>> walls;
    if constexpr (D == 2) {
      for (const auto& e : mesh_.edges) walls.push_back(sorted(e.corners));
    } else {
      for (const auto& t : mesh_.triangles) walls.push_back(sorted(t.corners));
      for (const auto& q : mesh_.quadrilaterals) {
        const auto& [a, b, c, d] = q.corners;
        for (const auto& t : {std::array{a, b, c}, std::array{a, c, d}, std::array{a, b, d}, std::array{b, c, d}})
          walls.push_back(sorted(t));
      }
    }
    return walls;
  }

  void add_surface_of_cells() {
    std::vector<LabelledCell<D>> cells;
    const auto add = [&cells](const auto& list) {
      cells.reserve(list.size());
      for (const auto& c : list) cells.push_back({c.corners, c.label});
    };
    if constexpr (D == 2)
      add(mesh_.triangles);
    else
      add(mesh_.tetrahedra);
    CellSurface<D> surface = surface_of<D>(plc_.points, cells, walls());
    for (const auto& face : surface.faces) {
      if constexpr (D == 2) {
        plc_.segments.push_back({face, 0});
        if (!plc_.source.segment_lines.empty()) plc_.source.segment_lines.push_back(0);
      } else {
        add_facet(face, 0);
        if (!plc_.source.facet_lines.empty()) plc_.source.facet_lines.push_back(0);
      }
    }
    give_seeds(surface, plc_);
  }

  /// Points that cells have and nothing that is kept has. What no cell has either was put into the file on its own.
  void drop_points_of_cells() {
    std::vector<std::uint8_t> kept(plc_.points.size(), 1);
    const auto mark = [&kept](const auto& corners, std::uint8_t value) {
      for (const std::uint32_t v : corners) kept[v] = value;
    };
    for (const auto& c : mesh_.tetrahedra) mark(c.corners, 0);
    mark(mesh_.other_corners, 0);
    if constexpr (D == 2)
      for (const auto& c : mesh_.triangles) mark(c.corners, 0);
    for (const auto& s : plc_.segments) mark(s.points, 1);
    for (const auto& f : plc_.facets) mark(f.polygons.front(), 1);
    for (std::size_t i = 0; i < mesh_.required.size(); ++i) kept[i] |= mesh_.required[i];

    std::vector<std::uint32_t> number(kept.size());
    std::uint32_t n = 0;
    for (std::size_t i = 0; i < kept.size(); ++i) {
      number[i] = n;
      if (kept[i] == 0) continue;
      plc_.points[n] = plc_.points[i];
      mesh_.point_markers[n] = mesh_.point_markers[i];
      if (!mesh_.point_lines.empty()) mesh_.point_lines[n] = mesh_.point_lines[i];
      ++n;
    }
    plc_.points.resize(n);
    mesh_.point_markers.resize(n);
    if (!mesh_.point_lines.empty()) mesh_.point_lines.resize(n);
    for (auto& s : plc_.segments) {
      for (auto& v : s.points) v = number[v];
    }
    for (auto& f : plc_.facets) {
      for (auto& v : f.polygons.front()) v = number[v];
    }
  }

  FileMesh mesh_;
  Plc<D> plc_;
};

}  // namespace

int dimension_of(const FileMesh& mesh) {
  if (mesh.dimension == 2 || mesh.dimension_certain || mesh.points.empty()) return mesh.dimension;
  if (!mesh.tetrahedra.empty() || !mesh.other_cells.empty()) return 3;
  const bool flat = std::all_of(mesh.points.begin(), mesh.points.end(), [](const Point3& p) { return p[2] == 0; });
  return flat ? 2 : 3;
}

bool has_cells(const FileMesh& mesh) {
  if (!mesh.tetrahedra.empty() || !mesh.other_cells.empty()) return true;
  return dimension_of(mesh) == 2 && !(mesh.triangles.empty() && mesh.quadrilaterals.empty());
}

namespace {

/// Calls f(corner) for all corners of elements.
template <class Mesh, class F>
void each_element_corner(Mesh& mesh, const F& f) {
  const auto each = [&f](auto& elements) {
    for (auto& e : elements)
      for (auto& v : e.corners) f(v);
  };
  each(mesh.edges), each(mesh.triangles), each(mesh.quadrilaterals), each(mesh.tetrahedra);
  for (auto& v : mesh.other_corners) f(v);
}

}  // namespace

std::vector<std::uint8_t> dropped_mid_sides(const FileMesh& mesh) {
  std::vector<std::uint8_t> dropped = mesh.mid_sides;
  if (dropped.empty()) return dropped;
  each_element_corner(mesh, [&dropped](std::uint32_t v) { dropped[v] = 0; });
  for (std::size_t i = 0; i < mesh.required.size(); ++i)
    if (mesh.required[i]) dropped[i] = 0;
  return dropped;
}

std::size_t drop_mid_sides(FileMesh& mesh) {
  const std::vector<std::uint8_t> dropped = dropped_mid_sides(mesh);
  if (dropped.empty()) return 0;
  mesh.mid_sides.clear();
  std::vector<std::uint32_t> number(dropped.size());
  std::uint32_t n = 0;
  for (std::size_t i = 0; i < dropped.size(); ++i) number[i] = dropped[i] ? n : n++;
  keep_rows(mesh.points, 1, dropped), keep_rows(mesh.point_markers, 1, dropped);
  keep_rows(mesh.required, 1, dropped), keep_rows(mesh.point_lines, 1, dropped);
  each_element_corner(mesh, [&number](std::uint32_t& v) { v = number[v]; });
  for (auto& link : mesh.periodic_links) {
    std::erase_if(link.points, [&](const auto& pair) { return dropped[pair[0]] || dropped[pair[1]]; });
    for (auto& pair : link.points) pair = {number[pair[0]], number[pair[1]]};
  }
  mesh.input_points = std::min<std::size_t>(mesh.input_points, n);
  return dropped.size() - n;
}

template <int D>
Plc<D> to_plc(FileMesh&& mesh) {
  require_dimension(mesh, D);
  return PlcBuilder<D>(std::move(mesh)).build();
}

template <int D>
OutputMesh<D> to_output_mesh(FileMesh&& mesh) {
  require_dimension(mesh, D);
  if (!mesh.quadrilaterals.empty()) refuse_cells(mesh, "Quadrilaterals", first_of(mesh.quadrilateral_lines));
  if (!mesh.other_cells.empty()) refuse_cells(mesh, mesh.other_cells, mesh.other_line);
  OutputMesh<D> out;
  out.names = GroupNames(mesh, D).take();
  out.points.reserve(mesh.points.size());
  for (const Point3& p : mesh.points) out.points.push_back(flattened<D>(p));
  out.input_points = mesh.input_points;
  out.point_markers = markers_if_any(std::move(mesh.point_markers));
  const auto add_cells = [&out](const auto& list) {
    out.cells.reserve(list.size());
    out.regions.reserve(list.size());
    for (const auto& c : list) {
      out.cells.push_back(c.corners);
      out.regions.push_back(c.label);
    }
  };
  if constexpr (D == 2)
    add_cells(mesh.triangles);
  else
    add_cells(mesh.tetrahedra);
  if (std::all_of(out.regions.begin(), out.regions.end(), [](double r) { return std::bit_cast<std::uint64_t>(r) == 0; }))
    out.regions.clear();
  out.subsegments.reserve(mesh.edges.size());
  for (const auto& e : mesh.edges) out.subsegments.push_back({e.corners, marker_of(mesh, e.label)});
  if constexpr (D == 3) {
    out.subfacets.reserve(mesh.triangles.size());
    for (const auto& t : mesh.triangles) out.subfacets.push_back({t.corners, marker_of(mesh, t.label)});
  }
  return out;
}

/// Links of one pair of markers and one motion are one pair of sides.
template <int D>
StatedPeriods to_periods(const FileMesh& mesh) {
  require_dimension(mesh, D);
  StatedPeriods stated;
  for (const auto& link : mesh.periodic_links) {
    if (link.dimension != D - 1) continue;
    PeriodicPairs pairs{marker_of(mesh, link.from), marker_of(mesh, link.to), {}, link.points, 0, 0, 0};
    for (std::size_t i = 0; !link.affine.empty() && i < D; ++i) {
      for (std::size_t k = 0; k < D; ++k) pairs.motion.push_back(link.affine[4 * i + k]);
      pairs.motion.push_back(link.affine[4 * i + 3]);
    }
    const auto same = std::ranges::find_if(stated.pairs, [&](const PeriodicPairs& p) {
      return p.from == pairs.from && p.to == pairs.to && p.motion == pairs.motion;
    });
    if (same == stated.pairs.end())
      stated.pairs.push_back(std::move(pairs));
    else
      same->points.insert(same->points.end(), pairs.points.begin(), pairs.points.end());
  }
  for (PeriodicPairs& p : stated.pairs) {
    std::ranges::sort(p.points);
    p.points.erase(std::unique(p.points.begin(), p.points.end()), p.points.end());
  }
  return stated;
}

template Plc<2> to_plc<2>(FileMesh&&);
template Plc<3> to_plc<3>(FileMesh&&);
template OutputMesh<2> to_output_mesh<2>(FileMesh&&);
template OutputMesh<3> to_output_mesh<3>(FileMesh&&);
template StatedPeriods to_periods<2>(const FileMesh&);
template StatedPeriods to_periods<3>(const FileMesh&);

}  // namespace pgdr::detail
