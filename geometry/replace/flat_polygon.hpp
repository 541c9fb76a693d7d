// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// A part of a plane, known by its edges, as one facet of a Plc.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "numbers/vectors.hpp"
#include "pgdr/plc.hpp"
#include "space/planar_cdt.hpp"

namespace pgdr::detail {

/// What bounds a part that hangs together by edges, and the plane that it is in, by numbers of points.
struct FlatRim {
  std::vector<PlanarEdge> rim;    ///< as the part's triangles run
  std::vector<PlanarEdge> inner;  ///< edges inside of it that are kept
  int axis = 2;                   ///< the coordinate dropped in its projection
  Sign way = Sign::positive;      ///< how its triangles run in that
  Point3 anchor{};                ///< on the plane
  Vector<3> normal{};             ///< of the plane, of length 1
  bool may_touch_itself = false;  ///< at points: the rim as a whole, each loop of it does not
};

/// Its outer polygon, those of its holes with their seeds, and inner edges. None where its outline touches itself and may not, or
/// comes so near to itself that it is none once points on its edges are rounded.
std::optional<Plc<3>::Facet> polygon_of(std::span<const Point3> points, const FlatRim& rim);

}  // namespace pgdr::detail
