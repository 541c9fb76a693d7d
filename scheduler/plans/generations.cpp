// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "plans/generations.hpp"

#include <algorithm>

namespace pgdr::detail {
template <int D>
Generations<D>::Generations(RunState<D>& state)
    : state_(&state),
      context_(&state.context),
      options_(&state.options),
      waiting_(&state.waiting),
      conflicts_(state.waiting.tree(), state.options.claims, state.options.claim_order) {}

template <int D>
std::optional<PlannedVisits<D>> Generations<D>::next() {
  const std::vector<VisitRequest> wanted = waiting_->requests();
  if (wanted.empty()) return std::nullopt;
  if (options_->claims == ClaimRule::leaves) renew_buffers(wanted);
  return PlannedVisits<D>{conflicts_.plan(wanted), Posting::at_once};
}

template <int D>
void Generations<D>::done(VisitRunner<D>& runner, const PlannedVisits<D>& plan, std::vector<EndedVisit<D>> ended,
                          const std::exception_ptr& error) {
  Planner<D>::done(runner, plan, std::move(ended), error);
  std::vector<Node> candidates;
  for (const Visit<D>& visit : plan.generation.visits)
    if (visit.request.order == 1) candidates.push_back(visit.request.node);
  split_leaves(std::move(candidates));
}

/// Finds BUF of the leaves that are to be visited anew where a split has changed it.
template <int D>
void Generations<D>::renew_buffers(std::span<const VisitRequest> requests) {
  constexpr std::size_t requests_a_piece = 32;
  conflicts_.make_room();
  state_->pieces.run((requests.size() + requests_a_piece - 1) / requests_a_piece, [&](std::size_t piece) {
    const std::size_t first = piece * requests_a_piece, last = std::min(requests.size(), first + requests_a_piece);
    for (std::size_t i = first; i < last; ++i)
      if (requests[i].order == 1) conflicts_.renew(requests[i].node);
  });
}

/// Splits those that are crowded, and their children as long as these are, unless the run has to end meanwhile.
template <int D>
void Generations<D>::split_leaves(std::vector<Node> candidates) {
  while (!candidates.empty() && !context_->ended()) {
    std::vector<Node> parents;
    for (const Node leaf : candidates)
      if (waiting_->split_if_crowded(leaf)) parents.push_back(leaf);
    state_->pieces.run(parents.size(), [&](std::size_t v) { waiting_->hand_down(parents[v]); });
    candidates.clear();
    for (const Node parent : parents)
      for (Node child = 0; child < Orthtree<D>::children; ++child)
        candidates.push_back(waiting_->tree().first_child(parent) + child);
  }
}

template class Generations<2>;
template class Generations<3>;

}  // namespace pgdr::detail
