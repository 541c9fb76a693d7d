// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Delaunay refinement of one region, serial: encroached subsegments first, then subfacets, then poor elements, largest
// circumradius first by buckets of a factor of two, first in first out within a bucket (dissertation, sections 2.1, 3.4).
//
// Every run ends, whatever the input angles: see insertion_rule.hpp. What is refused stays, and elements that stay poor
// name the two input entities that meet at the small angle.
#pragma once

#include <deque>
#include <map>
#include <optional>
#include <vector>

#include "pgdr/cavity.hpp"
#include "pgdr/cell_bounds.hpp"
#include "pgdr/check.hpp"
#include "pgdr/insertion_rule.hpp"
#include "pgdr/local_flips.hpp"
#include "pgdr/refine_options.hpp"

namespace pgdr {

struct RefineCounts {
  std::uint64_t committed = 0, refused = 0, selector_outside = 0;
};

/// An element that stays poor, or has a face that is not locally Delaunay, and why. `PoorReason::cell` is filled when
/// the mesh is compacted.
struct PoorCell {
  CellId cell;
  bool over_bound = false, over_size = false;
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
  /// Every cell still over a bound, and every cell with a face that is not locally Delaunay for other reasons than
  /// rounding, each with its reason. @pre `run` has finished. Without reasons (a run that a budget ended, or no run, has
  /// none to give): those over a bound.
  std::vector<PoorCell> poor_cells(bool with_reasons);

  const RefineCounts& counts() const { return counts_; }

 private:
  struct Entry {
    CellId cell;
    std::array<VertexId, D + 1> vertices;
    int which;  // face or edge; for elements, why
  };
  struct EntityPair {
    std::array<EntityRef, 2> entities;
  };
  enum class Outcome { committed, refused };
  static constexpr int over_bound = 0, not_delaunay = 1;  // Entry::which of elements
  static constexpr int buckets = 64;

  // refiner.cpp: the lists
  Entry make_entry(CellId c, int which) const { return {c, mesh_->cell(c).vertices, which}; }
  bool alive(const Entry& e) const { return mesh_->cell(e.cell).vertices == e.vertices; }
  void list_cell(CellId c);
  void list_poor(CellId c, int why = over_bound);
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
  struct FacetWalk {
    std::optional<Entry> edge, face;
  };
  FacetWalk walk_in_facet(const Entry& e, const Point<D>& x) const;
  Demand demand_of(EntityRef entity, std::span<const VertexId> own, bool pass_on) const;
  Outcome decide(EntityRef entity, std::span<const VertexId> own, const Demand* cause);
  Outcome refuse(EntityRef entity, std::span<const VertexId> own);

  // refiner_cells.cpp: poor elements
  void treat_cell(const Entry& e);
  Point<D> steiner_point(CellId c, const CellVerdict& verdict);
  Demand demand_of_cell(CellId c, const CellVerdict& verdict) const;
  std::optional<Entry> encroached_face(const Point<D>& x) const;
  std::optional<Entry> blocking_face(CellId c, const Point<D>& x) const;
  void cell_refused(const Entry& e);

  // refiner_reasons.cpp: why some stay
  PoorReason explain(CellId c, bool beside) const;
  bool explains(const std::array<EntityRef, 2>& pair, const Ball<D>& doubled, PoorReason& reason) const;
  void add_entities(CellId c, std::vector<EntityRef>& list) const;

  void committed();
  void list_violations(std::span<const CellId> cells);
  void list_all_violations();
  void flip(const Entry& e);
  void flipped();
  bool mend_far_from_walls();

  Mesh<D>* mesh_;
  typename Mesh<D>::Pools* pools_;
  const Domain<D>* domain_;
  const RefineOptions<D>* options_;
  CellBounds<D> bounds_;
  Cavity<D> cavity_;
  LocalFlips<D> flips_;
  int base_exponent_;  // of the bucket 0: circumradii of the size of the domain and above
  std::deque<Entry> edges_, faces_;
  std::deque<Entry> not_delaunay_;  ///< faces to flip away
  std::uint64_t flips_left_ = 0;
  std::vector<std::array<VertexId, D + 1>> hopeless_;  ///< cells with a violation far from walls that cannot be mended
  std::array<std::deque<Entry>, buckets> poor_;
  int first_bucket_ = 0;
  std::vector<Entry> refused_edges_, refused_faces_, refused_cells_;
  std::vector<std::vector<EntityId>> segments_at_;  ///< of each input point; made for the reasons
  std::map<std::array<VertexId, D + 1>, EntityPair> why_;  // of refused elements
  std::optional<EntityPair> last_refusal_;
  std::uint64_t vertices_, commits_at_check_ = 0;
  bool min_edge_hit_ = false, violations_seen_ = false, rewraps_ = false, mending_ = false;
  RefineCounts counts_;
  std::chrono::steady_clock::time_point start_, last_progress_;
};

extern template class Refiner<2>;
extern template class Refiner<3>;

}  // namespace pgdr
