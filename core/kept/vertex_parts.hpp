// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// What is about a vertex that is to go: the sectors into which walls divide the cells at it, and the fans of subfacets there. A
// fan goes from one subsegment at the vertex to the next, or round it. Without the vertex the polygon of a fan is triangulated
// anew, in the plane of its facet; and each sector is a polyhedron, of the faces opposite the vertex and of these triangles.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "mesh/mesh.hpp"

namespace pgdr {

/// A polyhedron that is to be filled with cells. Plain data, to be used again.
struct Hull {
  using Face = std::array<VertexId, 3>;  ///< (face, a point beside it in the polyhedron) is positively oriented
  std::vector<Face> faces;
  std::vector<Link> beyond;                    ///< of each face: the cell on its other side; none across walls
  std::vector<std::array<VertexId, 2>> edges;  ///< subsegments, which have to be edges of the cells
  std::vector<VertexId> inside;                ///< vertices that have to be corners of cells, and are none of faces
  std::uint16_t region = 0;                    ///< of its cells
  std::array<double, 3> inwards{};             ///< a direction from the vertex that is strictly inside of all fans; or zero
};

/// See above. Changes nothing of the mesh but marks of cells, which it takes off again; one thread.
class VertexParts {
 public:
  VertexParts(Mesh<3>& mesh, const Domain<3>& domain) : mesh_(&mesh), domain_(&domain) {}  ///< both must outlive it

  /// Takes the vertex, which is no point of the input; c is a cell at it. False where it cannot do without the vertex, as a fan
  /// has no other triangulation.
  bool take(VertexId v, CellId c);

  /// A triangle of a fan without the vertex.
  struct Triangle {
    std::array<VertexId, 3> corners;  ///< positive in the projection of the facet
    EntityId facet;
  };
  const std::vector<CellId>& cells() const { return cells_; }                           ///< all at the vertex
  const std::vector<Hull>& hulls() const { return hulls_; }                             ///< of the sectors
  const std::vector<Triangle>& triangles() const { return triangles_; }                 ///< of all fans
  const std::optional<std::array<VertexId, 2>>& subsegment() const { return joined_; }  ///< in the place of two

 private:
  /// A subfacet at the vertex, by its other corners, as they follow each other in the projection.
  struct Leaf {
    VertexId from, to;
    EntityId facet;
    std::uint32_t fan;
  };
  void collect_cells(CellId c);
  void take_cell(CellId c);
  void add_pinched(CellId c);
  void divide();
  bool collect_leaves();
  bool find_fans();
  std::vector<std::array<std::uint32_t, 2>> with_flat_faces(std::span<const VertexId> polygon,
                                                            std::vector<std::array<std::uint32_t, 2>> edges) const;
  bool triangulate(std::uint32_t fan, std::span<const Leaf> leaves);
  void build_hulls();
  void add_face(Hull& hull, const Hull::Face& face) const;
  bool is_end(VertexId w) const { return w == ends_[0] || w == ends_[1]; }

  Mesh<3>* mesh_;
  const Domain<3>* domain_;
  VertexId vertex_{};
  std::vector<CellId> cells_;
  std::vector<std::uint32_t> sector_;  ///< of each cell
  std::uint32_t sectors_ = 0;
  std::array<VertexId, 2> ends_{};  ///< of the subsegments at the vertex; no_vertex: none
  std::vector<Leaf> leaves_;
  std::uint32_t fans_ = 0;
  std::vector<std::uint32_t> fan_of_triangle_;
  std::vector<Triangle> triangles_;
  std::vector<Hull> hulls_;
  std::optional<std::array<VertexId, 2>> joined_;
};

}  // namespace pgdr
