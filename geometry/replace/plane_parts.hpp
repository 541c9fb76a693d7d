// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The facets of a Domain, put together where they are one. A Domain joins facets of one plane by normals in doubles, of which
// those of needles that are 10,000 times as long as wide say nothing to the tolerance; what a mesh has made of a needle are such
// pieces. Here normals have twice the digits.
#pragma once

#include <cstdint>
#include <vector>

#include "numbers/vectors.hpp"
#include "pgdr/domain.hpp"
#include "space/planar_cdt.hpp"

namespace pgdr::detail {

struct PlanePart {
  int marker = 0;
  int axis = 2;                           ///< the coordinate dropped in its projection
  Vector<3> normal{};                     ///< of length 1
  std::vector<PlanarTriangle> triangles;  ///< all positive in that; one of the largest is first
  std::vector<std::uint32_t> inputs;      ///< of each triangle, a facet of the input
  std::vector<std::uint32_t> points;      ///< all, sorted
};

/// Facets that have a common edge, which is of no other facet and no segment of the input, equal markers, and points within the
/// tolerance of one plane, two by two and as groups; a group that is not remains as it is in the Domain. In the order of their
/// first facets.
std::vector<PlanePart> plane_parts(const Domain<3>& domain);

}  // namespace pgdr::detail
