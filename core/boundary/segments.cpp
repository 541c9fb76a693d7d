// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cassert>
#include <utility>

#include "boundary/named_points.hpp"
#include "boundary/state.hpp"
#include "mesh/ridge.hpp"

namespace pgdr::detail {

SegmentChains::SegmentChains(Mesh<3>& mesh, Delaunay<3>& delaunay, const Domain<3>& domain)
    : mesh_(&mesh), delaunay_(&delaunay), domain_(&domain), shells_(domain), edges_(mesh) {
  for (const DomainSegment& s : domain.segments())
    chains_.push_back({{delaunay.vertices()[s.points[0]], 0.0}, {delaunay.vertices()[s.points[1]], 1.0}});
  for (EntityId s = 0; s < chains_.size(); ++s) look_again_.push_back(s);
  delaunay.tell_changes(edges_.changed());
  find_companions();
}

std::vector<Subsegment> SegmentChains::missing() {
  std::vector<EntityId> due = edges_.take_due();
  due.insert(due.end(), look_again_.begin(), look_again_.end());
  make_set(due);
  for (const EntityId s : due) {
    auto& chain = chains_[s];
    for (std::size_t i = 1; i < chain.size(); ++i) edges_.ask(s, {chain[i - 1].vertex, chain[i].vertex}, chain[i].seen);
  }
  edges_.find();
  std::vector<Subsegment> list;
  look_again_.clear();
  for (const EntityId s : due)
    for (std::size_t i = 1; i < chains_[s].size(); ++i) {
      const Link &a = chains_[s][i - 1], &b = chains_[s][i];
      if (b.seen != not_seen) continue;
      list.push_back({s, a.vertex, b.vertex, a.t});
      look_again_.push_back(s);
    }
  return list;
}

/// Place of b in the chain if ab is a subsegment, else 0.
std::size_t SegmentChains::position(const Subsegment& s) const {
  const auto& chain = chains_[s.segment];
  const auto at = std::lower_bound(chain.begin(), chain.end(), s.t, [](const Link& link, double t) { return link.t < t; });
  const auto i = static_cast<std::size_t>(at - chain.begin());
  return i + 1 < chain.size() && chain[i].vertex == s.a && chain[i + 1].vertex == s.b ? i + 1 : 0;
}

void SegmentChains::add(EntityId segment, std::size_t position, VertexId v, double t) {
  auto& chain = chains_[segment];
  chain.insert(chain.begin() + static_cast<std::ptrdiff_t>(position), {v, t, round_});
  changed_.push_back(segment);
  look_again_.push_back(segment);
  ++points_;
}

/// Where the segment should be split at x, there is another vertex: within rounding something else is there.
Diagnostic SegmentChains::not_resolved(EntityId segment, bool is_its_end, Home home, const Point3& x) const {
  const bool at_input = home.kind() == EntityKind::vertex && !is_its_end;
  std::vector<std::uint32_t> points(domain_->segments()[segment].points.begin(), domain_->segments()[segment].points.end());
  if (at_input) points.push_back(home.id());
  Diagnostic d = about_points<3>(is_its_end ? Errc::boundary_not_recovered : Errc::entities_intersect, *domain_, points);
  d.message = segment_words(d);
  if (is_its_end)
    d.message += " cannot be resolved in double precision; something touches or crosses it here";
  else if (at_input)
    d.message += " passes through point " + std::to_string(d.ids[2]) + ", but for rounding";
  else
    d.message += " passes through another segment or facet";
  d.points = {x.x};
  return d;
}

VertexId SegmentChains::split(const Subsegment& s, double least) {
  const std::size_t i = position(s);
  if (i == 0) return no_vertex;
  const auto& [segment, a, b, begin] = s;
  const auto [t, twins] = split_place(segment, begin, chains_[segment][i].t);
  const Point<3> p = point_on_segment<3>(*domain_, segment, t);
  const VertexId v = delaunay_->insert(p, Home(EntityKind::segment, segment), a, least, twins);
  if (v == no_vertex) return no_vertex;
  const Home home = mesh_->vertex(v).home;
  if (!(home.kind() == EntityKind::segment && home.id() == segment) || v == a || v == b) {
    throw InputError(not_resolved(segment, v == a || v == b, home, p));
  }
  add(segment, i, v, t);
  return v;
}

std::vector<EntityId> SegmentChains::take_changed() {
  std::sort(changed_.begin(), changed_.end());
  changed_.erase(std::unique(changed_.begin(), changed_.end()), changed_.end());
  ++round_;
  return std::exchange(changed_, {});
}

/// Segments s and u have the same edge ab in the mesh.
InputError SegmentChains::in_common(EntityId s, EntityId u, VertexId a, VertexId b) const {
  const Diagnostic other = about_points<3>(Errc::boundary_not_recovered, *domain_, domain_->segments()[u].points);
  Diagnostic d = about_points<3>(Errc::boundary_not_recovered, *domain_, domain_->segments()[s].points);
  d.message = segment_words(d) + " and " + segment_words(other) + " run along each other within rounding";
  d.ids.insert(d.ids.end(), other.ids.begin(), other.ids.end());
  d.points = {mesh_->point(a).x, mesh_->point(b).x};
  return InputError(std::move(d));
}

/// Marks the edge in all cells at each subsegment, round it from the cell in which it was seen. @pre none is missing
/// @throws InputError boundary_not_recovered: an edge is one of two segments
void SegmentChains::mark(Mesh<3>::Pools& pools) {
  for (EntityId s = 0; s < chains_.size(); ++s)
    for (std::size_t i = 1; i < chains_[s].size(); ++i) {
      const VertexId a = chains_[s][i - 1].vertex, b = chains_[s][i].vertex;
      const CellId first = chains_[s][i].seen;
      assert(has_corners<2>(*mesh_, first, {a, b}));
      const auto edge_in = [&](CellId c) {
        const auto& v = mesh_->cell(c).vertices;
        return edge_of_ends[corner_of(v, a)][corner_of(v, b)];
      };
      if (mesh_->is_subsegment(first, edge_in(first)))
        throw in_common(mesh_->constraints(first)->edge_entity[edge_in(first)], s, a, b);
      for_cells_round(*mesh_, first, edge_in(first), [&](const RidgeWalk<3>& walk) {
        mesh_->constrain_edge(pools, walk.cell, edge_in(walk.cell), s);
        return RoundEdge::go_on;
      });
    }
}

}  // namespace pgdr::detail
