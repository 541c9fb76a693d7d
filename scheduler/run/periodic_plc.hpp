// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// A spatial input with the triangles of periodic sides in the place of their facets. One thread.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "pgdr/domain.hpp"
#include "pgdr/make_periodic.hpp"
#include "run/side_surface.hpp"

namespace pgdr::detail {

/// Facets of sides go, and triangles of all sides stand before all other facets, so that they have what several have as before.
/// Whatever else has an edge with points of the sides is divided there, so that nothing has to be joined.
class PeriodicPlc {
 public:
  /// All must outlive it. @param points  first those of the domain
  PeriodicPlc(const Plc<3>& given, const Domain<3>& domain, const SideInput<3>& input, const NearPoints<3>& points);

  void add(const SideChain<3>& chain, const std::vector<SideTriangle>& triangles);
  /// What was added, then the others. Fills plc, given_facets, inner_edges and added_points.
  void finish(PeriodicInput<3>& out);

 private:
  using Side = SideChain<3>::Side;
  using Polygon = std::vector<std::uint32_t>;

  void number_points(const SideChain<3>& chain, const Side& side);
  void add_point(const SideChain<3>& chain, const Side& side, std::uint32_t place);
  void add_triangle(const Side& side, const SideTriangle& triangle, const SideChain<3>& chain);
  bool is_on_line(const Side& side, const Point3& p, const Point3& q) const;
  void add_facet(Plc<3>::Facet facet, std::uint32_t given);
  void add_other_facets();
  void add_segments();
  Polygon divided(std::uint32_t a, std::uint32_t b) const;
  Polygon divided(const Polygon& polygon) const;

  const Plc<3>& given_;
  const Domain<3>& domain_;
  const SideInput<3>& input_;
  const NearPoints<3>& points_;
  std::vector<std::array<std::uint32_t, 2>> walls_;  // facet of the domain, and which of its triangles
  BoxTree<3> lines_;                                 // of the input
  std::vector<std::uint32_t> number_;                // in the new input, of each point; no_entity: none yet
  std::vector<std::uint8_t> is_side_;                // of given facets
  std::vector<std::uint32_t> on_lines_;              // new points on pieces
  std::vector<std::array<std::uint32_t, 2>> edges_, pieces_;
  BoxTree<3> tree_;  // of on_lines_
  Plc<3> plc_;
  std::vector<std::uint32_t> given_facets_;
};

}  // namespace pgdr::detail
