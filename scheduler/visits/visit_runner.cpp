// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "visits/visit_runner.hpp"

#include <algorithm>
#include <cassert>
#include <numeric>

#include "claims/claimed_area.hpp"
#include "graph/arena.hpp"
#include "mesh/whole.hpp"

namespace pgdr::detail {
namespace {

/// The share of the v-th of n visits of the vertices that are still allowed. All get as many, so that who knows n knows the
/// share, and the rest is for the next generation; only where there is not one for each, the first visits get one.
std::uint64_t share_of(std::uint64_t v, std::uint64_t n, std::uint64_t left) { return left >= n ? left / n : v < left ? 1 : 0; }

}  // namespace

template <int D>
VisitRunner<D>::VisitRunner(RunState<D>& state)
    : state_(&state),
      context_(&state.context),
      options_(&state.options),
      waiting_(&state.waiting),
      recorder_(&state.recorder),
      random_(static_cast<std::uint64_t>(state.options.threads)) {}

template <int D>
std::vector<EndedVisit<D>> VisitRunner<D>::run(const Generation<D>& generation, Posting posting, const Numbers& numbers,
                                               const Hooks& hooks) {
  recorder_->count_generation();
  touch_memory(generation);
  std::vector<EndedVisit<D>> ended(generation.visits.size());
  const std::uint64_t most = context_->options.max_vertices;
  const std::uint64_t left = most - std::min(most, state_->totals.vertices);
  if (ended.size() > 1) context_->mesh.leave_heap();  // several visits have pools of their own
  const auto start = VisitRecorder::Clock::now();
  execute(generation.graph, [&](VisitGraph::Visit v) {
    ended[v].work.most_insertions = share_of(numbers.first + v, numbers.in_all, left);
    run_visit(generation.visits[v], ended[v], posting, v, hooks);
  });
  const double wall = VisitRecorder::seconds_since(start);
  assert(is_whole_if_small());
  std::vector<double> seconds;
  for (const EndedVisit<D>& visit : ended) seconds.push_back(visit.seconds);
  recorder_->add_generation(wall);
  const double work = std::accumulate(seconds.begin(), seconds.end(), 0.0);
  state_->pieces.clock().add_section(wall, work, critical_path(generation.graph, seconds), state_->pieces.is_parallel());
  return ended;
}

template <int D>
void VisitRunner<D>::run_visit(const Visit<D>& visit, EndedVisit<D>& ended, Posting posting, VisitGraph::Visit number,
                               const Hooks& hooks) {
  const VisitRecorder::Watch watch;
  state_->prepare(visit.request, ended.work);
  const Claim<D> claim = visit.claim(waiting_->tree());
  const TakenClaim<D> held(registry_, visit);
  const ClaimedArea<D> area(waiting_->placement(), claim);
  if (visit.request.order == 1) (*waiting_)[visit.request.node].open_inbox([this] { return context_->ended(); });
  if (hooks.before) hooks.before(number, ended.work);
  if (!state_->workers.run(area, ended.work)) return;
  if (hooks.after) hooks.after(number, ended.work);
  if (posting == Posting::at_once)
    std::erase_if(ended.work.outboxes, [&](typename NodeVisit<D>::Outbox& box) {
      const bool claimed = claim.holds(box.node);
      if (claimed) waiting_->post(box.node, std::move(box.entries));
      return claimed;
    });
  ended.seconds = recorder_->record(visit.request, ended.work, watch);
}

template <int D>
void VisitRunner<D>::account(const Generation<D>& generation, std::vector<EndedVisit<D>>& ended) {
  for (std::size_t v = 0; v < ended.size(); ++v) {
    state_->account(generation.visits[v].request, ended[v].work);
    for (auto& box : ended[v].work.outboxes) waiting_->post(box.node, std::move(box.entries));
  }
  if (options_->executor == Executor::shuffled) state_->renumber(random_);
}

/// For assertions: large meshes are not looked at, lest debug builds take for ever.
template <int D>
bool VisitRunner<D>::is_whole_if_small() const {
  return context_->mesh.cell_bound() > 200000 || is_whole<D>(context_->mesh);
}

/// Touches the memory that the cells to come need, a little less, lest it be for nothing: a visit that waits for the kernel makes
/// others wait.
template <int D>
void VisitRunner<D>::touch_memory(const Generation<D>& generation) {
  std::uint64_t made = 0, replaced = 0;
  for (const Visit<D>& visit : generation.visits) {
    const VisitRequest& r = visit.request;
    if (r.order != 1) continue;
    made += (*waiting_)[r.node].list.to_come();
    replaced += (*waiting_)[r.node].list.poor();
  }
  constexpr std::uint64_t cells_a_vertex = D == 3 ? 7 : 2;
  const std::uint64_t cells = made - std::min(made, made / 16 + replaced);
  const std::uint64_t vertices = std::min(cells / cells_a_vertex, context_->options.max_vertices - state_->totals.vertices);
  const auto pages = context_->mesh.fresh_pages(cells_a_vertex * vertices, vertices);
  state_->pieces.run(pages.size(), [&](std::size_t v) {
    if (!context_->ended()) touch_pages(pages[v]);
  });
}

template <int D>
void VisitRunner<D>::execute(const VisitGraph& graph, const VisitBody& body) {
  if (graph.visits() == 0) return;
  VisitRun run;
  if (graph.visits() == 1 || options_->executor == Executor::serial) {
    run = run_serial(graph, body);
  } else if (options_->executor == Executor::shuffled) {
    run = run_shuffled(graph, body, random_);
  } else if (options_->executor == Executor::threads) {
    recorder_->threads_are_new();
    run = run_threads(graph, body, static_cast<unsigned>(std::max(options_->threads, 1)));
  } else {
    in_arena(options_->threads, [&] { run = run_flow_graph(graph, body); });
  }
  if (!run.complete()) context_->stop = static_cast<int>(StopCause::cancelled);
  recorder_->count_concurrent(run.max_concurrent);
}

template class VisitRunner<2>;
template class VisitRunner<3>;

}  // namespace pgdr::detail
