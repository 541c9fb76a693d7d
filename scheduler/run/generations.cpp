// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "run/generations.hpp"

#include <algorithm>
#include <cassert>

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
      conflicts_(state.waiting.tree(), state.options.claim_order),
      random_(static_cast<std::uint64_t>(state.options.threads)) {}

template <int D>
StopCause Generations<D>::drain() {
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
  renew_buffers(wanted);
  touch_memory(wanted);
  Generation<D> generation = conflicts_.plan(wanted);
  std::vector<Planned> planned(wanted.size());
  const std::uint64_t most = context_->options.max_vertices, n = planned.size();
  const std::uint64_t left = most - std::min(most, state_->totals.vertices);
  if (n > 1) context_->mesh.leave_heap();          // several visits have pools of their own
  registry_.reset(waiting_->tree().node_count());  // grows geometrically; of use to debug builds alone
  const auto start = Clock::now();
  execute(generation.graph, [&](VisitGraph::Visit v) {
    // Of the vertices still allowed each visit gets its share, fixed by its number.
    planned[v].work.most_insertions = left / n + (v < left % n ? 1 : 0);
    run_visit(generation.visits[v], planned[v]);
  });
  const double seconds = VisitRecorder::seconds_since(start);
  assert(is_whole_if_small());
  recorder_->add_generation(seconds, account(generation, planned));
  std::vector<Node> candidates;
  for (const Visit<D>& visit : generation.visits)
    if (visit.request.order == 1) candidates.push_back(visit.request.leaf);
  split_leaves(std::move(candidates));
  return true;
}

/// Runs the visit, and posts what it finds for other leaves that it has claimed, for the visits of these that come after it in
/// the plan.
template <int D>
void Generations<D>::run_visit(const Visit<D>& visit, Planned& planned) {
  const VisitRecorder::Watch watch;
  state_->prepare(visit.request, planned.work);
  const Claim<D> claim = visit.claim(waiting_->tree());
  const HeldClaim<D> held(registry_, claim);
  const ClaimedArea<D> area(waiting_->tree(), claim);
  if (visit.request.order == 1) (*waiting_)[visit.request.leaf].open_inbox();
  if (!state_->workers.run(area, planned.work)) return;
  std::erase_if(planned.work.outboxes, [&](typename RegionVisit<D>::Outbox& box) {
    const bool claimed = visit.leaves.empty() || std::binary_search(visit.leaves.begin(), visit.leaves.end(), box.leaf);
    if (claimed) waiting_->post(box.leaf, std::move(box.entries));
    return claimed;
  });
  state_->refused.mark_changed(planned.work, visit.leaves);
  planned.seconds = recorder_->record(visit.request, planned.work, watch);
}

/// For assertions: large meshes are not looked at, lest debug builds take for ever.
template <int D>
bool Generations<D>::is_whole_if_small() const {
  return context_->mesh.cell_bound() > 200000 || is_whole<D>(context_->mesh);
}

/// Takes in what the visits did, in their order. Returns the seconds of their longest chain.
template <int D>
double Generations<D>::account(Generation<D>& generation, std::vector<Planned>& planned) {
  std::vector<double> seconds;
  for (std::size_t v = 0; v < planned.size(); ++v) {
    const Visit<D>& visit = generation.visits[v];
    seconds.push_back(planned[v].seconds);
    state_->account(visit.request, planned[v].work, visit.leaves);
    for (auto& box : planned[v].work.outboxes) waiting_->post(box.leaf, std::move(box.entries));
  }
  return critical_path(generation.graph, seconds);
}

/// Runs pieces of what is done between generations, which do not wait for each other.
template <int D>
void Generations<D>::execute_pieces(std::size_t pieces, const VisitBody& piece) {
  VisitGraph independent;
  for (std::size_t i = 0; i < pieces; ++i) independent.add_visit();
  double longest = 0;
  std::vector<double> seconds(pieces, 0.0);
  const auto start = Clock::now();
  execute(independent, [&](VisitGraph::Visit v) {
    const auto piece_start = Clock::now();
    piece(v);
    seconds[v] = VisitRecorder::seconds_since(piece_start);
  });
  for (const double s : seconds) longest = std::max(longest, s);
  recorder_->add_parts({VisitRecorder::seconds_since(start), longest});
}

/// Finds BUF of the leaves that are to be visited anew where a split has changed it.
template <int D>
void Generations<D>::renew_buffers(std::span<const VisitRequest> requests) {
  constexpr std::size_t leaves_a_piece = 32;
  std::vector<Node> stale;
  for (const VisitRequest& r : requests)
    if (r.order == 1 && conflicts_.is_stale(r.leaf)) stale.push_back(r.leaf);
  execute_pieces((stale.size() + leaves_a_piece - 1) / leaves_a_piece, [&](VisitGraph::Visit v) {
    const std::size_t first = v * leaves_a_piece, last = std::min(stale.size(), first + leaves_a_piece);
    for (std::size_t i = first; i < last; ++i) conflicts_.renew(stale[i]);
  });
}

/// Touches the memory that the cells to come need, a little less, lest it be for nothing: a visit that waits for the kernel makes
/// others wait.
template <int D>
void Generations<D>::touch_memory(std::span<const VisitRequest> requests) {
  std::uint64_t made = 0, replaced = 0;
  for (const VisitRequest& r : requests) {
    if (r.order != 1) continue;
    made += (*waiting_)[r.leaf].list.to_come();
    replaced += (*waiting_)[r.leaf].list.poor();
  }
  constexpr std::uint64_t cells_a_vertex = D == 3 ? 7 : 2;
  const std::uint64_t cells = made - std::min(made, made / 16 + replaced);
  const std::uint64_t vertices = std::min(cells / cells_a_vertex, context_->options.max_vertices - state_->totals.vertices);
  const auto pages = context_->mesh.fresh_pages(cells_a_vertex * vertices, vertices);
  execute_pieces(pages.size(), [&](VisitGraph::Visit v) {
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
    execute_pieces(parents.size(), [&](VisitGraph::Visit v) { waiting_->hand_down(parents[v]); });
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
