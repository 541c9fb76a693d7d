// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Splits of encroached subsegments and subfacets, as far as the insertion rule allows. Where the point of a subfacet encroaches
// upon a subsegment, that is split in its place.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "refine/inserter.hpp"
#include "refine/refusal_memo.hpp"
#include "refine/workspace.hpp"
#include "rule/insertion_rule.hpp"
#include "rule/twins.hpp"

namespace pgdr {

/// Splits subsegments and subfacets. Part of a worker: one thread at a time.
template <int D>
class EntitySplitter {
 public:
  /// Both must outlive it.
  EntitySplitter(Workspace<D>& workspace, Inserter<D>& inserter)
      : w_(&workspace), mesh_(&workspace.mesh), domain_(&workspace.domain), cavity_(&workspace.cavity), inserter_(&inserter) {}

  /// Must be called before the visit does anything.
  void begin_visit() { memo_.clear(); }
  /// Splits the subsegment or subfacet of the entry. `cause`: the demand of the element that it is split for; null: it is
  /// encroached.
  Outcome split(const Entry<D>& e, const Demand* cause) {
    return e.kind() == EntryKind::edge ? split_edge(e, cause) : split_face(e, cause);
  }

  bool knows_refused_faces() const { return memo_.knows_faces(); }  ///< has the split of any subfacet been refused in this visit?
  /// For a subfacet in whose place a subsegment was to be split and was refused: that subsegment, and the cell with the vertex
  /// that is too near. Nothing if that no longer holds.
  std::optional<std::pair<Entry<D>, typename RefusalMemo<D>::Near>> refused_before(const Entry<D>& face,
                                                                                   const Demand& cause) const;

 private:
  using Status = typename Cavity<D>::Status;
  using Near = typename RefusalMemo<D>::Near;
  struct FacetWalk {
    std::optional<Entry<D>> edge, face;
    bool owned = true;
  };

  Outcome split_edge(const Entry<D>& e, const Demand* cause);
  Outcome split_face(const Entry<D>& e, const Demand* cause);
  Outcome split_edges_instead(const Entry<D>& face, std::span<const Entry<D>> edges, const Demand& demand, const Demand* cause);
  VertexId encroacher(const Entry<D>& face, const Point<D>& x) const;
  Demand demand_passed_on(EntityRef facet, const Point<D>& x, VertexId q);
  Outcome commit_split(EntityRef entity, std::span<const VertexId> own, const Demand* cause, std::span<const VertexId> twins);
  bool is_near_boundary(std::span<const VertexId> own) const;
  Outcome refuse(EntityRef entity, std::span<const VertexId> own);
  Outcome refuse_kept(EntityRef kept);
  Outcome refuse_near(const Entry<D>& e, const Near& near);
  bool is_refused_as_before(const Entry<D>& face, const Demand& cause);
  Demand demand_of(EntityRef entity, std::span<const VertexId> own);
  bool may_be_near(EntityId s, std::span<const VertexId> own, VertexId q) const;
  FacetWalk walk_in_facet(const Entry<D>& e, const Point<D>& x);
  std::optional<CellId> cell_near_edge(const Entry<D>& e, const Point<D>& x, double distance, const SplitPlace* place) const;
  VertexId nearest_corner(CellId c, const Point<D>& x, EntityId segment, const SplitPlace* place) const;
  // 3D: subsegments that vertices are close beside (twins.hpp)
  std::vector<VertexId> twins_of(EntityId s, const SplitPlace& place) const;

  Workspace<D>* w_;
  Mesh<D>* mesh_;
  const Domain<D>* domain_;
  Cavity<D>* cavity_;
  Inserter<D>* inserter_;
  RefusalMemo<D> memo_;  ///< of the visit
};

extern template class EntitySplitter<2>;
extern template class EntitySplitter<3>;

}  // namespace pgdr
