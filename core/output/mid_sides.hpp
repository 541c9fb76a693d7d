// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Meshes of second order: a node in the middle of each edge, behind the points of the mesh. Edges stay straight. Immutable; any
// thread.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "pgdr/error.hpp"
#include "pgdr/output_mesh.hpp"

namespace pgdr::detail {

/// The two corners of each edge of a line, triangle or tetrahedron, in the order in which formats list the nodes in their
/// middles. Those of lines and triangles are the same everywhere: VTK file formats, "Node numbering"; Gmsh reference manual,
/// "Node ordering"; Abaqus Analysis User's Guide, "Three-dimensional solid element library" (C3D10), of planes (CPS6).
inline constexpr std::array<std::array<std::uint8_t, 2>, 6> vtk_mid_sides = {{{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}}},
                                                            abaqus_mid_sides = vtk_mid_sides,
                                                            gmsh_mid_sides = {{{0, 1}, {1, 2}, {2, 0}, {0, 3}, {2, 3}, {1, 3}}};
/// Edges of a simplex of so many corners; nodes of second order.
inline constexpr std::size_t mid_sides_of(std::size_t corners) { return corners * (corners - 1) / 2; }
inline constexpr std::size_t nodes_of_second_order(std::size_t corners) { return corners * (corners + 1) / 2; }

template <int D>
class MidSides {
 public:
  /// Numbers the edges of cells, subfacets and subsegments by their ends.
  explicit MidSides(const OutputMesh<D>& mesh);

  /// The mesh with the nodes as further points: without markers, attributes are means.
  OutputMesh<D> with_nodes(const OutputMesh<D>& mesh) const;
  /// The two points that the node between them is the middle of, of each, in their order.
  std::span<const std::array<std::uint32_t, 2>> edges() const { return edges_; }
  /// The number of the node between two points that an edge joins.
  std::uint32_t between(std::uint32_t a, std::uint32_t b) const;

 private:
  static std::array<std::uint32_t, 2> edge(std::uint32_t a, std::uint32_t b) { return {std::min(a, b), std::max(a, b)}; }

  std::uint32_t points_;
  std::vector<std::array<std::uint32_t, 2>> edges_;
};

template <int D>
MidSides<D>::MidSides(const OutputMesh<D>& mesh) : points_(static_cast<std::uint32_t>(mesh.points.size())) {
  const auto add = [this](const auto& corners) {
    for (std::size_t i = 0; i < corners.size(); ++i)
      for (std::size_t k = i + 1; k < corners.size(); ++k) edges_.push_back(edge(corners[i], corners[k]));
  };
  for (const auto& cell : mesh.cells) add(cell);
  for (const auto& f : mesh.subfacets) add(f.vertices);
  for (const auto& s : mesh.subsegments) add(s.vertices);
  std::sort(edges_.begin(), edges_.end());
  edges_.erase(std::unique(edges_.begin(), edges_.end()), edges_.end());
  constexpr std::size_t most_points = 0xfffffffe;
  if (edges_.size() > most_points - points_)
    throw ResourceError({.code = Errc::out_of_memory, .message = "with nodes on its edges the mesh has too many points"});
}

template <int D>
OutputMesh<D> MidSides<D>::with_nodes(const OutputMesh<D>& mesh) const {
  OutputMesh<D> out = mesh;
  const std::size_t width = mesh.points.empty() ? 0 : mesh.point_attributes.size() / mesh.points.size();
  for (const auto& [a, b] : edges_) {
    Point<D>& p = out.points.emplace_back();
    for (int k = 0; k < D; ++k) p[k] = mesh.points[a][k] / 2 + mesh.points[b][k] / 2;
    for (std::size_t k = 0; k < width; ++k)
      out.point_attributes.push_back(mesh.point_attributes[a * width + k] / 2 + mesh.point_attributes[b * width + k] / 2);
  }
  if (!out.point_markers.empty()) out.point_markers.resize(out.points.size());
  return out;
}

template <int D>
std::uint32_t MidSides<D>::between(std::uint32_t a, std::uint32_t b) const {
  const auto at = std::lower_bound(edges_.begin(), edges_.end(), edge(a, b));
  return points_ + static_cast<std::uint32_t>(at - edges_.begin());
}

}  // namespace pgdr::detail
