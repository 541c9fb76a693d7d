// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// What meets inside of a common plane (3D): facets that overlap with an area, and edges that run inside of facets. Exactly, or as
// near as the tolerance says all along. Points that lie on edges and facets are points of them by now, so that two triangles
// overlap only if they have the same corners or an edge of the one runs inside of the other.
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "join/build_input.hpp"
#include "join/facet_triangles.hpp"

namespace pgdr::detail {

struct PlaneMeetings {
  std::vector<std::pair<std::uint32_t, std::uint64_t>> inner;     ///< a triangle, and an edge that runs inside it
  std::vector<std::pair<std::uint32_t, std::uint32_t>> overlaps;  ///< triangulated facets, the smaller number first

  bool empty() const { return inner.empty() && overlaps.empty(); }
};

/// How near is near: the tolerance; of what goes through points that were added, which are rounded, at least their rounding.
class PlaneWidth {
 public:
  /// `first_added`: the number of the first such point.
  PlaneWidth(const BuildInput<3>& in, std::uint32_t first_added);

  /// Of what has these corners, times BuildInput::scale; 0: exactly.
  template <class Corners>
  double of(const Corners& corners) const {
    for (const std::uint32_t v : corners)
      if (is_added(v)) return added_;
    return given_;
  }
  bool is_added(std::uint32_t v) const { return v >= first_added_ && v != no_entity; }
  /// Of added points.
  double of_added() const { return added_; }
  /// The largest, in units of the coordinates.
  double largest() const { return largest_; }

 private:
  double given_, added_, largest_;
  std::uint32_t first_added_;
};

/// Both lists are sorted and distinct. Indexes the facets of triangles. Near-linear in the size of the input and the number of
/// pairs that meet, in parallel.
PlaneMeetings find_plane_meetings(const BuildInput<3>& in, FacetTriangles& faces, std::span<const OwnedEdge> segment_edges,
                                  const PlaneWidth& width);

}  // namespace pgdr::detail
