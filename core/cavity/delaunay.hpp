// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The (perturbed) Delaunay triangulation of a point set, built by insertion into a Mesh, its convex hull closed by
// ghost cells. Unique for a set of points: independent of the order of insertion.
#pragma once

#include <span>
#include <stop_token>
#include <vector>

#include "cavity/cavity.hpp"
#include "mesh/mesh.hpp"
#include "space/pieces.hpp"

namespace pgdr {
namespace detail {
class Bulk;
class ChangedCells;
}
struct CurveOrder;

/// The cell that contains p (closed), or the ghost beyond whose hull face p lies, by a visibility walk from `hint`.
/// @pre the mesh is a triangulation, Delaunay or not, closed by ghosts.
template <int D>
CellId locate(const Mesh<D>& mesh, const Point<D>& p, CellId hint);

/// Triangulates points by insertion, with cavities. One thread calls it.
template <int D>
class Delaunay {
 public:
  /// @pre `mesh` is empty.
  Delaunay(Mesh<D>& mesh, typename Mesh<D>::Pools& pools) : mesh_(&mesh), pools_(&pools), cavity_(mesh) {}

  /// Triangulates distinct points; vertex k of the result is points[k], at home at input vertex k. False (and no cell)
  /// if the points lie in one line (2D) or plane (3D). Ends early, with some of the points, once `stop` is requested.
  /// Many points go in side by side, as pieces. The mesh does not depend on the threads, and neither do its slots.
  /// @param island  of each point, from 0 on without gaps: each island is triangulated by itself, closed by ghosts of its own, in
  ///   the same mesh; empty: one for all. False if the points of any lie in one plane.
  bool build(std::span<const Point<D>> points, const detail::Pieces& pieces, const std::stop_token& stop = {},
             std::span<const std::uint32_t> island = {});
  /// The same on the calling thread.
  bool build(std::span<const Point<D>> points) { return build(points, detail::OneByOne()); }

  /// Inserts one more point, with its insertion radius, for which `twins` do not count. The search begins at the star of vertex
  /// `near`.
  /// @returns the new vertex; the vertex that is there already; no_vertex, without a change, if a vertex is nearer than `least`
  VertexId insert(const Point<D>& p, Home home, VertexId near, double least = 0, std::span<const VertexId> twins = {});

  /// Adds the cells that insertions delete and make to `changed` from now on. It must outlive this.
  void tell_changes(detail::ChangedCells& changed) { listeners_.push_back(&changed); }

  /// Somebody else has given these cells other vertices, the same together.
  void note_changed(std::span<const CellId> cells);

  /// Vertices in the order of `points`.
  const std::vector<VertexId>& vertices() const { return vertices_; }
  /// Of each island one of its vertices.
  const std::vector<VertexId>& first_vertices() const { return first_vertices_; }
  /// A cell at v (v < vertex bound).
  CellId cell_at(VertexId v) const { return cell_at_[index(v)]; }

 private:
  /// What is triangulated by itself.
  struct Island {
    std::vector<std::uint32_t> given;            ///< its points, ascending
    std::vector<std::uint32_t> along;            ///< places in the CurveOrder
    std::array<std::uint32_t, D + 1> corners{};  ///< of its first simplex
  };
  static std::vector<Island> islands_of(std::span<const std::uint32_t> island, const CurveOrder& order);
  static bool first_simplex(std::span<const Point<D>> points, Island& island);
  void make_vertices(std::span<const Point<D>> points, std::span<const Island> islands, const CurveOrder& order,
                     const detail::Bulk& bulk);
  void make_first_cells(const std::array<std::uint32_t, D + 1>& corners);
  void insert_rounds(const Island& island, const CurveOrder& order, const detail::Pieces& pieces, const std::stop_token& stop);
  VertexId insert_all(std::span<const VertexId> vertices, VertexId near, const std::stop_token& stop);
  /// Collects the cavity of p, or returns the vertex that is there already.
  VertexId prepare(const Point<D>& p, CellId hint);
  VertexId commit(Home home, float relaxed_radius);
  void note_cells();

  Mesh<D>* mesh_;
  typename Mesh<D>::Pools* pools_;
  Cavity<D> cavity_;
  std::vector<VertexId> vertices_, first_vertices_;
  std::vector<CellId> cell_at_;
  std::vector<detail::ChangedCells*> listeners_;
};

extern template class Delaunay<2>;
extern template class Delaunay<3>;

}  // namespace pgdr
