// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Where what was given crosses. Segments, or edges of facets that overlap: the mesh has a vertex there, also outside of its
// cells, that is no point of the input. Facets: the mesh has subsegments there that are no edge of any facet. (Facets that cross
// are meant only where both ends of the line that they have in common are points of both: others are refused.)
#pragma once

#include <memory>
#include <vector>

#include "given/cover.hpp"
#include "given/given_input.hpp"
#include "space/box_tree.hpp"

namespace pgdr::checking {

template <int D>
class GivenCrossings {
 public:
  /// Of edges that pass within r of a place.
  GivenCrossings(const GivenInput<D>& input, double r);
  /// Two that are not of one line pass there.
  bool has(const Point<D>& x) const;

 private:
  using Ends = std::array<Point<D>, 2>;
  double reach_;
  std::vector<Ends> edges_;
  std::unique_ptr<detail::BoxTree<D>> tree_;
};

/// Where given triangles of two planes cross.
class FacetCrossings {
 public:
  /// @param reach of each triangle, how far the mesh may be from it
  FacetCrossings(const GivenInput<3>& input, std::vector<double> reach);
  /// Appends the parts of the segment that lie on two of them.
  void append_parts(const std::array<Point3, 2>& segment, std::vector<CoveringSegment<3>>& out) const;

 private:
  bool are_even(std::uint32_t s, std::uint32_t t) const;
  const GivenInput<3>& input_;
  std::vector<double> reach_;
  std::unique_ptr<detail::BoxTree<3>> tree_;
};

}  // namespace pgdr::checking
