// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "refine/element_splitter.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "numbers/finite.hpp"
#include "refine/encroachment.hpp"
#include "refine/numbers.hpp"
#include "refine/visibility.hpp"
#include "select/off_center.hpp"

namespace pgdr {

/// The bounds that the cell is over. What the entry says of them is not asked again: sizes may be slow functions.
template <int D>
CellVerdict ElementSplitter<D>::verdict_of(const Entry<D>& e, const FilterSphere<D>& sphere) const {
  const auto& bounds = w_->context.bounds;
  if (e.which() == Entry<D>::over_size) {
    const auto [low, high] = mesh_->squared_radius_bounds(sphere);
    const CellShape shape{shortest_edge_squared<D>(mesh_->simplex(e.cell)), low, high, 0, CellBounds<D>::infinity};
    return {bounds.over_radius_edge(*mesh_, e.cell, shape), std::max(e.order, std::uint32_t{1})};
  }
  if (e.which() == Entry<D>::over_radius_edge) return {true, 0};
  return bounds.test(*mesh_, e.cell);
}

template <int D>
Outcome ElementSplitter<D>::split(const Entry<D>& e) {
  if (const Outcome flat = repair_->remove_flat_cell(e.cell); flat != Outcome::refused) return flat;
  const FilterSphere<D> sphere = mesh_->sphere(e.cell);
  Candidate<D> c{e, verdict_of(e, sphere), sphere, {}, !w_->options.selector};
  if constexpr (D == 2) {
    if (c.verdict.over_size == 0 && e.which() != Entry<D>::not_delaunay) {
      const auto vertex = [&](int i) { return &mesh_->vertex(mesh_->cell(e.cell).vertices[i]); };
      w_->refused_by = small_angle_across(w_->domain, {vertex(0), vertex(1), vertex(2)}, w_->options.radius_edge_bound);
      if (w_->refused_by) {
        ++w_->visit->counts.refused;
        return Outcome::refused;
      }
    }
  }
  const Point<D> center = mesh_->is_accurate(sphere) ? sphere.center : circumsphere<D>(mesh_->simplex(e.cell)).center;
  c.x = center;
  further_.clear();
  if (w_->options.selector && c.verdict.over_radius_edge) {
    const auto selected = selected_point<D>(*w_, answers_, e, center, further_);
    if (!selected) return Outcome::not_owned;
    c.x = *selected;
  }
  if (!detail::is_finite(c.x)) {  // farther than doubles reach: of a flat cell, where coordinates are huge
    ++w_->visit->counts.refused;
    return w_->give_up(Outcome::refused);
  }
  // A cell beside a violation that no flip repairs has the demand of one of poor shape.
  if (e.which() == Entry<D>::not_delaunay) c.verdict.over_radius_edge = true;
  if (is_forced(c)) {
    w_->trace = {e.cell};
    w_->trace_alone = true;
    ++w_->visit->counts.refused;
    return Outcome::refused;
  }
  if (!further_.empty()) {
    const Demand demand = demand_of(c);
    if (!further_.look_ahead(e.cell, std::max(demand.d, demand.h))) return Outcome::not_owned;
    c.leads = true;
  }
  Outcome outcome = insert(c);
  c.leads = false;
  if (outcome == Outcome::refused && !(c.x == center) && detail::is_finite(center) && w_->alive(e)) {
    cavity_->release();
    c.x = center;
    outcome = insert(c);
  }
  return w_->give_up(outcome);
}

/// 3D: is the element poor in shape for its edges' lengths alone, and not for their relaxed lengths? Then the input forces it:
/// these edges are children of a small angle, and what is split for it would get edges no longer than they are.
template <int D>
bool ElementSplitter<D>::is_forced(const Candidate<D>& c) {
  if (D == 2 || c.entry.which() != Entry<D>::over_radius_edge) return false;
  return std::sqrt(mesh_->squared_radius_bounds(c.sphere).second) < w_->options.radius_edge_bound * demand_of(c).d;
}

/// Inserts the candidate, or splits the entity that blocks it.
template <int D>
Outcome ElementSplitter<D>::insert(const Candidate<D>& c) {
  const Obstacle obstacle = find_obstacle(c);
  const bool is_kept = obstacle.entity && w_->context.kept.any() && w_->context.kept.has(entity_of(*mesh_, *obstacle.entity));
  if (obstacle.entity && !is_kept) return split_instead(*obstacle.entity, c);
  Outcome outcome = obstacle.outcome;
  if (obstacle.entity)
    outcome = pass_by(*obstacle.entity, c);
  else if (outcome == Outcome::committed) {
    outcome = commit(c);
    if (outcome == Outcome::committed && c.leads) further_.insert();
  }
  // An entity that was refused in place of the element has been counted, if it was asked anew.
  w_->visit->counts.refused += outcome == Outcome::refused ? 1 : 0;
  return outcome;
}

/// Looks, while the cavity of x is collected for a poor element, for a face that x encroaches upon and that is known to be
/// refused, and stops once the cavity is large. (Beside small angles most elements that stay poor are behind such a face, which
/// is near to them. Small cavities are collected to their ends, as there may be something else to split.)
template <int D>
class ElementSplitter<D>::RefusedFace final : public Cavity<D>::FaceWatch {
 public:
  RefusedFace(const Workspace<D>& workspace, const EntitySplitter<D>& entities, const Point<D>& x, const Demand& cause)
      : w_(&workspace), entities_(&entities), x_(x), cause_(cause) {}
  bool stops_at(CellId c, int face) override {
    const Entry<D> f = w_->entry(c, EntryKind::face, face);
    if (!found_ && entities_->refused_before(f, cause_) && encroachment<D>(w_->mesh, c, face, x_) != Encroachment::none)
      found_ = f;
    return found_ && w_->cavity.cells().size() > numbers::refused_face_cells;
  }
  const std::optional<Entry<D>>& found() const { return found_; }  ///< the face

 private:
  const Workspace<D>* w_;
  const EntitySplitter<D>* entities_;
  Point<D> x_;
  Demand cause_;
  std::optional<Entry<D>> found_;
};

/// Collects the candidate's cavity on the way. The short cuts come first: a far point's wall, and a face that was refused before.
template <int D>
auto ElementSplitter<D>::find_obstacle(const Candidate<D>& c) -> Obstacle {
  if (const auto wall = wall_before_distant_point<D>(*w_, c.entry.cell, c.x)) return {wall};
  Status status;
  if (entities_->knows_refused_faces()) {
    RefusedFace refused(*w_, *entities_, c.x, demand_on_entity(c));
    status = cavity_->collect(c.x, c.entry.cell, &refused);
    if (status == Status::stopped) return {refused.found()};
  } else {
    status = cavity_->collect(c.x, c.entry.cell);
  }
  if (status == Status::not_owned) {
    // A point that a wall of the claim cuts off asks for no larger claim: the wall does.
    cavity_->release();
    return {wall_in_claim<D>(*w_, c.entry.cell, c.x), Outcome::not_owned};
  }
  if (status != Status::ok) return {{}, Outcome::refused};
  if (const auto encroached = encroached_entity<D>(w_->context, *cavity_, c.x)) return {encroached};
  return {wall_that_hides<D>(*w_, c.entry.cell, c.x)};
}

/// Where a kept entity hides the circumcentre of an element, or is encroached upon by it. 2D: the incentre of one that is too
/// big. 3D: of one over the bound of shape the off-centre (pgdr/selectors.hpp); of one that
/// is too big the centroid, or farther from the entity where that is a face of it.
template <int D>
std::optional<Point<D>> ElementSplitter<D>::place_inside(const Entry<D>& entity, const Candidate<D>& c) const {
  Simplex<D> s = mesh_->simplex(c.entry.cell);
  std::sort(s.begin(), s.end(), lex_less<D>);
  Point<D> x{};
  if constexpr (D == 2) {
    if (c.verdict.over_size == 0) return std::nullopt;
    double whole = 0;
    for (int i = 0; i <= D; ++i) {
      const double weight = std::sqrt(squared_distance(s[(i + 1) % 3], s[(i + 2) % 3]));
      for (int k = 0; k < D; ++k) x[k] += weight * (s[i][k] - s[0][k]);
      whole += weight;
    }
    for (int k = 0; k < D; ++k) x[k] = s[0][k] + x[k] / whole;
    return x;
  }
  if (!c.verdict.over_radius_edge) {
    x = centroid<D>(s);
    if (entity.cell == c.entry.cell && entity.kind() == EntryKind::face) {
      const Point<D>& apex = mesh_->point(mesh_->cell(c.entry.cell).vertices[entity.which()]);
      for (int k = 0; k < D; ++k) x[k] += (apex[k] - x[k]) / 4;
    }
    return x;
  }
  return detail::off_center_before<D>(s, c.sphere.center, w_->options.radius_edge_bound);
}

template <int D>
Outcome ElementSplitter<D>::insert_inside(const Entry<D>& entity, Candidate<D> c) {
  const auto place = place_inside(entity, c);
  if (!place || !detail::is_finite(*place)) return w_->give_up(Outcome::refused);
  c.x = *place;
  c.at_center = false;
  c.is_beside_kept = true;
  cavity_->release();
  const Status status = cavity_->collect(c.x, c.entry.cell);
  if (status == Status::not_owned) return Outcome::not_owned;
  const auto is_blocked = [&] {
    if (D == 2) return flattened_face<D>(w_->context, *cavity_, c.x).has_value();
    return encroached_entity<D>(w_->context, *cavity_, c.x) || wall_that_hides<D>(*w_, c.entry.cell, c.x);
  };
  if (status == Status::ok && !is_blocked())
    if (const Outcome outcome = commit(c); outcome != Outcome::refused) return outcome;
  return w_->give_up(Outcome::refused);
}

/// A kept entity hides the candidate, or is encroached upon.
template <int D>
Outcome ElementSplitter<D>::pass_by(const Entry<D>& entity, const Candidate<D>& c) {
  w_->refused_by = EntityPair{{entity_of(*mesh_, entity), {}}};
  return insert_inside(entity, c);
}

/// Splits the entity that hides the candidate, or that it encroaches upon, in its place.
template <int D>
Outcome ElementSplitter<D>::split_instead(const Entry<D>& entity, const Candidate<D>& c) {
  const Demand demand = demand_on_entity(c);
  cavity_->release();
  const Outcome outcome = entities_->split(entity, &demand);
  // The element is looked at again if the split left it as it was.
  if (outcome == Outcome::committed && w_->alive(c.entry)) lister_->relist_cell(c.entry);
  return outcome;
}

/// @pre nothing blocks the candidate, and its cavity is collected
template <int D>
auto ElementSplitter<D>::judge(const Candidate<D>& c) -> Judgement {
  Status status = cavity_->make_star_shaped();
  if (status == Status::ok && (cavity_->cut_back() || cavity_->touches_constraints())) status = cavity_->keep_entities();
  if (status != Status::ok) return {status == Status::not_owned ? Outcome::not_owned : Outcome::refused};
  // If the cavity was not cut back, the circumcentre's nearest vertices are the element's own; but not where rounding moves it,
  // even onto another vertex.
  const bool plain = c.at_center && !cavity_->cut_back() && mesh_->is_accurate(c.sphere);
  const double r = plain ? std::sqrt(mesh_->squared_radius_bounds(c.sphere).first) : insertion_radius<D>(*mesh_, *cavity_);
  if (r < w_->context.least_apart || inserter_->is_too_short(r)) return {Outcome::refused};
  // Among volume vertices r >= d holds by itself, but for bounds below one and elements that are not poor in shape.
  bool ordinary = plain && c.entry.which() != Entry<D>::not_delaunay && !w_->refused_by &&
                  (w_->options.radius_edge_bound >= 1 || !c.verdict.over_radius_edge);
  for (const VertexId v : mesh_->cell(c.entry.cell).vertices) ordinary = ordinary && w_->in_volume(v);
  Demand demand;
  if (!ordinary) {
    demand = demand_of(c);
    if ((plain ? insertion_radius<D>(*mesh_, *cavity_) : r) < demand.d) return {Outcome::refused};
  }
  return {Outcome::committed, std::max(r, demand.h)};
}

/// Inserts the collected candidate, if the insertion rule allows.
template <int D>
Outcome ElementSplitter<D>::commit(const Candidate<D>& c) {
  const Judgement judgement = judge(c);
  if (judgement.outcome != Outcome::committed) return judgement.outcome;
  return inserter_->commit(Home(EntityKind::volume, 0), judgement.relaxed_radius);
}

template <int D>
Demand ElementSplitter<D>::demand_of(const Candidate<D>& c) {
  double least = std::numeric_limits<double>::infinity();
  const auto& v = mesh_->cell(c.entry.cell).vertices;
  for (int i = 0; i <= D; ++i)
    for (int j = i + 1; j <= D; ++j)
      least = std::min(least, relaxed_length<D>(w_->domain, mesh_->vertex(v[i]), mesh_->vertex(v[j])));
  // Beside a kept face there is less room; the size bounds a quarter as well.
  const double part = D == 3 && c.is_beside_kept ? 4 : 2;
  if (!c.verdict.over_radius_edge) least = std::min(least, std::sqrt(mesh_->squared_radius_bounds(c.entry.cell).first) / part);
  // A smaller demand lets points come nearer than the element's edges are long, beside small angles or below the proved bound.
  // There a few such points, which inherit the radius, make elements good that would stay poor. In 3D it is for those alone that
  // stayed so.
  const bool is_halved = D == 2 || (w_->context.last_resort && may_halve_demand(c.entry.cell));
  if (is_halved) return {inherited_fraction * least, least};
  return {least, 0};
}

/// May the cell's demand be halved in the last resort, as that repairs more cells than it makes poor? Not where two of the
/// entities that the cell's corners, faces and edges lie on meet at a sharp angle. Not at an input vertex either, where others
/// may meet so, unless two of these meet at a small angle. (bench/notebook/small_angles.md)
template <int D>
bool ElementSplitter<D>::may_halve_demand(CellId c) {
  std::vector<EntityRef> entities;
  const auto add = [&entities](EntityRef e) {
    const bool known = std::find(entities.begin(), entities.end(), e) != entities.end();
    if (!known && (e.kind == EntityKind::segment || e.kind == EntityKind::facet)) entities.push_back(e);
  };
  bool at_input_vertex = false, small = false;
  for (const VertexId v : mesh_->cell(c).vertices) {
    const Home home = mesh_->vertex(v).home;
    at_input_vertex = at_input_vertex || home.kind() == EntityKind::vertex;
    add(home.entity());
  }
  if (const auto* k = mesh_->constraints(c)) {
    for (int f = 0; f <= D; ++f)
      if (k->has_face(f)) add(mesh_->entity_of_face(c, f));
    if constexpr (D == 3)
      for (int e = 0; e < 6; ++e)
        if (k->has_edge(e)) add({EntityKind::segment, k->edge_entity[e]});
  }
  for (std::size_t i = 0; i < entities.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      const double angle = w_->angles.between(entities[i], entities[j]);
      if (angle < numbers::sharp_degrees) return false;
      small = small || angle < small_angle;
    }
  return small || !at_input_vertex;
}

/// The demand on an entity that is split for the candidate. Below the smallest proved bound a midpoint may be nearer to its
/// neighbours than the element's edges are long, as beside a small angle.
template <int D>
Demand ElementSplitter<D>::demand_on_entity(const Candidate<D>& c) {
  const Demand demand = demand_of(c);
  if (demand.h > 0 || !c.verdict.over_radius_edge) return demand;
  if (w_->options.radius_edge_bound >= smallest_proved_bound<D>()) return demand;
  return {inherited_fraction * demand.d, demand.d};
}

template class ElementSplitter<2>;
template class ElementSplitter<3>;

}  // namespace pgdr
