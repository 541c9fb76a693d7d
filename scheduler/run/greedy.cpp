// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "run/greedy.hpp"

#include <tbb/task_arena.h>
#include <tbb/task_group.h>

#include <algorithm>
#include <exception>
#include <functional>
#include <thread>

#include "claims/claimed_area.hpp"
#include "graph/arena.hpp"

namespace pgdr::detail {
namespace {

/// A claim as the boxes that it had when it was made: the tree may be split meanwhile.
template <int D>
class CopiedArea final : public VisitArea<D> {
 public:
  CopiedArea(const Orthtree<D>& tree, const Claim<D>& claim) {
    const ClaimedArea<D> area(tree, claim);
    static_cast<VisitArea<D>&>(*this) = area;
    whole_ = claim.whole();
    for (const std::uint32_t leaf : claim.leaves()) boxes_.push_back(ClaimedArea<D>::unbounded_box(tree, leaf));
  }
  bool claimed(const Point<D>& p) const override {
    return whole_ || std::any_of(boxes_.begin(), boxes_.end(), [&p](const auto& box) { return box.contains(p); });
  }
  /// Found out when the visit has ended.
  std::uint32_t leaf_of(const Point<D>&) const override { return 0; }

 private:
  bool whole_ = false;
  std::vector<typename Orthtree<D>::Box> boxes_;
};

}  // namespace

template <int D>
struct Greedy<D>::Running {
  VisitRequest request;
  RegionVisit<D> work;
  std::unique_ptr<CopiedArea<D>> area;
  std::vector<Node> leaves;  ///< claimed
};

template <int D>
Greedy<D>::Greedy(RunState<D>& state, int threads)
    : state_(&state),
      context_(&state.context),
      waiting_(&state.waiting),
      tree_(&state.waiting.tree()),
      conflicts_(*tree_, state.options.claim_order),
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
  const int level = request.order == whole_tree ? Orthtree<D>::max_level + 1 : tree_->level(request.leaf);
  if (pooled_.insert({request.leaf, request.order}).second) pool_.try_emplace({level, arrivals_++, request.order, request.leaf});
}

/// Could the visit run now? Asked of the whole pool whenever a visit ends: leaves are looked up once, and again only when
/// some of them were split.
template <int D>
bool Greedy<D>::is_free(const VisitRequest& r, Wanted& wanted) {
  if (r.order == whole_tree) return running_ == 0 && pool_.size() == 1;
  if (claimed_[r.leaf]) return false;
  if (wanted.tree_nodes != tree_->node_count()) {
    const auto was_split = [this](Node leaf) { return !tree_->is_leaf(leaf); };
    if (wanted.tree_nodes == 0 || std::any_of(wanted.claim.begin(), wanted.claim.end(), was_split)) {
      wanted.claim = conflicts_.visit_of(r).leaves;
      wanted.held = Orthtree<D>::none;
    }
    wanted.tree_nodes = tree_->node_count();
  }
  if (wanted.held != Orthtree<D>::none && claimed_[wanted.held]) return false;
  const auto held = std::find_if(wanted.claim.begin(), wanted.claim.end(), [this](Node leaf) { return claimed_[leaf] != 0; });
  if (held == wanted.claim.end()) return true;
  wanted.held = *held;
  return false;
}

template <int D>
void Greedy<D>::claim(Running& visit) {
  const Claim<D> claim = conflicts_.visit_of(visit.request).claim(*tree_);
  visit.leaves = claim.leaves();
  for (const Node leaf : visit.leaves) claimed_[leaf] = 1;
  visit.area = std::make_unique<CopiedArea<D>>(*tree_, claim);
}

/// The first in the pool that can run now; null if none can.
template <int D>
auto Greedy<D>::pick() -> std::unique_ptr<Running> {
  const std::uint64_t most = context_->options.max_vertices;
  const std::uint64_t left = most - std::min(most, state_->totals.vertices + reserved_);
  if (running_ >= threads_ || context_->stop != 0 || (left == 0 && !context_->stage)) return nullptr;
  claimed_.resize(tree_->node_count(), 0);
  for (auto next = pool_.begin(); next != pool_.end(); ++next) {
    const VisitRequest request{std::get<3>(next->first), std::get<2>(next->first), 0};
    if (!is_free(request, next->second)) continue;
    pool_.erase(next);
    pooled_.erase({request.leaf, request.order});
    return begin(request, left);
  }
  return nullptr;
}

/// Claims what the visit needs, and gives it its work and its share of the vertices that are left.
template <int D>
auto Greedy<D>::begin(const VisitRequest& request, std::uint64_t vertices_left) -> std::unique_ptr<Running> {
  auto visit = std::make_unique<Running>();
  visit->request = request;
  claim(*visit);
  state_->prepare(request, visit->work);
  if (request.order == 1) (*waiting_)[request.leaf].open_inbox();
  visit->work.most_insertions = std::min(vertices_left,
                                         std::max<std::uint64_t>(vertices_left / static_cast<std::uint64_t>(threads_), 1));
  reserved_ += visit->work.most_insertions;
  ++running_;
  state_->recorder.count_concurrent(static_cast<std::uint32_t>(running_));
  return visit;
}

/// Posts elements to the leaves that they belong to, which are looked up now that the visit has ended and still owns their cells.
template <int D>
void Greedy<D>::hand_over(Running& visit) {
  for (auto& box : visit.work.outboxes) {
    std::vector<std::pair<Node, std::vector<Entry<D>>>> letters;
    for (const Entry<D>& e : box.entries) {
      if (!e.alive(context_->mesh)) continue;
      const Node leaf = tree_->leaf_at(context_->place_of(e.cell));
      auto batch = std::find_if(letters.rbegin(), letters.rend(), [leaf](const auto& l) { return l.first == leaf; });
      if (batch == letters.rend()) {
        letters.push_back({leaf, {e}});
      } else {
        batch->second.push_back(e);
      }
    }
    for (auto& [leaf, entries] : letters) {
      waiting_->post(leaf, std::move(entries));
      if (leaf != visit.request.leaf) pool(leaf);
    }
  }
}

template <int D>
void Greedy<D>::split(Node leaf) {
  std::vector<Node> candidates{leaf};
  while (!candidates.empty()) {
    const Node parent = candidates.back();
    candidates.pop_back();
    if (!waiting_->split_if_crowded(parent)) {
      pool(parent);
      continue;
    }
    waiting_->hand_down(parent);
    std::erase_if(pool_,
                  [parent](const auto& w) { return std::get<3>(w.first) == parent && std::get<2>(w.first) != whole_tree; });
    std::erase_if(pooled_, [parent](const auto& p) { return p.first == parent && p.second != whole_tree; });
    for (Node child = 0; child < Orthtree<D>::children; ++child) candidates.push_back(tree_->first_child(parent) + child);
  }
}

template <int D>
void Greedy<D>::end(Running& visit) {
  reserved_ -= std::min(reserved_, visit.work.most_insertions);
  state_->refused.mark_changed(visit.work, visit.leaves);
  state_->account(visit.request, visit.work, visit.leaves);
  hand_over(visit);
  for (const Node leaf : visit.leaves) claimed_[leaf] = 0;
  --running_;
  if (visit.request.order == 1) {
    split(visit.request.leaf);
  } else if (visit.request.order != whole_tree) {
    pool(visit.request.leaf);
  }
  const auto of_whole_tree = [](const auto& w) { return std::get<2>(w.first) == whole_tree; };
  if (std::none_of(pool_.begin(), pool_.end(), of_whole_tree))
    if (const auto request = waiting_->whole_tree_request()) pool(*request);
  ended_.notify_all();
}

template <int D>
void Greedy<D>::run_visit(Running& visit) {
  const VisitRecorder::Watch watch;
  if (state_->workers.run(*visit.area, visit.work)) state_->recorder.record(visit.request, visit.work, watch);
}

template <int D>
void Greedy<D>::run_on_threads() {
  std::exception_ptr error;
  auto work = [&] {
    std::unique_lock lock(mutex_);
    while (!done() && !error) {
      auto visit = pick();
      if (!visit) {
        if (running_ == 0) return;
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
  for (const VisitRequest& r : waiting_->requests()) pool(r);
  if (state_->options.executor == Executor::flow_graph) {
    run_in_arena();
  } else {
    run_on_threads();
  }
  const double seconds = VisitRecorder::seconds_since(start);
  state_->recorder.add_generation(seconds, seconds);
  if (state_->stop() != StopCause::finished) return state_->stop();
  const bool spent = state_->totals.vertices >= context_->options.max_vertices;
  return spent && !pool_.empty() ? StopCause::max_vertices : StopCause::finished;
}

template class Greedy<2>;
template class Greedy<3>;

}  // namespace pgdr::detail
