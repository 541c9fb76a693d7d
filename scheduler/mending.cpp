// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The end of a run that saw faces which are not locally Delaunay: what flips could not mend is mended in larger regions.
// One visit after the other, of the whole mesh: such regions know no leaves, and there are few of them.
#include <algorithm>
#include <limits>

#include "detail/leaf_refinement.hpp"

namespace pgdr::detail {
namespace {

constexpr int most_rounds = 32;  // each of which ends with fewer violations but for insertions
constexpr int most_rounds_in_vain = 4;  // that find no fewer than the best before: what was taken out comes back

}  // namespace

/// Of the whole mesh, all by itself.
template <int D>
RegionVisit<D> LeafRefinement<D>::mending_visit() {
  RegionVisit<D> visit;
  visit.list = &whole_list_;
  visit.violations_seen = visit.rewraps = true;
  visit.order = whole_tree;
  visit.generation = generation_;
  visit.entities_refused = entities_refused_;
  visit.most_insertions = context_.options.max_vertices - vertices_;
  return visit;
}

template <int D>
StopCause LeafRefinement<D>::mend() {
  for (const Entry<D>& e : violations_everywhere()) whole_list_.push(e);
  std::set<std::array<VertexId, D + 1>> hopeless;
  std::size_t least = std::numeric_limits<std::size_t>::max();
  for (int round = 0, in_vain = 0; round < most_rounds && in_vain < most_rounds_in_vain; ++round) {
    do {
      RegionVisit<D> visit = mending_visit();
      Worker worker = check_out();
      worker->run(visit);
      check_in(std::move(worker));
      account({whole_tree_leaf(), whole_tree, 0}, visit, {});
      if (const int stop = context_.stop; stop != 0) return static_cast<StopCause>(stop);
      if (vertices_ >= context_.options.max_vertices && !whole_list_.empty()) return StopCause::max_vertices;
      if (!whole_list_.empty()) return StopCause::finished;
      // What a selector looks at is not known: refused once, its elements would be tried again for ever.
      if (!visit.changed_mesh) break;
      for (const Refusal<D>& r : take_refused()) whole_list_.push(r.entry);
    } while (!whole_list_.empty());
    const std::size_t found = mend_far_from_walls(hopeless);
    if (found == 0) break;
    in_vain = found < least ? 0 : in_vain + 1;
    least = std::min(least, found);
  }
  return static_cast<StopCause>(context_.stop.load());
}

/// Violations that no entity is beside, which nothing excuses, are mended, or moved to the walls, in as large a region as
/// that takes. How many there were; 0 if none could be mended.
template <int D>
std::size_t LeafRefinement<D>::mend_far_from_walls(std::set<std::array<VertexId, D + 1>>& hopeless) {
  RegionVisit<D> mending;
  mending.list = &whole_list_;
  Worker worker = check_out();
  worker->begin(mending);
  bool any = false;
  std::size_t found = 0;
  for (const Entry<D>& e : violations_everywhere()) {
    if (worker->ended()) break;
    if (!e.alive(context_.mesh) || !worker->is_far_from_walls(e)) continue;
    const auto vertices = context_.mesh.cell(e.cell).vertices;
    if (hopeless.contains(vertices)) continue;
    ++found;
    if (worker->mend(e)) {
      any = true;
    } else if (worker->violates(e)) {
      hopeless.insert(vertices);
    }
  }
  check_in(std::move(worker));
  return any ? found : 0;
}

template class LeafRefinement<2>;
template class LeafRefinement<3>;

}  // namespace pgdr::detail
