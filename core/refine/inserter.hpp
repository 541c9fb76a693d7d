// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The end of every insertion: test that no edge becomes too short, commit, list what is new.
#pragma once

#include <cstdint>

#include "refine/delaunay_repair.hpp"
#include "refine/work_lister.hpp"
#include "refine/workspace.hpp"

namespace pgdr {

/// Commits insertions. Part of a worker: one thread at a time.
template <int D>
class Inserter {
 public:
  /// All three must outlive it.
  Inserter(Workspace<D>& workspace, WorkLister<D>& lister, DelaunayRepair<D>& repair)
      : w_(&workspace), lister_(&lister), repair_(&repair) {}

  /// Is this distance of a point from its nearest vertex below the shortest edge allowed? The visit is told.
  bool is_too_short(double distance) const {
    if (!(distance < w_->options.min_edge)) return false;
    w_->visit->min_edge_hit = true;
    return true;
  }
  /// Inserts the point whose cavity was collected and judged, and lists what is encroached, poor or not locally Delaunay at its
  /// cells.
  Outcome commit(Home home, double relaxed_radius) {
    w_->cavity.commit(w_->pools, home, rounded_down(relaxed_radius));
    NodeVisit<D>& visit = *w_->visit;
    ++visit.counts.committed;
    lister_->list_inserted();
    // A cavity that was not cut back keeps every face locally Delaunay, if all were.
    if (w_->cavity.cut_back() || visit.violations_seen) repair_->look_at(w_->cavity.new_cells());
    return Outcome::committed;
  }

 private:
  Workspace<D>* w_;
  WorkLister<D>* lister_;
  DelaunayRepair<D>* repair_;
};

}  // namespace pgdr
