// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The part of the mesh that a rank holds (territory.hpp): what is dropped at the cut, and how the changes that other ranks'
// visits have made get there. Vertices are known by their coordinates, no two being at one place, and cells by their vertices.
// Tables find the vertices of cells that have one in what another rank holds, and the cells all of whose are there: others can
// name these alone. While no visit runs; one thread.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "mesh/mesh.hpp"
#include "ranks/cell_message.hpp"
#include "ranks/id_table.hpp"
#include "ranks/territory.hpp"

namespace pgdr::detail {

/// The points of the vertices of a cell, in their order.
template <int D>
using SentPoints = std::array<std::array<double, D>, D + 1>;
/// Those of this cell.
template <int D>
SentPoints<D> points_of(const Mesh<D>& mesh, CellId c) {
  SentPoints<D> points;
  for (std::size_t i = 0; i < points.size(); ++i)
    for (int k = 0; k < D; ++k) points[i][static_cast<std::size_t>(k)] = mesh.point(mesh.cell(c).vertices[i])[k];
  return points;
}
/// The first of a cell's vertices, by coordinates: whose it is, the cell is.
template <int D>
VertexId first_vertex(const Mesh<D>& mesh, CellId c) {
  VertexId first = mesh.cell(c).vertices[0];
  for (std::size_t i = 1; i <= D; ++i)
    if (const VertexId v = mesh.cell(c).vertices[i]; lex_less<D>(mesh.point(v), mesh.point(first))) first = v;
  return first;
}

/// See above.
template <int D>
class HeldMesh {
 public:
  using Vertices = std::array<VertexId, D + 1>;
  using Net = typename ChangeLog<D>::Net;
  using Zone = typename Territory<D>::Zone;

  /// Drops the cells that this rank does not hold. The mesh and the territory must outlive it.
  HeldMesh(Mesh<D>& mesh, const Territory<D>& territory);
  /// The rank holds less from now on, see Territory::of_next_level. Drops the cells that it does not hold any more.
  void shrink(const Territory<D>& territory);
  /// Where the vertex is. While nobody applies changes: any thread.
  Zone zone(VertexId v) const {
    const bool is_known = index(v) < zones_.size() && zones_[index(v)] != unknown;
    return is_known ? zones_[index(v)] : territory_->zone(mesh_->point(v));
  }
  const Territory<D>& territory() const { return *territory_; }

  // Takes note of what visits of this rank have changed: first of all that is gone, since slots are used again.
  void note_gone(const Net& net);
  void note_made(const Net& net);
  /// Makes the changes of a visit of another rank.
  /// @throws ResourceError internal: it names what is not here, ids_exhausted; std::bad_alloc
  void apply(const SentCells<D>& cells);
  /// Gives a cell that stays its constraints. False if it is not held.
  bool apply(const SentConstraints<D>& changed, std::span<const SentVertex<D>> vertices);
  /// Cells that were made by apply() so far.
  std::uint64_t cells_applied() const { return cells_applied_; }

  /// The cells that this rank owns, and that one does not hold.
  SentCells<D> own_beyond(int rank) const;
  /// Adds cells that are not held: those that ranks own, for one rank that holds all in the end.
  void add(const SentCells<D>& cells);
  /// Links all cells across the faces beyond which none was held, and forgets what is shared. Afterwards this is a whole mesh.
  /// @throws ResourceError internal: a cell is missing
  void complete();
  /// Which rank owns the cell: has its first vertex in its part? Each cell of the mesh has one owner, which holds it.
  int owner(CellId c) const { return territory_->owner(zone(first_vertex(*mesh_, c))); }
  bool is_own(CellId c) const { return owner(c) == territory_->rank(); }
  /// Enters all cells, for find().
  void find_all();
  /// The cell with vertices at these points; no_cell. Slow if others cannot name it, unless find_all() was called.
  CellId find(const SentPoints<D>& points) const;

 private:
  struct RimFace {
    std::array<VertexId, D> vertices;  ///< sorted
    Link beyond;                       ///< the cell that stays, and its face
  };

  static std::uint32_t hash_of(const Point<D>& p);
  static std::uint32_t hash_of(const Vertices& vertices);
  static bool are_same(const Vertices& a, const Vertices& b);
  static std::array<VertexId, D> face_of(const Vertices& vertices, int face);
  static Point<D> point_of(const std::array<double, D>& coordinates);
  VertexId find_vertex(const Point<D>& p) const;
  CellId find_cell(const Vertices& vertices, std::uint32_t hash) const;
  CellId find_anywhere(const Vertices& vertices) const;
  void enter(VertexId v);
  void share(CellId c);
  void enter_cells();
  void keep_held();
  bool is_held(CellId c) const;
  void note_zones();
  VertexId vertex_of(const SentVertex<D>& sent);
  std::vector<VertexId> vertices_of(const SentCells<D>& cells);
  Vertices local(const SentCorners<D>& corners, std::span<const VertexId> vertices) const;
  void take_out(const SentCells<D>& cells, std::span<const VertexId> vertices);
  std::vector<CellId> make(const SentCells<D>& cells, std::span<const VertexId> vertices);
  void link_at_rim(CellId c, int face);
  void drop(CellId c);

  Mesh<D>* mesh_;
  const Territory<D>* territory_;
  typename Mesh<D>::Pools pools_;
  IdTable vertices_, cells_;
  static constexpr Zone unknown{~std::uint32_t{0}};
  std::vector<Zone> zones_;       ///< by vertex: where those are that were looked at; unknown
  std::vector<bool> is_entered_;  ///< of each vertex: is it in the table?
  std::vector<RimFace> rim_;      ///< of the cells that apply() took out, sorted
  struct Named {
    CellId cell;
    std::uint32_t hash;
  };
  std::vector<Named> leaving_;   ///< cells that apply() takes out
  std::vector<Named> entering_;  ///< cells that are to be entered
  std::uint64_t cells_applied_ = 0;
};

extern template class HeldMesh<2>;
extern template class HeldMesh<3>;

}  // namespace pgdr::detail
