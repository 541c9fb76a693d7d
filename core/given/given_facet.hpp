// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The triangulation of one facet of the input, of its own polygons alone.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "pgdr/plc.hpp"

namespace pgdr::checking {

struct FacetTriangulation {
  std::vector<std::array<std::uint32_t, 3>> triangles;    ///< indices into Plc::points
  std::vector<std::array<std::uint32_t, 2>> inner_edges;  ///< of polygons, with the facet on both sides or on none
  double bend = 0;                                        ///< see GivenInput::bend
  bool failed = false;                                    ///< its edges cross by more than `reach`
};

/// Nothing, if all points of the facet are on one line. Points of it within `reach` of each other, or of its edges, are joined
/// where its polygons cannot be triangulated otherwise.
FacetTriangulation triangulate_given(const Plc<3>& plc, std::uint32_t facet, double reach);

}  // namespace pgdr::checking
