// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "run/poor_search.hpp"

#include <algorithm>
#include <cassert>

namespace pgdr::detail {

template <int D>
PoorSearch<D>::PoorSearch(RunState<D>& state, ViolationScan<D>& violations)
    : state_(&state),
      violations_(&violations),
      reasons_(state.context.mesh, state.context.domain, state.context.bounds, state.context.kept, state.context.meshed,
               Bulk(state.pieces)) {}

/// For an assertion: large meshes are not looked at, lest debug builds take for ever, nor those of a run that has to end.
template <int D>
bool PoorSearch<D>::lists_all_poor(std::size_t found) const {
  const RefineContext<D>& context = state_->context;
  const std::uint32_t cells = context.mesh.cell_bound(), part = 1000;
  if (cells > 200000) return true;
  std::uint64_t poor = 0;
  for (std::uint32_t c = 0; c < cells; c += part) {
    if (state_->context.ended()) return true;
    poor += count_poor_cells(context.mesh, context.bounds, c, std::min(c + part, cells)).cells;
  }
  return poor == found;
}

/// Unless there may be violations, nothing is poor but what was refused.
template <int D>
std::vector<PoorCell> PoorSearch<D>::find() {
  state_->refused.for_each_list([this](std::span<const Refusal<D>> refused) { reasons_.add(refused); });
  if (state_->totals.violations_seen) return look_at_all();
  std::vector<PoorCell> found = reasons_.of_refused([this] { return state_->context.ended(); }, Bulk(state_->pieces));
  assert(lists_all_poor(found.size()));
  return found;
}

template <int D>
std::vector<PoorCell> PoorSearch<D>::look_at_all() {
  violations_->scan();
  const std::uint32_t cells = state_->context.mesh.cell_bound();
  std::vector<bool> violated(cells);
  for (const Entry<D>& e : violations_->standing()) violated[index(e.cell)] = true;
  std::vector<std::vector<PoorCell>> parts(count_parts(cells));
  each_part(cells, state_->pieces, [&](const CellPart& part) {
    parts[part.number] = reasons_.of_cells(part.first, part.last, violated, [this] { return state_->context.ended(); });
  });
  std::vector<PoorCell> all;
  for (const auto& part : parts) all.insert(all.end(), part.begin(), part.end());
  return all;
}

template <int D>
std::vector<PoorCell> PoorSearch<D>::find_at_violations() {
  std::vector<CellId> cells;
  for (const Entry<D>& e : violations_->standing()) cells.push_back(e.cell);
  std::sort(cells.begin(), cells.end());
  cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
  return reasons_.of_violated(cells, [this] { return state_->context.ended(); });
}

template class PoorSearch<2>;
template class PoorSearch<3>;

}  // namespace pgdr::detail
