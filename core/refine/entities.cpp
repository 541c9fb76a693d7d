// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Splitting encroached subsegments and subfacets, and the rule that says when not to.
#include <algorithm>
#include <cmath>

#include "input/entities.hpp"
#include "refine/refiner.hpp"

namespace pgdr {
namespace {

constexpr int most_steps = 1000;  // of a walk in a facet; it can run in a circle where the facet is not Delaunay

}  // namespace

/// Vertices of the entity itself never encroach upon it, though rounding may put them some ulps inside a ball.
template <int D>
bool Refiner<D>::face_encroached_by(CellId c, int face, VertexId v) const {
  const auto& k = mesh_->cell(c).vertices;
  const EntityId id = mesh_->constraints(c)->face_entity[face];
  if constexpr (D == 2) {
    const VertexId a = k[(face + 1) % 3], b = k[(face + 2) % 3];
    return in_diametral_ball<2>(mesh_->point(a), mesh_->point(b), mesh_->point(v)) &&
           !lies_on<D>(*domain_, mesh_->vertex(v).home, {EntityKind::segment, id});
  } else {
    const Ball<3> ball = equatorial_ball(mesh_->point(k[(face + 1) & 3]), mesh_->point(k[(face + 2) & 3]),
                                         mesh_->point(k[(face + 3) & 3]));
    return in_equatorial_ball(ball, mesh_->point(v)) && !lies_on<D>(*domain_, mesh_->vertex(v).home, {EntityKind::facet, id});
  }
}

/// Where the two vertices lie on the segment, the smaller parameter first; its ends at 0 and 1.
template <int D>
std::array<double, 2> Refiner<D>::piece(EntityId s, VertexId a, VertexId b) const {
  const auto parameter = [&](VertexId v) {
    const Home home = mesh_->vertex(v).home;
    if (home.kind() != EntityKind::vertex) return segment_parameter<D>(*domain_, s, mesh_->point(v));
    return home.id() == domain_->segments()[s].points[0] ? 0.0 : 1.0;
  };
  const double ta = parameter(a), tb = parameter(b);
  return {std::min(ta, tb), std::max(ta, tb)};
}

/// The point that splits the subsegment ab.
template <int D>
Point<D> Refiner<D>::split_point(EntityId s, VertexId a, VertexId b) const {
  const auto [t0, t1] = piece(s, a, b);
  return point_on_segment<D>(*domain_, s, context_->shells.split_parameter(s, t0, t1));
}

/// A point on a shell goes in where the first one of its end does, or one no farther from the end, on another segment there,
/// is q; however near that is. (Of the former there are finitely many; a chain of the latter never comes nearer to the end,
/// so that their distances are bounded by the least angle there.)
template <int D>
bool Refiner<D>::may_be_near(EntityId s, std::span<const VertexId> own, VertexId q) const {
  const auto [t0, t1] = piece(s, own[0], own[1]);
  const int end = context_->shells.end_of(s, t0, t1);
  if (end < 0) return false;
  const std::uint32_t id = domain_->segments()[s].points[end];
  const Point<D>& v = domain_->points()[id];
  const VertexId far = mesh_->point(own[0]) == v ? own[1] : own[0];
  if (!context_->shells.is_radius(s, std::sqrt(squared_distance(v, mesh_->point(far))))) return true;
  if (q == no_vertex) return false;
  const EntityRef home = mesh_->vertex(q).home.entity();
  if (home.kind != EntityKind::segment || home.id == s) return false;
  const auto& ends = domain_->segments()[home.id].points;
  if (ends[0] != id && ends[1] != id) return false;
  const double radius = std::sqrt(squared_distance(v, cavity_.point()));
  return radius >= std::sqrt(squared_distance(v, mesh_->point(q))) - 2 * context_->shells.rounding(s);
}

template <int D>
Point<D> Refiner<D>::face_point(CellId c, int face) const {
  const auto& k = mesh_->cell(c).vertices;
  const EntityId id = mesh_->constraints(c)->face_entity[face];
  if constexpr (D == 2) {
    return split_point(id, k[(face + 1) % 3], k[(face + 2) % 3]);
  } else {
    const Ball<3> ball = equatorial_ball(mesh_->point(k[(face + 1) & 3]), mesh_->point(k[(face + 2) & 3]),
                                         mesh_->point(k[(face + 3) & 3]));
    return point_on_facet(*domain_, id, ball.center);
  }
}

/// A subsegment on a cell of the cavity in whose diametral ball x lies.
template <int D>
auto Refiner<D>::encroached_edge(const Point<D>& x) const -> std::optional<Item> {
  if constexpr (D == 3) {
    for (const CellId c : cavity_.cells()) {
      const auto* k = mesh_->constraints(c);
      if (!k || !k->edges) continue;
      const auto& vertices = mesh_->cell(c).vertices;
      for (int e = 0; e < 6; ++e)
        if ((k->edges >> e & 1) && in_diametral_ball<D>(mesh_->point(vertices[edge_ends[e][0]]),
                                                        mesh_->point(vertices[edge_ends[e][1]]), x))
          return make_entry(c, EntryKind::edge, e);
    }
  }
  return std::nullopt;
}

/// A subsegment at the rim of the facet's part of the cavity that cuts x off from it, in the facet's projection.
template <int D>
auto Refiner<D>::edge_beyond(const Point<D>& x) const -> std::optional<Item> {
  if constexpr (D == 3) {
    for (const auto& part : cavity_.part()) {
      const auto* k = mesh_->constraints(part.cell);
      const auto& vertices = mesh_->cell(part.cell).vertices;
      const int axis = domain_->facets()[part.entity].axis;
      for (int i = 0; i <= D; ++i)
        for (int j = i + 1; j <= D; ++j) {
          if (i == part.face || j == part.face || !(k->edges >> edge_of_ends[i][j] & 1)) continue;
          const int corner = 6 - part.face - i - j;
          const Point<D>&a = mesh_->point(vertices[i]), &b = mesh_->point(vertices[j]);
          const Sign inside = orient_projected(a, b, mesh_->point(vertices[corner]), axis);
          if (orient_projected(a, b, x, axis) != inside) return make_entry(part.cell, EntryKind::edge, edge_of_ends[i][j]);
        }
    }
  }
  return std::nullopt;
}

/// The subsegment that cuts x off from the subfacet, or else the subfacet of the same facet that x lies in, on a walk in
/// the facet's projection. Where the facet's triangulation is not Delaunay the part of a cavity need not reach either.
template <int D>
auto Refiner<D>::walk_in_facet(const Item& e, const Point<D>& x) const -> FacetWalk {
  if constexpr (D == 3) {
    const EntityId entity = mesh_->constraints(e.cell)->face_entity[e.which()];
    const int axis = domain_->facets()[entity].axis;
    Link at(e.cell, e.which());
    for (int steps = 0; steps < most_steps; ++steps) {
      const CellId c = at.cell();
      if (!cavity_.owns(c)) return {{}, {}, false};
      seen_.push_back(c);
      const auto& v = mesh_->cell(c).vertices;
      std::optional<Item> edge;
      Link next;
      for (int corner = 0; corner <= D && !next; ++corner) {
        if (corner == at.face()) continue;
        int ends[2], n = 0;
        for (int i = 0; i <= D; ++i)
          if (i != at.face() && i != corner) ends[n++] = i;
        const Point<D>&a = mesh_->point(v[ends[0]]), &b = mesh_->point(v[ends[1]]);
        const Sign inside = orient_projected(a, b, mesh_->point(v[corner]), axis);
        if (inside == Sign::zero || orient_projected(a, b, x, axis) != -inside) continue;
        const int ridge = edge_of_ends[ends[0]][ends[1]];
        if (mesh_->constraints(c)->edges >> ridge & 1) {
          edge = make_entry(c, EntryKind::edge, ridge);
        } else {
          bool owned = true;
          next = cavity_.entity_face_round_ridge(c, at.face(), corner, entity, owned);
          if (!owned) return {{}, {}, false};
        }
      }
      if (!next) return edge ? FacetWalk{edge, {}} : FacetWalk{{}, make_entry(c, EntryKind::face, at.face())};
      at = next;
    }
  }
  return {};
}

/// At which they meet, in degrees. It is kept, as each takes microseconds.
template <int D>
double Refiner<D>::angle_between(EntityRef a, EntityRef b) const {
  const auto key = [](EntityRef e) { return std::uint64_t{e.id} << 1 | (e.kind == EntityKind::facet ? 1 : 0); };
  const auto [at, is_new] = angles_.try_emplace({key(a), key(b)});
  if (is_new) at->second = entity_angle<D>(*domain_, a, b);
  return at->second;
}

/// @pre the cavity of x is collected.
template <int D>
auto Refiner<D>::demand_of(EntityRef entity, std::span<const VertexId> own, bool pass_on) const -> Demand {
  const VertexId q = nearest_vertex<D>(*mesh_, cavity_, own);
  if (q == no_vertex) return {};
  Demand demand = encroachment_demand<D>(*domain_, entity, mesh_->vertex(q));
  const EntityRef home = mesh_->vertex(q).home.entity();
  if (D == 3 && demand.h > 0 && meet_below(small_angle, entity, home)) demand.d = demand.h;
  if (pass_on && demand.h == 0) demand.d = std::sqrt(squared_distance(cavity_.point(), mesh_->point(q))) / 2;
  return demand;
}

template <int D>
auto Refiner<D>::refuse(EntityRef entity, std::span<const VertexId> own) -> Outcome {
  const VertexId q = nearest_vertex<D>(*mesh_, cavity_, own);
  last_refusal_ = EntityPair{{entity, q == no_vertex ? EntityRef{} : mesh_->vertex(q).home.entity()}};
  cavity_.release();
  ++visit_->counts.refused;
  return Outcome::refused;
}

/// `twins`: their distances do not count.
template <int D>
auto Refiner<D>::decide(EntityRef entity, std::span<const VertexId> own, const Demand* cause, std::span<const VertexId> twins)
    -> Outcome {
  auto status = cavity_.make_star_shaped();
  if (status == Cavity<D>::Status::ok) status = cavity_.check_nothing_swallowed();
  if (status == Cavity<D>::Status::not_owned) return give_up(Outcome::not_owned);
  if (status != Cavity<D>::Status::ok) return refuse(entity, own);
  std::vector<VertexId> left_out(twins.begin(), twins.end());
  if (!twins.empty()) left_out.insert(left_out.end(), own.begin(), own.end());
  Demand demand = cause ? *cause : demand_of(entity, twins.empty() ? own : left_out, false);
  const double r = insertion_radius<D>(*mesh_, cavity_, twins);
  if (r < demand.d) {
    const VertexId q = nearest_vertex<D>(*mesh_, cavity_, own);
    if (entity.kind != EntityKind::segment || !may_be_near(entity.id, own, q)) return refuse(entity, own);
    if (q != no_vertex && mesh_->vertex(q).home.kind() != EntityKind::vertex)
      demand.h = std::max(demand.h, double{mesh_->vertex(q).relaxed_radius});
  }
  if (options_->min_edge > 0 && insertion_radius<D>(*mesh_, cavity_) < options_->min_edge) {
    visit_->min_edge_hit = true;
    return refuse(entity, own);
  }
  cavity_.commit(pools_, Home(entity.kind, entity.id), rounded_down(std::max(r, demand.h)));
  committed();
  return Outcome::committed;
}

template <int D>
auto Refiner<D>::split_face(const Item& e, const Demand* cause) -> Outcome {
  const EntityRef entity{D == 3 ? EntityKind::facet : EntityKind::segment,
                         mesh_->constraints(e.cell)->face_entity[e.which()]};
  std::array<VertexId, D> own;
  for (int i = 0, n = 0; i <= D; ++i)
    if (i != e.which()) own[n++] = mesh_->cell(e.cell).vertices[i];
  if (cause && is_refused_as_before(e, *cause)) return Outcome::refused;
  const Point<D> x = face_point(e.cell, e.which());
  const auto status = cavity_.collect_on_face(x, e.cell, e.which());
  if (status == Cavity<D>::Status::not_owned) return give_up(Outcome::not_owned);
  if (status != Cavity<D>::Status::ok) return refuse(entity, own);
  if constexpr (D == 3) {
    auto edge = edge_beyond(x);
    if (!edge) edge = encroached_edge(x);
    const auto star = edge ? Cavity<D>::Status::ok : cavity_.make_star_shaped();
    if (star == Cavity<D>::Status::not_owned) return give_up(Outcome::not_owned);
    if (star != Cavity<D>::Status::ok) {
      const auto [beyond, around, owned] = walk_in_facet(e, x);
      if (!owned) return give_up(Outcome::not_owned);
      edge = beyond;
      const Item& from = around ? *around : e;
      cavity_.release();
      const auto again = cavity_.collect_on_face(x, from.cell, from.which());
      if (again == Cavity<D>::Status::not_owned) return give_up(Outcome::not_owned);
      if (again != Cavity<D>::Status::ok) return refuse(entity, own);
      if (!edge && around) edge = encroached_edge(x);
    }
    if (edge) {
      const Demand demand = cause ? *cause : demand_of(entity, own, true);
      cavity_.release();
      const Outcome outcome = split_edge(*edge, &demand);
      // The face is looked at again if the split left it as it was.
      if (outcome == Outcome::committed && !cause && alive(e)) visit_->list->push(e);
      if (outcome == Outcome::refused) {
        memo_.note_passed_on(e, *edge);
        seen_.push_back(e.cell);
      }
      return outcome;
    }
  }
  return decide(entity, own, cause);
}

/// A cell at the subsegment with a corner nearer than this to x on it; not counted are twins of `place`, if x is that. Such cells are
/// in the cavity of x, whatever else is, and are found long before that is collected. Ends where the claim does.
template <int D>
auto Refiner<D>::cell_near_edge(const Item& e, const Point<D>& x, double distance, const SplitPlace* place) const
    -> std::optional<CellId> {
  if constexpr (D == 3) {
    const EntityId s = mesh_->constraints(e.cell)->edge_entity[e.which()];
    int others[2], n = 0;
    for (int i = 0; i <= D; ++i)
      if (i != edge_ends[e.which()][0] && i != edge_ends[e.which()][1]) others[n++] = i;
    for (const int way : {0, 1}) {
      RidgeWalk<D> walk{e.cell, others[1 - way], others[way]};
      while (cavity_.owns(walk.cell)) {
        if (distance_to_corners(walk.cell, x, s, place) < distance) return walk.cell;
        if (!walk.link(*mesh_)) break;
        walk.step(*mesh_);
        if (walk.cell == e.cell) return {};
      }
    }
  }
  return {};
}

/// Of x on the segment from the nearest corner that is no twin of `place`.
template <int D>
double Refiner<D>::distance_to_corners(CellId c, const Point<D>& x, EntityId segment, const SplitPlace* place) const {
  double least = std::numeric_limits<double>::infinity();
  for (const VertexId v : mesh_->cell(c).vertices) {
    const double squared = squared_distance(mesh_->point(v), x);
    if constexpr (D == 3)
      if (place && squared < least && is_twin(*domain_, segment, *place, mesh_->vertex(v))) continue;
    least = std::min(least, squared);
  }
  return std::sqrt(least);
}

/// A subsegment whose point is too near to a corner of this cell of its cavity. These two cells decide that: whatever was
/// looked at before may change.
template <int D>
auto Refiner<D>::refuse_near(const Item& e, std::span<const VertexId> own, CellId near) -> Outcome {
  const Outcome outcome = refuse({EntityKind::segment, mesh_->constraints(e.cell)->edge_entity[e.which()]}, own);
  seen_.assign({e.cell, near});
  return outcome;
}

/// Of a subfacet that has asked for the split of a subsegment that is refused: that, and the cell with the vertex that is too near,
/// if that still holds.
template <int D>
auto Refiner<D>::refused_before(const Item& face, const Demand& cause) const -> std::optional<std::pair<Item, CellId>> {
  const auto edge = memo_.passed_on(*mesh_, face);
  if (!edge) return std::nullopt;
  const auto& v = mesh_->cell(edge->cell).vertices;
  const auto near = memo_.nearer_than(*mesh_, v[edge_ends[edge->which()][0]], v[edge_ends[edge->which()][1]], cause.d);
  return near ? std::optional(std::pair(*edge, near->cell)) : std::nullopt;
}

template <int D>
bool Refiner<D>::is_refused_as_before(const Item& face, const Demand& cause) {
  const auto known = refused_before(face, cause);
  if (!known) return false;
  const auto& [edge, near] = *known;
  const auto& v = mesh_->cell(edge.cell).vertices;
  refuse_near(edge, std::array{v[edge_ends[edge.which()][0]], v[edge_ends[edge.which()][1]]}, near);
  seen_.push_back(face.cell);
  return true;
}

template <int D>
auto Refiner<D>::split_edge(const Item& e, const Demand* cause) -> Outcome {
  if constexpr (D == 3) {
    const EntityId s = mesh_->constraints(e.cell)->edge_entity[e.which()];
    const auto& vertices = mesh_->cell(e.cell).vertices;
    const std::array<VertexId, 2> own{vertices[edge_ends[e.which()][0]], vertices[edge_ends[e.which()][1]]};
    bool owned = true;
    const auto beside_other = place_beside(e, own, owned);
    if (!owned) return give_up(Outcome::not_owned);
    const SplitPlace* place = beside_other ? &*beside_other : nullptr;
    const Point<D> x = place ? place->x : split_point(s, own[0], own[1]);
    const EntityRef entity{EntityKind::segment, s};
    const double least = cause ? cause->d : 0;
    if (const auto near = memo_.nearer_than(*mesh_, own[0], own[1], least); near && near->x == x) return refuse_near(e, own, near->cell);
    auto near = cause ? cell_near_edge(e, x, least, place) : std::nullopt;
    auto status = Cavity<D>::Status::too_near;
    if (!near) status = cavity_.collect_on_edge(x, e.cell, e.which(), least, place);
    if (status == Cavity<D>::Status::not_owned) return give_up(Outcome::not_owned);
    if (status == Cavity<D>::Status::too_near) {
      if (!near) near = cavity_.near_cell();
      memo_.note_near(own[0], own[1], {*near, mesh_->birth(*near), x, distance_to_corners(*near, x, s, place)});
      return refuse_near(e, own, *near);
    }
    if (status != Cavity<D>::Status::ok) return refuse(entity, own);
    return decide(entity, own, cause, place ? twins_of(s, *place) : std::vector<VertexId>{});
  } else {
    static_cast<void>(e);
    static_cast<void>(cause);
    return Outcome::refused;
  }
}

template class Refiner<2>;
template class Refiner<3>;

}  // namespace pgdr
