// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <utility>

#include "detail/recovery_state.hpp"

namespace pgdr::detail {
namespace {

template <int D>
std::array<double, 3> in_space(const Point<D>& p) {
  return {p[0], p[1], D == 3 ? p[D - 1] : 0.0};
}

}  // namespace

template <int D>
SegmentChains<D>::SegmentChains(Mesh<D>& mesh, Delaunay<D>& delaunay, const Domain<D>& domain)
    : mesh_(&mesh), delaunay_(&delaunay), domain_(&domain) {
  for (const DomainSegment& s : domain.segments())
    chains_.push_back({{delaunay.vertices()[s.points[0]], 0.0}, {delaunay.vertices()[s.points[1]], 1.0}});
  find_shells();
}

template <int D>
void SegmentChains<D>::find_shells() {
  const auto segments = domain_->segments();
  shell_.assign(segments.size(), {false, false});
  struct Use {
    std::uint32_t point;
    EntityId segment;
    int end;
  };
  std::vector<Use> uses;
  for (EntityId s = 0; s < segments.size(); ++s)
    for (int end : {0, 1}) uses.push_back({segments[s].points[end], s, end});
  std::sort(uses.begin(), uses.end(), [](const Use& a, const Use& b) {
    return std::pair(a.point, a.segment) < std::pair(b.point, b.segment);
  });
  auto far_end = [&](const Use& u) { return domain_->points()[segments[u.segment].points[1 - u.end]]; };
  for (std::size_t i = 0, j; i < uses.size(); i = j) {
    for (j = i; j < uses.size() && uses[j].point == uses[i].point;) ++j;
    const Point<D>& v = domain_->points()[uses[i].point];
    for (std::size_t a = i; a < j; ++a)
      for (std::size_t b = a + 1; b < j; ++b) {
        bool& shell_a = shell_[uses[a].segment][uses[a].end];
        bool& shell_b = shell_[uses[b].segment][uses[b].end];
        if ((shell_a && shell_b) || !angle_below_60<D>(v, far_end(uses[a]), far_end(uses[b]))) continue;
        shell_a = shell_b = true;
      }
  }
}

template <int D>
WantedSimplices<2> SegmentChains<D>::wanted() const {
  WantedSimplices<2> edges;
  for (EntityId s = 0; s < chains_.size(); ++s)
    for (std::size_t i = 1; i < chains_[s].size(); ++i)
      edges.add({chains_[s][i - 1].vertex, chains_[s][i].vertex}, s);
  edges.index_by_first(mesh_->vertex_bound());
  return edges;
}

template <int D>
auto SegmentChains<D>::missing() const -> std::vector<Subsegment> {
  WantedSimplices<2> edges = wanted();
  for (std::uint32_t i = 0; i < mesh_->cell_bound(); ++i) {
    if (!mesh_->alive(CellId{i})) continue;
    const auto& v = mesh_->cell(CellId{i}).vertices;
    for (int a = 0; a <= D; ++a)
      for (int b = a + 1; b <= D; ++b)
        if (auto* edge = edges.find({v[a], v[b]})) edge->present = true;
  }
  std::vector<Subsegment> list;
  for (EntityId s = 0; s < chains_.size(); ++s)
    for (std::size_t i = 1; i < chains_[s].size(); ++i) {
      const VertexId a = chains_[s][i - 1].vertex, b = chains_[s][i].vertex;
      if (!edges.find({a, b})->present) list.push_back({s, a, b});
    }
  return list;
}

/// Next to an end with a shell: the power of two between a third and two thirds of the length, about that end.
template <int D>
double SegmentChains<D>::split_parameter(EntityId segment, const Link& a, const Link& b) const {
  const double middle = a.t + (b.t - a.t) / 2;
  const bool at_first = a.t == 0 && shell_[segment][0], at_last = b.t == 1 && shell_[segment][1];
  if (!at_first && !at_last) return middle;
  const auto& ends = domain_->segments()[segment].points;
  const double whole = std::sqrt(squared_distance(domain_->points()[ends[0]], domain_->points()[ends[1]]));
  const double length = whole * (b.t - a.t);
  double radius = std::ldexp(1.0, std::ilogb(length * (2.0 / 3)));
  if (!(radius > length / 3)) radius *= 2;
  const double t = radius / whole;
  if (!(t > 0 && t < b.t - a.t)) return middle;
  return at_first ? t : 1 - t;  // both: the lexicographically smaller end, which is the first
}

/// Place of b in the chain if ab is a subsegment, else 0.
template <int D>
std::size_t SegmentChains<D>::position(EntityId segment, VertexId a, VertexId b) const {
  const auto& chain = chains_[segment];
  for (std::size_t i = 1; i < chain.size(); ++i)
    if (chain[i - 1].vertex == a && chain[i].vertex == b) return i;
  return 0;
}

template <int D>
void SegmentChains<D>::add(EntityId segment, std::size_t position, VertexId v, double t) {
  auto& chain = chains_[segment];
  chain.insert(chain.begin() + static_cast<std::ptrdiff_t>(position), {v, t});
  changed_.push_back(segment);
  ++points_;
}

template <int D>
bool SegmentChains<D>::split(EntityId segment, VertexId a, VertexId b) {
  const std::size_t i = position(segment, a, b);
  if (i == 0) return false;
  const double t = split_parameter(segment, chains_[segment][i - 1], chains_[segment][i]);
  const Point<D> p = point_on_segment<D>(*domain_, segment, t);
  const VertexId v = delaunay_->insert(p, Home(EntityKind::segment, segment), a);
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
    d.points = {in_space<D>(p)};
    throw InputError(std::move(d));
  }
  add(segment, i, v, t);
  return true;
}

template <int D>
std::vector<EntityId> SegmentChains<D>::take_changed() {
  std::sort(changed_.begin(), changed_.end());
  changed_.erase(std::unique(changed_.begin(), changed_.end()), changed_.end());
  return std::exchange(changed_, {});
}

template <int D>
void SegmentChains<D>::mark(typename Mesh<D>::Pools& pools) {
  WantedSimplices<2> edges = wanted();
  for (std::uint32_t i = 0; i < mesh_->cell_bound(); ++i) {
    const CellId c{i};
    if (!mesh_->alive(c)) continue;
    const auto v = mesh_->cell(c).vertices;
    for (int a = 0; a <= D; ++a)
      for (int b = a + 1; b <= D; ++b) {
        const auto* edge = edges.find({v[a], v[b]});
        if (!edge) continue;
        auto& k = mesh_->ensure_constraints(pools, c);
        if constexpr (D == 3) {
          const int e = edge_of_ends[a][b];
          k.edges |= static_cast<std::uint8_t>(1 << e);
          k.edge_entity[e] = edge->entity;
        } else {
          const int f = 3 - a - b;
          k.faces |= static_cast<std::uint8_t>(1 << f);
          k.face_entity[f] = edge->entity;
        }
      }
  }
}

template class SegmentChains<2>;
template class SegmentChains<3>;

}  // namespace pgdr::detail
