// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Delaunay refinement of one region, serial: encroached subsegments first, then subfacets, then poor elements, largest
// circumradius first by buckets of a factor of two, first in first out within a bucket (dissertation, sections 2.1, 3.4).
//
// Every run ends, whatever the input angles. Each vertex p has a home (the input vertex, segment or facet it lies on, or
// the volume) and a relaxed insertion radius R(p): infinity for input vertices. The relaxed length of an edge uv is |uv|
// between input vertices, else max(|uv|, min(R(u), R(v))). Let r(x) be the distance from a new point x to the nearest
// vertex of its cavity. x is inserted only if r(x) >= d, and gets R(x) = max(r(x), h), where
//   * for a poor element, or an entity that it encroaches upon or that hides its point: d is the least relaxed length
//     of the element's edges (of an element only too big, at most half its circumradius); h = 0;
//   * for an entity encroached upon by q, the cavity's nearest vertex that is none of the entity's: if q is an input
//     vertex or the entities of q and x do not touch, d = h = 0 (r(x) is then at least the least distance of disjoint
//     entities); else d = c R(q), h = R(q), c = 1/2.
// Since R is inherited along a chain of small angles the factor c is paid once, not once a link: with
// lambda = min(half the least distance of disjoint entities, the shortest edge of the initial mesh, half the least size)
// every Steiner point has R >= lambda and r >= c lambda, by induction over the insertions. Mutually visible vertices are
// thus c lambda apart, and the domain is bounded. Without inheritance c would have to be 1.
// What is refused stays, and elements that stay poor name the two input entities that meet at the small angle.
#pragma once

#include <deque>
#include <map>
#include <optional>
#include <vector>

#include "pgdr/cavity.hpp"
#include "pgdr/cell_bounds.hpp"
#include "pgdr/check.hpp"
#include "pgdr/refine_options.hpp"

namespace pgdr {

struct RefineCounts {
  std::uint64_t committed = 0, refused = 0, selector_outside = 0;
};

/// An element that stays poor: its vertices and why. `PoorReason::cell` is filled when the mesh is compacted.
struct PoorCell {
  CellId cell;
  bool over_size = false;
  PoorReason reason;
};

template <int D>
class Refiner {
 public:
  /// `start`: when the caller's time limit began to run.
  Refiner(Mesh<D>& mesh, typename Mesh<D>::Pools& pools, const Domain<D>& domain, const RefineOptions<D>& options,
          CellBounds<D> bounds, std::uint64_t vertices_so_far, std::chrono::steady_clock::time_point start);

  /// Lists what is encroached or poor among all cells of the mesh.
  void list_all();
  /// Treats what is listed, and what that brings forth, until nothing is left or a budget ends.
  StopCause run();
  /// Every cell still over a bound, with its reason. After `run`, or without it.
  std::vector<PoorCell> poor_cells();

  const RefineCounts& counts() const { return counts_; }

 private:
  struct Entry {
    CellId cell;
    std::array<VertexId, D + 1> vertices;
    int which;  // face or edge; unused for elements
  };
  struct Demand {
    double d = 0, h = 0;
  };
  struct EntityPair {
    std::array<EntityRef, 2> entities;
  };
  enum class Outcome { committed, refused };
  static constexpr int buckets = 64;
  static constexpr double inheritance = 0.5;  // c

  // refiner.cpp: the lists
  Entry make_entry(CellId c, int which) const { return {c, mesh_->cell(c).vertices, which}; }
  bool alive(const Entry& e) const { return mesh_->cell(e.cell).vertices == e.vertices; }
  void list_cell(CellId c);
  void list_poor(CellId c);
  void list_entities(CellId c, const ConstraintRecord<D>& k);
  int bucket_of(CellId c) const;
  std::optional<StopCause> budget();
  bool relist_refused();
  StopCause drain();

  // refiner_entities.cpp: encroached entities
  bool face_encroached_by(CellId c, int face, VertexId v) const;
  Outcome split_face(const Entry& e, const Demand* cause);
  Outcome split_edge(const Entry& e, const Demand* cause);
  Point<D> face_point(CellId c, int face) const;
  Point<D> segment_midpoint(EntityId s, VertexId a, VertexId b) const;
  std::optional<Entry> encroached_edge(const Point<D>& x) const;
  std::optional<Entry> edge_beyond(const Point<D>& x) const;
  Demand demand_of(EntityRef entity, const Point<D>& x, std::span<const VertexId> own, bool pass_on);
  Outcome decide(EntityRef entity, const Point<D>& x, std::span<const VertexId> own, const Demand* cause);
  Outcome refuse(EntityRef entity, const Point<D>& x, std::span<const VertexId> own);
  bool on_entity(VertexId v, EntityRef entity) const;
  VertexId nearest_in_cavity(const Point<D>& x, std::span<const VertexId> excluded) const;
  double insertion_radius() const;

  // refiner_cells.cpp: poor elements
  void treat_cell(const Entry& e);
  Point<D> steiner_point(CellId c, const CellVerdict& verdict);
  Demand demand_of_cell(CellId c, const CellVerdict& verdict) const;
  std::optional<Entry> encroached_face(const Point<D>& x) const;
  std::optional<Entry> blocking_face(CellId c, const Point<D>& x) const;
  void cell_refused(const Entry& e);
  PoorReason explain(CellId c) const;

  void committed(VertexId v);

  Mesh<D>* mesh_;
  typename Mesh<D>::Pools* pools_;
  const Domain<D>* domain_;
  const RefineOptions<D>* options_;
  CellBounds<D> bounds_;
  Cavity<D> cavity_;
  int base_exponent_;  // of the bucket 0: circumradii of the size of the domain and above
  std::deque<Entry> edges_, faces_;
  std::array<std::deque<Entry>, buckets> poor_;
  int first_bucket_ = 0;
  std::vector<Entry> refused_edges_, refused_faces_, refused_cells_;
  std::map<std::array<VertexId, D + 1>, EntityPair> why_;  // of refused elements
  std::optional<EntityPair> last_refusal_;
  std::uint64_t vertices_, commits_at_check_ = 0;
  bool min_edge_hit_ = false, finished_ = false;
  RefineCounts counts_;
  std::chrono::steady_clock::time_point start_, last_progress_;
};

extern template class Refiner<2>;
extern template class Refiner<3>;

}  // namespace pgdr
