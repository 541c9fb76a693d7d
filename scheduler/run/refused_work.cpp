// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "run/refused_work.hpp"

#include <algorithm>
#include <utility>

#include "mesh/surroundings.hpp"
#include "refine/element_stage.hpp"

namespace pgdr::detail {

template <int D>
void RefusedWork<D>::mark_changed(const RegionVisit<D>& visit, std::span<const Node> claim) {
  if (!visit.changed_mesh) return;
  for (const Node leaf : claim) (*waiting_)[leaf].changed = visit.generation;
}

template <int D>
void RefusedWork<D>::account(const VisitRequest& request, const RegionVisit<D>& visit, std::span<const Node> claim) {
  if (visit.changed_mesh) (claim.empty() ? whole_changed_ : last_change_) = visit.generation;
  if (!claim.empty() && visit.counts.refused > 0)
    (*waiting_)[request.leaf].zones.try_emplace(request.order, claim.begin(), claim.end());
}

/// Takes those of which the answer is yes off the lists, and drops those that are dead.
template <int D>
std::vector<Refusal<D>> RefusedWork<D>::take_if(const Question& question) {
  std::vector<Refusal<D>> taken, kept;
  waiting_->for_each_list([&](WorkList<D>& list, const LeafWork<D>* work) {
    for (Refusal<D>& r : list.refused)
      if (r.entry.alive(context_->mesh)) (question(r, work) ? taken : kept).push_back(std::move(r));
    list.refused = std::exchange(kept, {});
  });
  return taken;
}

template <int D>
std::vector<Refusal<D>> RefusedWork<D>::take_all() {
  return take_if([](const Refusal<D>&, const LeafWork<D>*) { return true; });
}

/// Has anything changed that the visit could see?
template <int D>
bool RefusedWork<D>::may_have_changed(const Refusal<D>& refusal, const LeafWork<D>* work) const {
  if (whole_changed_ >= refusal.generation) return true;
  if (!work || refusal.order == whole_tree) return last_change_ >= refusal.generation;
  const auto zone = work->zones.find(refusal.order);
  return zone == work->zones.end() || std::any_of(zone->second.begin(), zone->second.end(),
                                                  [&](Node n) { return (*waiting_)[n].changed >= refusal.generation; });
}

/// Has anything changed that the visit did see, or may have?
template <int D>
bool RefusedWork<D>::has_changed(const Refusal<D>& refusal) const {
  if (context_->stage) return context_->stage->version(refusal.entry.cell) != refusal.versions;
  return refusal.seen.empty() || surroundings_of<D>(context_->mesh, refusal.seen) != refusal.surroundings;
}

template <int D>
void RefusedWork<D>::relist_changed() {
  bool any = false;
  for_each_list([&any](std::span<const Refusal<D>> refused) { any = any || !refused.empty(); });
  if (!any) return;
  waiting_->pass_up_changes();
  const auto refused = take_if(
      [this](const Refusal<D>& r, const LeafWork<D>* work) { return may_have_changed(r, work) && has_changed(r); });
  for (const Refusal<D>& r : refused)
    if (r.order == 1)
      waiting_->relist(r.entry);
    else
      waiting_->set_aside(waiting_->tree().leaf_at(context_->place_of(r.entry.cell)), r.order, r.entry);
}

template <int D>
void RefusedWork<D>::relist_elements() {
  const auto elements = take_if([](const Refusal<D>& r, const LeafWork<D>*) { return r.entry.kind() == EntryKind::cell; });
  for (const Refusal<D>& r : elements) waiting_->relist(r.entry);
}

template class RefusedWork<2>;
template class RefusedWork<3>;

}  // namespace pgdr::detail
