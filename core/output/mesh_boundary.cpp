// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// A finished mesh as an input again.
#include <algorithm>

#include "output/cell_surface.hpp"
#include "output/simplices.hpp"
#include "output/whole_arrays.hpp"
#include "pgdr/error.hpp"
#include "pgdr/remesh_input.hpp"

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
  BoundaryPoints(const OutputMesh<D>& mesh, std::span<const std::uint8_t> required)
      : mesh_(mesh), number_(mesh.points.size(), none) {
    std::vector<std::uint8_t> in_cell(mesh.points.size(), 0);
    for (const auto& cell : mesh.cells)
      for (const std::uint32_t v : cell) in_cell[v] = 1;
    for (std::size_t v = 0; v < std::min(mesh.input_points, in_cell.size()); ++v)
      if (in_cell[v]) number_[v] = kept;
    for (std::size_t v = 0; v < required.size(); ++v)
      if (required[v]) number_[v] = kept;
  }
  template <class Vertices>
  void keep(const Vertices& vertices) {
    for (const std::uint32_t v : vertices) number_[v] = kept;
  }
  /// Into `plc`. From then on what is added has the new numbers.
  void hand_over(Plc<D>& plc, std::vector<std::uint32_t>& vertex_of_point) {
    const std::size_t attributes = mesh_.points.empty() ? 0 : mesh_.point_attributes.size() / mesh_.points.size();
    for (std::size_t v = 0; v < number_.size(); ++v) {
      if (number_[v] == none) continue;
      number_[v] = static_cast<std::uint32_t>(plc.points.size());
      plc.points.push_back(mesh_.points[v]);
      vertex_of_point.push_back(static_cast<std::uint32_t>(v));
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

/// Takes markers from points that have them of subfacets and subsegments.
template <int D>
void drop_inherited_markers(Plc<D>& plc, const std::vector<std::uint8_t>& required) {
  if (plc.point_markers.empty()) return;
  std::vector<std::uint8_t> is_inherited(plc.points.size(), 0);
  const auto look_at = [&](const auto& corners, int marker) {
    for (const std::uint32_t p : corners) is_inherited[p] |= plc.point_markers[p] == marker;
  };
  for (const auto& s : plc.segments) look_at(s.points, s.marker);
  for (const auto& f : plc.facets) look_at(f.polygons.front(), f.marker);
  for (std::size_t p = 0; p < is_inherited.size(); ++p)
    if (is_inherited[p] && (required.empty() || !required[p])) plc.point_markers[p] = 0;
  if (std::ranges::count(plc.point_markers, 0) == std::ssize(plc.point_markers)) plc.point_markers.clear();
}

}  // namespace

template <int D>
MeshBoundary<D> boundary_with_vertices(const OutputMesh<D>& mesh, std::span<const std::uint8_t> required) {
  detail::require_whole(mesh, {});
  if (!required.empty() && required.size() != mesh.points.size())
    throw UsageError({.code = Errc::bad_option,
                      .message = std::to_string(required.size()) + " flags of required vertices for " +
                                 std::to_string(mesh.points.size()) + " vertices"});
  detail::CellSurface<D> surface = surface_of_mesh(mesh);
  BoundaryPoints<D> points(mesh, required);
  for (const auto& s : mesh.subsegments) points.keep(s.vertices);
  for (const auto& f : mesh.subfacets) points.keep(f.vertices);
  for (const auto& face : surface.faces) points.keep(face);
  MeshBoundary<D> boundary;
  Plc<D>& plc = boundary.plc;
  points.hand_over(plc, boundary.vertex_of_point);
  for (const auto& s : mesh.subsegments) points.add_segment(plc, s.vertices, s.marker);
  if constexpr (D == 2) {
    for (const auto& face : surface.faces) points.add_segment(plc, face, 0);
  } else {
    for (const auto& f : mesh.subfacets) points.add_facet(plc, f.vertices, f.marker);
    for (const auto& face : surface.faces) points.add_facet(plc, face, 0);
  }
  detail::give_seeds(surface, plc);
  plc.names = mesh.names;
  return boundary;
}

template <int D>
Plc<D> boundary_of_mesh(const OutputMesh<D>& mesh) {
  return boundary_with_vertices(mesh).plc;
}

template <int D>
std::vector<std::uint8_t> required_points(const MeshBoundary<D>& boundary, std::span<const std::uint8_t> required) {
  std::vector<std::uint8_t> out(boundary.plc.points.size(), 0);
  for (std::size_t p = 0; p < out.size() && !required.empty(); ++p) out[p] = required[boundary.vertex_of_point[p]];
  return out;
}

void name_given_facets(std::span<const std::uint32_t> facet_of_input, std::vector<PoorReason>& reasons) {
  for (PoorReason& reason : reasons)
    for (GivenEntity& e : reason.entities)
      if (e.kind == EntityKind::facet && e.facet < facet_of_input.size()) e.facet = facet_of_input[e.facet];
}

void drop_plain_segments(Plc<3>& plc) {
  std::vector<std::array<std::uint32_t, 2>> edges;
  for (const auto& f : plc.facets) {
    const auto& polygon = f.polygons.front();
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const auto [a, b] = std::minmax(polygon[i], polygon[(i + 1) % polygon.size()]);
      edges.push_back({a, b});
    }
  }
  std::sort(edges.begin(), edges.end());
  std::erase_if(plc.segments, [&](const Plc<3>::Segment& s) {
    const auto [a, b] = std::minmax(s.points[0], s.points[1]);
    return s.marker == 0 && std::ranges::binary_search(edges, std::array{a, b});
  });
  plc.source.segment_lines.clear();
}

template <int D>
WholeFacets<D> remesh_input(const OutputMesh<D>& mesh, const RemeshInputOptions& options) {
  const std::vector<std::uint8_t> all(options.keep_vertices ? mesh.points.size() : 0, 1);
  const std::vector<std::uint8_t>& vertices = options.keep_vertices ? all : options.required;
  MeshBoundary<D> boundary = boundary_with_vertices<D>(mesh, vertices);
  const std::vector<std::uint8_t> required = required_points<D>(boundary, vertices);
  boundary.plc.tolerance = options.tolerance;
  boundary.plc.is_coarse = options.is_coarse;
  drop_inherited_markers(boundary.plc, required);
  boundary.plc.point_attributes.clear();
  if (options.keep_boundary || options.keep_vertices) return {std::move(boundary.plc), {}, {}};
  return with_whole_facets<D>(boundary.plc, required, options.stop);
}

#define PGDR_INSTANTIATE(D)                                                                                              \
  template PGDR_API MeshBoundary<D> boundary_with_vertices<D>(const OutputMesh<D>&, std::span<const std::uint8_t>);      \
  template PGDR_API std::vector<std::uint8_t> required_points<D>(const MeshBoundary<D>&, std::span<const std::uint8_t>); \
  template PGDR_API WholeFacets<D> remesh_input<D>(const OutputMesh<D>&, const RemeshInputOptions&);                     \
  template PGDR_API Plc<D> boundary_of_mesh<D>(const OutputMesh<D>&);
PGDR_INSTANTIATE(2)
PGDR_INSTANTIATE(3)
#undef PGDR_INSTANTIATE

}  // namespace pgdr
