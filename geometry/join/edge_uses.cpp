// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "join/edge_uses.hpp"

#include <tuple>

namespace pgdr::detail {

EdgeUses::EdgeUses(const FacetTriangles& faces, std::span<const OwnedEdge> segment_edges, const Bulk& bulk,
                   const StopCheck& stop) {
  using Kind = EdgeUse::Kind;
  uses_ = bulk.gather<EdgeUse>(faces.facets.size(), [&](std::size_t number, std::vector<EdgeUse>& found) {
    const auto f = static_cast<std::uint32_t>(number);
    for (std::uint32_t t = faces.facets[f].first; t < faces.facets[f].first + faces.facets[f].count; ++t)
      for (std::size_t i = 0; i < 3; ++i)
        found.push_back({faces.key_of_edge(t, i), f, t, faces.is_constraint(t, i) ? Kind::rim : Kind::diagonal});
  });
  uses_.reserve(uses_.size() + segment_edges.size() + faces.polygon_edges.size() + faces.outlines.size());
  for (const auto& [e, f] : faces.polygon_edges) uses_.push_back({edge_key(e[0], e[1]), f, 0, Kind::polygon});
  for (const auto& [e, s] : segment_edges) uses_.push_back({edge_key(e[0], e[1]), s, 0, Kind::explicit_segment});
  for (const std::uint64_t key : faces.outlines) uses_.push_back({key, 0, 0, Kind::outline});
  stop.sort(bulk, uses_, [](const EdgeUse& a, const EdgeUse& b) {
    return std::tuple{a.key, a.kind, a.owner, a.triangle} < std::tuple{b.key, b.kind, b.owner, b.triangle};
  });
}

std::span<const EdgeUse> EdgeUses::from(std::size_t begin) const {
  std::size_t end = begin + 1;
  while (end < uses_.size() && uses_[end].key == uses_[begin].key) ++end;
  return std::span(uses_).subspan(begin, end - begin);
}

}  // namespace pgdr::detail
