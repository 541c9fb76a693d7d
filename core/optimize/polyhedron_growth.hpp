// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Reconnection about a poor cell: it and cells about it, up to a wall, are filled anew with the same vertices
// (polyhedron_filling.hpp). The polyhedron grows by the vertices that see most of its faces, as they add cells and hardly any
// vertices.
#pragma once

#include <cstdint>
#include <vector>

#include "optimize/polyhedron_filling.hpp"
#include "optimize/surgery.hpp"

namespace pgdr {

/// See above. Part of a worker: one thread at a time.
class PolyhedronGrowth {
 public:
  explicit PolyhedronGrowth(Surgery& surgery) : s_(&surgery) {}  ///< it must outlive this

  /// Fills the smallest polyhedron about the cell for which the judge accepts a filling. True if one was filled.
  bool make(CellId c, Judge::Rule rule);

 private:
  bool grow();
  void take(CellId c);
  bool fill(Judge::Rule rule);
  void build();
  void add_flat_sets();

  Surgery* s_;
  PolyhedronFilling search_;
  Polyhedron polyhedron_;
  std::vector<CellId> cells_;
  std::vector<VertexId> vertices_;  ///< the polyhedron knows them by their places here
  Replacement<3> tried_;
};

}  // namespace pgdr
