// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Poor elements: where their point goes, what hides it, and why some stay poor.
#include <algorithm>
#include <cmath>

#include "numbers/vectors.hpp"
#include "refine/refiner.hpp"

namespace pgdr {
namespace {

/// Does the orthogonal projection of x to the hyperplane of the corners lie among them?
template <int D>
bool projects_into(const std::array<Point<D>, D>& corner, const Point<D>& x) {
  if constexpr (D == 2) {
    double along = 0, length = 0;
    for (int i = 0; i < D; ++i) {
      along += (x[i] - corner[0][i]) * (corner[1][i] - corner[0][i]);
      length += (corner[1][i] - corner[0][i]) * (corner[1][i] - corner[0][i]);
    }
    return along >= 0 && along <= length;
  } else {
    using detail::difference;
    const auto normal = detail::cross(difference(corner[1], corner[0]), difference(corner[2], corner[0]));
    for (int i = 0; i < 3; ++i)
      if (detail::dot(detail::cross(difference(corner[(i + 1) % 3], corner[i]), difference(x, corner[i])), normal) < 0)
        return false;
    return true;
  }
}

template <int D>
double longest_edge_squared(const Simplex<D>& s) {
  double longest = 0;
  for (int i = 0; i <= D; ++i)
    for (int j = 0; j < i; ++j) longest = std::max(longest, squared_distance(s[i], s[j]));
  return longest;
}

}  // namespace

template <int D>
auto Refiner<D>::demand_of_cell(CellId c, const CellVerdict& verdict) const -> Demand {
  double least = std::numeric_limits<double>::infinity();
  const auto& v = mesh_->cell(c).vertices;
  for (int i = 0; i <= D; ++i)
    for (int j = i + 1; j <= D; ++j) {
      const auto &a = mesh_->vertex(v[i]), &b = mesh_->vertex(v[j]);
      least = std::min(least, relaxed_length<D>(*domain_, a, b));
    }
  if (!verdict.over_radius_edge) least = std::min(least, std::sqrt(mesh_->squared_radius_bounds(c).first) / 2);
  // Without it a point may come nearer than the element's edges are long only beside a small angle or below the proved
  // bound. There a little of that, with the radius inherited, makes elements good that would stay poor; in 3D it is for those
  // alone that stayed so.
  const bool asks_for_less = D == 2 || (context_->last_resort && may_ask_for_less(c));
  if (asks_for_less) return {inherited_fraction * least, least};
  return {least, 0};
}

/// In the last resort: may less room mend more cells than it makes poor? Not where two of the entities that the cell's corners,
/// faces and edges lie on meet at a sharp angle, nor at an input vertex, where others may, unless two of these meet at a
/// small one. (docs/performance.md)
template <int D>
bool Refiner<D>::may_ask_for_less(CellId c) const {
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
      if (k->faces >> f & 1) add({D == 3 ? EntityKind::facet : EntityKind::segment, k->face_entity[f]});
    if constexpr (D == 3)
      for (int e = 0; e < 6; ++e)
        if (k->edges >> e & 1) add({EntityKind::segment, k->edge_entity[e]});
  }
  for (std::size_t i = 0; i < entities.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      if (meet_below(sharp_angle, entities[i], entities[j])) return false;
      small = small || meet_below(small_angle, entities[i], entities[j]);
    }
  return small || !at_input_vertex;
}

/// What it asks of an entity that is split for it. Below the smallest proved bound a midpoint may be nearer to its
/// neighbours than the element's edges are long, as beside a small angle.
template <int D>
auto Refiner<D>::demand_on_entity(CellId c, const CellVerdict& verdict) const -> Demand {
  const Demand demand = demand_of_cell(c, verdict);
  if (demand.h > 0 || !verdict.over_radius_edge) return demand;
  if (options_->radius_edge_bound >= smallest_proved_bound<D>()) return demand;
  return {inherited_fraction * demand.d, demand.d};
}

/// Does x encroach upon the constrained face, and does it project into it?
template <int D>
auto Refiner<D>::encroachment(CellId c, int face, const Point<D>& x) const -> Encroachment {
  std::array<Point<D>, D> corner;
  for (int i = 0, n = 0; i <= D; ++i)
    if (i != face) corner[n++] = mesh_->point(mesh_->cell(c).vertices[i]);
  bool inside;
  if constexpr (D == 2) {
    inside = in_diametral_ball<2>(corner[0], corner[1], x);
  } else {
    inside = in_equatorial_ball(equatorial_ball(corner[0], corner[1], corner[2]), x);
  }
  if (!inside) return Encroachment::none;
  return projects_into<D>(corner, x) ? Encroachment::before : Encroachment::beside;
}

/// A constrained face of the cavity's boundary in whose equatorial (diametral) ball x lies; one that x projects into, if
/// there is one (Projection Lemma 2.6).
template <int D>
auto Refiner<D>::encroached_face(const Point<D>& x) const -> std::optional<Item> {
  std::optional<Item> any;
  for (const auto& f : cavity_.boundary()) {
    if (!mesh_->constrained(f.cell, f.face)) continue;
    const Encroachment how = encroachment(f.cell, f.face, x);
    if (how == Encroachment::before) return make_entry(f.cell, EntryKind::face, f.face);
    if (how == Encroachment::beside && !any) any = make_entry(f.cell, EntryKind::face, f.face);
  }
  return any;
}

/// Looks, while the cavity of x is collected for a poor element, for a face that x encroaches upon and that is known to be refused,
/// and stops once the cavity is large. (Beside small angles most elements that stay poor are behind such a face, which is near to
/// them. Small cavities are collected to their ends, as there may be something else to split.)
template <int D>
class Refiner<D>::RefusedFace final : public Cavity<D>::FaceWatch {
 public:
  RefusedFace(const Refiner& refiner, const Point<D>& x, const Demand& cause) : refiner_(&refiner), x_(x), cause_(cause) {}
  bool stops_at(CellId c, int face) override {
    const Item f = refiner_->make_entry(c, EntryKind::face, face);
    if (!found_ && refiner_->refused_before(f, cause_) && refiner_->encroachment(c, face, x_) != Encroachment::none) found_ = f;
    return found_ && refiner_->cavity_.cells().size() > many_cells;
  }
  const Item& found() const { return *found_; }  ///< once it has stopped

 private:
  static constexpr std::size_t many_cells = 128;

  const Refiner* refiner_;
  Point<D> x_;
  Demand cause_;
  std::optional<Item> found_;
};

/// The constrained face that cuts x off from cell c, on a visibility walk through cells that `may_enter` allows; none if x
/// is reached or the walk leaves these before.
template <int D>
template <class MayEnter>
auto Refiner<D>::wall_before(CellId c, const Point<D>& x, MayEnter may_enter) const -> std::optional<Item> {
  const std::size_t most_steps = 256 + cavity_.cells().size();  // where cells are not Delaunay a walk can run in a circle
  int from = -1;
  for (std::size_t steps = 0; steps < most_steps && may_enter(c); ++steps) {
    const auto& k = mesh_->cell(c);
    seen_.push_back(c);
    int exit = -1, wall = -1;
    for (int i = 0; i <= D && exit < 0; ++i) {
      if (i == from) continue;
      Simplex<D> s = mesh_->simplex(c);
      s[i] = x;
      if (orient<D>(s) == Sign::positive) continue;
      (mesh_->constrained(c, i) ? wall : exit) = i;
    }
    if (exit < 0) return wall < 0 ? std::nullopt : std::optional(make_entry(c, EntryKind::face, wall));
    from = k.links[exit].face();
    c = k.links[exit].cell();
  }
  return std::nullopt;
}

/// That of the visit's claim.
template <int D>
auto Refiner<D>::wall_in_claim(CellId c, const Point<D>& x) const -> std::optional<Item> {
  return wall_before(c, x, [this](CellId k) { return cavity_.owns(k); });
}

/// Where the boundary is kept: a subsegment of the cavity's boundary with which x would make a triangle so flat that it has
/// an angle below the bound, whatever comes after. (A point that merely encroaches upon it does more good than harm.)
template <int D>
auto Refiner<D>::flattened_face(const Point<D>& x) const -> std::optional<Item> {
  if constexpr (D == 2) {
    // An angle at x above 180 degrees less twice the bound: cosine below -(1 - 2 sin^2).
    const double rho = options_->radius_edge_bound, limit = 1 - 1 / (2 * rho * rho);
    for (const auto& f : cavity_.boundary()) {
      if (!mesh_->constrained(f.cell, f.face)) continue;
      const auto& v = mesh_->cell(f.cell).vertices;
      const Point<D>&a = mesh_->point(v[(f.face + 1) % 3]), &b = mesh_->point(v[(f.face + 2) % 3]);
      const double product = (a[0] - x[0]) * (b[0] - x[0]) + (a[1] - x[1]) * (b[1] - x[1]);
      const double cosine = product / std::sqrt(squared_distance(a, x) * squared_distance(b, x));
      if (!(cosine >= -limit)) return make_entry(f.cell, EntryKind::face, f.face);
    }
  }
  return std::nullopt;
}

/// Where the boundary is kept: the incentre of an element too big whose circumcentre the boundary hides.
template <int D>
auto Refiner<D>::insert_inside(const Item& e, const CellVerdict& verdict) -> Outcome {
  if constexpr (D == 2) {
    Simplex<D> s = mesh_->simplex(e.cell);
    std::sort(s.begin(), s.end(), lex_less<D>);
    Point<D> x{};
    double whole = 0;
    for (int i = 0; i <= D; ++i) {
      const double weight = std::sqrt(squared_distance(s[(i + 1) % 3], s[(i + 2) % 3]));
      for (int k = 0; k < D; ++k) x[k] += weight * (s[i][k] - s[0][k]);
      whole += weight;
    }
    for (int k = 0; k < D; ++k) x[k] = s[0][k] + x[k] / whole;
    cavity_.release();
    const auto status = cavity_.collect(x, e.cell);
    if (status == Cavity<D>::Status::not_owned) return Outcome::not_owned;
    if (status == Cavity<D>::Status::ok && !flattened_face(x))
      if (const Outcome outcome = insert_point(e, verdict, false); outcome != Outcome::refused) return outcome;
  }
  return give_up(Outcome::refused);
}

/// An entity that the collected point encroaches upon.
template <int D>
auto Refiner<D>::encroached_entity(const Point<D>& x) const -> std::optional<Item> {
  if (!cavity_.touches_constraints()) return std::nullopt;
  if (auto edge = encroached_edge(x)) return edge;
  return options_->keep_boundary ? flattened_face(x) : encroached_face(x);
}

/// The wall beyond which the collected point of cell c lies. The cavity cannot be star-shaped about it then, and what is left
/// of it is of no use.
template <int D>
auto Refiner<D>::hiding_wall(CellId c, const Point<D>& x) -> std::optional<Item> {
  if (!cavity_.touches_constraints() || cavity_.surely_star_shaped()) return std::nullopt;
  return wall_before(c, x, [this](CellId k) { return mesh_->marked(k); });
}

/// Splits the entity that hides the element's point, or that the point encroaches upon, in its place.
template <int D>
auto Refiner<D>::split_instead(const Item& entity, const Item& e, const CellVerdict& verdict) -> Outcome {
  if (options_->keep_boundary) {
    last_refusal_ = EntityPair{{EntityRef{EntityKind::segment, mesh_->constraints(entity.cell)->face_entity[entity.which()]}, {}}};
    return verdict.over_size > 0 ? insert_inside(e, verdict) : Outcome::refused;
  }
  const Demand demand = demand_on_entity(e.cell, verdict);
  cavity_.release();
  const Outcome outcome = entity.kind() == EntryKind::edge ? split_edge(entity, &demand) : split_face(entity, &demand);
  // The element is looked at again if the split left it as it was.
  if (outcome == Outcome::committed && alive(e)) list_again(e);
  return outcome;
}

/// Of the element treated, which is asked for it several times.
template <int D>
FilterSphere<D> Refiner<D>::sphere_of(const Item& e) const {
  if constexpr (D == 3) {
    return mesh_->sphere(e.cell);
  } else {
    if (last_sphere_.cell != e.cell || last_sphere_.birth != e.birth) last_sphere_ = {e.cell, e.birth, mesh_->sphere(e.cell)};
    return last_sphere_.sphere;
  }
}

/// As much of it as is not known from why the cell is listed: sizes may be slow functions.
template <int D>
CellVerdict Refiner<D>::verdict_of(const Item& e) const {
  const auto& bounds = context_->bounds;
  if (e.which() == Item::over_size) {
    const auto [low, high] = mesh_->squared_radius_bounds(sphere_of(e));
    const CellShape shape{shortest_edge_squared<D>(mesh_->simplex(e.cell)), low, high, 0, CellBounds<D>::infinity};
    return {bounds.over_radius_edge(*mesh_, e.cell, shape), std::max(e.order, std::uint32_t{1})};
  }
  if (e.which() == Item::over_radius_edge) return {true, 0};
  return bounds.test(*mesh_, e.cell);
}

template <int D>
auto Refiner<D>::treat_cell(const Item& e) -> Outcome {
  const CellId c = e.cell;
  if (const auto outcome = flips_.take_off_flat(pools_, c); outcome != LocalFlips<D>::Outcome::stuck) {
    if (outcome == LocalFlips<D>::Outcome::not_owned) return Outcome::not_owned;
    flipped();
    return Outcome::committed;
  }
  CellVerdict verdict = verdict_of(e);
  if constexpr (D == 2) {
    if (verdict.over_size == 0 && e.which() != Item::not_delaunay) {
      const auto vertex = [&](int i) { return &mesh_->vertex(mesh_->cell(e.cell).vertices[i]); };
      last_refusal_ = small_angle_across(*domain_, {vertex(0), vertex(1), vertex(2)}, options_->radius_edge_bound);
      if (last_refusal_) {
        ++visit_->counts.refused;
        return Outcome::refused;
      }
    }
  }
  const FilterSphere<D> sphere = sphere_of(e);
  const Point<D> center = mesh_->is_accurate(sphere) ? sphere.center : circumsphere<D>(mesh_->simplex(c)).center;
  std::optional<Point<D>> x = center;
  if (options_->selector && verdict.over_radius_edge) x = selected_point(c, center);
  if (!x) return Outcome::not_owned;
  // A cell with a face that no flip makes locally Delaunay asks for as much as one with a poor shape.
  if (e.which() == Item::not_delaunay) verdict.over_radius_edge = true;
  Outcome outcome = treat_cell_at(e, *x, verdict);
  if (outcome == Outcome::refused && !(*x == center) && alive(e)) {
    cavity_.release();
    outcome = treat_cell_at(e, center, verdict);
  }
  if (outcome == Outcome::refused) ++visit_->counts.refused;
  return give_up(outcome);
}

/// 3D: the wall that hides the point of an element so flat that it lies many times the domain, or the element's longest edge, away.
/// Where facets are nearly coplanar other flat ones are in conflict with it, often thousands. They are not collected for the entity
/// that it encroaches upon, if any: mostly there is none, and the wall is split in the end.
template <int D>
auto Refiner<D>::wall_before_far_point(CellId c, const Point<D>& x) -> std::optional<Item> {
  if constexpr (D == 2) return std::nullopt;
  constexpr int far = 12;  // powers of two: nearer ones often encroach upon flat subfacets, whose splits leave fewer poor cells
  constexpr double far_for_its_edges = 128;
  const double away = std::ldexp(1.0, context_->base_exponent + far);
  const double squared = squared_distance(mesh_->point(mesh_->cell(c).vertices[0]), x);
  const double edges = far_for_its_edges * far_for_its_edges * longest_edge_squared<D>(mesh_->simplex(c));
  if (!(squared > std::min(away * away, edges))) return std::nullopt;
  cavity_.release();
  return wall_in_claim(c, x);
}

/// Inserts x for the element, or splits the entity that it encroaches upon or that hides it.
template <int D>
auto Refiner<D>::treat_cell_at(const Item& e, const Point<D>& x, const CellVerdict& verdict) -> Outcome {
  if (const auto wall = wall_before_far_point(e.cell, x)) return split_instead(*wall, e, verdict);
  typename Cavity<D>::Status status;
  if (memo_.knows_faces()) {
    RefusedFace refused(*this, x, demand_on_entity(e.cell, verdict));
    status = cavity_.collect(x, e.cell, &refused);
    if (status == Cavity<D>::Status::stopped) return split_instead(refused.found(), e, verdict);
  } else {
    status = cavity_.collect(x, e.cell);
  }
  if (status == Cavity<D>::Status::not_owned) {
    // A point that a wall of the claim cuts off asks for no larger claim: the wall does.
    cavity_.release();
    const auto wall = wall_in_claim(e.cell, x);
    return wall ? split_instead(*wall, e, verdict) : Outcome::not_owned;
  }
  if (status != Cavity<D>::Status::ok) return Outcome::refused;
  if (const auto encroached = encroached_entity(x)) return split_instead(*encroached, e, verdict);
  if (const auto wall = hiding_wall(e.cell, x)) return split_instead(*wall, e, verdict);
  return insert_point(e, verdict);
}

/// The collected point, if the insertion rule allows. `at_center`: it is the circumcentre, where there is no selector.
template <int D>
auto Refiner<D>::insert_point(const Item& e, const CellVerdict& verdict, bool at_center) -> Outcome {
  using Status = typename Cavity<D>::Status;
  auto status = cavity_.make_star_shaped();
  if (status == Status::ok && (cavity_.shrunk() || cavity_.touches_constraints())) status = cavity_.check_nothing_swallowed();
  if (status != Status::ok) return status == Status::not_owned ? Outcome::not_owned : Outcome::refused;

  // Unshrunk, the circumcentre's nearest vertices are the element's own; but not where rounding moves it, even onto another vertex.
  const FilterSphere<D> sphere = sphere_of(e);
  const bool plain = at_center && !cavity_.shrunk() && !options_->selector && mesh_->is_accurate(sphere);
  const double r = plain ? std::sqrt(mesh_->squared_radius_bounds(sphere).first) : insertion_radius<D>(*mesh_, cavity_);
  if (r < options_->min_edge) {
    visit_->min_edge_hit = true;
    return Outcome::refused;
  }
  // Among volume vertices r >= d holds by itself, but for bounds below one and elements that are not poor in shape.
  bool ordinary = plain && e.which() != Item::not_delaunay && !last_refusal_ && (options_->radius_edge_bound >= 1 || !verdict.over_radius_edge);
  for (const VertexId v : mesh_->cell(e.cell).vertices) ordinary = ordinary && mesh_->vertex(v).home.kind() == EntityKind::volume;
  Demand demand;
  if (!ordinary) {
    demand = demand_of_cell(e.cell, verdict);
    if ((plain ? insertion_radius<D>(*mesh_, cavity_) : r) < demand.d) return Outcome::refused;
  }
  cavity_.commit(pools_, Home(EntityKind::volume, 0), rounded_down(std::max(r, demand.h)));
  committed();
  return Outcome::committed;
}

template class Refiner<2>;
template class Refiner<3>;

}  // namespace pgdr
