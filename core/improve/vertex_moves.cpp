// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The last visits of a run, in 3D: Steiner vertices are taken out where that leaves no more excess, and moved where it leaves
// less (improve/improve.cpp says what that is, why this ends, and what may be new). Between segments at a small angle every
// vertex makes short edges, to those on the other segment, and poor elements at these; what needed it when it was inserted may
// be gone by now.
#include <algorithm>
#include <array>
#include <utility>

#include "improve/improvement.hpp"
#include "input/entities.hpp"
#include "refine/refiner.hpp"

namespace pgdr {
namespace {

constexpr double margin = 1.0 / 64;  // of two subsegments: no vertex moves nearer to their ends than that part of them

/// The point that is that far on the way from a to b.
template <int D>
Point<D> between(const Point<D>& a, const Point<D>& b, double part) {
  Point<D> x;
  for (int k = 0; k < D; ++k) x[k] = a[k] + part * (b[k] - a[k]);
  return x;
}

}  // namespace

/// By how much the move that was aimed at lessens the excess, if that is more than `least`, and it turns over none of the cells that
/// it takes to tell. Notes what is poor then.
template <int D>
std::optional<double> Refiner<D>::gain_of_move(double excess, double least) {
  poor_turned_.clear();
  for (std::size_t i = 0; i < move_.turned().size() && excess > least; ++i) {
    if (move_.turns_over(i)) return {};
    const double e = context_->bounds.excess(move_.prospect(i), mesh_->region(move_.turned()[i].cell));
    if (e > 0) poor_turned_.push_back(i);
    excess -= e;
  }
  return excess > least ? std::optional(excess) : std::nullopt;
}

/// Is no new cell too large, and no edge too short?
template <int D>
bool Refiner<D>::move_keeps_sizes() const {
  const double shortest = options_->min_edge * options_->min_edge;
  for (std::size_t i = 0; i < move_.turned().size(); ++i) {
    const Simplex<D> s = move_.prospect(i);
    if (shortest_edge_squared<D>(s) < shortest) return false;
    if (!context_->bounds.within_size(s, mesh_->region(move_.turned()[i].cell))) return false;
  }
  return true;
}

/// Of the corners of the i-th new cell.
template <int D>
std::vector<Home> Refiner<D>::homes_of_turned(std::size_t i) const {
  const auto [c, corner] = move_.turned()[i];
  std::vector<Home> homes;
  for (int k = 0; k <= D; ++k) homes.push_back(k == corner ? move_.home() : mesh_->vertex(mesh_->cell(c).vertices[k]).home);
  return homes;
}

/// Would small angles at their own corners explain all new elements that are poor, and all faces that are not locally
/// Delaunay? `any`: are there such faces?
template <int D>
bool Refiner<D>::move_is_explained(bool& any) const {
  for (const std::size_t i : poor_turned_)
    if (!is_explained(homes_of_turned(i), move_.prospect(i))) return false;
  any = false;
  for (const auto& [i, beyond] : move_.open_faces()) {
    const Simplex<D> s = move_.prospect(i);
    if (in_sphere<D>(s, mesh_->point(beyond)) != Sign::positive) continue;
    any = true;
    std::vector<Home> homes = homes_of_turned(i);
    homes.push_back(mesh_->vertex(beyond).home);
    if (!is_explained(homes, s)) return false;
  }
  return true;
}

/// On its two subsegments: some parts of these, and the projections of the vertices about it.
template <int D>
void Refiner<D>::add_places_on_segment(const std::vector<VertexId>& ends, std::vector<Point<D>>& places) const {
  if (ends.size() != 2) return;
  const EntityId segment = mesh_->vertex(move_.vertex()).home.id();
  const std::array<double, 2> both = piece(segment, ends[0], ends[1]);
  const double t0 = both[0], t1 = both[1], length = t1 - t0;
  const double t = segment_parameter<D>(*domain_, segment, mesh_->point(move_.vertex()));
  const auto add = [&](double to) {
    if (to > t0 + margin * length && to < t1 - margin * length) places.push_back(point_on_segment<D>(*domain_, segment, to));
  };
  for (int k = 1; k < 8; ++k) add(t0 + length * k / 8);
  for (const double part : {-0.25, -0.125, -0.0625, 0.0625, 0.125, 0.25}) add(t + part * length);
  for (const VertexId w : move_.neighbours())
    if (w != ends[0] && w != ends[1]) add(segment_parameter<D>(*domain_, segment, mesh_->point(w)));
}

/// Where the vertex might go, on its own entity: nearer to or farther from each of its neighbours there, or to their mean.
template <int D>
std::vector<Point<D>> Refiner<D>::places_to_move_to() const {
  std::vector<Point<D>> places;
  const std::vector<VertexId> ring = move_.targets();
  const VertexId v = move_.vertex();
  const Home home = mesh_->vertex(v).home;
  if (home.kind() == EntityKind::segment) {
    add_places_on_segment(ring, places);
    return places;
  }
  const Point<D>& p = mesh_->point(v);
  const auto add = [&](const Point<D>& x) {
    places.push_back(home.kind() == EntityKind::facet ? point_on_facet(*domain_, home.id(), x) : x);
  };
  Point<D> mean{};
  for (const VertexId w : ring)
    for (int k = 0; k < D; ++k) mean[k] += mesh_->point(w)[k] / static_cast<double>(ring.size());
  for (const double part : {1.0, 0.5}) add(between<D>(p, mean, part));
  for (const VertexId w : ring)
    for (const double part : {0.75, 0.5, 0.25, 0.125, -0.125, -0.25, -0.5}) add(between<D>(p, mesh_->point(w), part));
  return places;
}

/// Adds the vertex beyond each face, with its cell; false if one of these is not owned.
template <int D>
bool Refiner<D>::add_vertices_beyond(CellId c, std::vector<std::pair<VertexId, CellId>>& vertices) const {
  for (const Link next : mesh_->cell(c).links) {
    if (!next) continue;
    if (!cavity_.owns(next.cell())) return false;
    vertices.push_back({mesh_->cell(next.cell()).vertices[next.face()], next.cell()});
  }
  return true;
}

/// Does what lessens the excess most with a vertex of the element, or of a neighbour of it: takes it out, or else moves it.
template <int D>
auto Refiner<D>::change_vertex(const Item& e, VertexChange change) -> Outcome {
  struct Best {
    VertexId v;
    CellId at;
    VertexId u;  // if it is taken out
    Point<D> x;
    bool violates;
  };
  const bool takes_out = change == VertexChange::take_out;
  const auto aim = [this](VertexId u, const Point<D>& x) { u == no_vertex ? move_.aim(x) : move_.aim(u); };
  std::vector<std::pair<VertexId, CellId>> vertices;
  for (const VertexId v : mesh_->cell(e.cell).vertices) vertices.push_back({v, e.cell});
  if (takes_out && !add_vertices_beyond(e.cell, vertices)) return Outcome::not_owned;
  std::optional<Best> best;
  double most = takes_out ? least_gain_without : least_gain;
  for (const auto& candidate : vertices) {
    const VertexId v = candidate.first;
    const CellId at = candidate.second;
    VertexNote& note = mesh_->note(v);
    std::uint32_t& settled = note.settled[takes_out ? 0 : 1];
    if (settled == note.version + 1) continue;
    const auto status = move_.collect(v, at, most_cells_changed);
    if (status == VertexMove::Status::not_owned) return Outcome::not_owned;
    if (status != VertexMove::Status::ok) {
      settled = note.version + 1;
      continue;
    }
    bool may_go_elsewhere = false;  // in another visit
    const double excess = excess_of(move_.cells());
    // So it is soon known where too much stays poor.
    move_.put_first([this](CellId c) { return excess_of(c) > 0; });
    const auto consider = [&](VertexId u, const Point<D>& x) {
      aim(u, x);
      if (takes_out && move_.turns_cell_over()) return;  // most do, which is quicker to tell than what they gain
      const auto gain = gain_of_move(excess, most);
      bool violates = false;
      if (gain && !takes_out && visit_->area && !visit_->area->owns(x)) may_go_elsewhere = true;
      if (!gain || !move_.is_valid() || !move_keeps_sizes() || !move_is_explained(violates)) return;
      most = *gain;
      best = Best{v, at, u, x, violates};
    };
    if (takes_out)
      for (const VertexId u : move_.targets()) consider(u, mesh_->point(u));
    else
      for (const Point<D>& x : places_to_move_to()) consider(no_vertex, x);
    if (!best && !may_go_elsewhere) settled = note.version + 1;
  }
  if (!best) return Outcome::refused;
  move_.collect(best->v, best->at, most_cells_changed);
  aim(best->u, best->x);
  move_.is_valid();
  for (const VertexId v : move_.neighbours()) ++mesh_->note(v).version;  // also of those at vanishing cells alone
  move_.commit(pools_);
  return note_change(e, move_.new_cells(), best->violates);
}

template class Refiner<3>;  // nothing of this in 2D

}  // namespace pgdr
