// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Flips that restore the local Delaunay property where an insertion could not keep it. A constrained Delaunay
// triangulation of space need not exist while a subsegment is encroached upon from behind a wall: the cavity is then cut
// back, and a face of its rim may have a vertex of the one side in the sphere of the other. Once the subsegment is split
// such faces are flipped away: two triangles for two in 2D; two tetrahedra for three, or an edge taken out of a ring of
// up to seven, in 3D. A workspace of one visit, as the cavity.
#pragma once

#include <vector>

#include "pgdr/mesh.hpp"

namespace pgdr {

template <int D>
class LocalFlips {
 public:
  using Pools = typename Mesh<D>::Pools;

  explicit LocalFlips(Mesh<D>& mesh) : mesh_(&mesh) {}

  /// Is the face unconstrained, and the vertex beyond it strictly inside the (unperturbed) circumsphere of c?
  bool violates(CellId c, int face) const;
  /// Replaces the cells at the violating face by others with fewer violations. False if no flip does that.
  bool repair(Pools& pools, CellId c, int face);
  /// The cells made by the last successful repair.
  const std::vector<CellId>& new_cells() const { return new_cells_; }

 private:
  using Vertices = std::array<VertexId, D + 1>;
  using Face = std::array<VertexId, D>;  // sorted
  struct OuterFace {
    Face vertices;
    Link link;
    bool constrained;
    EntityId entity;
  };
  struct Subsegment {
    VertexId a, b;
    EntityId entity;
  };

  bool try_two_cells(Pools& pools, CellId c, int face);
  bool try_edge(Pools& pools, CellId c, int a, int b);
  bool take_old(std::vector<CellId> cells);
  int violations() const;
  bool positive(const Vertices& v) const;
  Simplex<D> simplex(const Vertices& v) const;
  int violations_of(const std::vector<Vertices>& cells) const;
  void replace(Pools& pools, const std::vector<Vertices>& cells);
  CellId make_cell(Pools& pools, const Vertices& v);
  const OuterFace* outer(const Face& f) const;

  Mesh<D>* mesh_;
  std::vector<CellId> old_, new_cells_;
  std::vector<OuterFace> outer_;
  std::vector<Subsegment> subsegments_;
};

extern template class LocalFlips<2>;
extern template class LocalFlips<3>;

}  // namespace pgdr
