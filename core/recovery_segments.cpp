// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <utility>

#include "detail/recovery_state.hpp"

namespace pgdr::detail {

SegmentChains::SegmentChains(Mesh<3>& mesh, Delaunay<3>& delaunay, const Domain<3>& domain)
    : mesh_(&mesh), delaunay_(&delaunay), domain_(&domain), shells_(domain) {
  for (const DomainSegment& s : domain.segments())
    chains_.push_back({{delaunay.vertices()[s.points[0]], 0.0}, {delaunay.vertices()[s.points[1]], 1.0}});
  find_companions();
}

WantedSimplices<2> SegmentChains::wanted() const {
  WantedSimplices<2> edges;
  for (EntityId s = 0; s < chains_.size(); ++s)
    for (std::size_t i = 1; i < chains_[s].size(); ++i)
      edges.add({chains_[s][i - 1].vertex, chains_[s][i].vertex}, s);
  edges.index_by_first(mesh_->vertex_bound());
  return edges;
}

std::vector<Subsegment> SegmentChains::missing() const {
  WantedSimplices<2> edges = wanted();
  for (std::uint32_t i = 0; i < mesh_->cell_bound(); ++i) {
    if (!mesh_->alive(CellId{i})) continue;
    const auto& v = mesh_->cell(CellId{i}).vertices;
    for (int a = 0; a <= 3; ++a)
      for (int b = a + 1; b <= 3; ++b)
        if (auto* edge = edges.find({v[a], v[b]})) edge->present = true;
  }
  std::vector<Subsegment> list;
  for (EntityId s = 0; s < chains_.size(); ++s)
    for (std::size_t i = 1; i < chains_[s].size(); ++i) {
      const VertexId a = chains_[s][i - 1].vertex, b = chains_[s][i].vertex;
      if (!edges.find({a, b})->present) list.push_back({s, a, b, chains_[s][i - 1].t});
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
  ++points_;
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
    const auto& ends = domain_->segments()[segment].points;
    Diagnostic d;
    const bool exhausted = v == a || v == b;
    d.code = exhausted ? Errc::boundary_not_recovered : Errc::entities_intersect;
    d.message = "the segment between points " + std::to_string(domain_->input_of_point()[ends[0]]) + " and " +
                std::to_string(domain_->input_of_point()[ends[1]]) +
                (exhausted ? " cannot be resolved in double precision; something touches or crosses it here"
                           : " passes through a point that belongs to another entity");
    d.ids = {domain_->input_of_point()[ends[0]], domain_->input_of_point()[ends[1]]};
    if (home.kind() == EntityKind::vertex && !exhausted) d.ids.push_back(domain_->input_of_point()[home.id()]);
    d.points = {p.x};
    throw InputError(std::move(d));
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

void SegmentChains::mark(Mesh<3>::Pools& pools) {
  WantedSimplices<2> edges = wanted();
  for (std::uint32_t i = 0; i < mesh_->cell_bound(); ++i) {
    const CellId c{i};
    if (!mesh_->alive(c)) continue;
    const auto v = mesh_->cell(c).vertices;
    for (int a = 0; a <= 3; ++a)
      for (int b = a + 1; b <= 3; ++b) {
        const auto* edge = edges.find({v[a], v[b]});
        if (!edge) continue;
        auto& k = mesh_->ensure_constraints(pools, c);
        const int e = edge_of_ends[a][b];
        k.edges |= static_cast<std::uint8_t>(1 << e);
        k.edge_entity[e] = edge->entity;
      }
  }
}

}  // namespace pgdr::detail
