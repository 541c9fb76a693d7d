// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// A move of a Steiner vertex v. A collapse moves it to a neighbour u, which takes it out of the mesh: every cell at v gets u in
// the place of v, and those that had both vanish. A relocation moves it to another place on its own entity.
//
// A vertex on a segment collapses onto a neighbour on it, one on a facet onto one on that, so that segments and facets stay
// unions of edges and faces. The new cells cover what the old ones did if all of them are positively oriented: then the whole
// border of the star of v is seen from the new place. So do the new subfacets if none turns over in the facet's projection. New
// faces need not be Delaunay: the caller asks for those to look at (open_faces).
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "mesh/mesh.hpp"
#include "mesh/visit_area.hpp"

namespace pgdr {

/// One collapse or relocation at a time: collect, aim, ask, commit. Part of a worker: one thread at a time.
class VertexMove {
 public:
  using Pools = Mesh<3>::Pools;  ///< of the worker
  /// May the vertex be moved? Stays: it is one of the input, or has too many cells.
  enum class Status { ok, not_owned, stays };
  /// A cell at the vertex that does not vanish: it gets the new place for one corner.
  struct Turned {
    CellId cell;  ///< as it is
    int corner;   ///< where the vertex is
  };
  /// An unconstrained face of a new cell. Those between two new cells come twice.
  struct OpenFace {
    std::size_t turned;  ///< index of the cell among these
    VertexId beyond;     ///< opposite the face, in its other cell
  };

  VertexMove(Mesh<3>& mesh, const Domain<3>& domain) : mesh_(&mesh), domain_(&domain) {}  ///< both must outlive it
  /// What the visit may change; null: everything.
  void set_area(const VisitArea<3>* area) { area_ = area; }

  /// Collects the cells at v, of which c is one that the visit owns.
  Status collect(VertexId v, CellId c, std::size_t most_cells);
  VertexId vertex() const { return v_; }                       ///< the vertex that was collected last
  const std::vector<CellId>& cells() const { return cells_; }  ///< the cells at it
  std::vector<VertexId> neighbours() const;                    ///< the other vertices of these cells
  std::vector<VertexId> targets() const;                       ///< the neighbours that it may collapse onto
  /// The cells for which f is true first, otherwise in their order: `turned` has them so.
  template <class F>
  void put_first(F f) {
    std::vector<int> corners;
    std::vector<CellId> cells;
    for (const bool first : {true, false})
      for (std::size_t i = 0; i < cells_.size(); ++i)
        if (f(cells_[i]) == first) {
          cells.push_back(cells_[i]);
          corners.push_back(corners_[i]);
        }
    cells_ = std::move(cells);
    corners_ = std::move(corners);
  }
  void aim(VertexId u);       ///< plans a collapse onto a neighbour
  void aim(const Point3& x);  ///< plans a relocation to a place on the vertex's own entity
  bool turns_over(std::size_t i) const {
    return orient<3>(prospect(i)) != Sign::positive;
  }                              ///< does the i-th turned cell turn over?
  bool turns_cell_over() const;  ///< does any? Most moves that are not valid do this, and it is quick to tell
  /// May the vertex go there?
  bool is_valid();
  Home home() const { return home_; }                            ///< of the target
  const std::vector<Turned>& turned() const { return turned_; }  ///< the cells that do not vanish
  Simplex<3> prospect(std::size_t i) const;                      ///< what becomes of the i-th of them
  std::vector<OpenFace> open_faces() const;                      ///< of the cells that they become
  /// Makes the planned move. @pre is_valid()
  void commit(Pools& pools);
  const std::vector<CellId>& new_cells() const { return new_cells_; }  ///< made by the last commit

 private:
  /// A cell that vanishes: the numbers of the two vertices in it.
  struct Flattened {
    CellId cell;
    int of_v, of_u;
  };
  /// A subsegment from the target that new cells get from cells that vanish.
  struct Edge {
    VertexId end;
    EntityId entity;
  };

  bool owns(CellId c) const { return !area_ || area_->owns(*mesh_, c); }
  void find_turned();
  int number_of(CellId c, VertexId v) const;
  bool may_flatten(const Flattened& x);
  bool keeps_subfacets(const Turned& t) const;
  bool is_flat(const Turned& t) const;
  const Flattened* flattened(CellId c) const;
  CellId turn(Pools& pools, const Turned& t);
  void link(Pools& pools, std::size_t i);
  void close(Pools& pools, const Flattened& x);

  Mesh<3>* mesh_;
  const Domain<3>* domain_;
  const VisitArea<3>* area_ = nullptr;
  VertexId v_ = no_vertex;
  VertexId u_ = no_vertex;  ///< the target, if that is a vertex
  Point3 x_;                ///< where it is
  Home home_{EntityKind::volume, 0};
  std::vector<CellId> cells_, new_cells_;
  std::vector<int> corners_;  ///< of the cells, where the vertex is
  std::vector<Turned> turned_;
  std::vector<Flattened> flattened_;
  std::vector<Edge> edges_;
  std::vector<EntityId> facets_;  ///< of the constrained faces about the vertex
};

}  // namespace pgdr
