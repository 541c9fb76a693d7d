// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// A run of refinement, from a mesh with its boundary to one whose elements are good, or stay poor for a reason. run() has the
// stages in their order.
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "run/improver.hpp"
#include "run/poor_search.hpp"
#include "run/run_state.hpp"
#include "run/violation_scan.hpp"

namespace pgdr::detail {

/// See above. One thread; the schedule runs visits on others.
template <int D>
class Refinement {
 public:
  /// `pools`: those that made the mesh so far. `vertices`: it has so many. The context must outlive this.
  Refinement(RefineContext<D>& context, typename Mesh<D>::Pools pools, std::uint64_t vertices);

  /// Runs the stages until one does not finish. Once. @throws what a callback throws
  StopCause run();

  /// If the run has finished: every cell over a bound, or beside a face that is not locally Delaunay and a small angle, and why.
  /// If a limit has ended it, the latter.
  std::vector<PoorCell> take_explained() { return std::move(explained_); }
  RunState<D>& state() { return state_; }

 private:
  using Clock = std::chrono::steady_clock;

  // The stages.
  StopCause list_everything();
  StopCause refine();
  StopCause refine_as_last_resort();
  StopCause look_for_violations();
  StopCause end_if_min_edge_hit();
  StopCause explain();
  StopCause collapse();
  StopCause improve();
  StopCause explain_what_was_improved();
  StopCause end_if_vertices_are_spent();

  void leave_in_order();
  void repair_standing_violations();

  std::unique_ptr<Improver> improver_;  ///< 3D; declared before the workers, which may hold on to it
  RunState<D> state_;
  std::unique_ptr<VisitSchedule<D>> schedule_;
  ViolationScan<D> violations_;
  std::optional<PoorSearch<D>> poor_;  ///< from explain() on
  std::vector<PoorCell> explained_;
};

extern template class Refinement<2>;
extern template class Refinement<3>;

}  // namespace pgdr::detail
