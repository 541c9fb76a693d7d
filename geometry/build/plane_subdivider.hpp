// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Continues the fourth step of a Domain (3D): what meets inside of a common plane. Facets that overlap are subdivided along each
// other's outlines, and what several of them have becomes that of the first one, or, where markers differ, of the smallest; an
// edge that runs inside of a facet becomes an edge of its triangulation. Where edges cross inside of such a plane, but for those
// between triangles of one plane that are no segments, a point is added, and all facets and segments that have the edges go
// through it. Then the triangles of each cluster, the facets that hang together by overlapping or by such an edge across what is
// no segment, are made anew together.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "build/edge_crossings.hpp"
#include "build/facet_areas.hpp"
#include "build/plane_edges.hpp"
#include "build/plane_meetings.hpp"
#include "join/build_input.hpp"
#include "join/build_report.hpp"
#include "join/facet_triangles.hpp"
#include "space/disjoint_sets.hpp"

namespace pgdr::detail {

class PlaneSubdivider {
 public:
  /// `in`: looks at the lists of points, also at what is added to them.
  PlaneSubdivider(BuildInput<3>& in, PointLists lists, FacetTriangles& faces, std::vector<OwnedEdge>& segment_edges,
                  BuildReport<3>& report);

  /// Subdivides. True if anything met.
  bool run();
  /// Refuses what meets still, as near as the tolerance says. (Where it meets exactly the diagnosis says so.)
  void refuse_rest();

 private:
  using Edges = std::vector<std::pair<std::uint32_t, std::uint64_t>>;

  void find_crossings(const PlaneMeetings& met, const PlaneEdges& edges, const PlaneWidth& width);
  bool crosses_plane(std::uint32_t f, std::uint64_t key, const PlaneEdges& edges) const;
  void look_across(std::uint32_t t, std::uint64_t key, const PlaneEdges& edges);
  void add_crossing(std::uint64_t first, std::uint64_t second, const PlaneEdges& edges);
  void find_inner_crossings(const PlaneEdges& edges, const PlaneWidth& width);
  void cross_each_other(std::span<const std::uint64_t> inside, int axis, const PlaneEdges& edges, const PlaneWidth& width);
  void split_at_crossings(const PlaneWidth& width);
  void triangulate(const PlaneMeetings& met, const PlaneEdges& edges, const PlaneWidth& width);
  void note_inside(std::span<const std::uint32_t> cluster, std::span<const std::uint64_t> inside, const PlaneEdges& edges);
  void note_overlaps(const PlaneMeetings& met);
  void name_planes();
  void mark_bent_facets();

  BuildInput<3>& in_;
  PointLists lists_;
  FacetTriangles& faces_;
  std::vector<OwnedEdge>& segment_edges_;
  BuildReport<3>& report_;
  std::uint32_t first_added_;
  std::optional<FacetAreas> areas_;  // as facets were before anything was subdivided
  // Of a round.
  DisjointSets clusters_{0};                                       // of facets
  std::vector<std::uint32_t> plane_of_;                            // of each facet the name of its cluster
  std::vector<std::uint32_t> touched_;                             // facets of clusters
  Edges inner_;                                                    // facet, edge inside it that is no soft one
  std::vector<std::pair<std::uint64_t, std::uint64_t>> crossing_;  // pairs of edges
};

}  // namespace pgdr::detail
