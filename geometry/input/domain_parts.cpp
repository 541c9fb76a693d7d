// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "input/domain_parts.hpp"

#include <algorithm>
#include <cmath>

#include "space/disjoint_sets.hpp"

namespace pgdr::detail {
namespace {

std::size_t triangles_of_all(const Domain<3>& domain) {
  return domain.facets().empty() ? 0 : domain.facets().back().first_triangle + domain.facets().back().triangle_count;
}

}  // namespace

void EdgeNumbers::index() { std::sort(edges_.begin(), edges_.end()); }

std::uint32_t EdgeNumbers::find(std::uint32_t a, std::uint32_t b) const {
  const Edge edge = edge_of(a, b);
  const auto at = std::ranges::lower_bound(edges_, edge, {}, [](const auto& e) { return e.first; });
  return at != edges_.end() && at->first == edge ? at->second : no_entity;
}

/// Triangles with an edge in common that is no segment are of one part. The triangles of a Domain are positive in the projections
/// of their facets.
DomainParts::DomainParts(const Domain<3>& domain) : part_of_(triangles_of_all(domain)) {
  EdgeNumbers segments;
  DisjointSets sets(part_of_.size());
  std::vector<std::pair<std::array<std::uint32_t, 2>, std::uint32_t>> open;  // an edge of a facet, and a triangle at it
  for (EntityId f = 0; f < domain.facets().size(); ++f) {
    const DomainFacet& facet = domain.facets()[f];
    if (facet.triangle_count == 1) continue;
    segments = {};
    for (const EntityId s : domain.facet_segments(f))
      segments.add(domain.segments()[s].points[0], domain.segments()[s].points[1], s);
    segments.index();
    open.clear();
    for (std::uint32_t k = 0; k < facet.triangle_count; ++k)
      for (std::size_t i = 0; i < 3; ++i) {
        const auto& t = domain.triangles(f)[k];
        const std::uint32_t a = t[i], b = t[(i + 1) % 3], number = facet.first_triangle + k;
        if (const EntityId s = segments.find(a, b); s == no_entity)
          open.push_back({{std::min(a, b), std::max(a, b)}, number});
        else
          at_sides_.push_back({{f, s, domain.segments()[s].points[0] == a}, number});
      }
    std::sort(open.begin(), open.end());
    for (std::size_t i = 1; i < open.size(); ++i)
      if (open[i].first == open[i - 1].first) sets.unite(open[i].second, open[i - 1].second);
  }
  for (std::uint32_t t = 0; t < part_of_.size(); ++t) part_of_[t] = sets.find(t);
  for (PartAtSide& p : at_sides_) p.part = part_of_[p.part];
  std::sort(at_sides_.begin(), at_sides_.end());
}

std::uint32_t DomainParts::at(const Side& side) const {
  const auto at = std::ranges::lower_bound(at_sides_, side, {}, &PartAtSide::side);
  return at != at_sides_.end() && at->side == side ? at->part : no_entity;
}

bool runs_along(const Domain<3>& domain, EntityId segment, const Point3& a, const Point3& b) {
  const auto& ends = domain.segments()[segment].points;
  const Point3 &p = domain.points()[ends[0]], &q = domain.points()[ends[1]];
  int axis = 0;
  for (int k = 1; k < 3; ++k)
    if (std::fabs(q[k] - p[k]) > std::fabs(q[axis] - p[axis])) axis = k;
  return (q[axis] > p[axis]) == (b[axis] > a[axis]);
}

}  // namespace pgdr::detail
