// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// What a run that several ranks share does otherwise than one of a single process.
#pragma once

#include <memory>

#include "boundary/labeling.hpp"
#include "compact/point_data.hpp"
#include "pgdr/refine.hpp"
#include "run/run_pieces.hpp"
#include "run/run_state.hpp"

namespace pgdr::detail {

/// See above. One thread.
template <int D>
class RunHooks {
 public:
  virtual ~RunHooks() = default;
  /// The schedule of the run. `optimizes`: it goes on after the refinement.
  virtual std::unique_ptr<VisitSchedule<D>> make_schedule(RunState<D>& state, bool optimizes) = 0;
  /// Does this rank, once the refinement has ended, hold a part of the mesh alone?
  virtual bool has_part() const = 0;
  /// Then this finishes the run in place of counting what is poor and numbering the mesh.
  virtual void finish(const RefineContext<D>& context, const RegionTable& regions, const PointData<D>& data,
                      const RunPieces& pieces, RefineResult<D>& result) = 0;
};

/// refine(plc, options), with these hooks.
template <int D>
RefineResult<D> refine_with(const Plc<D>& plc, const RefineOptions<D>& options, RunHooks<D>& hooks);

}  // namespace pgdr::detail
