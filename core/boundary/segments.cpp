// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <map>
#include <utility>

#include "boundary/named_points.hpp"
#include "boundary/state.hpp"
#include "space/make_set.hpp"

namespace pgdr::detail {

SegmentChains::SegmentChains(Mesh<3>& mesh, Delaunay<3>& delaunay, const Domain<3>& domain, SquareFlips& squares,
                             const Bulk& bulk)
    : mesh_(&mesh),
      delaunay_(&delaunay),
      domain_(&domain),
      squares_(&squares),
      bulk_(&bulk),
      chains_(domain.segments().size()),
      shells_(domain, true, bulk),
      edges_(mesh),
      look_again_(chains_.size()) {
  bulk.each(chains_.size(), [&](std::size_t s) {
    const auto& ends = domain.segments()[s].points;
    chains_[s] = {{delaunay.vertices()[ends[0]], 0.0}, {delaunay.vertices()[ends[1]], 1.0}};
    look_again_[s] = static_cast<EntityId>(s);
  });
  delaunay.tell_changes(edges_.changed());
  find_companions();
}

std::vector<Subsegment> SegmentChains::missing() {
  std::vector<EntityId> due = edges_.take_due();
  due.insert(due.end(), look_again_.begin(), look_again_.end());
  make_set(due, *bulk_);
  const auto ask_for = [this](EntityId s, const auto& ask) {
    auto& chain = chains_[s];
    for (std::size_t i = 1; i < chain.size(); ++i) ask({chain[i - 1].vertex, chain[i].vertex}, chain[i].seen);
  };
  edges_.look(due, ask_for, *bulk_);
  std::vector<Subsegment> list = bulk_->gather<Subsegment>(due.size(), [&](std::size_t k, std::vector<Subsegment>& out) {
    const auto& chain = chains_[due[k]];
    for (std::size_t i = 1; i < chain.size(); ++i)
      if (chain[i].seen == not_seen) out.push_back({due[k], chain[i - 1].vertex, chain[i].vertex, chain[i - 1].t});
  });
  look_again_.clear();
  for (const Subsegment& s : list) look_again_.push_back(s.segment);
  return list;
}

std::vector<EntityId> SegmentChains::missing_segments() {
  std::vector<EntityId> segments;
  for (const Subsegment& s : missing())
    if (segments.empty() || segments.back() != s.segment) segments.push_back(s.segment);
  return segments;
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
  for (const EntityId f : domain_->facets_of_segment(segment)) squares_->drop_facet(f);
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
  make_set(changed_, *bulk_);
  ++round_;
  return std::exchange(changed_, {});
}

WantedEdges SegmentChains::wanted() const {
  using Item = WantedEdges::Item;
  WantedEdges edges;
  edges.set(
      bulk_->gather<Item>(chains_.size(),
                          [this](std::size_t s, std::vector<Item>& out) {
                            const auto& chain = chains_[s];
                            for (std::size_t i = 1; i < chain.size(); ++i)
                              out.push_back(WantedEdges::item({chain[i - 1].vertex, chain[i].vertex}, static_cast<EntityId>(s)));
                          }),
      mesh_->vertex_bound(), *bulk_);
  return edges;
}

void SegmentChains::require_distinct(const WantedEdges& wanted) const {
  if (!wanted.has_equal(*bulk_)) return;
  std::map<std::array<VertexId, 2>, EntityId> before;  // to name the first of those that run along others
  for (EntityId s = 0; s < chains_.size(); ++s)
    for (std::size_t i = 1; i < chains_[s].size(); ++i) {
      const VertexId a = chains_[s][i - 1].vertex, b = chains_[s][i].vertex;
      const auto [at, is_new] = before.try_emplace({std::min(a, b), std::max(a, b)}, s);
      if (is_new) continue;
      const Diagnostic other = about_points<3>(Errc::boundary_not_recovered, *domain_, domain_->segments()[s].points);
      Diagnostic d = about_points<3>(Errc::boundary_not_recovered, *domain_, domain_->segments()[at->second].points);
      d.message = segment_words(d) + " and " + segment_words(other) + " run along each other within rounding";
      d.ids.insert(d.ids.end(), other.ids.begin(), other.ids.end());
      d.points = {mesh_->point(a).x, mesh_->point(b).x};
      throw InputError(std::move(d));
    }
}

}  // namespace pgdr::detail
