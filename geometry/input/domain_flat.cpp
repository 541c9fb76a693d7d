// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Continues the fourth step of a Domain (3D): a facet all of whose points lie on one line is dropped. If the edges of others cover
// it, it adds nothing to the union of all facets and segments; edges have no points inside by now, so that a walk from one end
// along the line sees it. If not, it adds a piece of that line, which bounds nothing: its edges, split at its own points, run
// through each place of the line as often there as back, so that no surface is open without them. CAD programs write such where
// a corner lies on an axis of revolution. It is told apart in the report.
#include <algorithm>

#include "input/domain_builder.hpp"
#include "pgdr/predicates.hpp"

namespace pgdr {
using detail::EdgeUse;
using detail::PlanarEdge;

template <int D>
void DomainBuilder<D>::drop_flat_facets() requires(D == 3) {
  if (flat_facets_.empty()) return;
  std::vector<PlanarEdge> edges;  // both ways
  for (const EdgeUse& use : uses_) {
    const auto [a, b] = detail::edge_of(use.key);
    edges.insert(edges.end(), {{a, b}, {b, a}});
  }
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  for (const detail::FlatFacet& flat : flat_facets_) {
    detail::RepairList& list = is_covered(flat, edges) ? dropped_flat_ : dropped_bare_;
    list.add([&] { return std::to_string(number(flat.input)); }, {number(flat.input)});
  }
}

template <int D>
bool DomainBuilder<D>::is_covered(const detail::FlatFacet& facet, const std::vector<PlanarEdge>& edges) const
    requires(D == 3) {
  const auto& p = out_.points_;
  const auto less = [&](std::uint32_t v, std::uint32_t w) { return lex_less(p[v], p[w]); };
  const auto [low, high] = std::ranges::minmax(facet.vertices, less);
  std::uint32_t at = low;
  const auto first_at = [&](std::uint32_t v) { return std::ranges::lower_bound(edges, PlanarEdge{v, 0}); };
  if (low == high) return first_at(at) != edges.end() && (*first_at(at))[0] == at;
  if (near_width_ > 0) return is_covered_nearly(facet, edges);
  while (at != high) {
    std::uint32_t next = no_entity;
    for (auto e = first_at(at); e != edges.end() && (*e)[0] == at && next == no_entity; ++e) {
      const std::uint32_t v = (*e)[1];
      if (v == high || (less(at, v) && less(v, high) && collinear<3>(p[at], p[high], p[v]))) next = v;
    }
    if (next == no_entity) return false;
    at = next;
  }
  return true;
}

/// The same of edges that go through points near them.
template <int D>
bool DomainBuilder<D>::is_covered_nearly(const detail::FlatFacet& facet, const std::vector<PlanarEdge>& edges) const
    requires(D == 3) {
  for (std::size_t k = 0; k < facet.vertices.size(); ++k) {
    const auto chain = near_chain(facet.vertices[k], facet.vertices[(k + 1) % facet.vertices.size()]);
    for (std::size_t i = 1; i < chain.size(); ++i)
      if (chain[i - 1] != chain[i] && !std::ranges::binary_search(edges, PlanarEdge{chain[i - 1], chain[i]})) return false;
  }
  return true;
}

template void DomainBuilder<3>::drop_flat_facets();

}  // namespace pgdr
