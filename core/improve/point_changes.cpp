// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "improve/point_changes.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <tuple>

#include "input/entities.hpp"
#include "refine/encroachment.hpp"
#include "refine/split_points.hpp"
#include "space/corner_means.hpp"

namespace pgdr {
namespace {

constexpr double margin = 1.0 / 64;  // of a subsegment: no point is nearer to its ends than that part of it

using Ridge = std::array<VertexId, 2>;

Ridge ridge_of(VertexId a, VertexId b) { return a < b ? Ridge{a, b} : Ridge{b, a}; }

/// Bits of the two corners.
unsigned ends_of_longest_edge(const Simplex<3>& s) {
  double longest = -1;
  unsigned ends = 0;
  for (int i = 0; i < 4; ++i)
    for (int j = i + 1; j < 4; ++j)
      if (const double length = squared_distance(s[i], s[j]); length > longest) {
        longest = length;
        ends = 1u << i | 1u << j;
      }
  return ends;
}

/// The edges of the subfacets that the collected point splits.
std::vector<Ridge> ridges_of_part(const Mesh<3>& mesh, const Cavity<3>& cavity) {
  std::vector<Ridge> ridges;
  for (const auto& f : cavity.part()) {
    const auto& v = mesh.cell(f.cell).vertices;
    for (int i = 0; i < 4; ++i)
      for (int j = i + 1; j < 4; ++j)
        if (i != f.face && j != f.face) ridges.push_back(ridge_of(v[i], v[j]));
  }
  std::sort(ridges.begin(), ridges.end());
  return ridges;
}

}  // namespace

void PointChanges::add_places_on_face(CellId c, int face, std::vector<Place>& places) const {
  const EntityId facet = w_->mesh.constraints(c)->face_entity[face];
  const Simplex<3> s = w_->mesh.simplex(c);
  const auto add = [&](const Point3& x) {
    places.push_back({w_->entry(c, EntryKind::face, face), point_on_facet(w_->domain, facet, x), Home(EntityKind::facet, facet)});
  };
  add(split_point_of_face(w_->context, c, face));
  add(detail::mean_of_corners<3>(s, 15u & ~(1u << face)));
  add(s[face]);
}

void PointChanges::add_places_on_edge(CellId c, int edge, std::vector<Place>& places) const {
  const EntityId segment = w_->mesh.constraints(c)->edge_entity[edge];
  const auto& v = w_->mesh.cell(c).vertices;
  const auto [from, to] = edge_ends[edge];
  const auto [t0, t1] = parameters_of(w_->context, segment, v[from], v[to]);
  const auto add = [&](double t) {
    places.push_back(
        {w_->entry(c, EntryKind::edge, edge), point_on_segment<3>(w_->domain, segment, t), Home(EntityKind::segment, segment)});
  };
  add((t0 + t1) / 2);
  for (int i = 0; i < 4; ++i) {
    if (i == from || i == to) continue;
    const double t = segment_parameter<3>(w_->domain, segment, w_->mesh.point(v[i]));
    if (t > t0 + margin * (t1 - t0) && t < t1 - margin * (t1 - t0)) add(t);
  }
}

/// Its circumcentre, and means of its corners; on its constrained faces the circumcentre, the centroid and the projection of
/// the corner opposite, on its subsegments the middle and the projections of the other corners; and the same on the entity that
/// its circumcentre encroaches upon.
auto PointChanges::places_for(CellId c) -> std::vector<Place> {
  std::vector<Place> places;
  const auto add = [&](const Point3& x) { places.push_back({w_->entry(c, EntryKind::cell, 0), x, Home(EntityKind::volume, 0)}); };
  Simplex<3> s = w_->mesh.simplex(c);
  add(circumsphere<3>(s).center);
  std::sort(s.begin(), s.end(), lex_less<3>);
  add(detail::mean_of_corners<3>(s, ends_of_longest_edge(s)));
  add(detail::mean_of_corners<3>(s, 15u));
  if (const auto* k = w_->mesh.constraints(c)) {
    for (int f = 0; f < 4; ++f)
      if (k->has_face(f)) add_places_on_face(c, f, places);
    for (int e = 0; e < 6; ++e)
      if (k->has_edge(e)) add_places_on_edge(c, e, places);
  }
  const Point3 center = places.front().x;
  const auto encroached = w_->cavity.collect(center, c) == Cavity<3>::Status::ok
                              ? encroached_entity<3>(w_->mesh, w_->cavity, w_->options, center)
                              : std::nullopt;
  if (encroached && encroached->kind() == EntryKind::face) add_places_on_face(encroached->cell, encroached->which(), places);
  if (encroached && encroached->kind() == EntryKind::edge) add_places_on_edge(encroached->cell, encroached->which(), places);
  return places;
}

/// Collects the star-shaped cavity of a point there, if it may go in.
auto PointChanges::collect_at(const Place& p) -> Cavity<3>::Status {
  using Status = Cavity<3>::Status;
  const auto collect = [&] {
    if (p.at.kind() == EntryKind::cell) return w_->cavity.collect(p.x, p.at.cell);
    if (p.at.kind() == EntryKind::face) return w_->cavity.collect_on_face(p.x, p.at.cell, p.at.which());
    return w_->cavity.collect_on_edge(p.x, p.at.cell, p.at.which());
  };
  w_->cavity.release();
  Status status = collect();
  if (status == Status::ok && p.at.kind() == EntryKind::face && edge_beyond<3>(w_->mesh, w_->domain, w_->cavity, p.x))
    return Status::not_star_shaped;
  return status == Status::ok ? w_->cavity.make_star_shaped() : status;
}

/// The element that the collected point makes with face n of the cavity's boundary.
Simplex<3> PointChanges::prospect(std::size_t n) const {
  const auto& f = w_->cavity.boundary()[n];
  Simplex<3> s = w_->mesh.simplex(f.cell);
  s[f.face] = w_->cavity.point();
  return s;
}

/// The amount by which the collected point lowers the excess.
double PointChanges::gain_of_collected() {
  double left = judge_->excess_of(w_->cavity.cells());
  for (std::size_t n = 0; n < w_->cavity.boundary().size() && left > 0; ++n)
    left -= judge_->excess_of(prospect(n), w_->mesh.region(w_->cavity.boundary()[n].cell));
  return left;
}

/// Would a small angle at its own corners explain that element n is poor, or that its face to a cell with this further corner
/// is not locally Delaunay?
bool PointChanges::is_explained(const Place& p, std::size_t n, VertexId further) {
  const auto& f = w_->cavity.boundary()[n];
  std::vector<Home> homes{p.home};
  for (int i = 0; i < 4; ++i)
    if (i != f.face) homes.push_back(w_->mesh.vertex(w_->mesh.cell(f.cell).vertices[i]).home);
  if (further != no_vertex) homes.push_back(w_->mesh.vertex(further).home);
  return judge_->is_explained(homes, prospect(n));
}

/// Would small angles explain all new elements that are poor: at their own corners, or else at those of the cavity?
bool PointChanges::poor_ones_are_explained(const Place& p) {
  std::vector<Home> homes;
  for (std::size_t n = 0; n < w_->cavity.boundary().size(); ++n) {
    if (!(judge_->excess_of(prospect(n), w_->mesh.region(w_->cavity.boundary()[n].cell)) > 0)) continue;
    if (is_explained(p, n, no_vertex)) continue;
    if (homes.empty()) homes = homes_of_cavity();
    if (!judge_->is_explained(homes, prospect(n))) return false;
  }
  return true;
}

/// The homes of the corners of the cavity that lie on entities, each once.
std::vector<Home> PointChanges::homes_of_cavity() const {
  std::vector<Home> homes;
  for (const CellId c : w_->cavity.cells())
    for (const VertexId v : w_->mesh.cell(c).vertices)
      if (const Home home = w_->mesh.vertex(v).home;
          home.kind() != EntityKind::volume && std::find(homes.begin(), homes.end(), home) == homes.end())
        homes.push_back(home);
  return homes;
}

/// Calls f(n, v) for each face that would not be locally Delaunay, of the n-th new element and one with the further vertex v,
/// until it says false: of the boundary, then those between new cells. Has it always said true?
template <class F>
bool PointChanges::all_new_violations(F f) const {
  const Point3& x = w_->cavity.point();
  struct NewFace {
    Ridge ridge;
    VertexId opposite;  // in its cell
    std::size_t cell;
    bool operator<(const NewFace& o) const { return std::tie(ridge, cell) < std::tie(o.ridge, o.cell); }
  };
  std::vector<NewFace> faces;
  const std::vector<Ridge> constrained = ridges_of_part(w_->mesh, w_->cavity);
  for (std::size_t n = 0; n < w_->cavity.boundary().size(); ++n) {
    const auto [c, face] = w_->cavity.boundary()[n];
    const Link out = w_->mesh.cell(c).links[face];
    const bool open = out && !w_->mesh.constrained(c, face);
    if (open && w_->mesh.conflicts(out.cell(), x) && in_sphere<3>(w_->mesh.simplex(out.cell()), x) == Sign::positive)
      if (!f(n, w_->mesh.cell(out.cell()).vertices[out.face()])) return false;
    const auto& v = w_->mesh.cell(c).vertices;
    for (int i = 0; i < 4; ++i)
      for (int j = i + 1; j < 4; ++j) {
        if (i == face || j == face) continue;
        const Ridge r = ridge_of(v[i], v[j]);
        if (!std::binary_search(constrained.begin(), constrained.end(), r)) faces.push_back({r, v[6 - face - i - j], n});
      }
  }
  std::sort(faces.begin(), faces.end());
  for (std::size_t i = 0; i + 1 < faces.size(); ++i) {
    if (faces[i].ridge != faces[i + 1].ridge) continue;
    if (in_sphere<3>(prospect(faces[i].cell), w_->mesh.point(faces[i + 1].opposite)) != Sign::positive) continue;
    if (!f(faces[i].cell, faces[i + 1].opposite)) return false;
  }
  return true;
}

/// Would all new violations be explained? `any`: are there any?
bool PointChanges::violations_are_explained(const Place& p, bool& any) {
  return all_new_violations([&](std::size_t n, VertexId further) { return any = true, is_explained(p, n, further); });
}

Outcome PointChanges::insert_to_improve(const Entry<3>& e) {
  using Status = Cavity<3>::Status;
  std::optional<Place> best;
  double most = least_gain;
  bool violates = false;
  for (const Place& p : places_for(e.cell)) {
    Status status = collect_at(p);
    if (status == Status::ok && gain_of_collected() > most) status = w_->cavity.keep_entities();
    if (status == Status::not_owned) return w_->give_up(Outcome::not_owned);
    if (status != Status::ok || insertion_radius<3>(w_->mesh, w_->cavity) < w_->options.min_edge) continue;
    const double gain = gain_of_collected();  // the check may have cut it back
    bool any = false;
    if (!(gain > most) || !poor_ones_are_explained(p) || !violations_are_explained(p, any)) continue;
    most = gain;
    best = p;
    violates = any;
  }
  if (!best) return w_->give_up(Outcome::refused);
  collect_at(*best);
  w_->cavity.keep_entities();
  w_->cavity.commit(w_->pools, best->home, rounded_down(insertion_radius<3>(w_->mesh, w_->cavity)));
  ++w_->visit->counts.committed;
  return flips_->finish(e, w_->cavity.new_cells(), violates);
}

}  // namespace pgdr
