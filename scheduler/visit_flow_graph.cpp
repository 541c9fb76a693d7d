// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The one place where visits become nodes of a oneTBB flow graph.
#include <tbb/flow_graph.h>
#include <tbb/task_arena.h>

#include <deque>

#include "detail/visit_log.hpp"
#include "pgdr/visit_graph.hpp"

namespace pgdr {

VisitRun run_flow_graph(const VisitGraph& graph, const VisitBody& body) {
  using Node = tbb::flow::continue_node<tbb::flow::continue_msg>;
  VisitLog log(graph.visits());
  tbb::this_task_arena::isolate([&] {
    tbb::flow::graph flow;  // attaches itself to the arena of the thread that makes it
    std::deque<Node> nodes;
    for (VisitGraph::Visit v = 0; v < graph.visits(); ++v) {
      // Exceptions stay in the log: cancelling the flow graph would lose the rule which of several comes out.
      nodes.emplace_back(flow, [&log, &body, v](const tbb::flow::continue_msg&) {
        // Isolated: a body that waits for parallel work of its own must not pick up another visit meanwhile.
        tbb::this_task_arena::isolate([&] { log.run(body, v); });
      });
      for (const VisitGraph::Visit p : graph.predecessors(v)) tbb::flow::make_edge(nodes[p], nodes[v]);
    }
    // An edge made after its predecessor ran would be dead, silently: all edges exist before the first message.
    for (VisitGraph::Visit v = 0; v < graph.visits(); ++v)
      if (graph.predecessors(v).empty()) nodes[v].try_put(tbb::flow::continue_msg());
    flow.wait_for_all();
  });
  return log.finish();
}

}  // namespace pgdr
