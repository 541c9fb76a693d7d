// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Points for elements that stay poor although no small angle of the input explains it.
#include <algorithm>
#include <cmath>
#include <limits>

#include "detail/corner_means.hpp"
#include "detail/entity_distance.hpp"
#include "pgdr/refiner.hpp"

namespace pgdr {

/// From x to the nearest constrained face of the collected cavity.
template <int D>
double Refiner<D>::squared_distance_to_walls(const Point<D>& x) const {
  double least = std::numeric_limits<double>::infinity();
  for (const auto& f : cavity_.boundary()) {
    if (!mesh_->constrained(f.cell, f.face)) continue;
    const Simplex<D> s = mesh_->simplex(f.cell);
    const auto corner = [&](int i) { return s[(f.face + i) % (D + 1)]; };
    if constexpr (D == 2) {
      least = std::min(least, detail::squared_distance_to_edge<2>(corner(1), corner(2), x));
    } else {
      least = std::min(least, detail::squared_distance_to_triangle(corner(1), corner(2), corner(3), x));
    }
  }
  return least;
}

/// Collects the cavity of x. Its distance from vertices there, or twice that from walls, if that is less (half way between two
/// of them there is as much room as they are apart); 0 if x may not go in.
template <int D>
double Refiner<D>::room_for(const Point<D>& x, CellId c) {
  using Status = typename Cavity<D>::Status;
  cavity_.release();
  if (cavity_.collect(x, c) != Status::ok || cavity_.make_star_shaped() != Status::ok) return 0;
  if (cavity_.check_nothing_swallowed() != Status::ok) return 0;
  return std::min(insertion_radius<D>(*mesh_, cavity_), 2 * std::sqrt(squared_distance_to_walls(x)));
}

/// Inserts the midpoint of an edge, or the centroid of a face or of the element, that has the most room.
template <int D>
bool Refiner<D>::insert_mean_of_corners(const Item& e, const CellVerdict& verdict) {
  const Demand demand = demand_of_cell(e.cell, verdict);
  double most = 0;
  Point<D> best{};
  for (const Point<D>& x : detail::means_of_corners<D>(mesh_->simplex(e.cell))) {
    const double room = room_for(x, e.cell);
    if (room <= most) continue;
    most = room;
    best = x;
  }
  if (!(most > 0) || most < demand.d || most < options_->min_edge) return false;
  room_for(best, e.cell);
  const double r = insertion_radius<D>(*mesh_, cavity_);
  cavity_.commit(pools_, Home(EntityKind::volume, 0), rounded_down(std::max(r, demand.h)));
  committed();
  return true;
}

/// Faces of the collected cavity, its boundary too, that are not locally Delaunay, which nothing excuses.
template <int D>
int Refiner<D>::unexcused_in_cavity() const {
  int twice = 0;
  for (const CellId c : cavity_.cells())
    for (int f = 0; f <= D; ++f) {
      if (!flips_.violates(c, f)) continue;
      const auto& v = mesh_->cell(c).vertices;
      const Link next = mesh_->cell(c).links[f];
      if (excuses(mesh_->cell(next.cell()).vertices[next.face()])) continue;
      if (std::any_of(v.begin(), v.end(), [this](VertexId x) { return excuses(x); })) continue;
      twice += mesh_->marked(next.cell()) ? 1 : 2;
    }
  return twice / 2;
}

/// 3D: how many fewer there would be with the collected point.
template <int D>
int Refiner<D>::fewer_unexcused() const {
  if constexpr (D == 3) return unexcused_in_cavity() - unexcused_after();
  return 0;
}

/// 3D: puts a point into one of the two cells at such a face so that fewer of them are left, the fewest that any does.
template <int D>
bool Refiner<D>::insert_for_fewer_violations(const Item& e) {
  std::vector<CellId> cells{e.cell};
  for (int f = 0; f <= D; ++f)
    if (flips_.violates(e.cell, f)) cells.push_back(mesh_->cell(e.cell).links[f].cell());
  const Demand demand = demand_of_cell(e.cell, CellVerdict{true, 0});
  int best_gain = 0;
  double most_room = 0;
  Point<D> best{};
  CellId at = e.cell;
  for (const CellId c : cells) {
    std::vector<Point<D>> places = detail::means_of_corners<D>(mesh_->simplex(c));
    places.push_back(circumsphere<D>(mesh_->simplex(c)).center);
    for (const Point<D>& x : places) {
      const double room = room_for(x, c);
      if (!(room > 0) || room < demand.d || room < options_->min_edge) continue;
      const int gain = fewer_unexcused();
      if (gain < best_gain || (gain == best_gain && (gain == 0 || room <= most_room))) continue;
      best_gain = gain;
      most_room = room;
      best = x;
      at = c;
    }
  }
  if (best_gain == 0) return false;
  room_for(best, at);
  cavity_.commit(pools_, Home(EntityKind::volume, 0), rounded_down(std::max(insertion_radius<D>(*mesh_, cavity_), demand.h)));
  committed();
  return true;
}

template <int D>
bool Refiner<D>::list_violations_about(CellId c) {
  std::vector<CellId> cells{c};
  for (const Link next : mesh_->cell(c).links)
    if (next) cells.push_back(next.cell());
  return list_violations(cells) > 0;
}

template <int D>
bool Refiner<D>::violates_anywhere(CellId c) const {
  for (int f = 0; f <= D; ++f)
    if (flips_.violates(c, f)) return true;
  return false;
}

template <int D>
bool Refiner<D>::insert_within(const Item& e) {
  if (!may_go_on()) return false;
  last_refusal_.reset();
  CellVerdict verdict = verdict_of(e);
  if (!verdict && !violates_anywhere(e.cell)) return false;  // mended by what was done for others
  unexplained_ = true;  // what throws meanwhile ends the run, and this with it
  bool inserted = D == 3 && !verdict && insert_for_fewer_violations(e);
  cavity_.release();
  verdict.over_radius_edge = true;
  inserted = inserted || treat_cell_at(e, circumsphere<D>(mesh_->simplex(e.cell)).center, verdict) == Outcome::committed;
  cavity_.release();
  inserted = inserted || (alive(e) && insert_mean_of_corners(e, verdict));
  cavity_.release();
  unexplained_ = false;
  return inserted;
}

template class Refiner<2>;
template class Refiner<3>;

}  // namespace pgdr
