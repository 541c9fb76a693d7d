// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// A stage of a run that does something else for poor elements than inserting points (element_splitter.hpp). What is poor is for
// the stage to say. In it elements belong to the leaves that hold their centroids, all have bucket 0, so that no leaf splits, and
// go by an order that the stage gives them. What was refused is tried again once the version of the element is another.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

#include "refine/delaunay_repair.hpp"
#include "refine/work_lister.hpp"
#include "refine/workspace.hpp"

namespace pgdr {

/// Treats the poor elements of a worker's visits in a stage of the run. One thread at a time. It counts in NodeVisit::counts
/// what it changes and evaluates, but for `refused`; inserts no point once NodeVisit::most_insertions are committed; and lists
/// the poor elements that it makes (WorkLister::list_element).
template <int D>
class ElementTreatment {
 public:
  virtual ~ElementTreatment() = default;
  virtual void begin_visit() = 0;                ///< is called before a visit does anything
  virtual Outcome treat(const Entry<D>& e) = 0;  ///< treats the element of an entry of kind cell
  virtual std::uint64_t version(
      CellId c) const = 0;  ///< a hash of what a decision about the element rests on (Refusal::versions)
};

/// A stage, which makes a treatment for each worker. Any thread.
template <int D>
class ElementStage {
 public:
  virtual ~ElementStage() = default;
  /// All three outlive it.
  virtual std::unique_ptr<ElementTreatment<D>> treatment(Workspace<D>& workspace, WorkLister<D>& lister,
                                                         DelaunayRepair<D>& repair) const = 0;
  /// `ElementTreatment::version`, between visits.
  virtual std::uint64_t version(CellId c) const = 0;
};

}  // namespace pgdr
