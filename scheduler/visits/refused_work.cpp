// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "visits/refused_work.hpp"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "mesh/surroundings.hpp"
#include "refine/element_stage.hpp"

namespace pgdr::detail {

/// Takes those of which the answer is yes off the lists, in the order of the lists, and drops those that are dead. Does nothing
/// if the run has to end meanwhile.
template <int D>
std::vector<Refusal<D>> RefusedWork<D>::take_if(const Question& question) {
  enum class Fate : char { stays, is_taken, is_dead };
  constexpr std::size_t refusals_a_piece = 256;
  std::vector<const Refusal<D>*> all;
  waiting_->for_each_list([&all](WorkList<D>& list) {
    for (const Refusal<D>& r : list.refused) all.push_back(&r);
  });
  std::vector<Fate> fates(all.size());
  pieces_->run((all.size() + refusals_a_piece - 1) / refusals_a_piece, [&](std::size_t piece) {
    if (context_->ended()) return;
    const std::size_t first = piece * refusals_a_piece, last = std::min(all.size(), first + refusals_a_piece);
    for (std::size_t i = first; i < last; ++i)
      fates[i] = !all[i]->entry.alive(context_->mesh) ? Fate::is_dead : question(*all[i]) ? Fate::is_taken : Fate::stays;
  });
  std::vector<Refusal<D>> taken;
  if (context_->stop != 0) return taken;
  auto fate = fates.begin();
  waiting_->for_each_list([&](WorkList<D>& list) {
    std::vector<Refusal<D>> stay;
    for (Refusal<D>& r : list.refused) {
      if (*fate != Fate::is_dead) (*fate == Fate::stays ? stay : taken).push_back(std::move(r));
      ++fate;
    }
    list.refused = std::move(stay);
  });
  return taken;
}

template <int D>
std::vector<Refusal<D>> RefusedWork<D>::take_all() {
  return take_if([](const Refusal<D>&) { return true; });
}

/// Has anything changed that the visit did see, or may have?
template <int D>
bool RefusedWork<D>::has_changed(const Refusal<D>& refusal) const {
  if (refusal.again) return true;
  if (context_->stage) return context_->stage->version(refusal.entry.cell) != refusal.versions;
  return surroundings_of<D>(context_->mesh, refusal.seen, refusal.owned) != refusal.surroundings;
}

template <int D>
void RefusedWork<D>::relist_changed() {
  for (const Refusal<D>& r : take_if([this](const Refusal<D>& r) { return has_changed(r); })) waiting_->relist(r.entry, r.order);
}

template <int D>
void RefusedWork<D>::try_all_again() {
  waiting_->for_each_list([](WorkList<D>& list) {
    for (Refusal<D>& r : list.refused) {
      r.again = true;
      r.seen = {};
    }
  });
}

template <int D>
void RefusedWork<D>::relist_elements() {
  for (const Refusal<D>& r : take_if([](const Refusal<D>& r) { return r.entry.kind() == EntryKind::cell; }))
    waiting_->relist(r.entry);
}

template class RefusedWork<2>;
template class RefusedWork<3>;

}  // namespace pgdr::detail
