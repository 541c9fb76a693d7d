// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "build/flat_facets.hpp"

#include <algorithm>
#include <string>
#include <vector>

#include "pgdr/predicates.hpp"
#include "space/make_set.hpp"

namespace pgdr::detail {
namespace {

/// `edges`: both ways, sorted.
bool is_covered_nearly(const FlatFacet& facet, const std::vector<PlanarEdge>& edges, const NearContacts& near) {
  for (std::size_t k = 0; k < facet.vertices.size(); ++k) {
    const auto chain = near.chain(facet.vertices[k], facet.vertices[(k + 1) % facet.vertices.size()]);
    for (std::size_t i = 1; i < chain.size(); ++i)
      if (chain[i - 1] != chain[i] && !std::ranges::binary_search(edges, PlanarEdge{chain[i - 1], chain[i]})) return false;
  }
  return true;
}

/// `edges`: both ways, sorted.
bool is_covered(const FlatFacet& facet, const std::vector<PlanarEdge>& edges, std::span<const Point3> p,
                const NearContacts* near) {
  const auto less = [&](std::uint32_t v, std::uint32_t w) { return lex_less(p[v], p[w]); };
  const auto [low, high] = std::ranges::minmax(facet.vertices, less);
  std::uint32_t at = low;
  const auto first_at = [&](std::uint32_t v) { return std::ranges::lower_bound(edges, PlanarEdge{v, 0}); };
  if (low == high) return first_at(at) != edges.end() && (*first_at(at))[0] == at;
  if (near != nullptr) return is_covered_nearly(facet, edges, *near);
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

}  // namespace

void report_flat_facets(const BuildInput<3>& in, std::span<const FlatFacet> flat, const EdgeUses& uses, const NearContacts* near,
                        BuildReport<3>& report) {
  if (flat.empty()) return;
  std::vector<PlanarEdge> edges;  // both ways
  for (const EdgeUse& use : uses.all()) {
    const auto [a, b] = edge_of(use.key);
    edges.insert(edges.end(), {{a, b}, {b, a}});
  }
  make_set(edges);
  for (const FlatFacet& facet : flat) {
    RepairList& list = is_covered(facet, edges, in.points, near) ? report.repairs.dropped_flat : report.repairs.dropped_bare;
    list.add([&] { return std::to_string(report.number(facet.input)); }, {report.number(facet.input)});
  }
}

}  // namespace pgdr::detail
