// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// One visit of a region: what it is asked to do, and what it did. Plain data; one thread at a time.
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
  std::uint64_t improved = 0;          ///< changes for elements that stay poor, insertions among them
  std::uint64_t refused = 0;           ///< entries that the insertion rule refused
  std::uint64_t selector_outside = 0;  ///< points of the selector outside their disk

  /// Adds each.
  RefineCounts& operator+=(const RefineCounts& o) {
    committed += o.committed;
    improved += o.improved;
    refused += o.refused;
    selector_outside += o.selector_outside;
    return *this;
  }
};

/// What one visit is asked to do, and what it did.
template <int D>
struct RegionVisit {
  // asked
  const VisitArea<D>* area = nullptr;  ///< what it may change; null: everything
  WorkList<D>* list = nullptr;         ///< of the region
  std::vector<Entry<D>> given;         ///< set aside by earlier visits: these alone are treated, and what they bring
  bool treat_list = true;              ///< false: `given` only
  std::uint32_t level = 0;             ///< level of the region in its tree; for the trace
  std::uint32_t order = 1;             ///< order of the claim; for the trace and for Refusal
  std::uint64_t generation = 0;        ///< the generation that the visit is of; for the trace and for Refusal
  double small_radius = 0;             ///< end once no poor element is larger ...
  std::size_t floor = 0;               ///< ... and the list is crowded by this
  int granularity = std::numeric_limits<int>::max();                          ///< end this many buckets after the first
  std::uint64_t most_insertions = std::numeric_limits<std::uint64_t>::max();  ///< share of the budget
  bool violations_seen = false;   ///< look for faces that are not locally Delaunay at every insertion
  bool entities_refused = false;  ///< has any visit refused an entity's split; after the visit, this one included?
  // done
  /// Entries for another region.
  struct Outbox {
    std::uint32_t leaf;             ///< which
    std::vector<Entry<D>> entries;  ///< in the order in which they were found
  };
  std::vector<Outbox> outboxes;     ///< elements with their circumcentre in other regions, alive at the end
  std::vector<Entry<D>> set_aside;  ///< would have changed cells that the visit does not own
  RefineCounts counts;              ///< of this visit
  bool changed_mesh = false;        ///< by an insertion or a flip
  bool min_edge_hit = false;        ///< something was refused for `min_edge`
};

}  // namespace pgdr
