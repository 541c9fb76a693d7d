// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The one place where visits become nodes of a oneTBB flow graph:
//
//      start[u]  - - task: the body of u - ->  end[u] ----> start[v]  - - task: the body of v - ->  end[v]
//                                                 \--> start[w] ...
//
// start[v] is a continue_node that counts the predecessors of v as they end, and then hands the visit to a task group;
// end[v] tells those that wait for v. The graph's own tasks and wait cannot be used: wait_for_all goes through
// task_arena::execute, which drops the isolation of the thread that waits (oneTBB 2021.8), so that it would start tasks
// of the caller, or visits of an outer graph, on top of what the caller is doing. A task group keeps the isolation.
#include <tbb/flow_graph.h>
#include <tbb/task_arena.h>
#include <tbb/task_group.h>

#include <deque>

#include "graph/visit_graph.hpp"
#include "graph/visit_log.hpp"

namespace pgdr {

namespace {

class FlowVisits {
 public:
  using Message = tbb::flow::continue_msg;
  using Start = tbb::flow::continue_node<Message, tbb::flow::lightweight>;
  using End = tbb::flow::broadcast_node<Message>;

  FlowVisits(const VisitGraph& graph, const VisitBody& body) : graph_(graph), body_(body), log_(graph.visits()) {
    for (VisitGraph::Visit v = 0; v < graph.visits(); ++v) {
      // Lightweight and noexcept: called by the thread that ends the last predecessor, without a task of the graph's own.
      starts_.emplace_back(flow_, [this, v](const Message&) noexcept { start(v); });
      ends_.emplace_back(flow_);
      for (const VisitGraph::Visit p : graph.predecessors(v)) tbb::flow::make_edge(ends_[p], starts_[v]);
    }
  }

  VisitRun run() {
    // An edge made after its predecessor ran would be dead, silently: all edges exist before the first message.
    for (VisitGraph::Visit v = 0; v < graph_.visits(); ++v)
      if (graph_.predecessors(v).empty()) starts_[v].try_put(Message());
    group_.wait();
    return log_.finish();
  }

 private:
  void start(VisitGraph::Visit v) noexcept {
    if (log_.stopped()) return;
    try {
      group_.run([this, v] {
        // Isolated: a body that waits for parallel work of its own must not pick up another visit meanwhile.
        tbb::this_task_arena::isolate([&] { log_.run(body_, v); });
        ends_[v].try_put(Message());
      });
    } catch (...) {  // no memory for the task
      log_.fail(v);
    }
  }

  const VisitGraph& graph_;
  const VisitBody& body_;
  VisitLog log_;
  tbb::flow::graph flow_;
  std::deque<Start> starts_;
  std::deque<End> ends_;
  tbb::task_group group_;
};

}  // namespace

VisitRun run_flow_graph(const VisitGraph& graph, const VisitBody& body) {
  return tbb::this_task_arena::isolate([&] { return FlowVisits(graph, body).run(); });
}

}  // namespace pgdr
