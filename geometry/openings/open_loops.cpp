// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Which chains are loops depends on the graph of open edges alone: its blocks do not hang on the order of a search, and one with
// as many edges as points is a cycle. A block of more edges could be taken apart in several ways, and is none.
#include "openings/open_loops.hpp"

#include <algorithm>
#include <utility>

#include "input/edges.hpp"
#include "space/blocks.hpp"

namespace pgdr::detail {
namespace {

struct EdgeOfTriangle {
  std::uint64_t key;
  EntityId facet;
  std::uint32_t triangle, edge;  // of the facet; opposite that corner
  friend auto operator<=>(const EdgeOfTriangle&, const EdgeOfTriangle&) = default;
};

std::vector<EdgeOfTriangle> edges_of_triangles(const Domain<3>& domain, const Bulk& bulk, const StopCheck& stop) {
  std::vector<EdgeOfTriangle> edges = bulk.gather<EdgeOfTriangle>(domain.facets().size(), [&](std::size_t f, auto& found) {
    const auto facet = static_cast<EntityId>(f);
    const auto triangles = domain.triangles(facet);
    for (std::uint32_t k = 0; k < triangles.size(); ++k)
      for (std::uint32_t i = 0; i < 3; ++i)
        found.push_back({edge_key(triangles[k][(i + 1) % 3], triangles[k][(i + 2) % 3]), facet, k, i});
  });
  stop();
  stop.sort(bulk, edges);
  return edges;
}

OpenEdge open_edge(const Domain<3>& domain, const EdgeOfTriangle& e) {
  const auto& corners = domain.triangles(e.facet)[e.triangle];
  const TriangleOrigin& origin = domain.triangle_origins(e.facet)[e.triangle];
  OpenEdge open{{corners[(e.edge + 1) % 3], corners[(e.edge + 2) % 3]}, corners[e.edge], origin.facet};
  if (origin.reversed) std::swap(open.ends[0], open.ends[1]);
  return open;
}

/// By their keys.
std::vector<std::pair<std::uint64_t, OpenEdge>> open_edges(const Domain<3>& domain, const Bulk& bulk, const StopCheck& stop) {
  const auto edges = edges_of_triangles(domain, bulk, stop);
  std::vector<std::pair<std::uint64_t, OpenEdge>> open;
  for (std::size_t i = 0, n; i < edges.size(); i += n) {
    for (n = 1; i + n < edges.size() && edges[i + n].key == edges[i].key;) ++n;
    if (n == 1) open.emplace_back(edges[i].key, open_edge(domain, edges[i]));
  }
  return open;
}

/// With points and edges in their order.
void put_in_order(const Domain<3>& domain, OpenLoop& loop) {
  const auto runs_with_facets = [&loop](std::size_t k) { return loop.edges[k].ends[0] == loop.points[k]; };
  std::size_t with = 0;
  for (std::size_t k = 0; k < loop.points.size(); ++k) with += runs_with_facets(k);
  loop.is_oriented = with == 0 || with == loop.points.size();
  const auto is_less = [&domain](std::uint32_t a, std::uint32_t b) { return domain.points()[a].x < domain.points()[b].x; };
  const auto first = std::ranges::min_element(loop.points, is_less) - loop.points.begin();
  std::rotate(loop.points.begin(), loop.points.begin() + first, loop.points.end());
  std::rotate(loop.edges.begin(), loop.edges.begin() + first, loop.edges.end());
  const bool turn = loop.is_oriented ? with > 0 : is_less(loop.points.back(), loop.points[1]);
  if (!turn) return;
  std::reverse(loop.points.begin() + 1, loop.points.end());
  std::ranges::reverse(loop.edges);
}

}  // namespace

std::vector<OpenLoop> open_loops(const Domain<3>& domain, const Bulk& bulk, const StopCheck& stop) {
  const auto open = open_edges(domain, bulk, stop);
  std::vector<Blocks::Pair> pairs;
  for (const auto& [key, edge] : open) pairs.push_back(edge.ends);
  Blocks blocks(static_cast<std::uint32_t>(domain.points().size()), std::move(pairs));
  for (const auto& [key, edge] : open) blocks.search(edge.ends[0]);
  std::vector<OpenLoop> loops;
  for (const Blocks::Block& block : blocks.found()) {
    const auto forward = std::ranges::count_if(block, [&blocks](const auto& e) { return blocks.is_forward(e); });
    if (block.size() < 3 || static_cast<std::size_t>(forward) + 1 != block.size()) continue;
    OpenLoop& loop = loops.emplace_back();
    for (const auto& [a, b] : block) {  // the search has gone along it
      loop.points.push_back(a);
      loop.edges.push_back(std::ranges::lower_bound(open, edge_key(a, b), {}, [](const auto& e) { return e.first; })->second);
    }
    put_in_order(domain, loop);
  }
  stop();
  std::ranges::sort(loops, [&domain](const OpenLoop& p, const OpenLoop& q) {
    return std::ranges::lexicographical_compare(
        p.points, q.points, [&domain](std::uint32_t a, std::uint32_t b) { return domain.points()[a].x < domain.points()[b].x; });
  });
  return loops;
}

}  // namespace pgdr::detail
