// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// What a change for elements that stay poor is judged by: the excess of the elements that go and come, and whether small angles
// explain what is poor, or not locally Delaunay, after it. One thread at a time.
//
// Let the excess of an element be 0 within its bounds, else at least 1 and at most 3.5 (CellBounds::excess). Anything is done
// only if the elements that it makes have less excess than those that they take the place of, by at least 1/128; but a vertex
// is taken out if they have no more, and faces are flipped if they have no more and fewer faces are not locally Delaunay. All
// in all there is at most 3.5 for each poor element when these visits begin, so that they insert at most 448 points for each;
// they take out no more vertices than there were and come; and after each of these changes there are finitely many flips. No
// room is asked for, as nothing else follows from such a point: entities that it encroaches upon are left as they are.
//
// What is new is explained as the rest is: a new element that is poor, and a new face that is not locally Delaunay, is allowed
// only beside two entities that meet at a small angle and touch its own corners, so that no later point can take that away.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "reasons/poor_reasons.hpp"
#include "refine/workspace.hpp"

namespace pgdr {

constexpr double least_gain = 1.0 / 128;       ///< by which anything lessens the excess
constexpr double least_gain_of_collapse = -1e-9;   ///< the same of a vertex that is taken out: none, but for rounding
constexpr std::size_t most_cells_changed = 100;  ///< at once: more, of tangles, are slow and gain little

/// See above. Part of a worker.
class ChangeJudge {
 public:
  ChangeJudge(Workspace<3>& workspace, const PoorReasons<3>& reasons) : w_(&workspace), reasons_(&reasons) {}  ///< both outlive it

  double excess_of(CellId c);                          ///< of an element of the mesh
  double excess_of(const std::vector<CellId>& cells);  ///< of all of them
  /// Of an element that a change would make in the region.
  double excess_of(const Simplex<3>& s, int region) const { return w_->context.bounds.excess(s, region); }
  /// Would small angles between entities with these homes explain that it is poor, or that a face of it is not locally Delaunay?
  bool is_explained(const std::vector<Home>& homes, const Simplex<3>& s);

 private:
  struct KnownExcess {
    CellId cell{0xffffffffu};
    std::uint16_t birth = 0;
    double value = 0;
  };

  Workspace<3>* w_;
  const PoorReasons<3>* reasons_;  ///< which no visit changes
  std::vector<KnownExcess> excess_cache_ = std::vector<KnownExcess>(1024);  ///< of the cells asked for last
};

}  // namespace pgdr
