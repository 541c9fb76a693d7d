// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Delaunay refinement of one node of the tree: encroached subsegments first, then subfacets, then poor elements, those that are
// too big by buckets of a factor of two of the circumradius, largest first, then those of poor shape, shortest edge first
// (work_list.hpp; dissertation, sections 2.1, 3.4).
// The whole mesh refined as one node is the sequential algorithm.
//
// Every run ends, whatever the input angles: see insertion_rule.hpp. What is refused stays, and elements that stay poor
// name the two input entities that meet at the small angle (poor_reasons.hpp).
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "mesh/key_set.hpp"
#include "refine/context.hpp"
#include "refine/delaunay_repair.hpp"
#include "refine/element_splitter.hpp"
#include "refine/element_stage.hpp"
#include "refine/entity_splitter.hpp"
#include "refine/inserter.hpp"
#include "refine/node_visit.hpp"
#include "refine/work_lister.hpp"
#include "refine/workspace.hpp"

namespace pgdr {

/// A worker: runs visits, one thread at a time.
template <int D>
class Refiner {
 public:
  using Pools = typename Mesh<D>::Pools;  ///< of this worker

  Refiner(RefineContext<D>& context, Pools pools);  ///< the context must outlive it
  ~Refiner();

  /// Treats what waits, and what that brings forth, until nothing is left that the visit may treat or the run is stopped.
  /// @throws what a callback throws; the mesh is whole then.
  void run(NodeVisit<D>& visit);

  /// Repairs the violations on the visit's list, and those that this brings, and treats nothing else; until the run is stopped.
  void repair(NodeVisit<D>& visit);

  /// Forgets what its treatment has learnt of cells, as when these have got other numbers. Between visits.
  void forget_cells() {
    stage_ = nullptr;
    treatment_ = nullptr;
  }
  /// Makes `visit` the one that list_cell lists for.
  void begin(NodeVisit<D>& visit);
  /// Lists what is encroached or poor at a cell that the visit owns.
  void list_cell(CellId c) { lister_.list_cell(c); }
  /// Must be called after the last list_cell: some of it may wait for sizes. @throws what a size function throws
  void end_listing() { lister_.ask_sizes(); }

 private:
  enum class Until { none_wait, element_is_next };
  bool treat_entities(Until until);
  bool is_larger_than_entities();
  void treat_elements();
  void treat(const Entry<D>& e);
  Outcome treat_poor(const Entry<D>& e) { return treatment_ ? treat_in_stage(e) : elements_.split(e); }
  Outcome treat_in_stage(const Entry<D>& e);
  bool may_go_on();
  bool sizes_decide();
  bool any_poor();
  void look_at_budget();
  void record_refusal(const Entry<D>& e);
  std::vector<CellName> distinct_trace(const Entry<D>& e);

  Workspace<D> workspace_;
  WorkLister<D> lister_;
  DelaunayRepair<D> repair_;
  Inserter<D> inserter_;
  EntitySplitter<D> entities_;
  ElementSplitter<D> elements_;
  const ElementStage<D>* stage_ = nullptr;          ///< that the treatment is of
  std::unique_ptr<ElementTreatment<D>> treatment_;  ///< of poor elements; null: points are inserted
  std::uint64_t most_evaluated_ = 0;                ///< by the treatment, in the visit
  bool undecided_ = false;                          ///< of the entry treated: was it beyond that?
  std::uint64_t treated_ = 0, checked_at_ = 0, reported_ = 0, evaluations_reported_ = 0;
  std::uint64_t stride_ = 1;  ///< entries between two looks at the clock
  std::chrono::steady_clock::time_point checked_time_;
  KeySet distinct_;
};

extern template class Refiner<2>;
extern template class Refiner<3>;

}  // namespace pgdr
