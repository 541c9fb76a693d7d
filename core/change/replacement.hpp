// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// A replacement: cells go, and others take their place. Beside the insertion of points (cavity/) it is the only way in which a
// visit changes a mesh once its boundary is there. (Between visits a rank puts in what others have made: ranks/held_mesh.hpp.)
//
// Why no test for intersections is needed. If all new cells are positively oriented and their oriented boundary is that of the
// old ones, they tile the same region: the difference of the two chains is a cycle of tetrahedra, hence 0, so that every point is
// covered as often as before. Where subfacets of a slanted facet flip, or its vertices move, the boundary changes by rounding;
// who proposes that tests that nothing overlaps in the facet's projection, and replaces the cells on both sides at once.
#pragma once

#include <array>
#include <compare>
#include <cstdint>
#include <utility>
#include <vector>

#include "mesh/mesh.hpp"
#include "mesh/visit_area.hpp"

namespace pgdr {

/// What goes and what comes. Plain data, to be used again.
template <int D>
struct Replacement {
  using Face = std::array<VertexId, D>;  ///< in any order
  /// A cell that comes.
  struct Cell {
    std::array<VertexId, D + 1> vertices;  ///< in positive order
    std::uint16_t region;                  ///< its region
  };
  /// A face (2D: edge) that becomes constrained, on each side that has a cell.
  struct Wall {
    Face vertices;
    EntityId entity;  ///< facet (2D: segment)
  };
  /// 3D: an edge that becomes a subsegment.
  struct Subsegment {
    std::array<VertexId, 2> ends;
    EntityId segment;
  };

  std::vector<CellId> old;              ///< the cells that go, each once
  std::vector<Cell> cells;              ///< those that come
  std::vector<Wall> walls;              ///< subfacets beside those that old cells have, which stay with the faces that do
  std::vector<Subsegment> subsegments;  ///< likewise

  void clear() {
    old.clear();
    cells.clear();
    walls.clear();
    subsegments.clear();
  }
};

/// Makes replacements. Part of a worker: one thread at a time.
template <int D>
class Replacer {
 public:
  using Pools = typename Mesh<D>::Pools;  ///< of the worker
  /// What becomes of the old cells. Kept: they stay in their slots, out of the mesh, until the caller frees them or links them in
  /// again; at pinched edges they stay listed.
  enum class OldCells { freed, kept };

  explicit Replacer(Mesh<D>& mesh) : mesh_(&mesh) {}  ///< it must outlive this
  /// What the visit may change; null: everything. For assertions.
  void set_area(const VisitArea<D>* area) { area_ = area; }

  /// Do the new cells fit: does each face of one occur once more, turned over, or is it a face of the rim of the old cells, or of
  /// the hull and a new wall; is each face of the rim taken, or closed by a new wall; does each subsegment and inner subfacet of
  /// the old cells stay an edge or face of the new ones, but for those that others of the same entity take the place of, with the
  /// same border; and are the two cells at each unconstrained face of one region? @pre all old cells may be read
  bool fits(const Replacement<D>& r);
  /// How many faces of the new cells would not be locally Delaunay; those between two of them count twice. No more are counted
  /// than one or two above `most`. @pre fits(r) was asked last, and said so
  int violations(const Replacement<D>& r, int most) const;
  /// Makes it: new cells with links, constraints and spheres, listed at pinched edges; notes that the cells at their vertices and
  /// at those of the old ones have changed (VertexNote::version, 3D). A face of the hull that gets a cell on its other side is
  /// constrained no more, unless it is one of the new walls. @pre fits(r); the visit owns the old cells; all new cells are
  /// positive
  void commit(Pools& pools, const Replacement<D>& r, OldCells fate = OldCells::freed);
  /// The cells that the last commit made, in the order of Replacement::cells; where there were none, those beside the new walls.
  const std::vector<CellId>& new_cells() const { return new_cells_; }

 private:
  /// A face of old cells, of new ones, or both, or a new wall.
  struct Face {
    std::array<VertexId, D> vertices;        ///< ascending
    std::array<std::uint32_t, 2> old, made;  ///< of each cell that has it: the number, that of the face there, how it is turned
    std::uint8_t olds, mades;                ///< how many cells have it
    bool too_often;                          ///< more than two cells of one kind have it; or it is a wall of two entities
    EntityId before;                         ///< entity that it is a part of; or no_entity
    EntityId wall;                           ///< of a new wall, its entity; else no_entity
    std::uint32_t wall_number;               ///< of a new wall
    bool is_wall() const { return wall != no_entity; }
    bool was_wall() const { return before != no_entity; }
  };
  /// A piece of an entity that comes or goes, or of its border.
  struct Piece {
    EntityId entity;
    std::array<VertexId, 2> ends;  ///< of an edge, ascending; of a vertex, itself twice
    friend auto operator<=>(const Piece&, const Piece&) = default;
  };

  void match_faces(const Replacement<D>& r);
  Face& face_with(const std::array<VertexId, D>& vertices, std::uint32_t& code);
  void add_side(const std::array<VertexId, D>& vertices, std::uint32_t code, bool of_old, EntityId entity);
  Link beyond(const Replacement<D>& r, const Face& f) const;
  bool face_fits(const Replacement<D>& r, const Face& f);
  bool regions_agree(const Replacement<D>& r, const Face& f, Link beyond) const;
  void note_changed_wall(const Face& f, EntityId entity);
  void take_subsegments(const Replacement<D>& r);
  bool note_changed_subsegments(const Replacement<D>& r);
  bool keeps_borders();
  CellId make_cell(Pools& pools, const typename Replacement<D>::Cell& cell);
  void link(Pools& pools, const Replacement<D>& r, const Face& f);
  void close(Pools& pools, Link beyond, const Face& f);
  void constrain_edges(Pools& pools, const Replacement<D>& r);
  void count_versions(const Replacement<D>& r);

  Mesh<D>* mesh_;
  const VisitArea<D>* area_ = nullptr;
  std::vector<CellId> new_cells_;
  std::vector<Face> faces_;                   ///< each once, in the order in which they were met
  std::vector<std::uint32_t> table_;          ///< finds them by their vertices: numbers from 1, or 0 where there is none
  std::vector<Piece> subsegments_;            ///< of old cells
  std::vector<Piece> borders_;                ///< of walls that come or go; D = 3: edges, D = 2: ends
  std::vector<Piece> changed_subsegments_;    ///< that come or go
  std::vector<std::array<VertexId, D>> rim_;  ///< faces that stay, beside cells that stay
  std::vector<std::pair<std::uint32_t, CellId>> laid_bare_;  ///< with the numbers of the walls
  std::vector<VertexId> vertices_;
};

extern template class Replacer<2>;
extern template class Replacer<3>;

}  // namespace pgdr
