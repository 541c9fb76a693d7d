// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "run/generations.hpp"

#include <algorithm>
#include <cassert>
#include <numeric>

#include "claims/claimed_area.hpp"
#include "graph/arena.hpp"
#include "mesh/whole.hpp"

namespace pgdr::detail {

template <int D>
Generations<D>::Generations(RunState<D>& state)
    : state_(&state),
      context_(&state.context),
      options_(&state.options),
      waiting_(&state.waiting),
      recorder_(&state.recorder),
      conflicts_(state.waiting.tree(), state.options.claims, state.options.claim_order),
      random_(static_cast<std::uint64_t>(state.options.threads)) {}

template <int D>
StopCause Generations<D>::drain() {
  split_leaves(waiting_->tree().leaves());
  while (true) {
    if (context_->options.stop.stop_requested()) return StopCause::cancelled;
    if (!context_->stage && state_->totals.vertices >= context_->options.max_vertices) return StopCause::max_vertices;
    if (state_->is_spent() || !one_generation()) return StopCause::finished;
    if (state_->stop() != StopCause::finished) return state_->stop();
  }
}

/// Plans the visits of a generation, runs them, takes in what they did, and splits leaves; false if nothing waits.
template <int D>
bool Generations<D>::one_generation() {
  const std::vector<VisitRequest> wanted = waiting_->requests();
  if (wanted.empty()) return false;
  waiting_->begin_generation();
  recorder_->count_generation();
  if (options_->claims == ClaimRule::leaves) renew_buffers(wanted);
  touch_memory(wanted);
  Generation<D> generation = conflicts_.plan(wanted);
  std::vector<Planned> planned(wanted.size());
  const std::uint64_t most = context_->options.max_vertices, n = planned.size();
  const std::uint64_t left = most - std::min(most, state_->totals.vertices);
  if (n > 1) context_->mesh.leave_heap();  // several visits have pools of their own
  const auto start = Clock::now();
  execute(generation.graph, [&](VisitGraph::Visit v) {
    // Of the vertices still allowed each visit gets its share, fixed by its number.
    planned[v].work.most_insertions = left / n + (v < left % n ? 1 : 0);
    run_visit(generation.visits[v], planned[v]);
  });
  const double seconds = VisitRecorder::seconds_since(start);
  assert(is_whole_if_small());
  account(generation, planned, seconds);
  std::vector<Node> candidates;
  for (const Visit<D>& visit : generation.visits)
    if (visit.request.order == 1) candidates.push_back(visit.request.node);
  split_leaves(std::move(candidates));
  return true;
}

/// Runs the visit, and posts what it finds for other nodes that it has claimed whole, for the visits of these that come after it
/// in the plan: their claims hold these nodes, too.
template <int D>
void Generations<D>::run_visit(const Visit<D>& visit, Planned& planned) {
  const VisitRecorder::Watch watch;
  state_->prepare(visit.request, planned.work);
  const Claim<D> claim = visit.claim(waiting_->tree());
  const HeldClaim<D> held(registry_, visit);
  const ClaimedArea<D> area(waiting_->placement(), claim);
  if (visit.request.order == 1) (*waiting_)[visit.request.node].open_inbox();
  if (!state_->workers.run(area, planned.work)) return;
  std::erase_if(planned.work.outboxes, [&](typename RegionVisit<D>::Outbox& box) {
    const bool claimed = claim.holds(box.region);
    if (claimed) waiting_->post(box.region, std::move(box.entries));
    return claimed;
  });
  planned.seconds = recorder_->record(visit.request, planned.work, watch);
}

/// For assertions: large meshes are not looked at, lest debug builds take for ever.
template <int D>
bool Generations<D>::is_whole_if_small() const {
  return context_->mesh.cell_bound() > 200000 || is_whole<D>(context_->mesh);
}

/// Takes in what the visits did, in their order. `wall`: the seconds that they took.
template <int D>
void Generations<D>::account(Generation<D>& generation, std::vector<Planned>& planned, double wall) {
  std::vector<double> seconds;
  for (std::size_t v = 0; v < planned.size(); ++v) {
    const Visit<D>& visit = generation.visits[v];
    seconds.push_back(planned[v].seconds);
    state_->account(visit.request, planned[v].work);
    for (auto& box : planned[v].work.outboxes) waiting_->post(box.region, std::move(box.entries));
  }
  recorder_->add_generation(wall);
  const double work = std::accumulate(seconds.begin(), seconds.end(), 0.0);
  state_->pieces.clock().add_section(wall, work, critical_path(generation.graph, seconds), state_->pieces.is_parallel());
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

/// Touches the memory that the cells to come need, a little less, lest it be for nothing: a visit that waits for the kernel makes
/// others wait.
template <int D>
void Generations<D>::touch_memory(std::span<const VisitRequest> requests) {
  std::uint64_t made = 0, replaced = 0;
  for (const VisitRequest& r : requests) {
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

/// Splits those that are crowded, and their children as long as these are.
template <int D>
void Generations<D>::split_leaves(std::vector<Node> candidates) {
  while (!candidates.empty()) {
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

template <int D>
void Generations<D>::execute(const VisitGraph& graph, const VisitBody& body) {
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

template class Generations<2>;
template class Generations<3>;

}  // namespace pgdr::detail
