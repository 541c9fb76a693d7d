// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// How large facets are, where they overlap in a plane (3D): the smaller one says what is of both. What hangs together across
// edges that are no segments is one facet, so that it does not matter into how many an input has it divided.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "build/plane_meetings.hpp"
#include "join/build_input.hpp"
#include "join/edge_uses.hpp"
#include "join/facet_triangles.hpp"
#include "space/disjoint_sets.hpp"

namespace pgdr::detail {

/// In coordinates times BuildInput::scale.
struct FacetArea {
  double area = 0;
  double rim = 0;  ///< the length of what bounds it

  /// By more than what the width may have moved of both their rims.
  bool is_smaller_than(const FacetArea& other, double width) const { return area + width * (rim + other.rim) < other.area; }
};

class FacetAreas {
 public:
  /// Of the facets as they are now.
  FacetAreas(const BuildInput<3>& in, const FacetTriangles& faces, const EdgeUses& uses, const PlaneWidth& width);

  /// Of these facets, and of all that are one with any of them.
  FacetArea of(std::span<const std::uint32_t> facets);

 private:
  DisjointSets groups_;
  std::vector<FacetArea> areas_;  // of each group, by its first facet
};

}  // namespace pgdr::detail
