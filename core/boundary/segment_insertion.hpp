// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// 2D: the constrained Delaunay triangulation of the input, made of its Delaunay triangulation without a single new point.
// Segments that are missing are forced into it (space/edge_forcing.hpp). With the perturbed predicate the constrained Delaunay
// triangulation is unique: it does not depend on the order of the segments. Passes over all cells run side by side. Private to
// recovery.cpp.
#pragma once

#include <array>
#include <vector>

#include "boundary/wanted_simplices.hpp"
#include "cavity/delaunay.hpp"
#include "mesh/ids.hpp"
#include "pgdr/domain.hpp"

namespace pgdr::detail {

class SegmentInsertion {
 public:
  /// @pre `mesh` is the Delaunay triangulation of domain.points(), closed by ghosts.
  SegmentInsertion(Mesh<2>& mesh, Mesh<2>::Pools& pools, const Delaunay<2>& delaunay, const Domain<2>& domain, Bulk bulk);

  /// Makes every segment an edge, and marks it. False if `stop` says so; nothing is marked then.
  /// @throws InputError entities_intersect, with the points of the segment, where it meets another or passes through a point.
  template <class Stop>
  bool run(const Stop& stop) {
    find_segments();
    for (EntityId s = 0; s < present_.size(); ++s) {
      if (present_[s]) continue;
      if (stop()) return false;
      force(s);
    }
    mark();
    return true;
  }

 private:
  struct Forcible;  // the mesh as EdgeForcing sees it

  using Wanted = WantedSimplices<2, EntityId>;

  void find_segments();
  template <class F>
  void each_segment_of(CellId c, const F& f) const;
  void force(EntityId s);
  void mark();
  bool fixed(CellId c, int face) const { return fixed_[index(c)] >> face & 1; }
  void fix(CellId c, int face) { fixed_[index(c)] |= static_cast<std::uint8_t>(1 << face); }
  [[noreturn]] void fail(EntityId s, VertexId through) const;

  Mesh<2>* mesh_;
  Mesh<2>::Pools* pools_;
  const Domain<2>* domain_;
  const Bulk bulk_;
  std::vector<std::array<VertexId, 2>> ends_;  ///< of each segment
  Wanted wanted_;                              ///< all segments
  std::vector<std::uint8_t> present_;          ///< of each segment: was it an edge at first?
  std::vector<std::uint8_t> fixed_;            ///< by cell, bit i: the face opposite vertex i is a segment
  std::vector<CellId> cell_at_;                ///< of each vertex, a cell that has it
};

}  // namespace pgdr::detail
