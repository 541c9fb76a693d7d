// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "detail/cell_parts.hpp"

#include <algorithm>

#include "detail/arena.hpp"
#include "detail/float_environment.hpp"
#include "pgdr/visit_graph.hpp"

namespace pgdr::detail {
namespace {

constexpr std::uint32_t cells_a_part = 1 << 15;

}  // namespace

int threads_of(const ScheduleOptions& options) {
  switch (options.executor) {
    case Executor::flow_graph: return arena_threads(options.threads);
    case Executor::threads: return std::max(options.threads, 1);
    case Executor::serial: break;
  }
  return 1;
}

std::uint32_t count_parts(std::uint32_t cells) { return cells / cells_a_part + 1; }

void each_part(std::uint32_t cells, const ScheduleOptions& options, const std::function<void(const CellPart&)>& f) {
  VisitGraph independent;
  for (std::uint32_t i = 0; i < count_parts(cells); ++i) independent.add_visit();
  const VisitBody body = [&](VisitGraph::Visit v) {
    const DefaultFloats floats;
    f({v, v * cells_a_part, std::min(cells, (v + 1) * cells_a_part)});
  };
  if (independent.visits() == 1) return body(0);
  switch (options.executor) {
    case Executor::flow_graph:
      in_arena_to_the_end(options.threads, [&] { run_flow_graph(independent, body); });
      break;
    case Executor::threads: run_threads(independent, body, static_cast<unsigned>(threads_of(options))); break;
    case Executor::serial: run_serial(independent, body); break;
  }
}

}  // namespace pgdr::detail
