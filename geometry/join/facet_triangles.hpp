// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The triangles of the facets of a Domain in the making, and the edges of their polygons (3D; in 2D there are none).
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "input/edges.hpp"
#include "pgdr/types.hpp"
#include "space/planar_cdt.hpp"

namespace pgdr::detail {

/// An input facet as triangles, or a planar part of one that is bent, before facets of one plane are grouped.
struct TriangulatedFacet {
  std::uint32_t input = 0;             ///< index in Plc::facets
  std::uint32_t first = 0, count = 0;  ///< its triangles
  int axis = 2;                        ///< the coordinate dropped in its projection
  bool planar = true;
  double defect = 0;      ///< largest distance of one of its points from the plane of its largest triangle
  bool reversed = false;  ///< its triangles run against its first polygon
  bool mixed = false;     ///< some triangles were made anew together with those of other facets
};

struct FacetTriangles {
  std::vector<TriangulatedFacet> facets;
  std::vector<PlanarTriangle> triangles;  ///< facet by facet
  std::vector<std::uint8_t> masks;        ///< of each triangle, bit i: edge i (opposite corner i) is a constraint
  std::vector<OwnedEdge> polygon_edges;   ///< of facets that are no single triangle
  std::vector<std::uint64_t> outlines;    ///< edges of facets, by their keys, inside of others that overlap these
  std::vector<std::uint32_t> facet_of;    ///< of each triangle, in `facets`; as index_facets() left it
  /// What of the input was left out since it repeats other facets: (the one of `facets` that is kept, index in Plc::facets).
  std::vector<std::pair<std::uint32_t, std::uint32_t>> repeated;
  /// The same of single triangles, where facets overlap: (in `triangles`, index in Plc::facets). Made last: nothing renumbers it.
  std::vector<std::pair<std::uint32_t, std::uint32_t>> overlapped;

  bool is_constraint(std::uint32_t t, std::size_t edge) const { return (masks[t] >> edge & 1) != 0; }
  std::uint64_t key_of_edge(std::uint32_t t, std::size_t edge) const {
    return edge_key(triangles[t][(edge + 1) % 3], triangles[t][(edge + 2) % 3]);
  }
  std::span<const PlanarTriangle> of(const TriangulatedFacet& f) const { return std::span(triangles).subspan(f.first, f.count); }
  void add(const PlanarTriangle& t, std::uint8_t mask) {
    triangles.push_back(t);
    masks.push_back(mask);
  }
  void resize(std::size_t count) {
    triangles.resize(count);
    masks.resize(count);
  }
  void index_facets() {
    facet_of.clear();
    for (std::uint32_t f = 0; f < facets.size(); ++f) facet_of.resize(facets[f].first + facets[f].count, f);
  }
};

/// Which edges of a triangle are among these keys, which are sorted: bit i for edge i.
inline std::uint8_t mask_of(const PlanarTriangle& t, std::span<const std::uint64_t> keys) {
  unsigned mask = 0;
  for (std::size_t i = 0; i < 3; ++i)
    if (std::binary_search(keys.begin(), keys.end(), edge_key(t[(i + 1) % 3], t[(i + 2) % 3]))) mask |= 1u << i;
  return static_cast<std::uint8_t>(mask);
}

}  // namespace pgdr::detail
