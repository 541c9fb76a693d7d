// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "bodies/kept_facets.hpp"

#include <algorithm>
#include <functional>
#include <numeric>

#include "pgdr/predicates.hpp"
#include "space/equal_rows.hpp"

namespace pgdr::detail {

KeptFacets::KeptFacets(const Plc<3>& plc, const Arrangement& pieces, const RegionGroups& groups, bool are_cut)
    : plc_(plc), pieces_(pieces) {
  const auto count = static_cast<std::uint32_t>(plc.facets.size());
  std::vector<std::uint32_t> begin(count + 1, 0), at(pieces.origins.size());
  for (const PieceOrigin& o : pieces.origins) ++begin[o.facet + 1];
  for (std::uint32_t f = 0; f < count; ++f) begin[f + 1] += begin[f];
  std::vector<std::uint32_t> next(begin.begin(), begin.end() - 1);
  bool some_dropped = false;
  for (std::uint32_t p = 0; p < pieces.triangles.size(); ++p) {
    some_dropped = some_dropped || groups.is_dropped(p);
    for (std::uint32_t k = pieces.origins_begin[p]; k < pieces.origins_begin[p + 1]; ++k) at[next[pieces.origins[k].facet]++] = p;
  }
  std::vector<char> whole(count, 1);
  if (some_dropped || are_cut) {
    std::vector<std::uint32_t> all(pieces.triangles.size());
    std::iota(all.begin(), all.end(), 0u);
    edges_ = edges_of(all);
  }
  for (std::uint32_t f = 0; f < count && (some_dropped || are_cut); ++f) {
    const auto its_pieces = std::span(at).subspan(begin[f], begin[f + 1] - begin[f]);
    whole[f] = std::ranges::none_of(its_pieces, [&](std::uint32_t p) { return groups.is_dropped(p); }) &&
               is_itself(f, its_pieces);
  }
  for (std::uint32_t f = 0; f < count; ++f)
    if (whole[f] != 0) from_.push_back({f, no_entity});
  for (std::uint32_t p = 0; p < pieces.triangles.size(); ++p) {
    const std::uint32_t f = pieces.origins[pieces.origins_begin[p]].facet;
    if (!groups.is_dropped(p) && whole[f] == 0) from_.push_back({f, p});
  }
  std::stable_sort(from_.begin(), from_.end(), [](const From& a, const From& b) { return a.facet < b.facet; });
}

Plc<3>::Facet KeptFacets::make(std::size_t i) const {
  const auto& [f, p] = from_[i];
  if (p == no_entity) return plc_.facets[f];
  const auto& t = pieces_.triangles[p];
  const bool reversed = pieces_.origins[pieces_.origins_begin[p]].reversed;
  return {{{t[0], t[reversed ? 2u : 1u], t[reversed ? 1u : 2u]}}, {}, plc_.facets[f].marker};
}

std::vector<KeptFacets::Edge> KeptFacets::edges_of(std::span<const std::uint32_t> pieces) const {
  std::vector<Edge> edges;
  for (const std::uint32_t p : pieces)
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [a, b] = std::minmax(pieces_.triangles[p][k], pieces_.triangles[p][(k + 1) % 3]);
      edges.push_back({a, b});
    }
  std::ranges::sort(edges);
  return edges;
}

// A chain of triangles in a plane is told by its boundary: if that lies on the outline of the facet, the chain is the facet.
bool KeptFacets::is_itself(std::uint32_t facet, std::span<const std::uint32_t> its_pieces) const {
  const auto& f = plc_.facets[facet];
  if (its_pieces.empty() || (its_pieces.size() == 1 && is_triangle(f, its_pieces[0]))) return true;
  const std::vector<Edge> edges = edges_of(its_pieces);
  for (std::size_t i = 0, j = 0; i < edges.size(); i = j) {
    for (j = i + 1; j < edges.size() && edges[j] == edges[i];) ++j;
    const bool is_inner = (j - i) % 2 == 0;
    const std::size_t of_all = is_inner ? equal_rows<Edge>(edges_, edges[i], std::identity{}).size() : 0;
    if (is_inner ? of_all > j - i : !is_on_outline(f, edges[i][0], edges[i][1])) return false;
  }
  return true;
}

bool KeptFacets::is_triangle(const Plc<3>::Facet& facet, std::uint32_t piece) const {
  if (facet.polygons.size() != 1 || facet.polygons[0].size() != 3) return false;
  const auto& points = pieces_.points;
  return std::ranges::is_permutation(facet.polygons[0], pieces_.triangles[piece],
                                     [&](std::uint32_t v, std::uint32_t w) { return points[v] == points[w]; });
}

bool KeptFacets::is_on_outline(const Plc<3>::Facet& facet, std::uint32_t v, std::uint32_t w) const {
  for (const auto& polygon : facet.polygons)
    for (std::size_t k = 0; k < polygon.size(); ++k) {
      const std::uint32_t a = polygon[k], b = polygon[(k + 1) % polygon.size()];
      if (is_on_edge(v, a, b) && is_on_edge(w, a, b)) return true;
    }
  return false;
}

bool KeptFacets::is_on_edge(std::uint32_t v, std::uint32_t a, std::uint32_t b) const {
  const Point<3>&x = pieces_.points[v], &from = pieces_.points[a], &to = pieces_.points[b];
  for (int i = 0; i < 3; ++i)
    if (orient_projected(from, to, x, i) != Sign::zero || x[i] < std::min(from[i], to[i]) || x[i] > std::max(from[i], to[i]))
      return false;
  return true;
}

}  // namespace pgdr::detail
