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
Generations<D>::Generations(RefineContext<D>& context, typename Mesh<D>::Pools pools, std::uint64_t vertices_so_far)
    : Base(context, std::move(pools), vertices_so_far), conflicts_(tree_, options_.claim_order) {}

template <int D>
StopCause Generations<D>::drain() {
  while (true) {
    if (context_.options.stop.stop_requested()) return StopCause::cancelled;
    if (vertices_ >= context_.options.max_vertices) return StopCause::max_vertices;
    if (!one_generation()) return StopCause::finished;
    if (const int stop = context_.stop; stop != 0) return static_cast<StopCause>(stop);
  }
}

template <int D>
bool Generations<D>::one_generation() {
  const std::vector<VisitRequest> wanted = Base::requests();
  if (wanted.empty()) return false;
  ++generation_;
  ++statistics_.generations;
  renew_buffers(wanted);
  touch_memory(wanted);
  Generation<D> generation = conflicts_.plan(wanted);
  std::vector<Planned> planned(wanted.size());
  const std::uint64_t left = context_.options.max_vertices - vertices_, n = planned.size();
  registry_.reset(tree_.node_count());  // grows geometrically; of use to debug builds alone
  const auto start = Clock::now();
  execute(generation.graph, [&](VisitGraph::Visit v) {
    // Of the vertices still allowed each visit gets its share, fixed by its number.
    planned[v].work.most_insertions = left / n + (v < left % n ? 1 : 0);
    run_visit(generation.visits[v], planned[v]);
  });
  statistics_.seconds_in_generations += seconds_since(start);
  finish(generation, planned);
  return true;
}

/// What it finds for other leaves that it has claimed is there when these are visited, if after it: whether it is, is in the plan.
template <int D>
void Generations<D>::run_visit(const Visit<D>& visit, Planned& planned) {
  const typename Base::Watch watch;
  Base::prepare(visit.request, planned.work);
  const Claim<D> claim = visit.claim(tree_);
  const HeldClaim<D> held(registry_, claim);
  const ClaimedArea<D> area(tree_, claim);
  if (visit.request.order == 1) works_[visit.request.leaf].open_inbox();
  if (!Base::work_off(area, planned.work)) return;
  std::erase_if(planned.work.outboxes, [&](typename RegionVisit<D>::Outbox& box) {
    const bool claimed = visit.leaves.empty() || std::binary_search(visit.leaves.begin(), visit.leaves.end(), box.leaf);
    if (claimed) Base::post(box.leaf, std::move(box.entries));
    return claimed;
  });
  Base::mark_changed(planned.work, visit.leaves);
  planned.seconds = Base::record(visit.request, planned.work, watch);
}

/// For assertions: large meshes are not looked at, lest debug builds take for ever.
template <int D>
bool Generations<D>::is_whole_if_small() const {
  return context_.mesh.cell_bound() > 200000 || is_whole<D>(context_.mesh);
}

template <int D>
void Generations<D>::finish(Generation<D>& generation, std::vector<Planned>& planned) {
  assert(is_whole_if_small());
  std::vector<double> seconds;
  std::vector<Node> candidates;
  for (std::size_t v = 0; v < planned.size(); ++v) {
    const VisitRequest& request = generation.visits[v].request;
    seconds.push_back(planned[v].seconds);
    Base::account(request, planned[v].work, generation.visits[v].leaves);
    for (auto& box : planned[v].work.outboxes) Base::post(box.leaf, std::move(box.entries));
    if (request.order == 1) candidates.push_back(request.leaf);
  }
  statistics_.critical_path_seconds += critical_path(generation.graph, seconds);
  split_leaves(std::move(candidates));
}

/// Pieces of what is done between generations that do not wait for each other. All of it counts as serial, but on the critical
/// path the longest alone.
template <int D>
void Generations<D>::execute_pieces(std::size_t pieces, const VisitBody& piece) {
  VisitGraph independent;
  for (std::size_t i = 0; i < pieces; ++i) independent.add_visit();
  std::vector<double> seconds(pieces, 0.0);
  const auto start = Clock::now();
  execute(independent, [&](VisitGraph::Visit v) {
    const auto piece_start = Clock::now();
    piece(v);
    seconds[v] = seconds_since(piece_start);
  });
  statistics_.critical_path_seconds -= seconds_since(start);
  if (pieces > 0) statistics_.critical_path_seconds += *std::max_element(seconds.begin(), seconds.end());
}

/// BUF of the leaves that are to be visited, where a split has changed it.
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

/// What the cells to come need, a little less, lest it be for nothing: a visit that waits for the kernel makes others wait.
template <int D>
void Generations<D>::touch_memory(std::span<const VisitRequest> requests) {
  std::uint64_t made = 0, replaced = 0;
  for (const VisitRequest& r : requests) {
    if (r.order != 1) continue;
    made += works_[r.leaf].list.to_come();
    replaced += works_[r.leaf].list.poor();
  }
  constexpr std::uint64_t cells_a_vertex = D == 3 ? 7 : 2;
  const std::uint64_t cells = made - std::min(made, made / 16 + replaced);
  const std::uint64_t vertices = std::min(cells / cells_a_vertex, context_.options.max_vertices - vertices_);
  const auto pages = context_.mesh.fresh_pages(cells_a_vertex * vertices, vertices);
  execute_pieces(pages.size(), [&](VisitGraph::Visit v) {
    if (!context_.ended()) touch_pages(pages[v]);
  });
}

/// Splits those that may, and their children as long as these may.
template <int D>
void Generations<D>::split_leaves(std::vector<Node> candidates) {
  while (!candidates.empty()) {
    std::vector<Node> parents;
    for (const Node leaf : candidates)
      if (Base::wants_split(leaf) && tree_.split(leaf) != Orthtree<D>::none) parents.push_back(leaf);
    works_.grow();
    execute_pieces(parents.size(), [&](VisitGraph::Visit v) { works_.hand_down(context_.mesh, parents[v], generation_); });
    candidates.clear();
    for (const Node parent : parents)
      for (Node child = 0; child < Orthtree<D>::children; ++child) candidates.push_back(tree_.first_child(parent) + child);
  }
}

template <int D>
void Generations<D>::execute(const VisitGraph& graph, const VisitBody& body) {
  if (graph.visits() == 0) return;
  VisitRun run;
  if (graph.visits() == 1 || options_.executor == Executor::serial) {
    run = run_serial(graph, body);
  } else if (options_.executor == Executor::shuffled) {
    run = run_shuffled(graph, body, random_);
  } else if (options_.executor == Executor::threads) {
    Base::threads_are_new();
    run = run_threads(graph, body, static_cast<unsigned>(std::max(options_.threads, 1)));
  } else {
    in_arena(options_.threads, [&] { run = run_flow_graph(graph, body); });
  }
  if (!run.complete()) context_.stop = static_cast<int>(StopCause::cancelled);
  statistics_.max_concurrent = std::max(statistics_.max_concurrent, run.max_concurrent);
}

template class Generations<2>;
template class Generations<3>;

}  // namespace pgdr::detail
