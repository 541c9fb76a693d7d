// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "run/folded_facets.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <string>
#include <tuple>
#include <vector>

#include "boundary/named_points.hpp"
#include "compact/compact.hpp"
#include "pgdr/check.hpp"
#include "space/bulk.hpp"

namespace pgdr {
namespace {

constexpr const char* advice = "; another tolerance may keep them apart";
constexpr double more_than_rounding = 0x1p-40;  // of the largest coordinate
constexpr double whole = 1 - 0x1p-30;           // the sum of the pieces, each of which is rounded
constexpr double as_short = 0x1p-34;            // of the largest coordinate: longer segments no rounding folds over
constexpr double as_near = 1e-6;  // degrees: at larger angles no rounding folds facets over that are not thin themselves

bool is_bent(const Domain<3>& domain, EntityId f, double by_more_than) {
  return domain.facets()[f].planarity_defect > by_more_than * domain.facet_magnitude(f);
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

/// May rounding fold facets at the segment, one of them not exactly planar, as it is so short or they are so near?
bool is_tight(const Domain<3>& domain, EntityId s) {
  const auto facets = domain.facets_of_segment(s);
  if (std::none_of(facets.begin(), facets.end(), [&](EntityId f) { return is_bent(domain, f, 0); })) return false;
  const auto& [a, b] = domain.segments()[s].points;
  const double length = std::sqrt(squared_distance(domain.points()[a], domain.points()[b]));
  if (length < as_short * domain.segment_magnitude(s)) return true;
  for (std::size_t i = 0; i < facets.size(); ++i)
    for (std::size_t k = i + 1; k < facets.size(); ++k)
      if (entity_angle(domain, {EntityKind::facet, facets[i]}, {EntityKind::facet, facets[k]}) < as_near) return true;
  return false;
}

void require_whole_segments(const Mesh<3>& mesh, const Domain<3>& domain) {
  std::vector<double> length(domain.segments().size());
  for (const auto& [s, a, b] : subsegments(mesh)) length[s] += std::sqrt(squared_distance(mesh.point(a), mesh.point(b)));
  for (EntityId s = 0; s < length.size(); ++s) {
    const auto& ends = domain.segments()[s].points;
    const Point3 &p = domain.points()[ends[0]], &q = domain.points()[ends[1]];
    if (length[s] == 0 || length[s] >= whole * std::sqrt(squared_distance(p, q))) continue;
    Diagnostic d = detail::about_points<3>(Errc::boundary_not_recovered, domain, ends);
    d.message = "facets that are planar only within the tolerance fold over at " + detail::segment_words(d) + advice;
    throw InputError(std::move(d));
  }
}

EntityId most_bent_facet(const Domain<3>& domain) {
  EntityId most = 0;
  for (EntityId f = 1; f < domain.facets().size(); ++f)
    if (domain.facets()[f].planarity_defect > domain.facets()[most].planarity_defect) most = f;
  return most;
}

/// Is this a mesh of the domain? Before the refinement it need not be Delaunay, which flat cells at bent facets may prevent.
bool conforms(const OutputMesh<3>& mesh, const Domain<3>& domain, RegionMode regions, const std::stop_token& stop) {
  CheckOptions<3> options;
  options.domain = &domain;
  options.regions = regions;
  options.max_listed = 0;
  options.stop = stop;
  const CheckReport report = check<3>(mesh, options);
  return report.finding_count == report.count(CheckFinding::Kind::not_delaunay);
}

}  // namespace

bool may_fold(const Domain<3>& domain, const detail::Pieces& pieces) {
  const detail::Bulk bulk(pieces);
  std::atomic<bool> may = false;
  const auto look = [&](std::size_t count, const auto& is_suspect) {
    bulk.each(count, [&](std::size_t i) {
      if (!may.load(std::memory_order_relaxed) && is_suspect(static_cast<EntityId>(i)))
        may.store(true, std::memory_order_relaxed);
    });
  };
  look(domain.facets().size(), [&](EntityId f) { return is_bent(domain, f, more_than_rounding); });
  look(domain.segments().size(), [&](EntityId s) { return is_tight(domain, s); });
  return may;
}

void require_unfolded(const Mesh<3>& mesh, const Domain<3>& domain, RegionMode regions, std::span<const double> region_attributes,
                      const detail::Pieces& pieces, const std::stop_token& stop) {
  if (!may_fold(domain, pieces)) return;
  require_whole_segments(mesh, domain);
  if (conforms(compact_by_slots<3>(mesh, domain, region_attributes, pieces).mesh, domain, regions, stop)) return;
  const EntityId f = most_bent_facet(domain);
  Diagnostic d = detail::about_points<3>(Errc::boundary_not_recovered, domain, domain.facet_points(f));
  char defect[32];
  std::snprintf(defect, sizeof defect, "%.3g", domain.facets()[f].planarity_defect);
  d.message = "facets that are planar only within the tolerance fold over, or touch; " + detail::facet_words(d) +
              " is off its plane by " + defect + advice;
  throw InputError(std::move(d));
}

}  // namespace pgdr
