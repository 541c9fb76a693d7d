// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Conformity, combinatorial and metric: which input entity each vertex, subsegment and subfacet of the mesh belongs to,
// decided from connectivity between input points (the files carry no entity numbers), then tested against the entity's
// line or plane.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "check/links.hpp"
#include "check/volumes/input_volumes.hpp"
#include "numbers/exact_tests.hpp"

namespace pgdr::checking {

/// Where a subsegment or a wall belongs.
struct Place {
  std::uint32_t entity = none;  ///< a segment, resp. a patch of InputVolumes
  bool reversed = false;        ///< its vertices run from the segment's end to its start, resp. its sides are swapped
};

template <int D>
struct Conformity {
  std::vector<std::uint32_t> vertex_of_point;  ///< of each domain point; none
  std::vector<EntityRef> home;                 ///< of each vertex: the lowest entity that it lies on
  std::vector<Place> segment_of;               ///< of each subsegment
  std::vector<std::uint32_t> pieces;           ///< of each segment: the number of its subsegments
  std::vector<Place> patch_of;                 ///< of each wall
};

/// What the stages of conformity work on.
template <int D>
struct ConformityTask {
  const OutputMesh<D>& mesh;
  const InputVolumes<D>& input;
  int ulps;
  Findings& findings;
};

/// Every wanted input point is a vertex of a cell and has its marker; no other vertex is loose.
/// @param sorted the vertices in lexicographic order of coordinates.
template <int D>
void match_points(const ConformityTask<D>& task, std::span<const std::uint32_t> sorted, Conformity<D>& out);

/// The subsegments of each wanted segment are one chain between its ends, on its line, in order, with its marker.
template <int D>
void match_segments(const ConformityTask<D>& task, Conformity<D>& out);

/// 3D: the subfacets of each wanted facet are a disc with its holes, bounded by those chains, on its plane, with its
/// marker.
void match_facets(const ConformityTask<3>& task, Conformity<3>& out);

template <int D>
Conformity<D> check_conformity(const ConformityTask<D>& task, std::span<const std::uint32_t> sorted) {
  Conformity<D> out;
  match_points(task, sorted, out);
  match_segments(task, out);
  if constexpr (D == 3) match_facets(task, out);
  return out;
}

/// Parallel to an axis: its points are representable, so that nothing moves by rounding.
template <int D>
bool axis_aligned_segment(const Domain<D>& domain, EntityId segment);
bool axis_aligned_facet(const Domain<3>& domain, EntityId facet);

/// How far rounding may have moved each vertex off its entity, per coordinate and in distance: 0 for volume points, points of
/// axis-aligned entities, and input points but those of a facet that is not exactly planar. As much for these as for points
/// put on the facet, however far off its plane they are.
template <int D>
std::vector<double> slack_of_vertices(const Domain<D>& domain, std::span<const EntityRef> home, int ulps);

}  // namespace pgdr::checking
