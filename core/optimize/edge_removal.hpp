// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The best way to do without an edge: of all triangulations of the ring of vertices round it, the one whose two tetrahedra a
// triangle, to the ends of the edge, are best (Shewchuk 2002, "Two discrete optimization algorithms for the topological
// improvement of tetrahedral meshes"; dynamic programming after Klincsek). Half a ring, about an edge inside a facet, has its
// two tips in one triangle. Points and numbers alone; no mesh. One thread at a time.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "optimize/cell_quality.hpp"
#include "pgdr/types.hpp"

namespace pgdr {

/// Finds triangulations of rings.
class EdgeRemoval {
 public:
  static constexpr std::size_t longest_ring = 14;  ///< of more vertices there are too many triangles

  /// `ring`: the vertices, at least 3 and at most longest_ring, in an order such that (a, b, ring[i], ring[i+1]) are positively
  /// oriented. It is closed, as the polygon to be triangulated is, also where it is half a ring. All new cells are in the region.
  /// Returns the least quality of the new cells, or some number that is at most `enough` if no triangulation is better. Signs of
  /// the cells are exact. Each is measured once, if need be. @throws UsageError bad_size as CellQuality::of
  double find(std::span<const Point3> ring, const Point3& a, const Point3& b, int region, const CellQuality& quality,
              double enough);
  /// The triangles (numbers of the ring, ascending) of the best triangulation. The new cells are, for each, (i, j, k, b) and
  /// (k, j, i, a), positively oriented. @pre find() returned more than `enough`
  const std::vector<std::array<std::uint8_t, 3>>& triangles() const { return triangles_; }

 private:
  template <class T>
  using OfChords = std::array<std::array<T, longest_ring>, longest_ring>;  // by the ends of the chord, the lower one first

  void list(std::size_t i, std::size_t j);

  std::vector<std::array<std::uint8_t, 3>> triangles_;
  OfChords<double> best_;        // of the part of the ring from one end to the other
  OfChords<std::uint8_t> apex_;  // of the triangle on the chord, in the best triangulation of the part
};

}  // namespace pgdr
