// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Steiner vertices are taken out where that leaves no more excess, and moved where it leaves less (change_judge.hpp says what that
// is, why this ends, and what may be new). Between segments at a small angle every vertex makes short edges, to those on the other
// segment, and poor elements at these; what needed it when it was inserted may be gone by now. Part of a worker.
#pragma once

#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "change/vertex_move.hpp"
#include "improve/change_judge.hpp"
#include "improve/flip_changes.hpp"
#include "refine/workspace.hpp"

namespace pgdr {

/// See above.
class VertexChanges {
 public:
  /// All outlive it.
  VertexChanges(Workspace<3>& workspace, ChangeJudge& judge, FlipChanges& flips)
      : w_(&workspace), judge_(&judge), flips_(&flips), move_(workspace.mesh, workspace.domain) {}

  enum class Kind { collapse, move };  ///< of a change
  /// Before the visit does anything.
  void begin_visit() { move_.set_area(w_->visit->area); }
  /// Does what lessens the excess most with a vertex of the element, or of a neighbour of it: takes it out, or else moves it.
  Outcome change(const Entry<3>& e, Kind kind);

 private:
  bool add_vertices_beyond(CellId c, std::vector<std::pair<VertexId, CellId>>& vertices) const;
  std::optional<double> gain_of_move(double excess, double least);
  bool move_keeps_sizes() const;
  std::vector<Home> homes_of_turned(std::size_t i) const;
  bool move_is_explained(bool& any);
  std::vector<Point3> places_to_move_to() const;
  void add_places_on_segment(const std::vector<VertexId>& ends, std::vector<Point3>& places) const;

  Workspace<3>* w_;
  ChangeJudge* judge_;
  FlipChanges* flips_;
  VertexMove move_;
  std::vector<std::size_t> poor_turned_;  ///< of the cells that the last move would make
};

}  // namespace pgdr
