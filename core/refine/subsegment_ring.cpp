// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "refine/subsegment_ring.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "mesh/ridge.hpp"
#include "refine/split_points.hpp"

namespace pgdr {

SubsegmentRing::SubsegmentRing(Workspace<3>& workspace, CellId c, int edge)
    : w_(&workspace),
      cell_(c),
      edge_(edge),
      segment_(workspace.mesh.constraints(c)->edge_entity[edge]),
      ends_(ends_of_edge(workspace.mesh.cell(c).vertices, edge)) {
  const Mesh<3>& mesh = w_->mesh;
  const auto [t0, t1] = parameters_of(w_->context, segment_, ends_[0], ends_[1]);
  TwinPlaces places(w_->domain, segment_, t0, t1, Beside::as_far);
  for_cells_round(mesh, cell_, edge_, [&](const RidgeWalk<3>& walk) {
    owned_ = w_->cavity.owns(walk.cell);
    if (!owned_) return RoundEdge::stop;
    for (const int i : {walk.entry, walk.exit})
      if (const VertexId v = mesh.cell(walk.cell).vertices[i]; v != infinite_vertex) places.look_at(mesh.vertex(v));
    return RoundEdge::go_on;
  });
  if (!owned_) return;
  place_ = places.best();
  x_ = place_ ? place_->x : split_point(w_->context, segment_, ends_[0], ends_[1]);
}

/// Calls f for the vertices of the ring but the ends and the twins, most of them twice.
template <class F>
void SubsegmentRing::for_vertices(F f) const {
  const Mesh<3>& mesh = w_->mesh;
  for_cells_round(mesh, cell_, edge_, [&](const RidgeWalk<3>& walk) {
    for (const int i : {walk.entry, walk.exit}) {
      const VertexId v = mesh.cell(walk.cell).vertices[i];
      if (v != infinite_vertex && !(place_ && is_twin(w_->domain, segment_, *place_, mesh.vertex(v)))) f(v);
    }
    return RoundEdge::go_on;
  });
}

std::optional<EntityPair> SubsegmentRing::refuses() const {
  const Mesh<3>& mesh = w_->mesh;
  VertexId nearest = no_vertex;
  double least = std::numeric_limits<double>::infinity();
  for_vertices([&](VertexId v) {
    const double squared = squared_distance(x_, mesh.point(v));
    if (nearest != no_vertex && (squared > least || (squared == least && !lex_less(mesh.point(v), mesh.point(nearest))))) return;
    least = squared;
    nearest = v;
  });
  if (nearest == no_vertex) return std::nullopt;
  const EntityRef segment{EntityKind::segment, segment_};
  const Demand demand = demand_beside<3>(*w_, segment, nearest);
  for (const VertexId end : ends_) least = std::min(least, squared_distance(x_, mesh.point(end)));
  if (!(std::sqrt(least) < demand.d)) return std::nullopt;
  return EntityPair{{segment, mesh.vertex(nearest).home.entity()}};
}

template <int D>
Demand demand_beside(Workspace<D>& w, EntityRef entity, VertexId q) {
  Demand demand = encroachment_demand<D>(w.domain, entity, w.mesh.vertex(q));
  if (D == 3 && demand.h > 0 && w.angles.between(entity, w.mesh.vertex(q).home.entity()) < small_angle) demand.d = demand.h;
  return demand;
}

template Demand demand_beside<2>(Workspace<2>&, EntityRef, VertexId);
template Demand demand_beside<3>(Workspace<3>&, EntityRef, VertexId);

}  // namespace pgdr
