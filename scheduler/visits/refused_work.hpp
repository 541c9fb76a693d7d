// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// What was refused, and whether it may be decided otherwise by now. What a refusal rests on is kept with it. One thread at a
// time.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "space/pieces.hpp"
#include "visits/waiting_work.hpp"

namespace pgdr::detail {

/// Part of a run: see above.
template <int D>
class RefusedWork {
 public:
  using Node = typename Orthtree<D>::Node;

  /// All must outlive it.
  RefusedWork(RefineContext<D>& context, WaitingWork<D>& waiting, const Pieces& pieces)
      : context_(&context), waiting_(&waiting), pieces_(&pieces) {}

  // Where the run has to end meanwhile, nothing is taken or listed.
  /// Lists what was refused, and may be decided otherwise since the mesh has changed. What took a larger claim gets a larger one
  /// (WaitingWork).
  void relist_changed();
  /// From now on all counts as changed.
  void try_all_again();
  /// Lists the elements that were refused in their leaves.
  void relist_elements();
  /// Takes all refusals that are still alive off the lists.
  std::vector<Refusal<D>> take_all();
  /// Calls f(refusals) for each list.
  template <class F>
  void for_each_list(F f) const {
    waiting_->for_each_list([&f](const WorkList<D>& list) { f(std::span<const Refusal<D>>(list.refused)); });
  }

 private:
  /// Asked of refusals, of several at once.
  using Question = std::function<bool(const Refusal<D>&)>;

  std::vector<Refusal<D>> take_if(const Question& question);
  bool has_changed(const Refusal<D>& refusal) const;

  RefineContext<D>* context_;
  WaitingWork<D>* waiting_;
  const Pieces* pieces_;
};

extern template class RefusedWork<2>;
extern template class RefusedWork<3>;

}  // namespace pgdr::detail
