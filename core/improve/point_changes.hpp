// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Points of the last stage: insertions for poor elements that lower the excess (change_judge.hpp).
#pragma once

#include <cstddef>
#include <vector>

#include "improve/change_judge.hpp"
#include "improve/flip_changes.hpp"
#include "refine/workspace.hpp"

namespace pgdr {

/// The insertions of the last stage. Part of a worker: one thread at a time.
class PointChanges {
 public:
  /// All outlive it.
  PointChanges(Workspace<3>& workspace, ChangeJudge& judge, FlipChanges& flips)
      : w_(&workspace), judge_(&judge), flips_(&flips) {}

  /// Inserts the point that lowers the excess most, the first of those that do.
  Outcome insert_to_improve(const Entry<3>& e);

 private:
  /// Where a point may go, and on what.
  struct Place {
    Entry<3> at;  ///< a cell in conflict with it, or its face or edge
    Point3 x;
    Home home;
  };

  std::vector<Place> places_for(CellId c);
  void add_places_on_face(CellId c, int face, std::vector<Place>& places) const;
  void add_places_on_edge(CellId c, int edge, std::vector<Place>& places) const;
  Cavity<3>::Status collect_at(const Place& p);
  Simplex<3> prospect(std::size_t n) const;
  double gain_of_collected();
  bool is_explained(const Place& p, std::size_t n, VertexId further);
  bool poor_ones_are_explained(const Place& p);
  std::vector<Home> homes_of_cavity() const;
  template <class F>
  bool all_new_violations(F f) const;
  bool violations_are_explained(const Place& p, bool& any);

  Workspace<3>* w_;
  ChangeJudge* judge_;
  FlipChanges* flips_;
};

}  // namespace pgdr
