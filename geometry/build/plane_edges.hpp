// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Which edges between triangles of one plane are no segments (3D), where facets overlap there: of these several may have the same
// edge. It is no segment where it lies inside of each facet that has it, or between two of equal markers, one on each side.
#pragma once

#include <cstdint>
#include <span>

#include "build/joints.hpp"
#include "build/plane_meetings.hpp"
#include "join/build_input.hpp"
#include "join/edge_uses.hpp"
#include "join/facet_triangles.hpp"

namespace pgdr::detail {

class PlaneEdges {
 public:
  /// @pre the facets of triangles are indexed
  PlaneEdges(const BuildInput<3>& in, const FacetTriangles& faces, const EdgeUses& uses, const PlaneWidth& width)
      : in_(in), faces_(faces), uses_(uses), width_(width), joints_(in, faces) {}

  std::span<const EdgeUse> uses(std::uint64_t key) const { return uses_.of(key); }
  /// The facet beyond an edge of triangle t, inside of a facet that itself; no_entity if the edge is a segment as far as the
  /// triangle's facet goes. `plane_of`: of each facet a name of its plane.
  std::uint32_t beyond(std::uint32_t t, std::size_t edge, std::span<const std::uint32_t> plane_of) const;
  /// Is it no segment, whichever facet has it?
  bool is_soft(std::uint64_t key, std::span<const std::uint32_t> plane_of) const;
  /// Is it an edge of segments of the input alone, which no facet would have without them?
  bool is_of_segments(std::uint64_t key) const;
  /// Is it an edge of the outline of a facet, or of a triangle of the input?
  bool is_on_outline(std::uint64_t key) const;

 private:
  bool lies_in_plane(std::span<const EdgeUse> uses, std::uint32_t plane, std::span<const std::uint32_t> plane_of) const;
  std::uint32_t partner(std::uint32_t t, std::span<const EdgeUse> uses) const;

  const BuildInput<3>& in_;
  const FacetTriangles& faces_;
  const EdgeUses& uses_;
  const PlaneWidth& width_;
  Joints joints_;
};

}  // namespace pgdr::detail
