// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The judge of changes for elements that stay poor. It compares the excess of the elements that go and come, and asks whether
// small angles explain what is poor, or not locally Delaunay, after the change.
//
// Why the last stage ends. The excess of an element is 0 within its bounds, else at least 1 and at most 3.5 (CellBounds::excess).
//   * A change is made only if it lowers the excess by at least 1/128, with two exceptions: a collapse may leave it as it is, and
//     so may a flip that lowers the number of violations.
//   * There is at most 3.5 for each poor element when the stage begins, so that it inserts at most 448 points for each of them.
//   * It collapses no more vertices than there were and come.
//   * After each of these changes there are finitely many flips.
// A new point demands no room, as nothing else follows from it: entities that it encroaches upon are left as they are.
//
// Why the result is explained. A new poor element, and a new violation, is allowed only beside two entities that meet at a small
// angle and touch its own corners, so that no later point can take that away.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "reasons/poor_reasons.hpp"
#include "refine/workspace.hpp"

namespace pgdr {

constexpr double least_gain = 1.0 / 128;          ///< by which a change lowers the excess
constexpr double least_gain_of_collapse = -1e-9;  ///< by which a collapse does: none, but for rounding
constexpr std::size_t most_cells_changed = 100;   ///< by one change: more, of tangles, are slow and gain little

/// The judge. Part of a worker: one thread at a time.
class ChangeJudge {
 public:
  ChangeJudge(Workspace<3>& workspace, const PoorReasons<3>& reasons)
      : w_(&workspace), reasons_(&reasons) {}  ///< both outlive it

  double excess_of(CellId c);                          ///< the excess of an element of the mesh
  double excess_of(const std::vector<CellId>& cells);  ///< their sum
  /// The excess of an element that a change would make in the region.
  double excess_of(const Simplex<3>& s, int region) const { return w_->context.bounds.excess(s, region); }
  /// Would small angles between entities with these homes explain that the element s is poor, or that it has a violation?
  bool is_explained(const std::vector<Home>& homes, const Simplex<3>& s);

 private:
  struct KnownExcess {
    CellId cell{0xffffffffu};
    std::uint16_t birth = 0;
    double value = 0;
  };

  Workspace<3>* w_;
  const PoorReasons<3>* reasons_;                                           ///< changed by no visit
  std::vector<KnownExcess> excess_cache_ = std::vector<KnownExcess>(1024);  ///< of the cells asked for last
};

}  // namespace pgdr
