// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The last visits of a run, which change the mesh for elements that stay poor (core/improve/improve.cpp): of leaves, as those
// before them, with claims as large as it takes. Vertices are taken out before points come: that leaves as few poor elements, and
// fewer of all.
#include <cassert>
#include <utility>

#include "improve/improvement.hpp"
#include "run/leaf_refinement.hpp"

namespace pgdr::detail {

/// Takes what was refused off the lists, and lists the poor elements among it anew.
template <int D>
void LeafRefinement<D>::list_for_improvement() {
  std::vector<bool> listed(context_.mesh.cell_bound());
  assert(whole_list_.poor() == 0);
  for (Node n = 0; n <= tree_.node_count(); ++n) {
    auto& list = n < tree_.node_count() ? works_[n].list.refused : whole_list_.refused;
    for (Refusal<D>& r : std::exchange(list, {})) {
      if (r.entry.kind() != EntryKind::cell || !r.entry.alive(context_.mesh)) continue;
      const CellId c = r.entry.cell;
      if (!listed[index(c)] && context_.bounds.test(context_.mesh, c)) relist(r.entry);
      listed[index(c)] = true;
      r.seen = {};
      refused_before_.push_back(std::move(r));
    }
  }
}

/// Of bounds below what theory proves many elements may be over, for no reason but that. Where they are too many, it would take
/// many times as long as all before, and mend few of them; taking vertices out is the quickest, and mends most.
template <int D>
bool LeafRefinement<D>::may_improve(bool collapses_only) const {
  if (context_.options.radius_edge_bound >= smallest_proved_bound<D>()) return true;
  const Mesh<D>& mesh = context_.mesh;
  std::size_t cells = 0, poor = 0;
  for (std::uint32_t i = 0; i < mesh.cell_bound(); ++i) {
    if (!mesh.alive(CellId{i})) continue;
    ++cells;
    poor += context_.bounds.test(mesh, CellId{i}) ? 1 : 0;
  }
  const std::size_t least_cells = collapses_only ? 6 : 16;  // for each that is poor
  return least_cells * poor <= cells;
}

/// Visits until nothing that was refused is worth another try.
template <int D>
StopCause LeafRefinement<D>::improve_listed() {
  StopCause stop;
  std::uint64_t before;
  do {
    before = counts_.improved;
    stop = drain();
  } while (stop == StopCause::finished && counts_.improved != before && relist_refused());
  return stop;
}

template <int D>
StopCause LeafRefinement<D>::improve(PoorReasons<D>& reasons, std::vector<PoorCell>& found) {
  StopCause stop = StopCause::finished;
  if constexpr (D == 3) {
    if (found.empty() || !may_improve(true)) return stop;
    improvement_ = std::make_unique<Improvement>(context_.mesh, reasons);
    context_.stage = improvement_.get();
    const std::uint64_t before = counts_.improved;
    for (const bool alone : {true, false}) {
      if (!alone && !may_improve(false)) break;
      improvement_->collapses_only = alone;
      list_for_improvement();
      if (stop == StopCause::finished) stop = improve_listed();
    }
    context_.stage = nullptr;
    if (stop == StopCause::finished && counts_.improved != before) found = look_for_poor(reasons);
  }
  return stop;
}

template class LeafRefinement<2>;
template class LeafRefinement<3>;

}  // namespace pgdr::detail
