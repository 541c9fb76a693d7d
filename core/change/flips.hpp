// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Flips that restore the local Delaunay property where an insertion could not keep it. A constrained Delaunay
// triangulation of space need not exist while a subsegment is encroached upon from behind a wall: the cavity is then cut
// back, and a face of its rim may have a vertex of the one side in the sphere of the other. Once the subsegment is split
// such faces are flipped away: two triangles for two in 2D; two tetrahedra for three, or an edge taken out of a ring of
// up to seven, in 3D, if need be together with the two subfacets of one facet that it lies between. A workspace of one visit, as the cavity.
#pragma once

#include <type_traits>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "change/rewrap.hpp"
#include "mesh/ridge.hpp"
#include "mesh/visit_area.hpp"

namespace pgdr {

/// Mends faces that are not locally Delaunay: see above.
template <int D>
class LocalFlips {
 public:
  using Pools = typename Mesh<D>::Pools;  ///< of the worker
  /// As `repair` says.
  enum class Outcome { flipped, stuck, not_owned };
  /// A cell that a flip makes.
  struct NewCell {
    std::array<VertexId, D + 1> vertices;  ///< in positive order
    std::uint16_t region;  ///< that it is in
  };
  /// Cells about an edge.
  struct Ring {
    std::vector<CellId> cells;  ///< in order
    std::vector<VertexId> tips;  ///< far corners of the two subfacets at the edge, if it lies inside a facet
    EntityId entity = no_entity;  ///< that facet
  };
  /// Other cells for some: a face, or an edge and with it perhaps two subfacets, makes room for what crosses it.
  struct Flip {
    Ring old;  ///< the cells that go
    std::array<VertexId, 2> edge{no_vertex, no_vertex};  ///< likewise
    std::vector<NewCell> cells;  ///< those that come
  };
  /// A face that would not be locally Delaunay.
  struct Violation {
    std::size_t cell;  ///< index of a new cell
    VertexId beyond;  ///< in its sphere
    bool inner;  ///< between two new cells: comes twice
  };

  /// Both must outlive it.
  LocalFlips(Mesh<D>& mesh, const Domain<D>& domain) : mesh_(&mesh), domain_(&domain), rewrap_(mesh) {}

  /// Asked often by what is slow; once it says true, nothing more is mended by that.
  void set_ended(std::function<bool()> ended) { rewrap_.set_ended(std::move(ended)); }
  /// What the visit may change; null: everything.
  void set_area(const VisitArea<D>* area) {
    area_ = area;
    rewrap_.begin_visit(area);
  }

  /// Replaces the cells at the violating face by others with fewer violations. Stuck: no flip does that. Not owned: to find
  /// that out would need cells that the visit does not own.
  Outcome repair(Pools& pools, CellId c, int face);
  /// 3D: the same by gift wrapping (change/rewrap.hpp); slower.
  Outcome rewrap(Pools& pools, CellId c, int face, LocalRewrap::Effort effort);
  /// A cell with all its vertices on one facet, and two subfacets of it, is flat but for rounding: takes it out, which flips
  /// the facet's triangulation there. Stuck: c is no such cell, or cannot be taken out.
  Outcome remove_flat_cell(Pools& pools, CellId c);
  /// 3D: the flips of faces and edges of c that leave positively oriented cells, none of them with all corners on one facet. Adds
  /// the cells about each edge to `seen`. Not owned: there might be more.
  Outcome find_flips(CellId c, std::vector<Flip>& flips, std::vector<CellId>& seen) const;
  /// The faces that are not locally Delaunay after a flip; no value if it may not be, as a subfacet is where it makes one.
  std::optional<std::vector<Violation>> violations_after(const Flip& flip);
  /// How many faces that a flip would change are not locally Delaunay?
  std::size_t violations_before(const Flip& flip) const;
  /// Makes one of these flips.
  void make(Pools& pools, const Flip& flip);
  /// Has it, so far in this visit, been worth its while in large regions? `allowance`: what may be spent in vain.
  bool rewrap_pays(std::uint64_t allowance) const;
  /// The cells made, or laid bare, by the last success.
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

  bool owns(CellId c) const { return !area_ || area_->owns(*mesh_, c); }
  bool may_read(CellId c) const { return !area_ || area_->may_read(*mesh_, c); }  ///< for assertions
  std::vector<NewCell> cells_across(CellId c, int face) const;
  bool try_two_cells(Pools& pools, CellId c, int face);
  /// Of the number of violations: fewer, or as many in a smaller ring; at most as many.
  enum class Condition { better, no_worse };
  Outcome try_edge(Pools& pools, CellId c, int a, int b, Condition condition);
  bool note_wall(const RidgeWalk<D>& walk, Ring& ring) const;
  Outcome take_ring(CellId c, int a, int b, std::size_t longest, Ring& ring) const;
  std::optional<std::array<int, 2>> faces_of_flat(CellId c) const;
  void take_old(std::vector<CellId> cells);
  int violations() const;
  std::vector<VertexId> hubs(const Ring& ring, VertexId u, VertexId w) const;
  void add_flip(Flip flip, std::vector<Flip>& flips) const;
  Outcome find_edge_flips(CellId c, int a, int b, std::vector<Flip>& flips, std::vector<CellId>& seen) const;
  std::vector<NewCell> fans(const Ring& ring, VertexId u, VertexId w, VertexId hub) const;
  void add_walls(const Ring& ring, VertexId u, VertexId w);
  bool positive(const Vertices& v) const;
  Simplex<D> simplex(const Vertices& v) const;
  bool is_wall(const Face& f) const;
  bool walls_are_free() const;
  std::vector<Violation> violations_of(const std::vector<NewCell>& cells, std::size_t most);
  void replace(Pools& pools, const std::vector<NewCell>& cells);
  CellId make_cell(Pools& pools, const NewCell& cell);
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
  std::vector<CellId> old_, new_cells_;
  std::vector<OuterFace> outer_;
  std::vector<Subsegment> subsegments_;
  std::vector<Face> faces_;  ///< of the cells whose violations are counted
  std::vector<Face> old_walls_, new_walls_;  ///< constrained faces between the old, resp. of the new cells
  EntityId wall_entity_ = no_entity;
};

extern template class LocalFlips<2>;
extern template class LocalFlips<3>;

}  // namespace pgdr
