// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "plans/greedy.hpp"

#include <tbb/task_arena.h>
#include <tbb/task_group.h>

#include <algorithm>
#include <exception>
#include <functional>
#include <numeric>
#include <thread>

#include "claims/claimed_area.hpp"
#include "graph/arena.hpp"

namespace pgdr::detail {
namespace {

/// A claim as the boxes that it had when it was made: the tree may be split meanwhile.
template <int D>
class CopiedArea final : public VisitArea<D> {
 public:
  CopiedArea(const Placement<D>& placement, const Visit<D>& visit) {
    const Claim<D> claim = visit.claim(placement.tree());
    const ClaimedArea<D> area(placement, claim);
    static_cast<VisitArea<D>&>(*this) = area;
    whole_ = claim.whole();
    for (const std::uint32_t leaf : visit.leaves) boxes_.push_back(ClaimedArea<D>::unbounded_box(placement.tree(), leaf));
  }
  bool claimed(const Point<D>& p) const override {
    return whole_ || std::any_of(boxes_.begin(), boxes_.end(), [&p](const auto& box) { return box.contains(p); });
  }
  /// Found out when the visit has ended.
  std::uint32_t node_of(const Point<D>&, double) const override { return 0; }

 private:
  bool whole_ = false;
  std::vector<typename Orthtree<D>::Box> boxes_;  ///< beyond the inner one
};

}  // namespace

template <int D>
struct Greedy<D>::Running {
  Running(const Placement<D>& placement, Visit<D> v) : visit(std::move(v)), area(placement, visit) {}

  Visit<D> visit;
  NodeVisit<D> work;
  CopiedArea<D> area;
};

template <int D>
Greedy<D>::Greedy(RunState<D>& state, int threads)
    : state_(&state),
      context_(&state.context),
      waiting_(&state.waiting),
      tree_(&state.waiting.tree()),
      conflicts_(*tree_, state.options.claims, state.options.claim_order),
      threads_(threads) {}

/// Puts the leaf's work, of every order, into the pool.
template <int D>
void Greedy<D>::pool(Node leaf) {
  std::vector<VisitRequest> requests;
  waiting_->append_requests(leaf, requests);
  for (const VisitRequest& r : requests) pool(r);
}

/// What is in the pool already keeps its place. The whole tree comes last.
template <int D>
void Greedy<D>::pool(const VisitRequest& request) {
  const int level = request.order == whole_tree ? Orthtree<D>::max_level + 1 : tree_->level(request.node);
  if (pooled_.insert({request.node, request.order}).second) pool_.try_emplace({level, arrivals_++, request.order, request.node});
}

/// Could the visit run now? Asked of the whole pool whenever a visit ends: what it claims is found out once, and again only when
/// a leaf of that was split.
template <int D>
bool Greedy<D>::is_free(const VisitRequest& r, Wanted& wanted) {
  if (r.order == whole_tree) return running_.empty() && pool_.size() == 1;
  if (wanted.tree_nodes != tree_->node_count()) {
    const auto was_split = [this](Node leaf) { return !tree_->is_leaf(leaf); };
    if (wanted.tree_nodes == 0 || std::any_of(wanted.visit.leaves.begin(), wanted.visit.leaves.end(), was_split))
      wanted.visit = conflicts_.visit_of(r);
    wanted.tree_nodes = tree_->node_count();
  }
  return std::none_of(running_.begin(), running_.end(), [&](const Running* other) { return meet(wanted.visit, other->visit); });
}

/// The first in the pool that can run now; null if none can.
template <int D>
auto Greedy<D>::pick() -> std::unique_ptr<Running> {
  const std::uint64_t most = context_->options.max_vertices;
  const std::uint64_t left = most - std::min(most, state_->totals.vertices + reserved_);
  if (static_cast<int>(running_.size()) >= threads_ || context_->stop != 0 || (left == 0 && !context_->stage)) return nullptr;
  for (auto next = pool_.begin(); next != pool_.end(); ++next) {
    const VisitRequest request{std::get<3>(next->first), std::get<2>(next->first), 0};
    if (!is_free(request, next->second)) continue;
    pool_.erase(next);
    pooled_.erase({request.node, request.order});
    return begin(request, left);
  }
  return nullptr;
}

/// Claims what the visit needs, and gives it its work and its share of the vertices that are left.
template <int D>
auto Greedy<D>::begin(const VisitRequest& request, std::uint64_t vertices_left) -> std::unique_ptr<Running> {
  auto visit = std::make_unique<Running>(waiting_->placement(), conflicts_.visit_of(request));
  state_->prepare(request, visit->work);
  if (request.order == 1) (*waiting_)[request.node].open_inbox([this] { return context_->ended(); });
  visit->work.most_insertions = std::min(vertices_left,
                                         std::max<std::uint64_t>(vertices_left / static_cast<std::uint64_t>(threads_), 1));
  reserved_ += visit->work.most_insertions;
  running_.push_back(visit.get());
  state_->recorder.count_concurrent(static_cast<std::uint32_t>(running_.size()));
  return visit;
}

/// Posts elements to the nodes that they belong to, which are looked up now that the visit has ended and still owns their cells.
template <int D>
void Greedy<D>::hand_over(Running& visit) {
  for (auto& box : visit.work.outboxes) {
    std::vector<std::pair<Node, std::vector<Entry<D>>>> letters;
    for (const Entry<D>& e : box.entries) {
      if (!e.alive(context_->mesh)) continue;
      const Node node = waiting_->node_of(e);
      auto batch = std::find_if(letters.rbegin(), letters.rend(), [node](const auto& l) { return l.first == node; });
      if (batch == letters.rend()) {
        letters.push_back({node, {e}});
      } else {
        batch->second.push_back(e);
      }
    }
    for (auto& [node, entries] : letters) {
      waiting_->post(node, std::move(entries));
      if (node != visit.visit.request.node) pool(node);
    }
  }
}

template <int D>
void Greedy<D>::split(Node leaf) {
  std::vector<Node> candidates{leaf};
  while (!candidates.empty()) {
    const Node parent = candidates.back();
    candidates.pop_back();
    if (context_->ended() || !waiting_->split_if_crowded(parent)) {
      pool(parent);
      continue;
    }
    waiting_->hand_down(parent);
    std::erase_if(pool_,
                  [parent](const auto& w) { return std::get<3>(w.first) == parent && std::get<2>(w.first) != whole_tree; });
    std::erase_if(pooled_, [parent](const auto& p) { return p.first == parent && p.second != whole_tree; });
    pool(parent);  // for what is too large for the children
    for (Node child = 0; child < Orthtree<D>::children; ++child) candidates.push_back(tree_->first_child(parent) + child);
  }
}

template <int D>
void Greedy<D>::end(Running& visit) {
  const VisitRequest& request = visit.visit.request;
  reserved_ -= std::min(reserved_, visit.work.most_insertions);
  state_->account(request, visit.work);
  hand_over(visit);
  std::erase(running_, &visit);
  if (request.order == 1) split(request.node);
  for (Node node = request.node;; node = tree_->parent(node)) {  // what was set aside is for one of these
    pool(node);
    if (node == Orthtree<D>::root) break;
  }
  ended_.notify_all();
}

template <int D>
void Greedy<D>::run_visit(Running& visit) {
  const VisitRecorder::Watch watch;
  if (state_->workers.run(visit.area, visit.work)) state_->recorder.record(visit.visit.request, visit.work, watch);
}

template <int D>
void Greedy<D>::run_on_threads() {
  std::exception_ptr error;
  auto work = [&] {
    std::unique_lock lock(mutex_);
    while (!done() && !error) {
      auto visit = pick();
      if (!visit) {
        if (running_.empty()) return;
        ended_.wait(lock);
        continue;
      }
      lock.unlock();
      std::exception_ptr thrown;
      try {
        run_visit(*visit);
      } catch (...) {
        thrown = std::current_exception();
      }
      lock.lock();
      if (thrown && !error) error = thrown;
      end(*visit);
    }
    ended_.notify_all();
  };
  state_->recorder.threads_are_new();
  std::vector<std::thread> threads;
  for (int i = 1; i < threads_; ++i) threads.emplace_back(work);
  work();
  for (std::thread& t : threads) t.join();
  if (error) std::rethrow_exception(error);
}

template <int D>
void Greedy<D>::run_in_arena() {
  in_arena(state_->options.threads, [this] {
    tbb::task_group group;
    std::function<void()> start_ready = [&] {
      const std::lock_guard lock(mutex_);
      while (std::shared_ptr<Running> visit = pick())
        group.run([this, visit, &start_ready] {
          try {
            // Isolated: a callback that waits for parallel work of its own must not pick up another visit meanwhile.
            tbb::this_task_arena::isolate([&] { run_visit(*visit); });
          } catch (...) {
            context_->stop = static_cast<int>(StopCause::cancelled);
            const std::lock_guard end_lock(mutex_);
            end(*visit);
            throw;
          }
          {
            const std::lock_guard end_lock(mutex_);
            end(*visit);
          }
          start_ready();
        });
    };
    tbb::this_task_arena::isolate([&] {
      start_ready();
      group.wait();
    });
  });
}

template <int D>
StopCause Greedy<D>::drain() {
  waiting_->set_all_listed(false);  // the work of a visit is lost if somebody cancels the caller's tasks
  waiting_->begin_generation();
  state_->recorder.count_generation();
  const auto start = VisitRecorder::Clock::now();
  const std::vector<double>& busy_so_far = state_->recorder.statistics().busy_seconds;
  const double busy_before = std::accumulate(busy_so_far.begin(), busy_so_far.end(), 0.0);
  for (const VisitRequest& r : waiting_->requests()) pool(r);
  if (state_->options.executor == Executor::flow_graph) {
    run_in_arena();
  } else {
    run_on_threads();
  }
  const double seconds = VisitRecorder::seconds_since(start);
  const std::vector<double>& busy = state_->recorder.statistics().busy_seconds;
  const double work = std::accumulate(busy.begin(), busy.end(), 0.0) - busy_before;
  state_->recorder.add_generation(seconds);
  state_->pieces.clock().add_section(seconds, work, seconds, true);  // what waited for what is not recorded
  if (state_->stop() != StopCause::finished) return state_->stop();
  const bool spent = state_->totals.vertices >= context_->options.max_vertices;
  return spent && !pool_.empty() ? StopCause::max_vertices : StopCause::finished;
}

template class Greedy<2>;
template class Greedy<3>;

}  // namespace pgdr::detail
