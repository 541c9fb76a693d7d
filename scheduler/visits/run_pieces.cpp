// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "visits/run_pieces.hpp"

#include <algorithm>
#include <numeric>
#include <random>
#include <thread>

#include "graph/arena.hpp"
#include "graph/float_environment.hpp"
#include "graph/visit_graph.hpp"

namespace pgdr::detail {
namespace {

/// Runs visits that do not wait for each other.
void run_all(const VisitGraph& independent, const ScheduleOptions& options, const VisitBody& body) {
  if (independent.visits() == 1) return body(0);
  switch (options.executor) {
    case Executor::flow_graph: in_arena_to_the_end(options.threads, [&] { run_flow_graph(independent, body); }); break;
    case Executor::threads: run_threads(independent, body, static_cast<unsigned>(threads_of(options))); break;
    case Executor::serial: run_serial(independent, body); break;
    case Executor::shuffled: {
      std::mt19937_64 random(static_cast<std::uint64_t>(options.threads));
      run_shuffled(independent, body, random);
      break;
    }
  }
}

}  // namespace

int threads_of(const ScheduleOptions& options) {
  switch (options.executor) {
    case Executor::flow_graph: return arena_threads(options.threads);
    case Executor::threads: return std::max(options.threads, 1);
    case Executor::serial:
    case Executor::shuffled: break;
  }
  return 1;
}

void RunPieces::run(std::size_t count, const std::function<void(std::size_t)>& piece) const {
  if (count == 0) return;
  const double start = clock_->now();
  VisitGraph independent;
  for (std::size_t i = 0; i < count; ++i) independent.add_visit();
  std::vector<double> seconds(count, 0.0);
  const auto caller = std::this_thread::get_id();
  run_all(independent, *options_, [&](VisitGraph::Visit v) {
    const DefaultFloats floats;
    const double piece_start = clock_->now();
    const PredicateCounts before = predicate_counts();
    piece(v);
    seconds[v] = clock_->now() - piece_start;
    if (std::this_thread::get_id() == caller) return;
    const std::lock_guard lock(mutex_);
    predicates_elsewhere_ += predicate_counts() - before;
  });
  const double work = std::accumulate(seconds.begin(), seconds.end(), 0.0);
  clock_->add_section(clock_->now() - start, work, *std::max_element(seconds.begin(), seconds.end()), is_parallel());
}

}  // namespace pgdr::detail
