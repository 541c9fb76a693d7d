// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// One visit of a node of the tree: what it is asked to do, and what it did. Plain data; one thread at a time.
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "mesh/visit_area.hpp"
#include "refine/work_list.hpp"

namespace pgdr {

/// What was done, in one visit or in all.
struct RefineCounts {
  std::uint64_t committed = 0;         ///< insertions
  std::uint64_t refused = 0;           ///< entries that stay as they are: the insertion rule, or the stage, found nothing
  std::uint64_t selector_outside = 0;  ///< points of the selector outside their disk
  std::uint64_t selector_further = 0;  ///< of the insertions: further points of a selector of several
  std::uint64_t selector_dropped = 0;  ///< further points that were left out, where the first went in
  // The optimiser; what it undid does not count.
  std::uint64_t moves = 0;          ///< vertices that got another place
  std::uint64_t edge_removals = 0;  ///< edges that went, and faces in whose place one came
  std::uint64_t reconnections = 0;  ///< small polyhedra that were filled anew
  std::uint64_t removed = 0;        ///< vertices that went
  std::uint64_t evaluated = 0;      ///< qualities of cells that were asked for
  std::uint64_t out_of_budget = 0;  ///< entries that the visit did not look at, since it had evaluated as many as it may

  /// Changes of the mesh.
  std::uint64_t changes() const { return committed + moves + edge_removals + reconnections + removed; }
  /// Adds each.
  RefineCounts& operator+=(const RefineCounts& o) {
    committed += o.committed;
    refused += o.refused;
    selector_outside += o.selector_outside;
    selector_further += o.selector_further;
    selector_dropped += o.selector_dropped;
    moves += o.moves;
    edge_removals += o.edge_removals;
    reconnections += o.reconnections;
    removed += o.removed;
    evaluated += o.evaluated;
    out_of_budget += o.out_of_budget;
    return *this;
  }
};

/// What one visit is asked to do, and what it did.
template <int D>
struct NodeVisit {
  // asked
  const VisitArea<D>* area = nullptr;  ///< what it may change; null: everything
  WorkList<D>* list = nullptr;         ///< of the node
  std::vector<Entry<D>> given;         ///< set aside by earlier visits: these alone are treated, and what they bring
  bool treat_list = true;              ///< false: `given` only
  std::uint32_t level = 0;             ///< level of the node in its tree; for the trace
  std::uint32_t order = 1;             ///< order of the claim; for the trace and for Refusal
  std::uint64_t generation = 0;        ///< the generation that the visit is of; for the trace
  double small_radius = 0;             ///< end once no poor element is larger ...
  std::size_t floor = 0;               ///< ... and the list is crowded by this
  int granularity = std::numeric_limits<int>::max();                          ///< end this many buckets after the first
  std::uint64_t most_insertions = std::numeric_limits<std::uint64_t>::max();  ///< share of the budget
  // In a stage: the qualities that it may ask for: in all; for each entry of the list; and beside evaluations_a_change a change.
  std::uint64_t most_evaluated = std::numeric_limits<std::uint64_t>::max();
  std::uint64_t most_evaluated_an_entry = std::numeric_limits<std::uint32_t>::max();
  std::uint64_t most_unpaid = std::numeric_limits<std::uint64_t>::max();
  bool violations_seen = false;   ///< look for faces that are not locally Delaunay at every insertion
  bool entities_refused = false;  ///< has any visit refused an entity's split; after the visit, this one included?
  ChangeLog<D>* log = nullptr;    ///< where to log what changes; null: nowhere
  // done
  /// Entries for another node.
  struct Outbox {
    std::uint32_t node;             ///< which
    std::vector<Entry<D>> entries;  ///< in the order in which they were found
  };
  std::vector<Outbox> outboxes;     ///< elements that belong to other nodes, alive at the end
  std::vector<Entry<D>> set_aside;  ///< would have changed cells that the visit does not own
  RefineCounts counts;              ///< of this visit
  bool min_edge_hit = false;        ///< something was refused for `min_edge`
};

}  // namespace pgdr
