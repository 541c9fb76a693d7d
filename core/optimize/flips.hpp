// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The best flip for a poor cell: one of its edges goes, with the best triangulation of its ring, or one of its faces makes room
// for an edge. An edge inside a facet is flipped within it, with the cells on both sides.
#pragma once

#include <cstddef>
#include <vector>

#include "optimize/edge_removal.hpp"
#include "optimize/surgery.hpp"

namespace pgdr {

/// See above. Part of a worker: one thread at a time.
class BestFlip {
 public:
  explicit BestFlip(Surgery& surgery) : s_(&surgery) {}  ///< it must outlive this

  /// Makes the flip at the cell whose worst new cell is best, if the judge accepts it. True if it was made.
  bool make(CellId c, Judge::Rule rule);

 private:
  void try_edge(CellId c, int edge, Judge::Rule rule);
  void try_face(CellId c, int face, Judge::Rule rule);
  bool fill_side(const RingSide& side, double enough);
  void take_if_best(const Judge::Standing& before, Judge::Rule rule);

  Surgery* s_;
  EdgeRemoval removal_;
  EdgeRing ring_;
  Replacement<3> tried_, best_;
  double best_quality_ = 0, tried_quality_ = 0;
  bool found_ = false;
};

}  // namespace pgdr
