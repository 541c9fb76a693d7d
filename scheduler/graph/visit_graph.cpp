// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "graph/visit_graph.hpp"

#include <algorithm>
#include <condition_variable>
#include <mutex>
#include <queue>
#include <thread>

#include "graph/visit_log.hpp"

namespace pgdr {

auto VisitGraph::add_visit(std::span<const Visit> predecessors) -> Visit {
  const Visit v = visits();
  for (const Visit p : predecessors)
    if (p >= v) throw ResourceError({Errc::internal, "a visit can wait for earlier ones only", {}, 0, {}, {}});
  predecessors_.insert(predecessors_.end(), predecessors.begin(), predecessors.end());
  first_.push_back(predecessors_.size());
  return v;
}

VisitRun run_serial(const VisitGraph& graph, const VisitBody& body) {
  for (VisitGraph::Visit v = 0; v < graph.visits(); ++v) body(v);
  return {graph.visits(), graph.visits(), graph.visits() > 0 ? 1u : 0u};
}

namespace {

/// How many visits each visit waits for.
class Predecessors {
 public:
  /// Calls `ready` with each visit that waits for none.
  template <class Ready>
  Predecessors(const VisitGraph& graph, Ready ready) : waiting_for_(graph.visits()), successors_(graph.visits()) {
    for (VisitGraph::Visit v = 0; v < graph.visits(); ++v) {
      waiting_for_[v] = graph.predecessors(v).size();
      for (const VisitGraph::Visit p : graph.predecessors(v)) successors_[p].push_back(v);
      if (waiting_for_[v] == 0) ready(v);
    }
  }
  /// Calls `ready` with each visit that has waited for v alone in the end.
  template <class Ready>
  void done(VisitGraph::Visit v, Ready ready) {
    for (const VisitGraph::Visit s : successors_[v])
      if (--waiting_for_[s] == 0) ready(s);
  }

 private:
  std::vector<std::size_t> waiting_for_;
  std::vector<std::vector<VisitGraph::Visit>> successors_;
};

/// What the threads of `run_threads` share, under its mutex.
class ReadyList {
 public:
  explicit ReadyList(const VisitGraph& graph)
      : predecessors_(graph, [this](VisitGraph::Visit v) { ready_.push(v); }), left_(graph.visits()) {}

  /// Waits for a visit that may run. @returns false when none will come
  bool take(VisitGraph::Visit& v) {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return !ready_.empty() || left_ == 0 || stopped_; });
    if (ready_.empty() || stopped_) return false;
    v = ready_.top();
    ready_.pop();
    return true;
  }
  void done(VisitGraph::Visit v, bool stop) {
    std::lock_guard lock(mutex_);
    --left_;
    stopped_ = stopped_ || stop;
    predecessors_.done(v, [this](VisitGraph::Visit s) { ready_.push(s); });
    changed_.notify_all();
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  std::priority_queue<VisitGraph::Visit, std::vector<VisitGraph::Visit>, std::greater<>> ready_;
  Predecessors predecessors_;
  std::size_t left_;
  bool stopped_ = false;
};

}  // namespace

VisitRun run_shuffled(const VisitGraph& graph, const VisitBody& body, std::mt19937_64& random) {
  std::vector<VisitGraph::Visit> ready;
  const auto add = [&ready](VisitGraph::Visit v) { ready.push_back(v); };
  Predecessors predecessors(graph, add);
  while (!ready.empty()) {
    std::swap(ready[random() % ready.size()], ready.back());
    const VisitGraph::Visit v = ready.back();
    ready.pop_back();
    body(v);
    predecessors.done(v, add);
  }
  return {graph.visits(), graph.visits(), graph.visits() > 0 ? 1u : 0u};
}

VisitRun run_threads(const VisitGraph& graph, const VisitBody& body, unsigned threads) {
  ReadyList list(graph);
  VisitLog log(graph.visits());
  const auto work = [&] {
    VisitGraph::Visit v = 0;
    while (list.take(v)) {
      log.run(body, v);
      list.done(v, log.stopped());
    }
  };
  {
    std::vector<std::jthread> others;
    for (unsigned i = 1; i < threads; ++i) others.emplace_back(work);
    work();
  }
  return log.finish();
}

double critical_path(const VisitGraph& graph, std::span<const double> seconds) {
  std::vector<double> end(graph.visits(), 0.0);
  double longest = 0;
  for (VisitGraph::Visit v = 0; v < graph.visits(); ++v) {
    for (const VisitGraph::Visit p : graph.predecessors(v)) end[v] = std::max(end[v], end[p]);
    end[v] += seconds[v];
    longest = std::max(longest, end[v]);
  }
  return longest;
}

}  // namespace pgdr
