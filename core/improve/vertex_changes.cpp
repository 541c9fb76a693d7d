// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "improve/vertex_changes.hpp"

#include <algorithm>
#include <array>

#include "input/entities.hpp"
#include "refine/split_points.hpp"

namespace pgdr {
namespace {

constexpr double margin = 1.0 / 64;  // of two subsegments: no vertex moves nearer to their ends than that part of them

/// The point that is that far on the way from a to b.
Point3 between(const Point3& a, const Point3& b, double part) {
  Point3 x;
  for (int k = 0; k < 3; ++k) x[k] = a[k] + part * (b[k] - a[k]);
  return x;
}

}  // namespace

/// The amount by which the planned move lowers the excess, if that is more than `least`, and it turns over none of the cells that
/// it takes to tell. Notes what is poor then.
std::optional<double> VertexChanges::gain_of_move(double excess, double least) {
  poor_turned_.clear();
  for (std::size_t i = 0; i < move_.turned().size() && excess > least; ++i) {
    if (move_.turns_over(i)) return {};
    const double e = judge_->excess_of(move_.prospect(i), w_->mesh.region(move_.turned()[i].cell));
    if (e > 0) poor_turned_.push_back(i);
    excess -= e;
  }
  return excess > least ? std::optional(excess) : std::nullopt;
}

/// Is no new cell too large, and no edge too short?
bool VertexChanges::move_keeps_sizes() const {
  const double shortest = w_->options.min_edge * w_->options.min_edge;
  for (std::size_t i = 0; i < move_.turned().size(); ++i) {
    const Simplex<3> s = move_.prospect(i);
    if (shortest_edge_squared<3>(s) < shortest) return false;
    if (!w_->context.bounds.within_size(s, w_->mesh.region(move_.turned()[i].cell))) return false;
  }
  return true;
}

/// The homes of the corners of the i-th new cell.
std::vector<Home> VertexChanges::homes_of_turned(std::size_t i) const {
  const auto [c, corner] = move_.turned()[i];
  std::vector<Home> homes;
  for (int k = 0; k < 4; ++k) homes.push_back(k == corner ? move_.home() : w_->mesh.vertex(w_->mesh.cell(c).vertices[k]).home);
  return homes;
}

/// Would small angles at their own corners explain all new elements that are poor, and all faces that are not locally
/// Delaunay? `any`: are there such faces?
bool VertexChanges::move_is_explained(bool& any) {
  for (const std::size_t i : poor_turned_)
    if (!judge_->is_explained(homes_of_turned(i), move_.prospect(i))) return false;
  any = false;
  for (const auto& [i, beyond] : move_.open_faces()) {
    const Simplex<3> s = move_.prospect(i);
    if (in_sphere<3>(s, w_->mesh.point(beyond)) != Sign::positive) continue;
    any = true;
    std::vector<Home> homes = homes_of_turned(i);
    homes.push_back(w_->mesh.vertex(beyond).home);
    if (!judge_->is_explained(homes, s)) return false;
  }
  return true;
}

/// Adds places on its two subsegments: some parts of these, and the projections of the vertices about it.
void VertexChanges::add_places_on_segment(const std::vector<VertexId>& ends, std::vector<Point3>& places) const {
  if (ends.size() != 2) return;
  const EntityId segment = w_->mesh.vertex(move_.vertex()).home.id();
  const std::array<double, 2> both = parameters_of(w_->context, segment, ends[0], ends[1]);
  const double t0 = both[0], t1 = both[1], length = t1 - t0;
  const double t = segment_parameter<3>(w_->domain, segment, w_->mesh.point(move_.vertex()));
  const auto add = [&](double to) {
    if (to > t0 + margin * length && to < t1 - margin * length) places.push_back(point_on_segment<3>(w_->domain, segment, to));
  };
  for (int k = 1; k < 8; ++k) add(t0 + length * k / 8);
  for (const double part : {-0.25, -0.125, -0.0625, 0.0625, 0.125, 0.25}) add(t + part * length);
  for (const VertexId w : move_.neighbours())
    if (w != ends[0] && w != ends[1]) add(segment_parameter<3>(w_->domain, segment, w_->mesh.point(w)));
}

/// Where the vertex might go, on its own entity: nearer to or farther from each of its neighbours there, or to their mean.
std::vector<Point3> VertexChanges::places_to_move_to() const {
  std::vector<Point3> places;
  const std::vector<VertexId> ring = move_.targets();
  const VertexId v = move_.vertex();
  const Home home = w_->mesh.vertex(v).home;
  if (home.kind() == EntityKind::segment) {
    add_places_on_segment(ring, places);
    return places;
  }
  const Point3& p = w_->mesh.point(v);
  const auto add = [&](const Point3& x) {
    places.push_back(home.kind() == EntityKind::facet ? point_on_facet(w_->domain, home.id(), x) : x);
  };
  Point3 mean{};
  for (const VertexId w : ring)
    for (int k = 0; k < 3; ++k) mean[k] += w_->mesh.point(w)[k] / static_cast<double>(ring.size());
  for (const double part : {1.0, 0.5}) add(between(p, mean, part));
  for (const VertexId w : ring)
    for (const double part : {0.75, 0.5, 0.25, 0.125, -0.125, -0.25, -0.5}) add(between(p, w_->mesh.point(w), part));
  return places;
}

/// Adds the vertex beyond each face, with its cell; false if one of these is not owned.
bool VertexChanges::add_vertices_beyond(CellId c, std::vector<std::pair<VertexId, CellId>>& vertices) const {
  for (const Link next : w_->mesh.cell(c).links) {
    if (!next) continue;
    if (!w_->cavity.owns(next.cell())) return false;
    vertices.push_back({w_->mesh.cell(next.cell()).vertices[next.face()], next.cell()});
  }
  return true;
}

Outcome VertexChanges::change(const Entry<3>& e, Kind kind) {
  struct Best {
    VertexId v;
    CellId at;
    VertexId u;  // the neighbour that it collapses onto
    Point3 x;
    bool violates;
  };
  const bool collapses = kind == Kind::collapse;
  const auto aim = [this](VertexId u, const Point3& x) { u == no_vertex ? move_.aim(x) : move_.aim(u); };
  std::vector<std::pair<VertexId, CellId>> vertices;
  for (const VertexId v : w_->mesh.cell(e.cell).vertices) vertices.push_back({v, e.cell});
  if (collapses && !add_vertices_beyond(e.cell, vertices)) return Outcome::not_owned;
  std::optional<Best> best;
  double most = collapses ? least_gain_of_collapse : least_gain;
  for (const auto& candidate : vertices) {
    const VertexId v = candidate.first;
    const CellId at = candidate.second;
    VertexNote& note = w_->mesh.note(v);
    std::uint32_t& unchangeable_until = collapses ? note.no_collapse_until : note.no_move_until;
    if (note.version < unchangeable_until) continue;
    const auto status = move_.collect(v, at, most_cells_changed);
    if (status == VertexMove::Status::not_owned) return Outcome::not_owned;
    if (status != VertexMove::Status::ok) {
      unchangeable_until = note.version + 1;
      continue;
    }
    bool may_go_elsewhere = false;  // in another visit
    const double excess = judge_->excess_of(move_.cells());
    // So it is soon known where too much stays poor.
    move_.put_first([this](CellId c) { return judge_->excess_of(c) > 0; });
    const auto consider = [&](VertexId u, const Point3& x) {
      aim(u, x);
      if (collapses && move_.turns_cell_over()) return;  // most do, which is quicker to tell than what they gain
      const auto gain = gain_of_move(excess, most);
      bool violates = false;
      if (gain && !collapses && w_->visit->area && !w_->visit->area->owns(x)) may_go_elsewhere = true;
      if (!gain || !move_.is_valid() || !move_keeps_sizes() || !move_is_explained(violates)) return;
      most = *gain;
      best = Best{v, at, u, x, violates};
    };
    if (collapses)
      for (const VertexId u : move_.targets()) consider(u, w_->mesh.point(u));
    else
      for (const Point3& x : places_to_move_to()) consider(no_vertex, x);
    if (!best && !may_go_elsewhere) unchangeable_until = note.version + 1;
  }
  if (!best) return Outcome::refused;
  move_.collect(best->v, best->at, most_cells_changed);
  aim(best->u, best->x);
  move_.is_valid();
  for (const VertexId v : move_.neighbours()) ++w_->mesh.note(v).version;  // also of those at vanishing cells alone
  move_.commit(w_->pools);
  return flips_->finish(e, move_.new_cells(), best->violates);
}

}  // namespace pgdr
