// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The executors of a visit graph: every visit once, after its predecessors, with the exceptions of its bodies.
#include "graph/visit_graph.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <mutex>
#include <numeric>
#include <random>
#include <set>
#include <stdexcept>
#include <string>
#include <thread>

#include "allow_threads.hpp"
#include "pgdr/error.hpp"

#if PGDR_TEST_TBB
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>
#include <tbb/task_group.h>
#endif

namespace pgdr::test_graph_visits {

using namespace std::chrono_literals;

constexpr std::uint64_t seed = 20270303;
constexpr unsigned eight = 8;

VisitGraph random_graph(std::uint32_t visits, std::uint32_t most_predecessors, std::uint32_t reach, std::uint64_t s) {
  std::mt19937_64 random(s);
  VisitGraph graph;
  for (std::uint32_t v = 0; v < visits; ++v) {
    std::set<std::uint32_t> before;
    if (v > 0)
      for (std::uint64_t k = random() % (most_predecessors + 1); k > 0; --k)
        before.insert(v - 1 - static_cast<std::uint32_t>(random() % std::min(v, reach)));
    graph.add_visit(std::vector<std::uint32_t>(before.begin(), before.end()));
  }
  return graph;
}

/// A body whose plain writes are ordered by the graph alone; each value depends on those of the predecessors.
struct Recorder {
  explicit Recorder(const VisitGraph& g) : graph(g), value(g.visits(), 0), times(g.visits(), 0) {}
  void operator()(std::uint32_t v) {
    std::uint64_t h = v + 1;
    for (const auto p : graph.predecessors(v)) {
      if (times[p] != 1) early = true;
      h = h * 31 + value[p];
    }
    value[v] = h;
    ++times[v];
  }
  void expect_all_once() const {
    EXPECT_FALSE(early);
    for (const int t : times) ASSERT_EQ(t, 1);
  }
  const VisitGraph& graph;
  std::vector<std::uint64_t> value;
  std::vector<int> times;
  std::atomic<bool> early{false};
};

struct Executor {
  std::string name;
  std::function<VisitRun(const VisitGraph&, const VisitBody&)> run;
};

#if PGDR_TEST_TBB
/// TBB with eight threads, on any machine.
VisitRun flow_on_eight(const VisitGraph& graph, const VisitBody& body) {
  const test::AllowThreads allow(eight);
  tbb::task_arena arena(eight);
  VisitRun run;
  arena.execute([&] { run = run_flow_graph(graph, body); });
  return run;
}
#endif

std::vector<Executor> executors() {
  std::vector<Executor> all{{"serial", run_serial},
                            {"shuffled",
                             [](const VisitGraph& g, const VisitBody& b) {
                               std::mt19937_64 random(seed);
                               return run_shuffled(g, b, random);
                             }},
                            {"one thread", [](const VisitGraph& g, const VisitBody& b) { return run_threads(g, b, 1); }},
                            {"threads", [](const VisitGraph& g, const VisitBody& b) { return run_threads(g, b, eight); }}};
#if PGDR_TEST_TBB
  all.push_back({"flow graph", flow_on_eight});
  all.push_back({"flow graph on one thread", [](const VisitGraph& g, const VisitBody& b) {
                   tbb::task_arena arena(1);
                   VisitRun run;
                   arena.execute([&] { run = run_flow_graph(g, b); });
                   return run;
                 }});
#endif
  return all;
}

TEST(VisitGraphTest, HoldsEdgesFromLowerToHigher) {
  VisitGraph graph;
  EXPECT_EQ(graph.visits(), 0u);
  EXPECT_EQ(graph.add_visit(), 0u);
  EXPECT_EQ(graph.add_visit(), 1u);
  const std::uint32_t both[] = {0, 1};
  EXPECT_EQ(graph.add_visit(both), 2u);
  EXPECT_EQ(graph.edges(), 2u);
  EXPECT_TRUE(graph.predecessors(1).empty());
  EXPECT_EQ(graph.predecessors(2).size(), 2u);
  const std::uint32_t itself[] = {3};
  EXPECT_THROW(graph.add_visit(itself), ResourceError);
  EXPECT_EQ(graph.visits(), 3u);
}

TEST(VisitGraphTest, CriticalPathIsTheLongestChain) {
  VisitGraph graph;
  const std::uint32_t p0[] = {0}, p12[] = {1, 2};
  graph.add_visit();
  graph.add_visit(p0);
  graph.add_visit(p0);
  graph.add_visit(p12);
  graph.add_visit();
  EXPECT_EQ(critical_path(graph, std::vector<double>{1, 2, 4, 8, 3}), 13.0);
  EXPECT_EQ(critical_path(graph, std::vector<double>{1, 2, 4, 8, 30}), 30.0);
  EXPECT_EQ(critical_path(VisitGraph(), {}), 0.0);
}

TEST(VisitGraphTest, EveryVisitOnceAfterItsPredecessors) {
  for (const auto& executor : executors())
    for (std::uint64_t round = 0; round < 4; ++round) {
      SCOPED_TRACE(executor.name);
      const auto most = 1 + 3 * static_cast<std::uint32_t>(round);
      const VisitGraph graph = random_graph(3000, most, round == 0 ? 3000 : 60, seed + round);
      Recorder expected(graph), recorder(graph);
      run_serial(graph, std::ref(expected));
      const VisitRun run = executor.run(graph, std::ref(recorder));
      recorder.expect_all_once();
      EXPECT_EQ(recorder.value, expected.value);
      EXPECT_TRUE(run.complete());
      EXPECT_EQ(run.visits_planned, 3000u);
      EXPECT_EQ(run.visits_run, 3000u);
      EXPECT_GE(run.max_concurrent, 1u);
      EXPECT_LE(run.max_concurrent, eight);
    }
}

TEST(VisitGraphTest, NothingToDo) {
  for (const auto& executor : executors()) {
    const VisitRun run = executor.run(VisitGraph(), [](std::uint32_t) { FAIL(); });
    EXPECT_TRUE(run.complete());
    EXPECT_EQ(run.max_concurrent, 0u);
  }
}

TEST(VisitGraphTest, AChainRunsAlone) {
  for (const auto& executor : executors()) {
    const VisitGraph graph = [] {
      VisitGraph chain;
      chain.add_visit();
      for (std::uint32_t v = 1; v < 500; ++v) chain.add_visit(std::vector<std::uint32_t>{v - 1});
      return chain;
    }();
    std::vector<std::uint32_t> order;
    const VisitRun run = executor.run(graph, [&](std::uint32_t v) { order.push_back(v); });
    EXPECT_EQ(run.max_concurrent, 1u) << executor.name;
    ASSERT_EQ(order.size(), 500u);
    EXPECT_TRUE(std::is_sorted(order.begin(), order.end()));
  }
}

/// Waits until eight bodies are in it at once, or for a good while.
struct Rendezvous {
  void operator()(std::uint32_t) {
    if (++inside >= eight) met = true;
    const auto end = std::chrono::steady_clock::now() + 20s;
    while (!met && std::chrono::steady_clock::now() < end) std::this_thread::yield();
  }
  std::atomic<unsigned> inside{0};
  std::atomic<bool> met{false};
};

TEST(VisitGraphTest, EightRunAtOnce) {
  VisitGraph graph;
  for (unsigned v = 0; v < eight; ++v) graph.add_visit();
  Rendezvous threads;
  EXPECT_EQ(run_threads(graph, std::ref(threads), eight).max_concurrent, eight);
  EXPECT_TRUE(threads.met);
#if PGDR_TEST_TBB
  Rendezvous flow;
  EXPECT_EQ(flow_on_eight(graph, std::ref(flow)).max_concurrent, eight);
  EXPECT_TRUE(flow.met);
#endif
}

struct Fault : std::runtime_error {
  explicit Fault(std::uint32_t v) : std::runtime_error("visit " + std::to_string(v)), visit(v) {}
  std::uint32_t visit;
};

TEST(VisitGraphTest, ExceptionsComeOutAsTheyAre) {
  for (const auto& executor : executors()) {
    SCOPED_TRACE(executor.name);
    for (const std::uint32_t culprit : {0u, 700u, 1999u}) {
      const VisitGraph graph = random_graph(2000, 3, 50, seed + 10);
      std::atomic<std::uint32_t> running{0}, ran{0};
      std::atomic<bool> dependant_ran{false};
      std::vector<char> poisoned(graph.visits(), 0);  // the culprit and all that wait for it
      poisoned[culprit] = 1;
      for (std::uint32_t v = culprit + 1; v < graph.visits(); ++v)
        for (const auto p : graph.predecessors(v)) poisoned[v] = poisoned[v] || poisoned[p];
      try {
        executor.run(graph, [&](std::uint32_t v) {
          ++running;
          if (v == culprit) {
            --running;
            throw Fault(v);
          }
          if (poisoned[v]) dependant_ran = true;
          ++ran;
          --running;
        });
        ADD_FAILURE() << "no exception";
      } catch (const Fault& fault) {
        EXPECT_EQ(fault.visit, culprit);
      }
      EXPECT_EQ(running, 0u) << "all bodies have ended";
      EXPECT_LT(ran, 2000u);
      EXPECT_FALSE(dependant_ran);
    }
    // Usable again.
    const VisitGraph graph = random_graph(100, 3, 50, seed + 11);
    Recorder recorder(graph);
    executor.run(graph, std::ref(recorder));
    recorder.expect_all_once();
  }
}

TEST(VisitGraphTest, OfSeveralExceptionsTheOneOfTheLowestVisit) {
  VisitGraph graph;
  for (unsigned v = 0; v < eight; ++v) graph.add_visit();
  const auto throw_all_at_once = [&](const auto& executor) {
    Rendezvous rendezvous;
    EXPECT_THROW(
        {
          try {
            executor(graph, [&](std::uint32_t v) {
              rendezvous(v);
              throw Fault(v);
            });
          } catch (const Fault& fault) {
            EXPECT_EQ(fault.visit, 0u);
            throw;
          }
        },
        Fault);
  };
  throw_all_at_once([](const VisitGraph& g, const VisitBody& b) { return run_threads(g, b, eight); });
#if PGDR_TEST_TBB
  throw_all_at_once(flow_on_eight);
#endif
}

#if PGDR_TEST_TBB

thread_local int depth = 0;

/// Counts the visits that began on top of another one of the same thread.
struct Nesting {
  explicit Nesting(std::atomic<int>& nested) { nested += depth++ > 0; }
  ~Nesting() { --depth; }
};

void parallel_work(int n) {
  std::atomic<int> sum{0};
  tbb::parallel_for(0, n, [&](int i) {
    const auto end = std::chrono::steady_clock::now() + 1us;
    while (std::chrono::steady_clock::now() < end) std::this_thread::yield();
    sum += i;
  });
  ASSERT_EQ(sum, n * (n - 1) / 2);
}

TEST(VisitFlowGraphTest, ParallelWorkInABodyStartsNoOtherVisit) {
  const VisitGraph graph = random_graph(1500, 2, 200, seed + 20);
  std::atomic<int> nested{0};
  const VisitRun run = flow_on_eight(graph, [&](std::uint32_t) {
    const Nesting guard(nested);
    parallel_work(64);
  });
  EXPECT_TRUE(run.complete());
  EXPECT_EQ(nested, 0);
}

TEST(VisitFlowGraphTest, AGraphInABodyStartsNoVisitOfTheOuterOne) {
  const VisitGraph graph = random_graph(300, 2, 100, seed + 21), inner = random_graph(30, 1, 30, seed + 22);
  std::atomic<int> nested{0}, inner_runs{0};
  const VisitRun run = flow_on_eight(graph, [&](std::uint32_t) {
    const Nesting guard(nested);
    const auto inner_body = [&](std::uint32_t) {
      std::this_thread::sleep_for(5us);
      ++inner_runs;
    };
    EXPECT_TRUE(run_flow_graph(inner, inner_body).complete());
  });
  EXPECT_TRUE(run.complete());
  EXPECT_EQ(inner_runs, 300 * 30);
  EXPECT_EQ(nested, 0);
}

TEST(VisitFlowGraphTest, TheWaitRunsNoneOfTheCallersOtherTasks) {
  // A caller that holds something while it refines must not be handed its own other work by our wait.
  const test::AllowThreads allow(eight);
  tbb::task_arena arena(eight);
  std::atomic<int> stolen{0};
  arena.execute([&] {
    tbb::parallel_for(
        0, 64,
        [&](int i) {
          const Nesting guard(stolen);
          const VisitGraph graph = random_graph(40, 2, 20, seed + 30 + static_cast<std::uint64_t>(i));
          EXPECT_TRUE(run_flow_graph(graph, [](std::uint32_t) { std::this_thread::sleep_for(20us); }).complete());
        },
        tbb::simple_partitioner());
  });
  EXPECT_EQ(stolen, 0);
}

TEST(VisitFlowGraphTest, RunsInTheCallersArena) {
  const test::AllowThreads allow(eight);
  tbb::task_arena arena(3);
  const VisitGraph graph = random_graph(2000, 1, 2000, seed + 40);
  std::atomic<int> elsewhere{0};
  VisitRun run;
  arena.execute([&] {
    run = run_flow_graph(graph, [&](std::uint32_t) {
      elsewhere += tbb::this_task_arena::max_concurrency() != 3 || tbb::this_task_arena::current_thread_index() >= 3;
    });
  });
  EXPECT_TRUE(run.complete());
  EXPECT_LE(run.max_concurrent, 3u);
  EXPECT_EQ(elsewhere, 0);
}

TEST(VisitFlowGraphTest, SeveralGraphsAtOnce) {
  const test::AllowThreads allow(eight);
  std::vector<std::jthread> callers;
  for (std::uint64_t c = 0; c < 4; ++c)
    callers.emplace_back([c] {
      const VisitGraph graph = random_graph(1000, 3, 50, seed + 50 + c);
      Recorder recorder(graph);
      EXPECT_TRUE(run_flow_graph(graph, std::ref(recorder)).complete());
      recorder.expect_all_once();
    });
}

TEST(VisitFlowGraphTest, NoticesThatTheCallerWasCancelled) {
  const test::AllowThreads allow(2);
  VisitGraph chain;
  chain.add_visit();
  for (std::uint32_t v = 1; v < 200; ++v) chain.add_visit(std::vector<std::uint32_t>{v - 1});
  VisitRun run;
  std::uint32_t bodies = 0;
  tbb::task_group_context context;
  tbb::task_group group(context);
  group.run_and_wait([&] {
    run = run_flow_graph(chain, [&](std::uint32_t v) {
      ++bodies;
      if (v == 50) context.cancel_group_execution();
    });
  });
  EXPECT_EQ(run.visits_planned, 200u);
  EXPECT_EQ(run.visits_run, bodies);
  EXPECT_GE(run.visits_run, 51u);
  // Whether the cancellation reaches the graph is TBB's business; that the count tells is ours.
  EXPECT_EQ(run.complete(), bodies == 200);
  EXPECT_FALSE(run.complete());
}

#endif

}  // namespace pgdr::test_graph_visits
