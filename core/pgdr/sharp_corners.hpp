// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Corners of the input at which no mesh meets the radius-edge bound. Where two segments of one facet (2D: any two) meet at an
// angle a with sin a < 1 / (2 bound), some subfacet at their common vertex lies between them. Its angle there is at most
// a and the edge opposite e, so that its circumradius is at least e / (2 sin a) > bound * e, while its shortest edge is at
// most e; the circumradius of a cell with that face is no smaller, its shortest edge no longer. So every mesh that keeps the
// facet has such a cell at each such corner, on each side of the facet that is in the domain.
#pragma once

#include <array>
#include <unordered_map>
#include <vector>

#include "pgdr/mesh.hpp"

namespace pgdr {

/// Those of one input. Immutable; const members from any thread.
template <int D>
class SharpCorners {
 public:
  /// Takes time proportional to the pairs of segments of a facet that meet. The domain must outlive it.
  SharpCorners(const Domain<D>& domain, double radius_edge_bound);

  /// Has the cell a subfacet (2D: an angle) in one of them, so that it cannot but be over the bound?
  bool meets(const Mesh<D>& mesh, CellId c) const;

 private:
  using Direction = std::array<double, D>;
  struct Corner {
    EntityId facet;  // 2D: none
    std::array<Direction, 2> sides;
    double angle;  // between them, in radians
  };
  void add_corners(std::uint32_t point, EntityId facet, const std::vector<EntityId>& segments);
  bool is_in_corner(const Corner& corner, const Point<D>& at, const Point<D>& x) const;
  bool has_corner(const Mesh<D>& mesh, VertexId at, std::array<VertexId, 2> others, EntityId facet) const;

  const Domain<D>* domain_;
  double sine_;  // of the largest angle, 1 / (2 bound)
  std::unordered_map<std::uint32_t, std::vector<Corner>> corners_;  // by domain point
};

extern template class SharpCorners<2>;
extern template class SharpCorners<3>;

}  // namespace pgdr
