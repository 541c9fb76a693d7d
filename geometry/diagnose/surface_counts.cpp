// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Counts of components, boundary loops and handles, by Euler's formula: V - E + F = 2 C - 2 H - L of a surface with C components,
// H handles and L boundary loops.
#include "pgdr/surface_counts.hpp"

#include <algorithm>
#include <span>
#include <vector>

#include "input/edges.hpp"
#include "space/disjoint_sets.hpp"
#include "space/point_places.hpp"

namespace pgdr {
namespace {

using Loop = std::vector<std::uint32_t>;

/// Takes polygons one by one; a polygon of a facet after its first adds a hole to it.
class Surface {
 public:
  explicit Surface(std::size_t points) : sets_(points), used_(points) {}

  void add(std::span<const std::uint32_t> polygon, bool is_first) {
    if (polygon.size() < 3) return;
    faces_ += is_first ? 1 : -1;
    for (std::size_t k = 0; k < polygon.size(); ++k) {
      const std::uint32_t a = polygon[k], b = polygon[(k + 1) % polygon.size()];
      used_[a] = true;
      if (a == b) continue;
      edges_.push_back(detail::edge_key(a, b));
      sets_.unite(a, b);
    }
  }
  /// The polygons of one facet hang together.
  void join(std::uint32_t a, std::uint32_t b) { sets_.unite(a, b); }

  SurfaceCounts count() {
    std::sort(edges_.begin(), edges_.end());
    SurfaceCounts counts;
    std::int64_t vertices = 0, edges = 0;
    for (std::uint32_t v = 0; v < used_.size(); ++v) {
      vertices += used_[v];
      counts.components += used_[v] && sets_.find(v) == v;
    }
    bool is_surface = true;
    detail::DisjointSets rims(used_.size());
    std::vector<std::uint8_t> rim_edges(used_.size());
    for (std::size_t i = 0, n; i < edges_.size(); i += n, ++edges) {
      for (n = 1; i + n < edges_.size() && edges_[i + n] == edges_[i];) ++n;
      is_surface = is_surface && n <= 2;
      if (n > 1) continue;
      const auto [a, b] = detail::edge_of(edges_[i]);
      rims.unite(a, b);
      for (const std::uint32_t v : {a, b}) rim_edges[v] = static_cast<std::uint8_t>(std::min(rim_edges[v] + 1, 3));
    }
    for (std::uint32_t v = 0; v < rim_edges.size(); ++v) {
      counts.open_loops += rim_edges[v] > 0 && rims.find(v) == v;
      is_surface = is_surface && (rim_edges[v] == 0 || rim_edges[v] == 2);
    }
    const std::int64_t twice = 2 * static_cast<std::int64_t>(counts.components) - (vertices - edges + faces_) -
                               static_cast<std::int64_t>(counts.open_loops);
    if (is_surface && twice >= 0 && twice % 2 == 0) counts.handles = static_cast<std::uint64_t>(twice / 2);
    return counts;
  }

 private:
  detail::DisjointSets sets_;
  std::vector<bool> used_;
  std::vector<std::uint64_t> edges_;
  std::int64_t faces_ = 0;
};

}  // namespace

SurfaceCounts surface_counts(const Plc<3>& plc) {
  const std::vector<std::uint32_t> first = detail::first_at_places<3>(plc.points);
  Surface surface(plc.points.size());
  Loop loop;
  for (const auto& facet : plc.facets) {
    std::uint32_t outer = no_entity;
    for (const auto& polygon : facet.polygons) {
      loop.clear();
      for (const std::uint32_t v : polygon)
        if (v < first.size() && (loop.empty() || loop.back() != first[v])) loop.push_back(first[v]);
      while (loop.size() > 1 && loop.front() == loop.back()) loop.pop_back();
      if (loop.size() < 3) continue;
      surface.add(loop, outer == no_entity);
      if (outer != no_entity) surface.join(outer, loop[0]);
      outer = loop[0];
    }
  }
  return surface.count();
}

SurfaceCounts surface_counts(const Domain<3>& domain) {
  Surface surface(domain.points().size());
  for (EntityId f = 0; f < domain.facets().size(); ++f)
    for (const auto& t : domain.triangles(f)) surface.add(t, true);
  return surface.count();
}

}  // namespace pgdr
