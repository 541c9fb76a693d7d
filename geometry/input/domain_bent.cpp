// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Continues the second step of a Domain (3D): how far polygons are from planar. A polygon that rounding has bent stays one
// facet. One that is bent by more is no facet that could be refined in a plane: where its triangles meet at a fold its mesh
// would cut across, and what is apart in space may touch in the projection. So it becomes its planar parts, with segments
// along the folds.
#include <algorithm>
#include <cmath>
#include <numeric>

#include "input/domain_builder.hpp"
#include "pgdr/predicates.hpp"

namespace pgdr {
using detail::CleanFacet;
using detail::TriangulatedFacet;

template <int D>
void DomainBuilder<D>::measure_planarity(TriangulatedFacet& facet, const CleanFacet& clean) requires(D == 3) {
  const auto area = [&](const Triangle& t) { return std::fabs(normal(t)[static_cast<std::size_t>(facet.axis)]); };
  const auto begin = triangles_.begin() + facet.first;
  const auto largest = std::max_element(begin, triangles_.end(),
                                        [&](const Triangle& s, const Triangle& t) { return area(s) < area(t); });
  const Point3 &a = out_.points_[(*largest)[0]], &b = out_.points_[(*largest)[1]], &c = out_.points_[(*largest)[2]];
  for (const std::uint32_t v : clean.vertices) {
    const Point3& p = out_.points_[v];
    if (p == a || p == b || p == c || orient3d(a, b, c, p) == Sign::zero) continue;
    facet.planar = false;
    facet.defect = std::max(facet.defect, detail::plane_distance(a, b, c, p));
  }
}

/// The longest side of its bounding box.
template <int D>
double DomainBuilder<D>::extent(const CleanFacet& clean) const requires(D == 3) {
  double longest = 0;
  for (int i = 0; i < 3; ++i) {
    const auto before = [&](std::uint32_t v, std::uint32_t w) { return out_.points_[v][i] < out_.points_[w][i]; };
    const auto [low, high] = std::minmax_element(clean.vertices.begin(), clean.vertices.end(), before);
    longest = std::max(longest, out_.points_[*high][i] - out_.points_[*low][i]);
  }
  return longest;
}

/// Of each triangle of the facet the least one that is reached over edges, not of the polygons, between coplanar ones.
template <int D>
std::vector<std::uint32_t> DomainBuilder<D>::planar_parts(const TriangulatedFacet& whole) requires(D == 3) {
  std::vector<std::pair<std::uint64_t, std::uint32_t>> sides;  // of an edge, 3 times the triangle plus the side
  for (std::uint32_t k = 0; k < 3 * whole.count; ++k) {
    const Triangle& t = triangles_[whole.first + k / 3];
    sides.emplace_back(detail::edge_key(t[(k + 1) % 3], t[(k + 2) % 3]), k);
  }
  std::sort(sides.begin(), sides.end());
  std::vector<std::uint32_t> least(whole.count);
  std::iota(least.begin(), least.end(), 0u);
  const auto root = [&](std::uint32_t k) {
    while (least[k] != k) k = least[k] = least[least[k]];
    return k;
  };
  const auto& p = out_.points_;
  for (std::size_t n = 1; n < sides.size(); ++n) {
    const std::uint32_t k = sides[n - 1].second, j = sides[n].second;
    auto& mask = masks_[whole.first + k / 3];
    if (sides[n - 1].first != sides[n].first || (mask >> k % 3 & 1) != 0) continue;
    const Triangle& t = triangles_[whole.first + k / 3];
    const std::uint32_t across = triangles_[whole.first + j / 3][j % 3];
    if (orient3d(p[t[0]], p[t[1]], p[t[2]], p[across]) == Sign::zero) {
      const std::uint32_t a = root(k / 3), b = root(j / 3);
      least[std::max(a, b)] = std::min(a, b);
    } else {
      mask |= static_cast<std::uint8_t>(1u << k % 3);
      masks_[whole.first + j / 3] |= static_cast<std::uint8_t>(1u << j % 3);
    }
  }
  for (std::uint32_t k = 0; k < whole.count; ++k) least[k] = root(k);
  return least;
}

/// In place of the whole, whose triangles are the last ones so far.
template <int D>
void DomainBuilder<D>::add_pieces(const TriangulatedFacet& whole, const CleanFacet& clean) requires(D == 3) {
  const std::vector<std::uint32_t> part = planar_parts(whole);
  const std::vector<Triangle> triangles(triangles_.begin() + whole.first, triangles_.end());
  const std::vector<std::uint8_t> masks(masks_.begin() + whole.first, masks_.end());
  triangles_.resize(whole.first);
  masks_.resize(whole.first);
  std::vector<std::pair<std::uint64_t, std::uint32_t>> edges;  // and a piece that has it
  for (std::uint32_t k = 0; k < whole.count; ++k) {
    if (part[k] != k) continue;
    const auto piece = static_cast<std::uint32_t>(facets_.size());
    const auto [axis, side] = visible_side(triangles[k]);
    TriangulatedFacet out{whole.input, static_cast<std::uint32_t>(triangles_.size()), 0, axis};
    out.reversed = whole.reversed != (side < 0);
    for (std::uint32_t j = k; j < whole.count; ++j) {
      if (part[j] != k) continue;
      Triangle t = triangles[j];
      std::uint8_t mask = masks[j];
      for (std::size_t i = 0; i < 3; ++i) edges.emplace_back(detail::edge_key(t[i], t[(i + 1) % 3]), piece);
      if (side < 0) {
        std::swap(t[1], t[2]);
        mask = static_cast<std::uint8_t>((mask & 1) | (mask & 2) << 1 | (mask & 4) >> 1);
      }
      triangles_.push_back(t);
      masks_.push_back(mask);
    }
    out.count = static_cast<std::uint32_t>(triangles_.size()) - out.first;
    facets_.push_back(out);
  }
  std::sort(edges.begin(), edges.end());
  for (const detail::PlanarEdge& e : clean.edges) {
    const auto at = std::lower_bound(edges.begin(), edges.end(), std::pair(detail::edge_key(e[0], e[1]), 0u));
    const bool found = at != edges.end() && at->first == detail::edge_key(e[0], e[1]);
    polygon_edges_.push_back({e, found ? at->second : static_cast<std::uint32_t>(facets_.size() - 1)});
  }
  bent_facets_.add([&] { return std::to_string(number(whole.input)); }, {number(whole.input)});
}

template void DomainBuilder<3>::measure_planarity(TriangulatedFacet&, const CleanFacet&);
template double DomainBuilder<3>::extent(const CleanFacet&) const;
template void DomainBuilder<3>::add_pieces(const TriangulatedFacet&, const CleanFacet&);

}  // namespace pgdr
