// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The last visits of a run, in 3D: vertices are taken out and moved (improve/vertex_moves.cpp), faces and edges flipped
// (improve/flips.cpp), and points put in for elements that stay poor, wherever that leaves fewer of these, or better ones.
//
// Let the excess of an element be 0 within its bounds, else at least 1 and at most 3.5 (CellBounds::excess). Anything is done
// only if the elements that it makes have less excess than those that they take the place of, by at least 1/128; but a vertex
// is taken out if they have no more, and faces are flipped if they have no more and fewer faces are not locally Delaunay. All
// in all there is at most 3.5 for each poor element when these visits begin, so that they insert at most 448 points for each;
// they take out no more vertices than there were and come; and after each of these changes there are finitely many flips. No
// room is asked for, as nothing else follows from such a point: entities that it encroaches upon are left as they are.
//
// What is new is explained as the rest is: a new element that is poor, and a new face that is not locally Delaunay, is allowed
// only beside two entities that meet at a small angle and touch its own corners, so that no later point can take that away.
#include <algorithm>
#include <array>
#include <tuple>

#include "improve/improvement.hpp"
#include "input/entities.hpp"
#include "refine/refiner.hpp"
#include "space/corner_means.hpp"

namespace pgdr {
namespace {

constexpr double margin = 1.0 / 64;  // of a subsegment: no point is nearer to its ends than that part of it

using Ridge = std::array<VertexId, 2>;

Ridge ridge_of(VertexId a, VertexId b) { return a < b ? Ridge{a, b} : Ridge{b, a}; }

/// Bits of the two corners.
template <int D>
unsigned ends_of_longest_edge(const Simplex<D>& s) {
  double longest = -1;
  unsigned ends = 0;
  for (int i = 0; i <= D; ++i)
    for (int j = i + 1; j <= D; ++j)
      if (const double length = squared_distance(s[i], s[j]); length > longest) {
        longest = length;
        ends = 1u << i | 1u << j;
      }
  return ends;
}

/// The edges of the subfacets that the collected point splits.
template <int D>
std::vector<Ridge> ridges_of_part(const Mesh<D>& mesh, const Cavity<D>& cavity) {
  std::vector<Ridge> ridges;
  for (const auto& f : cavity.part()) {
    const auto& v = mesh.cell(f.cell).vertices;
    for (int i = 0; i <= D; ++i)
      for (int j = i + 1; j <= D; ++j)
        if (i != f.face && j != f.face) ridges.push_back(ridge_of(v[i], v[j]));
  }
  std::sort(ridges.begin(), ridges.end());
  return ridges;
}

}  // namespace

template <int D>
void Refiner<D>::add_places_on_face(CellId c, int face, std::vector<Place>& places) const {
  const EntityId facet = mesh_->constraints(c)->face_entity[face];
  const Simplex<D> s = mesh_->simplex(c);
  const auto add = [&](const Point<D>& x) {
    places.push_back({make_entry(c, EntryKind::face, face), point_on_facet(*domain_, facet, x), Home(EntityKind::facet, facet)});
  };
  add(face_point(c, face));
  add(detail::mean_of_corners<D>(s, 15u & ~(1u << face)));
  add(s[face]);
}

template <int D>
void Refiner<D>::add_places_on_edge(CellId c, int edge, std::vector<Place>& places) const {
  const EntityId segment = mesh_->constraints(c)->edge_entity[edge];
  const auto& v = mesh_->cell(c).vertices;
  const auto [from, to] = edge_ends[edge];
  const auto [t0, t1] = piece(segment, v[from], v[to]);
  const auto add = [&](double t) {
    places.push_back({make_entry(c, EntryKind::edge, edge), point_on_segment<D>(*domain_, segment, t), Home(EntityKind::segment, segment)});
  };
  add((t0 + t1) / 2);
  for (int i = 0; i <= D; ++i) {
    if (i == from || i == to) continue;
    const double t = segment_parameter<D>(*domain_, segment, mesh_->point(v[i]));
    if (t > t0 + margin * (t1 - t0) && t < t1 - margin * (t1 - t0)) add(t);
  }
}

/// Its circumcentre, and means of its corners; on its constrained faces the circumcentre, the centroid and the projection of
/// the corner opposite, on its subsegments the middle and the projections of the other corners; and the same on the entity that
/// its circumcentre encroaches upon.
template <int D>
auto Refiner<D>::places_for(CellId c) -> std::vector<Place> {
  std::vector<Place> places;
  const auto add = [&](const Point<D>& x) { places.push_back({make_entry(c, EntryKind::cell, 0), x, Home(EntityKind::volume, 0)}); };
  Simplex<D> s = mesh_->simplex(c);
  add(circumsphere<D>(s).center);
  std::sort(s.begin(), s.end(), lex_less<D>);
  add(detail::mean_of_corners<D>(s, ends_of_longest_edge<D>(s)));
  add(detail::mean_of_corners<D>(s, (2u << D) - 1));
  if (const auto* k = mesh_->constraints(c)) {
    for (int f = 0; f <= D; ++f)
      if (k->faces >> f & 1) add_places_on_face(c, f, places);
    for (int e = 0; e < 6; ++e)
      if (k->edges >> e & 1) add_places_on_edge(c, e, places);
  }
  const Point<D> center = places.front().x;
  const auto encroached = cavity_.collect(center, c) == Cavity<D>::Status::ok ? encroached_entity(center) : std::nullopt;
  if (encroached && encroached->kind() == EntryKind::face) add_places_on_face(encroached->cell, encroached->which(), places);
  if (encroached && encroached->kind() == EntryKind::edge) add_places_on_edge(encroached->cell, encroached->which(), places);
  return places;
}

/// Collects the star-shaped cavity of a point there, if it may go in.
template <int D>
auto Refiner<D>::collect_at(const Place& p) -> typename Cavity<D>::Status {
  using Status = typename Cavity<D>::Status;
  const auto collect = [&] {
    if (p.at.kind() == EntryKind::cell) return cavity_.collect(p.x, p.at.cell);
    if (p.at.kind() == EntryKind::face) return cavity_.collect_on_face(p.x, p.at.cell, p.at.which());
    return cavity_.collect_on_edge(p.x, p.at.cell, p.at.which());
  };
  cavity_.release();
  Status status = collect();
  if (status == Status::ok && p.at.kind() == EntryKind::face && edge_beyond(p.x)) return Status::not_star_shaped;
  return status == Status::ok ? cavity_.make_star_shaped() : status;
}

/// The element that the collected point makes with face n of the cavity's boundary.
template <int D>
Simplex<D> Refiner<D>::prospect(std::size_t n) const {
  const auto& f = cavity_.boundary()[n];
  Simplex<D> s = mesh_->simplex(f.cell);
  s[f.face] = cavity_.point();
  return s;
}

/// By how much the collected point makes the excess less; nothing if it does not.
template <int D>
double Refiner<D>::gain_of_collected() const {
  double left = excess_of(cavity_.cells());
  for (std::size_t n = 0; n < cavity_.boundary().size() && left > 0; ++n)
    left -= context_->bounds.excess(prospect(n), mesh_->region(cavity_.boundary()[n].cell));
  return left;
}

/// Would a small angle at its own corners explain that element n is poor, or that its face to a cell with this further corner
/// is not locally Delaunay?
template <int D>
bool Refiner<D>::is_explained(const Place& p, std::size_t n, VertexId further) const {
  const auto& f = cavity_.boundary()[n];
  std::vector<Home> homes{p.home};
  for (int i = 0; i <= D; ++i)
    if (i != f.face) homes.push_back(mesh_->vertex(mesh_->cell(f.cell).vertices[i]).home);
  if (further != no_vertex) homes.push_back(mesh_->vertex(further).home);
  return is_explained(homes, prospect(n));
}

/// Would small angles explain all new elements that are poor: at their own corners, or else at those of the cavity?
template <int D>
bool Refiner<D>::poor_ones_are_explained(const Place& p) const {
  std::vector<Home> homes;
  for (std::size_t n = 0; n < cavity_.boundary().size(); ++n) {
    if (!(context_->bounds.excess(prospect(n), mesh_->region(cavity_.boundary()[n].cell)) > 0)) continue;
    if (is_explained(p, n, no_vertex)) continue;
    if (homes.empty()) homes = homes_of_cavity();
    if (!is_explained(homes, prospect(n))) return false;
  }
  return true;
}

/// Of its corners on entities, each once.
template <int D>
std::vector<Home> Refiner<D>::homes_of_cavity() const {
  std::vector<Home> homes;
  for (const CellId c : cavity_.cells())
    for (const VertexId v : mesh_->cell(c).vertices)
      if (const Home home = mesh_->vertex(v).home; home.kind() != EntityKind::volume && std::find(homes.begin(), homes.end(), home) == homes.end())
        homes.push_back(home);
  return homes;
}

/// Calls f(n, v) for each face that would not be locally Delaunay, of the n-th new element and one with the further vertex v,
/// until it says false: of the boundary, then those between new cells. Has it always said true?
template <int D>
template <class F>
bool Refiner<D>::all_new_violations(F f) const {
  const Point<D>& x = cavity_.point();
  struct NewFace {
    Ridge ridge;
    VertexId opposite;  // in its cell
    std::size_t cell;
    bool operator<(const NewFace& o) const { return std::tie(ridge, cell) < std::tie(o.ridge, o.cell); }
  };
  std::vector<NewFace> faces;
  const std::vector<Ridge> constrained = ridges_of_part(*mesh_, cavity_);
  for (std::size_t n = 0; n < cavity_.boundary().size(); ++n) {
    const auto [c, face] = cavity_.boundary()[n];
    const Link out = mesh_->cell(c).links[face];
    const bool open = out && !mesh_->constrained(c, face);
    if (open && mesh_->conflicts(out.cell(), x) && in_sphere<D>(mesh_->simplex(out.cell()), x) == Sign::positive)
      if (!f(n, mesh_->cell(out.cell()).vertices[out.face()])) return false;
    const auto& v = mesh_->cell(c).vertices;
    for (int i = 0; i <= D; ++i)
      for (int j = i + 1; j <= D; ++j) {
        if (i == face || j == face) continue;
        const Ridge r = ridge_of(v[i], v[j]);
        if (!std::binary_search(constrained.begin(), constrained.end(), r)) faces.push_back({r, v[6 - face - i - j], n});
      }
  }
  std::sort(faces.begin(), faces.end());
  for (std::size_t i = 0; i + 1 < faces.size(); ++i) {
    if (faces[i].ridge != faces[i + 1].ridge) continue;
    if (in_sphere<D>(prospect(faces[i].cell), mesh_->point(faces[i + 1].opposite)) != Sign::positive) continue;
    if (!f(faces[i].cell, faces[i + 1].opposite)) return false;
  }
  return true;
}

/// The same of the faces that would not be locally Delaunay. `any`: are there any?
template <int D>
bool Refiner<D>::violations_are_explained(const Place& p, bool& any) const {
  return all_new_violations([&](std::size_t n, VertexId further) { return any = true, is_explained(p, n, further); });
}

/// Inserts the point that lessens the excess most, the first of those that do.
template <int D>
auto Refiner<D>::insert_for_less(const Item& e) -> Outcome {
  using Status = typename Cavity<D>::Status;
  std::optional<Place> best;
  double most = least_gain;
  bool violates = false;
  for (const Place& p : places_for(e.cell)) {
    Status status = collect_at(p);
    if (status == Status::ok && gain_of_collected() > most) status = cavity_.check_nothing_swallowed();
    if (status == Status::not_owned) return give_up(Outcome::not_owned);
    if (status != Status::ok || insertion_radius<D>(*mesh_, cavity_) < options_->min_edge) continue;
    const double gain = gain_of_collected();  // the check may have cut it back
    bool any = false;
    if (!(gain > most) || !poor_ones_are_explained(p) || !violations_are_explained(p, any)) continue;
    most = gain;
    best = p;
    violates = any;
  }
  if (!best) return give_up(Outcome::refused);
  collect_at(*best);
  cavity_.check_nothing_swallowed();
  cavity_.commit(pools_, best->home, rounded_down(insertion_radius<D>(*mesh_, cavity_)));
  ++visit_->counts.committed;
  return note_change(e, cavity_.new_cells(), violates);
}

/// It is asked for the same cells again and again.
template <int D>
double Refiner<D>::excess_of(CellId c) const {
  KnownExcess& known = known_excess_[index(c) % known_excess_.size()];
  if (known.cell != c || known.birth != mesh_->birth(c)) {
    const bool poor = static_cast<bool>(context_->bounds.test(*mesh_, c));
    known = {c, mesh_->birth(c), poor ? context_->bounds.excess(mesh_->simplex(c), mesh_->region(c)) : 0};
  }
  return known.value;
}

template <int D>
double Refiner<D>::excess_of(const std::vector<CellId>& cells) const {
  double sum = 0;
  for (const CellId c : cells) sum += excess_of(c);
  return sum;
}

/// Would small angles between entities with these homes explain that it is poor, or that a face of it is not locally Delaunay?
template <int D>
bool Refiner<D>::is_explained(const std::vector<Home>& homes, const Simplex<D>& s) const {
  const auto sphere = circumsphere<D>(s);
  return context_->improvement->reasons.has_reason(homes, {sphere.center, sphere.squared_radius},
                                                   [this](EntityRef a, EntityRef b) { return angle_between(a, b); });
}

/// Lists what is poor after a change made for e. `violates`: is a new face not locally Delaunay?
template <int D>
auto Refiner<D>::note_change(const Item& e, std::vector<CellId> new_cells, bool violates) -> Outcome {
  if (violates) flip_to_delaunay(new_cells);
  ++visit_->counts.improved;
  visit_->changed_mesh = true;
  visit_->violations_seen = visit_->violations_seen || violates;
  for (const CellId c : new_cells) {
    for (const VertexId v : mesh_->cell(c).vertices) ++mesh_->note(v).version;
    list_if_poor(c);
  }
  if (alive(e)) list_again(e);  // the change was beside it
  return Outcome::committed;
}

/// Does something for an element that stays poor, if there is anything to be done.
template <int D>
auto Refiner<D>::improve(const Item& e) -> Outcome {
  Outcome outcome = change_vertex(e, VertexChange::take_out);
  if (!context_->improvement->takes_out_alone) {
    if (outcome == Outcome::refused) outcome = flip_for_less(e);
    if (outcome == Outcome::refused) outcome = change_vertex(e, VertexChange::move);
    if (outcome == Outcome::refused) outcome = insert_for_less(e);
  }
  visit_->counts.refused += outcome == Outcome::refused;
  return outcome;
}

template class Refiner<3>;  // nothing of this in 2D

}  // namespace pgdr
