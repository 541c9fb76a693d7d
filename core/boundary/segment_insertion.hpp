// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// 2D: the constrained Delaunay triangulation of the input, made of its Delaunay triangulation without a single new point.
// The cells that a missing segment crosses leave a polygon on each side of it, possibly with dangling edges, so that a
// vertex may occur twice in its chain. Each is filled from the segment outwards: the third corner of an edge is the chain
// vertex whose circle through the edge holds no other one. Every chain vertex is joined to the segment by a crossed edge
// inside the polygon; hence no chain edge can cut such a triangle, and the rest of the chain is again in that situation
// with respect to the two new edges. With the perturbed predicate the constrained Delaunay triangulation is unique: it does
// not depend on the order of the segments. Private to recovery.cpp; serial.
#pragma once

#include <array>
#include <vector>

#include "cavity/delaunay.hpp"
#include "mesh/ids.hpp"
#include "pgdr/domain.hpp"

namespace pgdr::detail {

class SegmentInsertion {
 public:
  /// @pre `mesh` is the Delaunay triangulation of domain.points(), closed by ghosts.
  SegmentInsertion(Mesh<2>& mesh, Mesh<2>::Pools& pools, const Delaunay<2>& delaunay, const Domain<2>& domain);

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
  struct Side {
    CellId cell;
    int face = 0;
  };
  /// An edge of a polygon, seen from inside.
  struct ChainEdge {
    Link old;     ///< of a crossed cell
    Link beyond;  ///< a cell outside, or (dangling edge) another crossed cell
    bool fixed;
    Side now;     ///< of a new cell
  };
  /// Vertices of a polygon from one end of the segment to the other, counterclockwise about what is to be filled.
  struct Chain {
    std::vector<VertexId> vertices;
    std::vector<ChainEdge> edges;  ///< edge i between vertices i and i + 1
  };

  void find_segments();
  void force(EntityId s);
  void march(EntityId s, Side at);
  Side first_crossing(EntityId s) const;
  Side fill(Chain& chain);
  std::size_t apex(const std::vector<VertexId>& chain, std::size_t i, std::size_t j) const;
  void join();
  void link(Side a, Side b);
  void mark();
  bool fixed(CellId c, int face) const { return fixed_[index(c)] >> face & 1; }
  void fix(Side s) { fixed_[index(s.cell)] |= static_cast<std::uint8_t>(1 << s.face); }
  [[noreturn]] void fail(EntityId s, VertexId through) const;

  Mesh<2>* mesh_;
  Mesh<2>::Pools* pools_;
  const Domain<2>* domain_;
  std::vector<std::array<VertexId, 2>> ends_;  ///< of each segment
  std::vector<bool> present_;
  std::vector<std::uint8_t> fixed_;  ///< by cell, bit i: the face opposite vertex i is a segment
  std::vector<CellId> cell_at_;      ///< of each vertex, a cell that has it
  std::vector<CellId> crossed_;      ///< by the segment at hand; their slots are used again, from the back
  Chain left_, right_;               ///< of it
};

}  // namespace pgdr::detail
