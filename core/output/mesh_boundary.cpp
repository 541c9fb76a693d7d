// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// A finished mesh as an input again.
#include <algorithm>

#include "output/cell_surface.hpp"
#include "output/simplices.hpp"
#include "output/whole_arrays.hpp"
#include "pgdr/mesh_maps.hpp"

namespace pgdr {
namespace {

template <int D>
detail::CellSurface<D> surface_of_mesh(const OutputMesh<D>& mesh) {
  std::vector<detail::LabelledCell<D>> cells;
  cells.reserve(mesh.cells.size());
  for (std::size_t c = 0; c < mesh.cells.size(); ++c)
    cells.push_back({mesh.cells[c], mesh.regions.empty() ? 0 : mesh.regions[c]});
  std::vector<std::array<std::uint32_t, D>> given;
  given.reserve(walls(mesh).size());
  for (const auto& wall : walls(mesh)) {
    given.push_back(wall.vertices);
    std::sort(given.back().begin(), given.back().end());
  }
  return detail::surface_of<D>(mesh.points, cells, given);
}

/// What is no wall or segment, and no point of the input, goes; the rest is numbered anew.
template <int D>
class BoundaryPoints {
 public:
  explicit BoundaryPoints(const OutputMesh<D>& mesh) : mesh_(mesh), number_(mesh.points.size(), none) {
    std::vector<std::uint8_t> in_cell(mesh.points.size(), 0);
    for (const auto& cell : mesh.cells)
      for (const std::uint32_t v : cell) in_cell[v] = 1;
    for (std::size_t v = 0; v < std::min(mesh.input_points, in_cell.size()); ++v)
      if (in_cell[v]) number_[v] = kept;
  }
  template <class Vertices>
  void keep(const Vertices& vertices) {
    for (const std::uint32_t v : vertices) number_[v] = kept;
  }
  /// Into `plc`. From then on what is added has the new numbers.
  void hand_over(Plc<D>& plc) {
    const std::size_t attributes = mesh_.points.empty() ? 0 : mesh_.point_attributes.size() / mesh_.points.size();
    for (std::size_t v = 0; v < number_.size(); ++v) {
      if (number_[v] == none) continue;
      number_[v] = static_cast<std::uint32_t>(plc.points.size());
      plc.points.push_back(mesh_.points[v]);
      if (!mesh_.point_markers.empty()) plc.point_markers.push_back(mesh_.point_markers[v]);
      const auto first = mesh_.point_attributes.begin() + static_cast<std::ptrdiff_t>(v * attributes);
      plc.point_attributes.insert(plc.point_attributes.end(), first, first + static_cast<std::ptrdiff_t>(attributes));
    }
  }
  void add_segment(Plc<D>& plc, const std::array<std::uint32_t, 2>& ends, int marker) const {
    plc.segments.push_back({{number_[ends[0]], number_[ends[1]]}, marker});
  }
  void add_facet(Plc<D>& plc, const std::array<std::uint32_t, 3>& corners, int marker) const {
    auto& facet = plc.facets.emplace_back();
    facet.polygons.push_back({number_[corners[0]], number_[corners[1]], number_[corners[2]]});
    facet.marker = marker;
  }

 private:
  static constexpr std::uint32_t none = 0xffffffffu, kept = 0;
  const OutputMesh<D>& mesh_;
  std::vector<std::uint32_t> number_;
};

}  // namespace

template <int D>
Plc<D> boundary_of_mesh(const OutputMesh<D>& mesh) {
  detail::require_whole(mesh, {});
  detail::CellSurface<D> surface = surface_of_mesh(mesh);
  BoundaryPoints<D> points(mesh);
  for (const auto& s : mesh.subsegments) points.keep(s.vertices);
  for (const auto& f : mesh.subfacets) points.keep(f.vertices);
  for (const auto& face : surface.faces) points.keep(face);
  Plc<D> plc;
  points.hand_over(plc);
  for (const auto& s : mesh.subsegments) points.add_segment(plc, s.vertices, s.marker);
  if constexpr (D == 2) {
    for (const auto& face : surface.faces) points.add_segment(plc, face, 0);
  } else {
    for (const auto& f : mesh.subfacets) points.add_facet(plc, f.vertices, f.marker);
    for (const auto& face : surface.faces) points.add_facet(plc, face, 0);
  }
  detail::give_seeds(surface, plc);
  plc.names = mesh.names;
  return plc;
}

template PGDR_API Plc<2> boundary_of_mesh<2>(const OutputMesh<2>&);
template PGDR_API Plc<3> boundary_of_mesh<3>(const OutputMesh<3>&);

}  // namespace pgdr
