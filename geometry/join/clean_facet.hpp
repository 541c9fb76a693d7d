// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// An input facet by its distinct points.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "input/triangle_shapes.hpp"
#include "join/build_input.hpp"
#include "join/build_report.hpp"
#include "join/near_contacts.hpp"
#include "space/planar_cdt.hpp"

namespace pgdr::detail {

struct CleanFacet {
  using Loops = std::vector<std::vector<std::uint32_t>>;

  Loops given;                          ///< as the input has them, but for neighbours that are one point
  Loops loops;                          ///< these, through the points that are near to them
  std::vector<std::uint32_t> vertices;  ///< sorted, distinct
  std::vector<PlanarEdge> edges;        ///< sorted, distinct, smaller index first

  /// Lets the given loops of facet f go through the points that are near to them.
  void join(std::uint32_t f, const NearContacts& near);
  /// The points of the given loops that are within the tolerance of given edges.
  std::vector<NearPoint> points_near_own_edges(const BuildInput<3>& in) const;
  /// Splits edges, in space, at points of the facet that lie exactly inside them; where points do so in the projection alone
  /// the facet stays as it was. True if any did.
  bool split_at_own_points(std::span<const Point3> points, BuildReport<3>& report);
  /// Newell's normal of the polygon that has the largest.
  std::array<double, 3> normal(const TriangleShapes& shapes) const;
  /// The longest side of its bounding box.
  double extent(std::span<const Point3> points) const;
};

/// Facet f of the input; edges of length zero are dropped, and it goes through the points that are near to it.
CleanFacet clean_facet(const BuildInput<3>& in, std::uint32_t f, const NearContacts& near, BuildReport<3>& report);

}  // namespace pgdr::detail
