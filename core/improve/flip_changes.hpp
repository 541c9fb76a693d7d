// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Flips of the last stage (change_judge.hpp says what excess is, why this ends, and what may be new). Flips for a poor element
// lower the excess. Flips after any change lower the number of violations, and do not raise the excess.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "change/flips.hpp"
#include "improve/change_judge.hpp"
#include "refine/work_lister.hpp"
#include "refine/workspace.hpp"

namespace pgdr {

/// The flips of the last stage. Part of a worker: one thread at a time.
class FlipChanges {
 public:
  /// All outlive it.
  FlipChanges(Workspace<3>& workspace, WorkLister<3>& lister, LocalFlips<3>& flips, ChangeJudge& judge)
      : w_(&workspace), lister_(&lister), flips_(&flips), judge_(&judge) {}

  /// Makes the flip of a face or edge of the element that lowers the excess most, the first of those that do.
  Outcome flip_to_improve(const Entry<3>& e);
  /// Finishes a change that was made for e: flips at its new cells, if a new face is not locally Delaunay (`violates`), and lists
  /// what is poor after that.
  Outcome finish(const Entry<3>& e, std::vector<CellId> new_cells, bool violates);

 private:
  using Flip = LocalFlips<3>::Flip;
  using Violations = std::vector<LocalFlips<3>::Violation>;

  Simplex<3> simplex_of(const std::array<VertexId, 4>& vertices) const;
  std::optional<double> gain_of_flip(const Flip& flip, double least);
  bool flip_is_explained(const Flip& flip, const Violations& violations);
  bool flip_to_delaunay(CellId c, int face);
  void flip_to_delaunay(std::vector<CellId>& cells);

  Workspace<3>* w_;
  WorkLister<3>* lister_;
  LocalFlips<3>* flips_;
  ChangeJudge* judge_;
};

}  // namespace pgdr
