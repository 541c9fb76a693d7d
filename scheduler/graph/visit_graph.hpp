// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The graph of the visits of a generation, in which each waits for some of the earlier ones, and its executors: one after the
// other, shuffled, as nodes of a oneTBB flow graph, and on plain threads (so that a thread sanitizer sees our code without the
// reports of TBB's own). A visit is a number here, and its body one call.
//
//      visit 0 ----> visit 2 ----> visit 4        an edge u -> v, always u < v: v starts when u has ended
//              \--> visit 3 --/
//      visit 1 ----/
//
// Every executor runs `body(v)` once for each visit v, after the bodies of all its predecessors; what a body wrote is
// visible to the bodies that depend on it. Bodies may run at once on any thread, and take their workspaces themselves.
// If a body throws, no further visit starts, those that run end, and then the exception comes out as it is; if several
// threw, the one of the lowest visit number among them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <random>
#include <span>
#include <vector>

namespace pgdr {

/// Visits 0, 1, 2, ... in their total order. Threads: const members from any thread.
class VisitGraph {
 public:
  using Visit = std::uint32_t;  ///< its number

  /// Adds the next visit, which waits for `predecessors`: earlier visits, each named once. @returns its number
  Visit add_visit(std::span<const Visit> predecessors = {});

  Visit visits() const { return static_cast<Visit>(first_.size() - 1); }  ///< so many
  std::size_t edges() const { return predecessors_.size(); }              ///< pairs of a visit and one that it waits for
  /// The visits that v waits for.
  std::span<const Visit> predecessors(Visit v) const {
    return std::span(predecessors_).subspan(first_[v], first_[v + 1] - first_[v]);
  }

 private:
  std::vector<std::size_t> first_{0};
  std::vector<Visit> predecessors_;
};

/// How a graph was worked off.
struct VisitRun {
  std::uint32_t visits_planned = 0;  ///< of the graph
  std::uint32_t visits_run = 0;      ///< of these
  std::uint32_t max_concurrent = 0;  ///< most bodies that ran at one time
  /// False if somebody cancelled the task group in which the caller runs: the rest was not run, and nothing was thrown.
  bool complete() const { return visits_run == visits_planned; }
};

using VisitBody = std::function<void(VisitGraph::Visit)>;  ///< runs one visit; may throw

/// Runs the visits in the order of their numbers, on the calling thread.
VisitRun run_serial(const VisitGraph& graph, const VisitBody& body);

/// Runs the visits on the calling thread, each time one at random of those that are free to run.
VisitRun run_shuffled(const VisitGraph& graph, const VisitBody& body, std::mt19937_64& random);

/// Runs the visits in the caller's task arena. Parallel work inside a body never starts another visit on top of it.
VisitRun run_flow_graph(const VisitGraph& graph, const VisitBody& body);

/// Runs the visits on `threads` threads, the caller's among them (at least one); lower numbers first of those that may run.
VisitRun run_threads(const VisitGraph& graph, const VisitBody& body, unsigned threads);

/// The seconds of the longest chain of visits, where visit v takes `seconds[v]`.
double critical_path(const VisitGraph& graph, std::span<const double> seconds);

}  // namespace pgdr
