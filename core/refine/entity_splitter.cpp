// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "refine/entity_splitter.hpp"

#include <algorithm>
#include <cmath>

#include "input/entities.hpp"
#include "mesh/ridge.hpp"
#include "refine/encroachment.hpp"
#include "refine/numbers.hpp"
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
    for (int steps = 0; steps < numbers::facet_walk_steps; ++steps) {
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
Demand EntitySplitter<D>::demand_of(EntityRef entity, std::span<const VertexId> own) {
  const VertexId q = nearest_vertex<D>(*mesh_, *cavity_, own);
  return q == no_vertex ? Demand{} : demand_beside<D>(*w_, entity, q);
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

/// What blocks a facet's point is kept.
template <int D>
Outcome EntitySplitter<D>::refuse_kept(EntityRef kept) {
  w_->refused_by = EntityPair{{kept, {}}};
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
  Demand demand = cause ? *cause : demand_of(entity, twins.empty() ? own : left_out);
  const double r = insertion_radius<D>(*mesh_, *cavity_, twins);
  if (D == 2 && cause && r < demand.d && is_near_boundary(own)) demand = demand_of(entity, own);
  if (r < demand.d) {
    const VertexId q = nearest_vertex<D>(*mesh_, *cavity_, own);
    const bool closing = w_->options.conforming_delaunay && !cause;
    if (!closing && (entity.kind != EntityKind::segment || !may_be_near(entity.id, own, q))) return refuse(entity, own);
    if (q != no_vertex && mesh_->vertex(q).home.kind() != EntityKind::vertex)
      demand.h = std::max(demand.h, double{mesh_->vertex(q).relaxed_radius});
  }
  if (D == 2 && r < w_->context.least_apart) return refuse(entity, own);
  if (w_->options.min_edge > 0 && inserter_->is_too_short(insertion_radius<D>(*mesh_, *cavity_))) return refuse(entity, own);
  return inserter_->commit(Home(entity.kind, entity.id), std::max(r, demand.h));
}

/// Whether a subsegment cuts its point off is looked at first, on a walk in the facet: while there are few points inside the
/// cavity of a point may be of thousands of cells.
template <int D>
Outcome EntitySplitter<D>::split_face(const Entry<D>& e, const Demand* cause) {
  const EntityRef entity = mesh_->entity_of_face(e.cell, e.which());
  const std::array<VertexId, D> own = face_without(mesh_->cell(e.cell).vertices, e.which());
  if (cause && is_refused_as_before(e, *cause)) return Outcome::refused;
  const Point<D> x = split_point_of_face(w_->context, e.cell, e.which());
  if (D == 2 && !is_between<D>(mesh_->point(own[0]), mesh_->point(own[1]), x)) return refuse(entity, own);
  const FacetWalk walk = walk_in_facet(e, x);
  if (!walk.owned) return w_->give_up(Outcome::not_owned);
  if (walk.edge) {
    const VertexId q = cause ? no_vertex : encroacher(e, x);
    if (cause || q != no_vertex)
      return split_edges_instead(e, {&*walk.edge, 1}, cause ? *cause : demand_passed_on(entity, x, q), cause);
  }
  const Entry<D>& from = walk.face ? *walk.face : e;
  const Status status = cavity_->collect_on_face(x, from.cell, from.which());
  if (status == Status::not_owned) return w_->give_up(Outcome::not_owned);
  if (status != Status::ok) return refuse(entity, own);
  std::vector<Entry<D>> edges;
  if (walk.edge) edges = {*walk.edge};
  if constexpr (D == 3)
    if (edges.empty()) edges = encroached_edges<D>(*mesh_, *cavity_, x);
  if (edges.empty()) return commit_split(entity, own, cause, {});
  return split_edges_instead(e, edges, cause ? *cause : demand_passed_on(entity, x, nearest_vertex<D>(*mesh_, *cavity_, own)),
                             cause);
}

/// 3D: of the two vertices beyond the subfacet, the one that encroaches upon it, and is nearer to its point x; none if neither
/// does.
template <int D>
VertexId EntitySplitter<D>::encroacher(const Entry<D>& face, const Point<D>& x) const {
  VertexId nearest = no_vertex;
  double least = std::numeric_limits<double>::infinity();
  const auto look_at = [&](CellId c, int which) {
    if (!is_face_encroached_by<D>(*mesh_, *domain_, c, which, mesh_->cell(c).vertices[which], w_->options)) return;
    const VertexId v = mesh_->cell(c).vertices[which];
    const double squared = squared_distance(mesh_->point(v), x);
    if (squared < least || (squared == least && lex_less<D>(mesh_->point(v), mesh_->point(nearest)))) {
      least = squared;
      nearest = v;
    }
  };
  look_at(face.cell, face.which());
  const Link beyond = mesh_->cell(face.cell).links[face.which()];
  if (beyond && cavity_->owns(beyond.cell())) look_at(beyond.cell(), beyond.face());
  return nearest;
}

/// The demand on subsegments that are split in place of a subfacet that q encroaches upon; x: its point.
template <int D>
Demand EntitySplitter<D>::demand_passed_on(EntityRef facet, const Point<D>& x, VertexId q) {
  if (q == no_vertex) return {};
  Demand demand = demand_beside<D>(*w_, facet, q);
  if (demand.h == 0) demand.d = std::sqrt(squared_distance(x, mesh_->point(q))) / 2;
  return demand;
}

/// Splits them until one is refused, or the subfacet is gone. Where it stays it is looked at again: an attempt each would collect
/// the same cavity for each of them.
template <int D>
Outcome EntitySplitter<D>::split_edges_instead(const Entry<D>& face, std::span<const Entry<D>> edges, const Demand& demand,
                                               const Demand* cause) {
  cavity_->release();
  const NodeVisit<D>& visit = *w_->visit;
  const std::uint64_t committed_before = visit.counts.committed;
  Outcome outcome = Outcome::committed;
  for (const Entry<D>& edge : edges) {
    if (!w_->alive(face) || visit.counts.committed >= visit.most_insertions) break;
    if (!w_->alive(edge)) continue;
    outcome = split_edge(edge, &demand);
    if (outcome == Outcome::committed) continue;
    if (outcome == Outcome::refused) memo_.note_passed_on(face, edge);
    break;
  }
  if (visit.counts.committed > committed_before) {
    if (!cause && w_->alive(face)) w_->visit->list->push(face);
    return Outcome::committed;
  }
  if (outcome == Outcome::refused) w_->trace.push_back(face.cell);
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
    if (w_->context.kept.has({EntityKind::segment, s})) return refuse_kept({EntityKind::segment, s});
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
