// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// What was refused, and whether it may be decided otherwise by now: what a refusal rests on are the cells that were seen, and
// these lie in the claim of the visit that refused. One thread at a time, but for mark_changed.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "run/waiting_work.hpp"

namespace pgdr::detail {

/// Part of a run: see above.
template <int D>
class RefusedWork {
 public:
  using Node = typename Orthtree<D>::Node;

  /// Both must outlive it.
  RefusedWork(const RefineContext<D>& context, WaitingWork<D>& waiting) : context_(&context), waiting_(&waiting) {}

  /// Notes that the visit has changed its leaves, if it has. Any thread, while the visit holds them.
  void mark_changed(const RegionVisit<D>& visit, std::span<const Node> claim);
  /// Notes what a visit that has ended changed, and with which claim it refused. `claim`: its leaves; none for the whole tree.
  void account(const VisitRequest& request, const RegionVisit<D>& visit, std::span<const Node> claim);

  /// Lists what was refused, and may be decided otherwise since the mesh has changed, for the claim that it took to refuse it.
  void relist_changed();
  /// Lists the elements that were refused in their leaves.
  void relist_elements();
  /// Takes all refusals that are still alive off the lists.
  std::vector<Refusal<D>> take_all();
  /// Calls f(refusals) for each list.
  template <class F>
  void for_each_list(F f) const {
    waiting_->for_each_list([&f](const WorkList<D>& list, const LeafWork<D>*) { f(std::span<const Refusal<D>>(list.refused)); });
  }

 private:
  /// Asked of a refusal, with the work of the leaf whose visit refused; null: a visit of the whole tree.
  using Question = std::function<bool(const Refusal<D>&, const LeafWork<D>*)>;

  std::vector<Refusal<D>> take_if(const Question& question);
  bool may_have_changed(const Refusal<D>& refusal, const LeafWork<D>* work) const;
  bool has_changed(const Refusal<D>& refusal) const;

  const RefineContext<D>* context_;
  WaitingWork<D>* waiting_;
  std::uint64_t whole_changed_ = 0;  ///< generation in which a visit of the whole tree last changed the mesh
  std::uint64_t last_change_ = 0;    ///< generation in which any other visit did
};

extern template class RefusedWork<2>;
extern template class RefusedWork<3>;

}  // namespace pgdr::detail
