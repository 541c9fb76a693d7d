// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "join/build_pieces.hpp"

#include <algorithm>
#include <atomic>

#include "space/make_set.hpp"

namespace pgdr::detail {

template <int D>
std::vector<Piece> pieces_of(const BuildInput<D>& in, FacetTriangles& faces, std::span<const OwnedEdge> segment_edges,
                             std::span<const FlatFacet> flat) {
  faces.index_facets();
  std::vector<Piece> pieces(faces.triangles.size());
  std::vector<char> used(in.points.size());
  in.bulk.each(pieces.size(), [&](std::size_t t) {
    pieces[t] = {faces.triangles[t], 3, static_cast<std::uint8_t>(faces.facets[faces.facet_of[t]].axis)};
    for (const std::uint32_t v : faces.triangles[t]) std::atomic_ref(used[v]).store(1, std::memory_order_relaxed);
  });
  std::vector<std::uint64_t> loose, of_triangles;
  for (const auto edges : {segment_edges, std::span<const OwnedEdge>(faces.polygon_edges)})
    for (const OwnedEdge& e : edges) loose.push_back(edge_key(e.edge[0], e.edge[1]));
  for (const FlatFacet& facet : flat)
    for (std::size_t k = 0, n = facet.vertices.size(); k < n; ++k)
      if (facet.vertices[k] != facet.vertices[(k + 1) % n])
        loose.push_back(edge_key(facet.vertices[k], facet.vertices[(k + 1) % n]));
  make_set(loose);
  if (!loose.empty()) {
    of_triangles.resize(3 * faces.triangles.size());
    in.bulk.each(of_triangles.size(),
                 [&](std::size_t k) { of_triangles[k] = faces.key_of_edge(static_cast<std::uint32_t>(k / 3), k % 3); });
    in.stop.sort(in.bulk, of_triangles);
  }
  for (const std::uint64_t key : loose) {
    const auto [a, b] = edge_of(key);
    used[a] = used[b] = 1;
    if (!std::binary_search(of_triangles.begin(), of_triangles.end(), key)) pieces.push_back({{a, b, no_entity}, 2, 0});
  }
  for (std::uint32_t v = 0; v < used.size(); ++v)
    if (!used[v]) pieces.push_back({{v, no_entity, no_entity}, 1, 0});
  return pieces;
}

template std::vector<Piece> pieces_of(const BuildInput<2>&, FacetTriangles&, std::span<const OwnedEdge>,
                                      std::span<const FlatFacet>);
template std::vector<Piece> pieces_of(const BuildInput<3>&, FacetTriangles&, std::span<const OwnedEdge>,
                                      std::span<const FlatFacet>);

}  // namespace pgdr::detail
