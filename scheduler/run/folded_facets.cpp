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
#include "run/numbers.hpp"
#include "space/bulk.hpp"

namespace pgdr {
namespace {

constexpr const char* advice = "; another tolerance may keep them apart";

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
  if (length < numbers::foldable_length * domain.segment_magnitude(s)) return true;
  for (std::size_t i = 0; i < facets.size(); ++i)
    for (std::size_t k = i + 1; k < facets.size(); ++k)
      if (entity_angle(domain, {EntityKind::facet, facets[i]}, {EntityKind::facet, facets[k]}) < numbers::foldable_degrees)
        return true;
  return false;
}

void require_whole_segments(const Mesh<3>& mesh, const Domain<3>& domain) {
  std::vector<double> length(domain.segments().size());
  for (const auto& [s, a, b] : subsegments(mesh)) length[s] += std::sqrt(squared_distance(mesh.point(a), mesh.point(b)));
  for (EntityId s = 0; s < length.size(); ++s) {
    const auto& ends = domain.segments()[s].points;
    const Point3 &p = domain.points()[ends[0]], &q = domain.points()[ends[1]];
    if (length[s] == 0 || length[s] >= (1 - numbers::lost_of_segment) * std::sqrt(squared_distance(p, q))) continue;
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

/// The domain as an input: a facet for each triangle, so that edges between those of one facet are none of its segments.
Plc<3> input_of(const Domain<3>& domain) {
  Plc<3> plc;
  plc.points.assign(domain.points().begin(), domain.points().end());
  for (const DomainSegment& s : domain.segments()) plc.segments.push_back({s.points, s.marker});
  for (EntityId f = 0; f < domain.facets().size(); ++f)
    for (const auto& t : domain.triangles(f)) {
      auto& facet = plc.facets.emplace_back();
      facet.polygons.push_back({t[0], t[1], t[2]});
      facet.marker = domain.facets()[f].marker;
    }
  plc.holes.assign(domain.holes().begin(), domain.holes().end());
  plc.regions.assign(domain.regions().begin(), domain.regions().end());
  return plc;
}

/// Is this a mesh of the domain, up to what facets are off their planes? Before the refinement it need not be Delaunay, which
/// flat cells at bent facets may prevent. What is outside may be as near: which of facets has what they have in
/// common, and what of segments is there, is not asked here.
bool conforms(const OutputMesh<3>& mesh, const Domain<3>& domain, RegionMode regions, const std::stop_token& stop) {
  const Plc<3> plc = input_of(domain);
  CheckOptions<3> options;
  options.input = &plc;
  options.tolerance = std::max(domain.tolerance(), domain.facets()[most_bent_facet(domain)].planarity_defect);
  options.regions = regions;
  options.max_listed = 0;
  options.stop = stop;
  const CheckReport report = check<3>(mesh, options);
  using Kind = CheckFinding::Kind;
  const auto others = {Kind::not_delaunay, Kind::wrong_marker, Kind::segment_not_conforming, Kind::missing_input_point};
  std::uint64_t passed = 0;
  for (const Kind kind : others) passed += report.count(kind);
  return report.finding_count == passed;
}

/// A subfacet at one of its edges.
struct FacetEdge {
  EntityId facet;
  std::array<std::uint32_t, 2> ends;  // sorted
  std::uint32_t apex;
  friend auto operator<=>(const FacetEdge&, const FacetEdge&) = default;
};

/// Twice the area of the triangle from its edge to x, in the projection along the axis, positive on one side of the edge; 0 if
/// that is no more than what rounding of its corners can make.
double side_of(const Point3& a, const Point3& b, const Point3& x, int axis, double rounding) {
  const int i = (axis + 1) % 3, k = (axis + 2) % 3;
  const double doubled = (b[i] - a[i]) * (x[k] - a[k]) - (b[k] - a[k]) * (x[i] - a[i]);
  const double longest = std::sqrt(std::max({squared_distance(a, b), squared_distance(b, x), squared_distance(x, a)}));
  return std::abs(doubled) > rounding * longest ? doubled : 0;
}

/// Are two subfacets of one facet on the same side of an edge between them that is no subsegment, in the facet's projection?
bool has_turned_subfacets(const OutputMesh<3>& mesh, const Domain<3>& domain) {
  constexpr double ulps = 8;  // two of each of the four numbers of an area
  std::vector<FacetEdge> edges;
  edges.reserve(3 * mesh.subfacets.size());
  for (const auto& s : mesh.subfacets)
    for (std::size_t i = 0; i < 3; ++i) {
      const auto [a, b] = std::minmax(s.vertices[(i + 1) % 3], s.vertices[(i + 2) % 3]);
      edges.push_back({s.entity, {a, b}, s.vertices[i]});
    }
  std::sort(edges.begin(), edges.end());
  std::vector<std::array<std::uint32_t, 2>> subsegments;
  for (const auto& s : mesh.subsegments)
    subsegments.push_back({std::min(s.vertices[0], s.vertices[1]), std::max(s.vertices[0], s.vertices[1])});
  std::sort(subsegments.begin(), subsegments.end());
  for (std::size_t i = 1; i < edges.size(); ++i) {
    const FacetEdge &e = edges[i - 1], &other = edges[i];
    if (e.facet != other.facet || e.ends != other.ends || std::ranges::binary_search(subsegments, e.ends)) continue;
    const double rounding = ulps * 0x1p-52 * domain.facet_magnitude(e.facet);
    const auto side = [&](std::uint32_t apex) {
      return side_of(mesh.points[e.ends[0]], mesh.points[e.ends[1]], mesh.points[apex], domain.facets()[e.facet].axis, rounding);
    };
    if (side(e.apex) * side(other.apex) > 0) return true;
  }
  return false;
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
  look(domain.facets().size(), [&](EntityId f) { return is_bent(domain, f, numbers::bent_beyond_rounding); });
  look(domain.segments().size(), [&](EntityId s) { return is_tight(domain, s); });
  return may;
}

void require_unfolded(const Mesh<3>& mesh, const Domain<3>& domain, RegionMode regions, std::span<const double> region_attributes,
                      const detail::Pieces& pieces, const std::stop_token& stop) {
  if (!may_fold(domain, pieces)) return;
  require_whole_segments(mesh, domain);
  const OutputMesh<3> made = compact_by_slots<3>(mesh, domain, region_attributes, pieces).mesh;
  if (!has_turned_subfacets(made, domain) && conforms(made, domain, regions, stop)) return;
  const EntityId f = most_bent_facet(domain);
  Diagnostic d = detail::about_points<3>(Errc::boundary_not_recovered, domain, domain.facet_points(f));
  char defect[32];
  std::snprintf(defect, sizeof defect, "%.3g", domain.facets()[f].planarity_defect);
  d.message = "facets that are planar only within the tolerance fold over, or touch; " + detail::facet_words(d) +
              " is off its plane by " + defect + advice;
  throw InputError(std::move(d));
}

}  // namespace pgdr
