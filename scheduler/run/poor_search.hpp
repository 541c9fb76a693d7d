// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Finds the elements that stay poor once a run has refined the mesh, and the reasons for them. Between visits; one thread, which
// has others look at parts of the mesh.
#pragma once

#include <utility>
#include <vector>

#include "reasons/poor_reasons.hpp"
#include "run/violation_scan.hpp"
#include "visits/cell_parts.hpp"
#include "visits/run_state.hpp"

namespace pgdr::detail {

/// Part of a run: see above.
template <int D>
class PoorSearch {
 public:
  PoorSearch(RunState<D>& state, ViolationScan<D>& violations);  ///< both must outlive it

  /// Returns every cell over a bound, and every one beside a face that is not locally Delaunay and a small angle, with its
  /// reason. Part of them if the run is cancelled meanwhile, or its time is up.
  std::vector<PoorCell> find();
  /// Of a run that a limit has ended: only what is beside the violations that are known.
  std::vector<PoorCell> find_at_violations();
  /// The reasons as of the last look.
  const PoorReasons<D>& reasons() const { return reasons_; }

 private:
  std::vector<PoorCell> look_at_all();
  bool lists_all_poor(std::size_t found) const;

  RunState<D>* state_;
  ViolationScan<D>* violations_;
  PoorReasons<D> reasons_;
};

extern template class PoorSearch<2>;
extern template class PoorSearch<3>;

}  // namespace pgdr::detail
