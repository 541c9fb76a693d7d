// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "refine/entity_splitter.hpp"

#include <algorithm>
#include <cmath>

#include "input/entities.hpp"
#include "mesh/ridge.hpp"
#include "refine/encroachment.hpp"
#include "refine/split_points.hpp"
#include "refine/subsegment_ring.hpp"

namespace pgdr {
namespace {

/// 2D: does x, beside the line pq, come between p and q on the axis along which that runs? With few doubles between them it may
/// not.
template <int D>
bool is_between(const Point<D>& p, const Point<D>& q, const Point<D>& x) {
  const int axis = std::fabs(q[0] - p[0]) >= std::fabs(q[1] - p[1]) ? 0 : 1;
  return std::min(p[axis], q[axis]) < x[axis] && x[axis] < std::max(p[axis], q[axis]);
}

constexpr int most_steps = 1000;  // of a walk in a facet; it can run in a circle where the facet is not Delaunay

}  // namespace

/// A point on a shell goes in where the first one of its end does, or one no farther from the end, on another segment there,
/// is q; however near that is. (Of the former there are finitely many; a chain of the latter never comes nearer to the end,
/// so that their distances are bounded by the least angle there.)
template <int D>
bool EntitySplitter<D>::may_be_near(EntityId s, std::span<const VertexId> own, VertexId q) const {
  const Shells<D>& shells = w_->context.shells;
  const auto [t0, t1] = parameters_of(w_->context, s, own[0], own[1]);
  const int end = shells.end_of(s, t0, t1);
  if (end < 0) return false;
  const std::uint32_t id = domain_->segments()[s].points[end];
  const Point<D>& v = domain_->points()[id];
  const VertexId far = mesh_->point(own[0]) == v ? own[1] : own[0];
  if (!shells.is_radius(s, std::sqrt(squared_distance(v, mesh_->point(far))))) return true;
  if (q == no_vertex) return false;
  const EntityRef home = mesh_->vertex(q).home.entity();
  if (home.kind != EntityKind::segment || home.id == s) return false;
  const auto& ends = domain_->segments()[home.id].points;
  if (ends[0] != id && ends[1] != id) return false;
  const double radius = std::sqrt(squared_distance(v, cavity_->point()));
  return radius >= std::sqrt(squared_distance(v, mesh_->point(q))) - 2 * shells.rounding(s);
}

/// The subsegment that cuts x off from the subfacet, or else the subfacet of the same facet that x lies in, on a walk in
/// the facet's projection. Where the facet's triangulation is not Delaunay the part of a cavity need not reach either.
template <int D>
auto EntitySplitter<D>::walk_in_facet(const Entry<D>& e, const Point<D>& x) -> FacetWalk {
  if constexpr (D == 3) {
    const EntityId entity = mesh_->constraints(e.cell)->face_entity[e.which()];
    const int axis = domain_->facets()[entity].axis;
    Link at(e.cell, e.which());
    for (int steps = 0; steps < most_steps; ++steps) {
      const CellId c = at.cell();
      if (!cavity_->owns(c)) return {{}, {}, false};
      w_->trace.push_back(c);
      const auto& v = mesh_->cell(c).vertices;
      std::optional<Entry<D>> edge;
      Link next;
      for (int corner = 0; corner <= D && !next; ++corner) {
        if (corner == at.face()) continue;
        const auto ends = corners_without(at.face(), corner);
        const Point<D>&a = mesh_->point(v[ends[0]]), &b = mesh_->point(v[ends[1]]);
        const Sign inside = orient_projected(a, b, mesh_->point(v[corner]), axis);
        if (inside == Sign::zero || orient_projected(a, b, x, axis) != -inside) continue;
        const int ridge = edge_of_ends[ends[0]][ends[1]];
        if (mesh_->constraints(c)->has_edge(ridge)) {
          edge = w_->entry(c, EntryKind::edge, ridge);
        } else {
          bool owned = true;
          next = cavity_->entity_face_round_ridge(c, at.face(), corner, entity, owned);
          if (!owned) return {{}, {}, false};
        }
      }
      if (!next) return edge ? FacetWalk{edge, {}} : FacetWalk{{}, w_->entry(c, EntryKind::face, at.face())};
      at = next;
    }
  }
  return {};
}

/// @pre the cavity of x is collected.
template <int D>
Demand EntitySplitter<D>::demand_of(EntityRef entity, std::span<const VertexId> own, bool passed_on) {
  const VertexId q = nearest_vertex<D>(*mesh_, *cavity_, own);
  if (q == no_vertex) return {};
  Demand demand = demand_beside<D>(*w_, entity, q);
  if (passed_on && demand.h == 0) demand.d = std::sqrt(squared_distance(cavity_->point(), mesh_->point(q))) / 2;
  return demand;
}

/// 2D: is the vertex of the cavity that is nearest to the point of a subsegment one of the boundary? Then it encroaches upon the
/// subsegment, which merely was not split for it yet (encroachment.hpp).
template <int D>
bool EntitySplitter<D>::is_near_boundary(std::span<const VertexId> own) const {
  const VertexId q = nearest_vertex<D>(*mesh_, *cavity_, own);
  return q != no_vertex && mesh_->vertex(q).home.kind() != EntityKind::volume;
}

template <int D>
Outcome EntitySplitter<D>::refuse(EntityRef entity, std::span<const VertexId> own) {
  const VertexId q = nearest_vertex<D>(*mesh_, *cavity_, own);
  w_->refused_by = EntityPair{{entity, q == no_vertex ? EntityRef{} : mesh_->vertex(q).home.entity()}};
  ++w_->visit->counts.refused;
  return w_->give_up(Outcome::refused);
}

/// Judges the collected point of the entity, and inserts it if the insertion rule allows. `twins`: their distances do not count.
template <int D>
Outcome EntitySplitter<D>::commit_split(EntityRef entity, std::span<const VertexId> own, const Demand* cause,
                                        std::span<const VertexId> twins) {
  Status status = cavity_->make_star_shaped();
  if (status == Status::ok) status = cavity_->keep_entities();
  if (status == Status::not_owned) return w_->give_up(Outcome::not_owned);
  if (status != Status::ok) return refuse(entity, own);
  std::vector<VertexId> left_out(twins.begin(), twins.end());
  if (!twins.empty()) left_out.insert(left_out.end(), own.begin(), own.end());
  Demand demand = cause ? *cause : demand_of(entity, twins.empty() ? own : left_out, false);
  const double r = insertion_radius<D>(*mesh_, *cavity_, twins);
  if (D == 2 && cause && r < demand.d && is_near_boundary(own)) demand = demand_of(entity, own, false);
  if (r < demand.d) {
    const VertexId q = nearest_vertex<D>(*mesh_, *cavity_, own);
    if (entity.kind != EntityKind::segment || !may_be_near(entity.id, own, q)) return refuse(entity, own);
    if (q != no_vertex && mesh_->vertex(q).home.kind() != EntityKind::vertex)
      demand.h = std::max(demand.h, double{mesh_->vertex(q).relaxed_radius});
  }
  if (D == 2 && r < w_->context.least_apart) return refuse(entity, own);
  if (w_->options.min_edge > 0 && inserter_->is_too_short(insertion_radius<D>(*mesh_, *cavity_))) return refuse(entity, own);
  return inserter_->commit(Home(entity.kind, entity.id), std::max(r, demand.h));
}

template <int D>
Outcome EntitySplitter<D>::split_face(const Entry<D>& e, const Demand* cause) {
  const EntityRef entity = mesh_->entity_of_face(e.cell, e.which());
  const std::array<VertexId, D> own = face_without(mesh_->cell(e.cell).vertices, e.which());
  if (cause && is_refused_as_before(e, *cause)) return Outcome::refused;
  const Point<D> x = split_point_of_face(w_->context, e.cell, e.which());
  if (D == 2 && !is_between<D>(mesh_->point(own[0]), mesh_->point(own[1]), x)) return refuse(entity, own);
  Status status = cavity_->collect_on_face(x, e.cell, e.which());
  std::optional<Entry<D>> edge;
  if (D == 3 && status == Status::ok) status = find_edge_in_the_way(e, x, edge);
  if (status == Status::not_owned) return w_->give_up(Outcome::not_owned);
  if (status != Status::ok) return refuse(entity, own);
  return edge ? split_edge_instead(e, *edge, entity, own, cause) : commit_split(entity, own, cause, {});
}

/// 3D: the subsegment that is to be split in place of the subfacet with the collected point x, if there is one. Where its cavity
/// is not star-shaped about x, it is collected anew from the subfacet that x lies in.
template <int D>
auto EntitySplitter<D>::find_edge_in_the_way(const Entry<D>& e, const Point<D>& x, std::optional<Entry<D>>& edge) -> Status {
  if constexpr (D == 3) {
    edge = edge_beyond<D>(*mesh_, *domain_, *cavity_, x);
    if (!edge) edge = encroached_edge<D>(*mesh_, *cavity_, x);
    const Status star = edge ? Status::ok : cavity_->make_star_shaped();
    if (star == Status::ok || star == Status::not_owned) return star;
    const auto [beyond, around, owned] = walk_in_facet(e, x);
    if (!owned) return Status::not_owned;
    edge = beyond;
    const Entry<D>& from = around ? *around : e;
    cavity_->release();
    const Status again = cavity_->collect_on_face(x, from.cell, from.which());
    if (again == Status::ok && !edge && around) edge = encroached_edge<D>(*mesh_, *cavity_, x);
    return again;
  }
  return Status::ok;
}

template <int D>
Outcome EntitySplitter<D>::split_edge_instead(const Entry<D>& face, const Entry<D>& edge, EntityRef facet,
                                              std::span<const VertexId> own, const Demand* cause) {
  const Demand demand = cause ? *cause : demand_of(facet, own, true);
  cavity_->release();
  const Outcome outcome = split_edge(edge, &demand);
  // The face is looked at again if the split left it as it was.
  if (outcome == Outcome::committed && !cause && w_->alive(face)) w_->visit->list->push(face);
  if (outcome == Outcome::refused) {
    memo_.note_passed_on(face, edge);
    w_->trace.push_back(face.cell);
  }
  return outcome;
}

/// A cell at the subsegment with a corner nearer than this to x on it; not counted are twins of `place`, if x is that. Such cells
/// are in the cavity of x, whatever else is, and are found long before that is collected. Ends where the claim does.
template <int D>
std::optional<CellId> EntitySplitter<D>::cell_near_edge(const Entry<D>& e, const Point<D>& x, double distance,
                                                        const SplitPlace* place) const {
  std::optional<CellId> near;
  if constexpr (D == 3) {
    const EntityId s = mesh_->constraints(e.cell)->edge_entity[e.which()];
    for_cells_round(*mesh_, e.cell, e.which(), [&](const RidgeWalk<D>& walk) {
      if (!cavity_->owns(walk.cell)) return RoundEdge::turn_back;
      const VertexId v = nearest_corner(walk.cell, x, s, place);
      if (v != no_vertex && std::sqrt(squared_distance(mesh_->point(v), x)) < distance) near = walk.cell;
      return near ? RoundEdge::stop : RoundEdge::go_on;
    });
  }
  return near;
}

/// The corner of the cell that is nearest to x on the segment and no twin of `place`; none if all are.
template <int D>
VertexId EntitySplitter<D>::nearest_corner(CellId c, const Point<D>& x, EntityId segment, const SplitPlace* place) const {
  VertexId nearest = no_vertex;
  double least = std::numeric_limits<double>::infinity();
  for (const VertexId v : mesh_->cell(c).vertices) {
    const double squared = squared_distance(mesh_->point(v), x);
    if (!(squared < least)) continue;
    if constexpr (D == 3)
      if (place && is_twin(*domain_, segment, *place, mesh_->vertex(v))) continue;
    least = squared;
    nearest = v;
  }
  return nearest;
}

/// A subsegment whose point is too near to a corner of this cell of its cavity. These two cells decide that: whatever was
/// looked at before may change.
template <int D>
Outcome EntitySplitter<D>::refuse_near(const Entry<D>& e, const Near& near) {
  w_->refused_by = EntityPair{{EntityRef{EntityKind::segment, mesh_->constraints(e.cell)->edge_entity[e.which()]}, near.home}};
  w_->trace.assign({e.cell, near.cell});
  w_->trace_alone = true;
  return w_->give_up(Outcome::refused);
}

template <int D>
auto EntitySplitter<D>::refused_before(const Entry<D>& face, const Demand& cause) const
    -> std::optional<std::pair<Entry<D>, Near>> {
  const auto edge = memo_.passed_on(*mesh_, face);
  if (!edge) return std::nullopt;
  const auto [a, b] = ends_of_edge(mesh_->cell(edge->cell).vertices, edge->which());
  const auto near = memo_.nearer_than(*mesh_, a, b, cause.d);
  return near ? std::optional(std::pair(*edge, *near)) : std::nullopt;
}

template <int D>
bool EntitySplitter<D>::is_refused_as_before(const Entry<D>& face, const Demand& cause) {
  const auto known = refused_before(face, cause);
  if (!known) return false;
  const auto& [edge, near] = *known;
  refuse_near(edge, near);
  w_->trace.push_back(face.cell);
  return true;
}

template <int D>
Outcome EntitySplitter<D>::split_edge(const Entry<D>& e, const Demand* cause) {
  if constexpr (D == 3) {
    const EntityId s = mesh_->constraints(e.cell)->edge_entity[e.which()];
    const std::array<VertexId, 2> own = ends_of_edge(mesh_->cell(e.cell).vertices, e.which());
    const SubsegmentRing ring(*w_, e.cell, e.which());
    if (!ring.owned()) return w_->give_up(Outcome::not_owned);
    const SplitPlace* place = ring.place();
    const Point<D> x = ring.x();
    const EntityRef entity{EntityKind::segment, s};
    const double least = cause ? cause->d : 0;
    if (const auto near = memo_.nearer_than(*mesh_, own[0], own[1], least); near && near->x == x) return refuse_near(e, *near);
    auto near = cause ? cell_near_edge(e, x, least, place) : std::nullopt;
    const Status status = near ? Status::too_near : cavity_->collect_on_edge(x, e.cell, e.which(), least, place);
    if (status == Status::not_owned) return w_->give_up(Outcome::not_owned);
    if (status == Status::too_near) {
      if (!near) near = cavity_->near_cell();
      const VertexId v = nearest_corner(*near, x, s, place);
      const double distance = std::sqrt(squared_distance(mesh_->point(v), x));
      const Near noted{*near, mesh_->birth(*near), x, distance, mesh_->vertex(v).home.entity()};
      memo_.note_near(own[0], own[1], noted);
      ++w_->visit->counts.refused;
      return refuse_near(e, noted);
    }
    if (status != Status::ok) return refuse(entity, own);
    return commit_split(entity, own, cause, place ? twins_of(s, *place) : std::vector<VertexId>{});
  } else {
    static_cast<void>(e);
    static_cast<void>(cause);
    return Outcome::refused;
  }
}

/// Vertices of the cavity whose distances from the place do not count.
template <int D>
std::vector<VertexId> EntitySplitter<D>::twins_of(EntityId s, const SplitPlace& place) const {
  std::vector<VertexId> twins;
  if constexpr (D == 3)
    for (const CellId c : cavity_->cells())
      for (const VertexId v : mesh_->cell(c).vertices)
        if (v != infinite_vertex && is_twin(*domain_, s, place, mesh_->vertex(v)) &&
            std::find(twins.begin(), twins.end(), v) == twins.end())
          twins.push_back(v);
  return twins;
}

template class EntitySplitter<2>;
template class EntitySplitter<3>;

}  // namespace pgdr
