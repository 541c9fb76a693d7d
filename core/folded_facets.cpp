// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "pgdr/folded_facets.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <tuple>
#include <vector>

#include "detail/named_points.hpp"

namespace pgdr {
namespace {

constexpr double more_than_rounding = 0x1p-40;  // of the largest coordinate
constexpr double whole = 1 - 0x1p-30;           // the sum of the pieces, each of which is rounded

bool has_bent_facets(const Domain<3>& domain) {
  for (EntityId f = 0; f < domain.facets().size(); ++f)
    if (domain.facets()[f].planarity_defect > more_than_rounding * domain.facet_magnitude(f)) return true;
  return false;
}

using Piece = std::tuple<EntityId, VertexId, VertexId>;

/// Each subsegment at a cell, once.
std::vector<Piece> subsegments(const Mesh<3>& mesh) {
  std::vector<Piece> pieces;
  for (std::uint32_t i = 0; i < mesh.cell_bound(); ++i) {
    const CellId c{i};
    const auto* k = mesh.alive(c) ? mesh.constraints(c) : nullptr;
    if (!k) continue;
    const auto& v = mesh.cell(c).vertices;
    for (int e = 0; e < 6; ++e)
      if (k->edges >> e & 1) {
        const auto [a, b] = std::minmax(v[edge_ends[e][0]], v[edge_ends[e][1]]);
        pieces.emplace_back(k->edge_entity[e], a, b);
      }
  }
  std::sort(pieces.begin(), pieces.end());
  pieces.erase(std::unique(pieces.begin(), pieces.end()), pieces.end());
  return pieces;
}

}  // namespace

void require_unfolded(const Mesh<3>& mesh, const Domain<3>& domain) {
  if (!has_bent_facets(domain)) return;
  std::vector<double> length(domain.segments().size());
  for (const auto& [s, a, b] : subsegments(mesh)) length[s] += std::sqrt(squared_distance(mesh.point(a), mesh.point(b)));
  for (EntityId s = 0; s < length.size(); ++s) {
    const auto& ends = domain.segments()[s].points;
    const Point3 &p = domain.points()[ends[0]], &q = domain.points()[ends[1]];
    if (length[s] == 0 || length[s] >= whole * std::sqrt(squared_distance(p, q))) continue;
    Diagnostic d = detail::about_points<3>(Errc::boundary_not_recovered, domain, ends);
    d.message = "facets that are planar only within the precision fold over at " + detail::segment_words(d) +
                "; another precision may keep them apart";
    throw InputError(std::move(d));
  }
}

}  // namespace pgdr
