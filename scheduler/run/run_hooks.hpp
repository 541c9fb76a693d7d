// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// What a run that several ranks share does otherwise than one of a single process.
#pragma once

#include <functional>
#include <memory>

#include "boundary/labeling.hpp"
#include "compact/point_data.hpp"
#include "pgdr/refine.hpp"
#include "visits/run_pieces.hpp"
#include "visits/run_state.hpp"

namespace pgdr::detail {

/// See above. One thread.
template <int D>
struct RunHooks {
  /// The schedule of the run. `optimizes`: it goes on after the refinement.
  std::function<std::unique_ptr<VisitSchedule<D>>(RunState<D>& state, bool optimizes)> make_schedule;
  /// If this rank, once the refinement has ended, holds a part of the mesh alone: finishes the run, in place of counting what is
  /// poor and numbering the mesh, and says true.
  std::function<bool(const RefineContext<D>& context, const RegionTable& regions, const PointData<D>& data,
                     const RunPieces& pieces, RefineResult<D>& result)>
      finish_part = [](const auto&...) { return false; };
};

/// refine(plc, options), with these hooks.
template <int D>
RefineResult<D> refine_with(const Plc<D>& plc, const RefineOptions<D>& options, const RunHooks<D>& hooks);

}  // namespace pgdr::detail
