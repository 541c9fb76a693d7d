// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The area of a visit: what it may read and change. A visit owns the cells all of whose vertices lie in the part of space that it
// has claimed. The claims of concurrent visits are disjoint. A visit deletes only cells that it owns. It reads only these and the
// cells that share a face with one. Such a cell has D vertices in this claim, so that no other claim can hold D of its D + 1
// vertices too (2D > D + 1): no other visit reads or changes it.
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>

#include "mesh/mesh.hpp"
#include "numbers/rounding.hpp"

namespace pgdr {

/// The area of a visit, which does not change during the visit. `claimed` and `node_of` are called by the visit's thread alone.
template <int D>
class VisitArea {
 public:
  virtual ~VisitArea() = default;

  /// An element belongs to the visit if its place (RefineContext::place_of) lies in this half-open box (unbounded where space
  /// ends), and its circumradius (RefineContext::radius_of) between these bounds.
  Point<D> home_low;                                             ///< its low corner
  Point<D> home_high;                                            ///< its high corner
  double radius_above = -1;                                      ///< larger than this ...
  double most_radius = std::numeric_limits<double>::infinity();  ///< ... and at most this
  /// A half-open box wholly claimed: a quick yes.
  Point<D> inner_low;   ///< its low corner
  Point<D> inner_high;  ///< its high corner

  /// Is the point in the claimed part of space? Asked beyond the inner box.
  virtual bool claimed(const Point<D>& p) const = 0;
  /// The node of the tree that an element with its place at p and this circumradius belongs to.
  virtual std::uint32_t node_of(const Point<D>& p, double radius) const = 0;

  /// Does an element with this place and circumradius belong to the visit?
  bool is_home(const Point<D>& p, double radius) const {
    if (!(radius > radius_above && radius <= most_radius)) return false;
    for (int i = 0; i < D; ++i)
      if (!(p[i] >= home_low[i] && p[i] < home_high[i])) return false;
    return true;
  }
  /// The square of a distance: all points nearer to p are in the inner box. 0 if p is not in it.
  double squared_depth(const Point<D>& p) const {
    double depth = std::numeric_limits<double>::infinity();
    for (int i = 0; i < D; ++i) depth = std::min({depth, p[i] - inner_low[i], inner_high[i] - p[i]});
    return depth > 0 ? depth * depth * (1 - rounding::of_pruning) : 0;
  }
  /// Is the point claimed?
  bool owns(const Point<D>& p) const {
    for (int i = 0; i < D; ++i)
      if (!(p[i] >= inner_low[i] && p[i] < inner_high[i])) return claimed(p);
    return true;
  }
  /// Are all of these vertices claimed?
  [[gnu::noinline]] bool owns(const Mesh<D>& mesh, const std::array<VertexId, D + 1>& vertices) const {
    for (const VertexId v : vertices)
      if (!owns(mesh.point(v))) return false;
    return true;
  }
  /// Does the visit own the cell? (In 3D a circumball in the inner box tells: the vertices are on its sphere.)
  bool owns(const Mesh<D>& mesh, CellId c) const {
    const auto& k = mesh.cell(c);
    if constexpr (D == 2)
      return owns(mesh, k.vertices);
    else
      return ball_is_inner(mesh, c) || owns(mesh, k.vertices);
  }
  /// Is the cell alive, and is it owned, or does it share a face with an owned cell? Debug builds assert this of what is read.
  bool may_read(const Mesh<D>& mesh, CellId c) const {
    int owned = 0;
    for (const VertexId v : mesh.cell(c).vertices) {
      if (v == no_vertex) return false;
      owned += owns(mesh.point(v)) ? 1 : 0;
    }
    return owned >= D;
  }

 private:
  bool ball_is_inner(const Mesh<D>& mesh, CellId c) const {
    const Point<D> center = mesh.center(c);
    const double r2 = mesh.squared_radius_bounds(c).second;
    for (int i = 0; i < D; ++i) {
      const double below = center[i] - inner_low[i], above = inner_high[i] - center[i];
      if (!(below > 0 && above > 0 && below * below > r2 && above * above > r2)) return false;
    }
    return true;
  }
};

}  // namespace pgdr
