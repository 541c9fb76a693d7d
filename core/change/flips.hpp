// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Flips that restore the local Delaunay property where an insertion could not keep it. A constrained Delaunay triangulation of
// space need not exist while a subsegment is encroached upon from behind a wall. The cavity is then cut back, and a face of its
// rim may have a vertex of the one side in the sphere of the other. Once the subsegment is split such faces are flipped away. In
// 2D two triangles become two others. In 3D two tetrahedra become three, or an edge leaves a ring of up to seven, if need be
// together with the two subfacets of one facet that it lies between.
#pragma once

#include <functional>
#include <optional>
#include <type_traits>
#include <utility>
#include <vector>

#include "change/replacement.hpp"
#include "change/rewrap.hpp"
#include "mesh/ridge.hpp"
#include "mesh/visit_area.hpp"

namespace pgdr {

/// Flips at the faces and edges of cells. One thread at a time, as the cavity.
template <int D>
class LocalFlips {
 public:
  using Pools = typename Mesh<D>::Pools;  ///< of the worker
  /// What became of an attempt. Stuck: no flip does it. Not owned: to find that out would need cells that the visit does not own.
  enum class Outcome { flipped, stuck, not_owned };

  /// Both must outlive it.
  LocalFlips(Mesh<D>& mesh, const Domain<D>& domain) : mesh_(&mesh), domain_(&domain), rewrap_(mesh), replacer_(mesh) {}

  /// A function that gift wrapping asks often; once it says true, gift wrapping ends.
  void set_ended(std::function<bool()> ended) { rewrap_.set_ended(std::move(ended)); }
  /// What the visit may change; null: everything.
  void set_area(const VisitArea<D>* area) {
    area_ = area;
    rewrap_.begin_visit(area);
    replacer_.set_area(area);
  }

  /// Flips the face, or an edge of it, if that leaves fewer violations.
  Outcome repair(Pools& pools, CellId c, int face);
  /// 3D: makes the cells about the face anew by gift wrapping, if that leaves fewer violations (change/rewrap.hpp); slower.
  Outcome rewrap(Pools& pools, CellId c, int face, LocalRewrap::Effort effort);
  /// Removes c if all its vertices lie on one facet, and two of its faces are subfacets of that: it is flat but for rounding.
  /// This flips the facet's triangulation there. Stuck: c is no such cell, or has to stay.
  Outcome remove_flat_cell(Pools& pools, CellId c);
  /// Has gift wrapping paid in this visit so far? `allowance`: the work that may be without effect in any case.
  bool rewrap_pays(std::uint64_t allowance) const;
  /// The cells that the last success made, or laid bare.
  const std::vector<CellId>& new_cells() const { return new_cells_; }

 private:
  using Vertices = std::array<VertexId, D + 1>;
  using NewCell = typename Replacement<D>::Cell;
  using Face = std::array<VertexId, D>;  // sorted
  struct OuterFace {
    Face vertices;
    Link link;
    bool constrained;
  };
  /// The cells round an edge.
  struct Ring {
    std::vector<CellId> cells;    ///< in order
    std::vector<VertexId> tips;   ///< far corners of the two subfacets at the edge, if it lies inside a facet
    EntityId entity = no_entity;  ///< that facet
  };
  /// What is known of the ring of cells round an edge. Edge stays: it is too long, or its constrained faces allow no flip.
  enum class RingStatus { whole, not_owned, edge_stays };

  bool owns(CellId c) const { return !area_ || area_->owns(*mesh_, c); }
  bool may_read(CellId c) const { return !area_ || area_->may_read(*mesh_, c); }  ///< for assertions
  std::vector<NewCell> cells_across(CellId c, int face) const;
  bool try_two_cells(Pools& pools, CellId c, int face);
  /// The condition on the number of violations. Better: fewer, or as many if three cells become two. No worse: at most as many.
  enum class Condition { better, no_worse };
  Outcome try_edge(Pools& pools, CellId c, int edge, Condition condition);
  bool note_wall(const RidgeWalk<D>& walk, Ring& ring) const;
  RingStatus take_ring(CellId c, int edge, std::size_t longest, Ring& ring) const;
  std::optional<std::array<int, 2>> faces_of_flat(CellId c) const;
  void take_old(std::vector<CellId> cells);
  int violations() const;
  std::vector<VertexId> hubs(const Ring& ring, VertexId u, VertexId w) const;
  std::vector<NewCell> fans(const Ring& ring, VertexId u, VertexId w, VertexId hub) const;
  void add_walls(const Ring& ring, VertexId u, VertexId w);
  bool positive(const Vertices& v) const;
  bool is_wall(const Face& f) const;
  bool walls_are_free() const;
  int violations_of(const std::vector<NewCell>& cells, int most);
  void replace(Pools& pools, const std::vector<NewCell>& cells);
  const OuterFace* outer(const Face& f) const;

  struct NoRewrap {
    explicit NoRewrap(Mesh<D>&) {}
    void begin_visit(const VisitArea<D>*) {}
    void set_ended(const std::function<bool()>&) {}
  };

  static constexpr std::size_t longest_ring = 7;

  Mesh<D>* mesh_;
  const Domain<D>* domain_;
  const VisitArea<D>* area_ = nullptr;
  std::conditional_t<D == 3, LocalRewrap, NoRewrap> rewrap_;
  Replacer<D> replacer_;
  Replacement<D> replacement_;
  std::vector<CellId> old_, new_cells_;
  std::vector<OuterFace> outer_;
  std::vector<Face> faces_;                  ///< of the cells whose violations are counted
  std::vector<Face> old_walls_, new_walls_;  ///< constrained faces between the old, resp. of the new cells
  EntityId wall_entity_ = no_entity;
};

extern template class LocalFlips<2>;
extern template class LocalFlips<3>;

}  // namespace pgdr
