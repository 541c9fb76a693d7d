// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The end of a run: why elements stay poor. Where walls have cut back cavities so far that the mesh is a tangle, with cells
// through half of it, elements stay poor beside no small angle. Flips within facets and a few points inside of these elements,
// nearer to others than the rule for poor elements allows, let the rest be refined as everywhere else. One visit after the
// other, of the whole mesh.
#include <algorithm>
#include <cassert>
#include <utility>

#include "detail/leaf_refinement.hpp"
#include "detail/make_set.hpp"

namespace pgdr::detail {
namespace {

constexpr int most_rounds = 16;
// Rounds that explain no more than the best before: of elements that may have a small angle farther away as their reason (what is
// put in for them brings as many new ones), and of those that have none.
constexpr int most_in_vain_near = 2, most_in_vain_far = 6;
constexpr int most_turns = 3;  // of helping and improving
constexpr int most_rings = 2;  // of cells about these: more bring on more than they mend

}  // namespace

/// For an assertion: large meshes are not looked at, lest debug builds take for ever, nor those of a run that is cancelled.
template <int D>
bool LeafRefinement<D>::lists_all_poor(const PoorFindings& found) const {
  const std::uint32_t cells = context_.mesh.cell_bound(), part = 1000;
  if (cells > 200000) return true;
  std::uint64_t poor = 0;
  for (std::uint32_t c = 0; c < cells; c += part) {
    if (context_.options.stop.stop_requested()) return true;
    poor += count_poor_cells(context_.mesh, context_.bounds, c, std::min(c + part, cells)).cells;
  }
  return poor == found.poor.size();
}

/// Unless there may be violations, nothing is poor but what was refused.
template <int D>
PoorFindings LeafRefinement<D>::look_for_poor(PoorReasons<D>& reasons) {
  reasons.forget();
  for_each_refused([&](std::span<const Refusal<D>> refused) { reasons.add(refused); });
  reasons.add(refused_before_);
  const std::stop_token& stop = context_.options.stop;
  if (!violations_seen_) {
    PoorFindings found = reasons.of_refused(stop);
    assert(lists_all_poor(found));
    return found;
  }
  look_for_violations();
  const std::uint32_t cells = context_.mesh.cell_bound();
  std::vector<bool> violated(cells);
  for (const Entry<D>& e : violations_) violated[index(e.cell)] = true;
  std::vector<PoorFindings> parts(count_parts(cells));
  each_cell_part([&](const CellPart& part) {
    parts[part.number] = reasons.of_cells(part.first, part.last, violated, stop);
  });
  PoorFindings all;
  for (const PoorFindings& part : parts) all.append(part);
  reasons.remember(all);
  reasons.excuse(all);
  unexplained_violations_ = all.violated.size();
  all.unexplained.insert(all.unexplained.end(), all.violated.begin(), all.violated.end());
  return all;
}

template <int D>
std::vector<PoorCell> LeafRefinement<D>::explain(StopCause& stop) {
  PoorReasons<D> reasons(context_.mesh, context_.domain, context_.bounds, context_.options.keep_boundary);
  PoorFindings found = look_for_poor(reasons);
  help_unexplained(reasons, found, most_in_vain_near);
  // What no round helps may be gone, or mended, once vertices about it are taken out and moved.
  bool changed = true;
  for (int turn = 0; turn < most_turns && (turn == 0 || !found.unexplained.empty()) && changed && stop == StopCause::finished; ++turn) {
    if (!found.unexplained.empty() && !context_.ended()) {
      reasons.look_far();
      found = look_for_poor(reasons);
      help_unexplained(reasons, found, most_in_vain_far);
    }
    cancelled(0);
    const std::uint64_t before = counts_.improved;
    if (context_.stop == 0) stop = improve(reasons, found);
    changed = counts_.improved != before && context_.stop == 0;
  }
  if (context_.stop != 0) stop = static_cast<StopCause>(context_.stop.load());
  total_statistics();
  if (stop == StopCause::finished && min_edge_hit_) stop = StopCause::min_edge;
  const bool budget_spent = vertices_ >= context_.options.max_vertices && !whole_list_.empty();
  if (stop == StopCause::finished && budget_spent) stop = StopCause::max_vertices;
  return std::move(found.poor);
}

/// These cells, and so many rings of neighbours about them. What came of the cells alone may be undone by what comes next, and so
/// on in turn; with others about them it is not.
template <int D>
std::vector<CellId> LeafRefinement<D>::with_rings(std::vector<CellId> cells, int rings) const {
  for (int ring = 0; ring < rings; ++ring) {
    for (std::size_t k = 0, n = cells.size(); k < n; ++k)
      for (const Link next : context_.mesh.cell(cells[k]).links)
        if (next) cells.push_back(next.cell());
    make_set(cells);
  }
  return cells;
}

template <int D>
void LeafRefinement<D>::help_unexplained(PoorReasons<D>& reasons, PoorFindings& found, int most_in_vain) {
  std::size_t least = found.unexplained.size();
  bool mends = false;
  for (int round = 0, in_vain = 0; round < most_rounds && in_vain < most_in_vain && !cancelled(0); ++round) {
    if (found.unexplained.empty() || context_.stop != 0) break;
    // What is mended by taking a vertex out may come back with it: then a point inside is better, or the other way round.
    mends = unexplained_violations_ > 0 && !(mends && in_vain > 0);
    context_.excusing = reasons.excusing_homes(found);
    const bool changed = insert_within(with_rings(found.unexplained, std::min(in_vain, most_rings)), mends);
    if (context_.stop != 0) break;
    if (changed) found = look_for_poor(reasons);
    in_vain = found.unexplained.size() < least ? 0 : in_vain + 1;
    least = std::min(least, found.unexplained.size());
  }
}

/// Mends what can be mended about these cells, if `mends`, or inserts points inside of them. False if the mesh is as it was.
template <int D>
bool LeafRefinement<D>::insert_within(std::span<const CellId> cells, bool mends) {
  std::vector<Entry<D>> entries;
  for (const CellId c : cells) entries.emplace_back(c, context_.mesh.birth(c), EntryKind::cell, Entry<D>::not_delaunay);
  sort_by_vertices(entries);
  bool changed = false;
  const auto visit_whole = [&](const auto& begun) {
    RegionVisit<D> visit = mending_visit();
    visit.repairs_facets = true;
    Worker worker = check_out();
    worker->begin(visit);
    if (begun(*worker)) worker->run(visit);
    check_in(std::move(worker));
    account({whole_tree_leaf(), whole_tree, 0}, visit, {});
    changed = changed || visit.changed_mesh;
  };
  for (const Entry<D>& e : entries) {
    const auto waits = [&] { return context_.stop == 0 && e.alive(context_.mesh); };
    if (waits()) visit_whole([&](Refiner<D>& worker) { return worker.list_violations_about(e.cell); });
    // What is taken out now would come back at once, and the violation with it.
    if (waits() && mends) visit_whole([&](Refiner<D>& worker) { return worker.mend_cell(e.cell); });
    if (waits()) visit_whole([&](Refiner<D>& worker) { return worker.insert_within(e); });
  }
  return changed;
}

template class LeafRefinement<2>;
template class LeafRefinement<3>;

}  // namespace pgdr::detail
