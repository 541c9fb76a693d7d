// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// A run of refinement, from a mesh with its boundary to one whose elements are good, or stay poor for a reason, and of the
// optimiser. A plan has the stages in their order.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "run/optimizer_run.hpp"
#include "run/poor_search.hpp"
#include "run/run_hooks.hpp"
#include "run/violation_scan.hpp"
#include "visits/run_state.hpp"

namespace pgdr::detail {

/// See above. One thread; the schedule runs visits on others.
template <int D>
class Refinement {
 public:
  /// A stage of the plan.
  struct Stage {
    const char* name;                ///< for reports
    StopCause (Refinement::*run)();  ///< does it
    bool optimizes = false;          ///< is it the optimiser's?
  };

  /// `pools`: those that made the mesh so far. `vertices`: it has so many. `min_dihedral`: the optimiser's target in degrees; 0:
  /// none. `hooks`: of a run on ranks; or null. The context, the pieces and the hooks must outlive this.
  Refinement(RefineContext<D>& context, typename Mesh<D>::Pools pools, std::uint64_t vertices, double min_dihedral,
             const RunPieces& pieces, const RunHooks<D>* hooks);

  /// The stages in their order, with the optimiser or without.
  static std::span<const Stage> plan(bool optimizes);
  /// Runs the stages until one does not finish. Once. @throws what a callback throws
  StopCause run();

  /// If the run has finished: every cell over a bound and why, and without the optimiser every cell beside a face that is not
  /// locally Delaunay and a small angle. If a limit has ended it before the optimiser began, the latter.
  std::vector<PoorCell> take_explained() { return std::move(explained_); }
  /// When the optimiser began, if it has (StageTime::start).
  std::optional<double> optimizing_since() const { return optimizing_since_; }
  /// The optimiser's part; null if it has not begun.
  const OptimizerRun* optimizing() const { return optimizing_.get(); }
  RunState<D>& state() { return state_; }

  /// Has the optimiser begun, with no cell over a bound of size?
  bool sizes_are_met() const { return optimizing_ && optimizing_->sizes_are_met(); }

 private:
  // The stages.
  StopCause list_everything();
  /// What is to be listed of some cells, and whether an entity there was refused already.
  struct Listed {
    std::vector<Entry<D>> entries;
    bool entities_refused = false;
  };
  Listed list_cells(std::size_t first, std::size_t last);
  StopCause refine();
  StopCause refine_as_last_resort();
  StopCause look_for_violations();
  StopCause end_if_min_edge_hit();
  StopCause explain();
  StopCause end_if_vertices_are_spent();
  StopCause optimize_cheaply();
  StopCause optimize_strongly();
  StopCause optimize_the_rest();
  StopCause explain_what_is_left();

  void leave_in_order();
  void repair_standing_violations();

  StopCause optimize(OptimizerStage::Phase phase);

  const double min_dihedral_;
  std::unique_ptr<OptimizerRun> optimizing_;  ///< 3D; declared before the workers, which may hold on to it
  RunState<D> state_;
  std::unique_ptr<VisitSchedule<D>> schedule_;
  ViolationScan<D> violations_;
  std::optional<PoorSearch<D>> poor_;  ///< from explain() on
  std::vector<PoorCell> explained_;
  std::optional<double> optimizing_since_;
};

extern template class Refinement<2>;
extern template class Refinement<3>;

}  // namespace pgdr::detail
