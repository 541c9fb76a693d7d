// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Collapses and relocations of Steiner vertices in the last stage (change_judge.hpp says what excess is, why this ends, and what
// may be new). A collapse leaves no more excess, a relocation less. Between segments at a small angle every vertex makes short
// edges, to the vertices on the other segment, and poor elements at these. What a vertex was inserted for may be gone by now.
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

/// The collapses and relocations of the last stage. Part of a worker: one thread at a time.
class VertexChanges {
 public:
  /// All outlive it.
  VertexChanges(Workspace<3>& workspace, ChangeJudge& judge, FlipChanges& flips)
      : w_(&workspace), judge_(&judge), flips_(&flips), move_(workspace.mesh, workspace.domain) {}

  enum class Kind { collapse, move };  ///< what a change does with a vertex
  /// Must be called before the visit does anything.
  void begin_visit() { move_.set_area(w_->visit->area); }
  /// Makes the change of a vertex of the element that lowers the excess most; of a neighbour, too, if it is a collapse.
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
