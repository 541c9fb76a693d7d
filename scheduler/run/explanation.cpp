// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The end of a run: why elements stay poor.
#include <algorithm>
#include <cassert>
#include <utility>

#include "run/leaf_refinement.hpp"

namespace pgdr::detail {

/// For an assertion: large meshes are not looked at, lest debug builds take for ever, nor those of a run that is cancelled.
template <int D>
bool LeafRefinement<D>::lists_all_poor(std::span<const PoorCell> found) const {
  const std::uint32_t cells = context_.mesh.cell_bound(), part = 1000;
  if (cells > 200000) return true;
  std::uint64_t poor = 0;
  for (std::uint32_t c = 0; c < cells; c += part) {
    if (context_.options.stop.stop_requested()) return true;
    poor += count_poor_cells(context_.mesh, context_.bounds, c, std::min(c + part, cells)).cells;
  }
  return poor == found.size();
}

/// Unless there may be violations, nothing is poor but what was refused.
template <int D>
std::vector<PoorCell> LeafRefinement<D>::look_for_poor(PoorReasons<D>& reasons) {
  reasons.forget();
  for_each_refused([&](std::span<const Refusal<D>> refused) { reasons.add(refused); });
  reasons.add(refused_before_);
  const std::stop_token& stop = context_.options.stop;
  if (!violations_seen_) {
    std::vector<PoorCell> found = reasons.of_refused(stop);
    assert(lists_all_poor(found));
    return found;
  }
  look_for_violations();
  const std::uint32_t cells = context_.mesh.cell_bound();
  std::vector<bool> violated(cells);
  for (const Entry<D>& e : violations_) violated[index(e.cell)] = true;
  std::vector<std::vector<PoorCell>> parts(count_parts(cells));
  each_cell_part([&](const CellPart& part) {
    parts[part.number] = reasons.of_cells(part.first, part.last, violated, stop);
  });
  std::vector<PoorCell> all;
  for (const auto& part : parts) all.insert(all.end(), part.begin(), part.end());
  reasons.remember(all);
  return all;
}

template <int D>
std::vector<PoorCell> LeafRefinement<D>::explain(StopCause& stop) {
  PoorReasons<D> reasons(context_.mesh, context_.domain, context_.bounds, context_.options.keep_boundary);
  std::vector<PoorCell> found = look_for_poor(reasons);
  cancelled(0);
  if (context_.stop == 0) stop = improve(reasons, found);
  if (context_.stop != 0) stop = static_cast<StopCause>(context_.stop.load());
  total_statistics();
  if (stop == StopCause::finished && min_edge_hit_) stop = StopCause::min_edge;
  const bool budget_spent = vertices_ >= context_.options.max_vertices && !whole_list_.empty();
  if (stop == StopCause::finished && budget_spent) stop = StopCause::max_vertices;
  return found;
}

template class LeafRefinement<2>;
template class LeafRefinement<3>;

}  // namespace pgdr::detail
