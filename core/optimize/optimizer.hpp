// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The optimiser: the last stage of a run in 3D. It changes the mesh about poor cells (cell_quality.hpp), wherever that makes the
// worst better (judge.hpp, which also says why it ends). For a poor cell it does the first of these that is accepted:
//
//   * cheap: the best of the flips at its edges and faces (flips.hpp); a better place for a vertex (vertex_changes.hpp); a
//     contraction, if the cell is over the bound on its ratio, as one that has too short an edge is;
//   * strong: reconnection of the cells about it (reconnect.hpp); a new vertex inside (insertions.hpp); a detour, which is a
//     change that makes the worst better and more cells poor, and what mends these; the split of an edge, and what that makes
//     possible; a contraction of other cells.
//
// Detours and splits are kept if the cells that changed are better together in the end, and undone otherwise. So no edge is
// halved again and again, and no accepted change has to be a step that is better by itself.
#pragma once

#include <memory>

#include "optimize/judge.hpp"
#include "refine/element_stage.hpp"
#include "refine/numbers.hpp"

namespace pgdr {

/// The stage. Threads: read by all visits at once, changed between them alone.
class OptimizerStage final : public ElementStage<3> {
 public:
  /// What is tried for a poor cell, and what is accepted.
  enum class Phase {
    cheap,   ///< what takes few evaluations; the worst gets better, and the poor cells weigh no more
    strong,  ///< all; likewise
    rest,    ///< all, and longer detours: for those that nothing excuses
  };

  /// The mesh must outlive it. `min_dihedral`: the target in degrees.
  OptimizerStage(const Mesh<3>& mesh, double min_dihedral) : mesh_(&mesh), min_dihedral_(min_dihedral) {}

  std::unique_ptr<ElementTreatment<3>> treatment(Workspace<3>& workspace, WorkLister<3>& lister,
                                                 DelaunayRepair<3>& repair) const override;
  std::uint64_t version(CellId c) const override;

  double min_dihedral() const { return min_dihedral_; }  ///< degrees

  Phase phase = Phase::cheap;                                    ///< of the visits to come
  std::uint64_t most_a_cell = numbers::evaluations_a_poor_cell;  ///< evaluations in one attempt

 private:
  const Mesh<3>* mesh_;
  double min_dihedral_;
};

}  // namespace pgdr
