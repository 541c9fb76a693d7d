// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Continues the fourth step of a Domain (3D): an edge that runs exactly inside of a facet, between two of its points, or as
// near to it as points are merged, becomes an edge of its triangulation. Where it crosses edges between triangles of one plane
// that are no segments, the triangles on its way (also of several input facets that will be one) are triangulated anew
// together. What it crosses otherwise is for the diagnosis to tell.
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "input/steps/build_input.hpp"
#include "input/steps/build_report.hpp"
#include "input/steps/contact_resolver.hpp"
#include "input/steps/edge_uses.hpp"
#include "input/steps/facet_triangles.hpp"
#include "input/steps/joints.hpp"
#include "input/steps/near_search.hpp"
#include "space/disjoint_sets.hpp"
#include "space/planar_cdt.hpp"

namespace pgdr::detail {

class InnerEdges {
 public:
  /// @pre the facets of triangles are indexed
  InnerEdges(const BuildInput<3>& in, const NearSearch<3>& near, FacetTriangles& faces, std::span<const OwnedEdge> segment_edges,
             BuildReport<3>& report)
      : in_(in), near_(near), faces_(faces), segment_edges_(segment_edges), report_(report), joints_(in, faces) {}

  /// Finds such edges among what meets, and makes them edges of the triangulations of facets.
  void constrain(const ContactResolver<3>& met);
  /// Refuses edges that still run along a facet, as near to it as points are merged, and edges that pass each other as near where
  /// neither has a point. (Where they meet exactly the diagnosis says so.)
  void refuse_near_crossings() const;

 private:
  void find(const ContactResolver<3>& met);
  bool runs_inside(std::uint32_t a, std::uint32_t b, std::uint32_t t) const;
  void join_crossed(std::uint64_t key, std::uint32_t t, const EdgeUses& uses, DisjointSets& patches);
  std::uint32_t other_side(std::uint64_t key, std::uint32_t t, const EdgeUses& uses) const;
  void retriangulate(std::span<const std::uint32_t> patch, std::span<const std::uint64_t> edges, const EdgeUses& uses);
  std::vector<PlanarEdge> rim_of(std::span<const std::uint32_t> patch, int axis, const EdgeUses& uses) const;
  std::vector<std::uint64_t> constraints_on(std::span<const std::uint32_t> patch, std::span<const std::uint64_t> rim) const;
  bool is_exactly_flat(std::span<const std::uint32_t> patch, const PlanarTriangle& plane) const;
  void replace(std::span<const std::uint32_t> patch, const std::vector<std::uint64_t>& fixed,
               const std::vector<std::uint64_t>& edges);

  const BuildInput<3>& in_;
  const NearSearch<3>& near_;
  FacetTriangles& faces_;
  std::span<const OwnedEdge> segment_edges_;
  BuildReport<3>& report_;
  Joints joints_;
  std::vector<std::pair<std::uint32_t, std::uint64_t>> inner_;  // triangle, edge that runs inside it; sorted
  std::vector<PlanarTriangle> made_;                            // triangles and masks as they will be
  std::vector<std::uint8_t> made_masks_;
  std::vector<std::uint64_t> blocked_;   // of these, edges that cross what is fixed
  std::vector<std::uint64_t> given_up_;  // edges that were inside of what was triangulated anew
  PlanarTriangulation planar_;
};

}  // namespace pgdr::detail
