// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "run/cell_parts.hpp"

#include <algorithm>
#include <chrono>
#include <vector>

#include "graph/arena.hpp"
#include "graph/float_environment.hpp"
#include "graph/visit_graph.hpp"
#include "mesh/slot_set.hpp"

namespace pgdr::detail {
namespace {

constexpr std::uint32_t cells_a_part = 1 << 15;
static_assert(cells_a_part % SlotSet::slots_a_word == 0);

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

std::uint32_t count_parts(std::uint32_t cells) { return cells / cells_a_part + 1; }

PartSeconds each_part(std::uint32_t cells, const ScheduleOptions& options, const std::function<void(const CellPart&)>& f) {
  using Clock = std::chrono::steady_clock;
  const auto since = [](Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); };
  VisitGraph independent;
  for (std::uint32_t i = 0; i < count_parts(cells); ++i) independent.add_visit();
  std::vector<double> seconds(independent.visits(), 0.0);
  const auto start = Clock::now();
  run_all(independent, options, [&](VisitGraph::Visit v) {
    const DefaultFloats floats;
    const auto part_start = Clock::now();
    f({v, v * cells_a_part, std::min(cells, (v + 1) * cells_a_part)});
    seconds[v] = since(part_start);
  });
  return {since(start), *std::max_element(seconds.begin(), seconds.end())};
}

}  // namespace pgdr::detail
