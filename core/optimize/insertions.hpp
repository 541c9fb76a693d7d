// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// New vertices for a poor cell. One may split an edge, with all cells, subfacets and the subsegment at it. One may take the place
// of cells inside: the cell is dug out, with neighbours for as long as the cells to come would be too bad.
#pragma once

#include <vector>

#include "optimize/placement.hpp"
#include "optimize/surgery.hpp"

namespace pgdr {

/// See above. Part of a worker: one thread at a time.
class Insertions {
 public:
  explicit Insertions(Surgery& surgery) : s_(&surgery) {}  ///< it must outlive this

  /// Splits the edge, whatever becomes of the cells at it, if they stay positive and none is flat but for rounding. True if it
  /// was split.
  bool split_edge(CellId c, int edge);
  /// Digs out cells about this one, and fills the hole from one new vertex, if the judge accepts it. True if it was done.
  bool dig(CellId c, Judge::Rule rule);

 private:
  bool split_ring(const Point3& x, Home home);
  bool keeps_sides(VertexId m) const;
  void add_star_of_ring();
  bool dig_out(CellId c, const Point3& p, double enough);
  bool loses_vertex() const;
  bool fill_hole(const Point3& p);
  void take(CellId c) {
    s_->mesh->mark(c);
    cells_.push_back(c);
  }

  struct RimFace {
    CellId cell;
    int face;
    double quality;
  };

  Surgery* s_;
  Placement placement_;
  EdgeRing ring_;
  Star star_;
  Replacement<3> tried_;
  std::vector<CellId> cells_;
  std::vector<RimFace> rim_;
};

}  // namespace pgdr
