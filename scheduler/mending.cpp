// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The end of a run that saw faces which are not locally Delaunay: what flips could not mend is mended in larger regions.
// One visit after the other, of the whole mesh: such regions know no leaves, and there are few of them.
#include "detail/leaf_refinement.hpp"

namespace pgdr::detail {
namespace {

constexpr int most_rounds = 32;  // each of which ends with fewer violations but for insertions

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
  std::vector<Entry<D>> waiting = violations_everywhere();
  for (const Refusal<D>& r : take_refused(true)) waiting.push_back(r.entry);
  for (const Entry<D>& e : waiting) whole_list_.push(e);
  std::set<std::array<VertexId, D + 1>> hopeless;
  for (int round = 0; round < most_rounds; ++round) {
    RegionVisit<D> visit = mending_visit();
    visit.mends = round > 0;
    Worker worker = check_out();
    worker->run(visit);
    account({whole_tree_leaf(), whole_tree, 0}, visit, {});
    bool go_on = context_.stop == 0 && whole_list_.empty();
    if (go_on) {
      RegionVisit<D> mending;
      mending.list = &whole_list_;
      worker->begin(mending);
      go_on = mend_far_from_walls(*worker, hopeless);
    }
    check_in(std::move(worker));
    if (const int stop = context_.stop; stop != 0) return static_cast<StopCause>(stop);
    if (vertices_ >= context_.options.max_vertices && !whole_list_.empty()) return StopCause::max_vertices;
    if (!go_on) break;
  }
  return StopCause::finished;
}

/// Violations that no entity is beside, which nothing excuses, are mended, or moved to the walls, in as large a region as
/// that takes. True if there was any such.
template <int D>
bool LeafRefinement<D>::mend_far_from_walls(Refiner<D>& worker, std::set<std::array<VertexId, D + 1>>& hopeless) {
  bool any = false;
  for (const Entry<D>& e : violations_everywhere()) {
    if (cancelled(0)) return false;
    if (!e.alive(context_.mesh) || !worker.is_far_from_walls(e)) continue;
    const auto vertices = context_.mesh.cell(e.cell).vertices;
    if (hopeless.contains(vertices)) continue;
    if (worker.mend(e)) {
      any = true;
    } else if (worker.violates(e)) {
      hopeless.insert(vertices);
    }
  }
  return any;
}

template class LeafRefinement<2>;
template class LeafRefinement<3>;

}  // namespace pgdr::detail
